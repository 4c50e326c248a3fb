// The direct solution of bound/relaxation.h: the modes of all sides and vertices at once.
#include "bound/relaxation.h"
#include "linear/condensing_solver.h"
#include "linear/matrix_entries.h"

namespace mortier {

Relaxation::TriangleModes Relaxation::modesOf(int triangle, const std::vector<int>& sideNumbers,
                                              const std::vector<int>& vertexNumbers,
                                              const std::vector<Matrix>& vertexModes) const {
  TriangleModes result;
  result.effects.setZero(12, 12);
  const auto add = [&](int number) {
    result.numbers.push_back(number);
    return static_cast<Eigen::Index>(result.numbers.size()) - 1;
  };
  for (int k = 0; k < 3; ++k) {
    const int side = sides_.of(triangle, k);
    if (sideNumbers[side] < 0) continue;
    const Eigen::Index column = add(sideNumbers[side]);
    result.effects.block<2, 1>(4 * k, column) = normalMode(side);
    result.effects.block<2, 1>(4 * k + 2, column) = -normalMode(side);
  }
  for (int i = 0; i < 3; ++i) {
    const int vertex = mesh_.triangles[triangle][i];
    const Matrix& modes = vertexModes[vertex];
    const double length = lengthAt(vertex);
    for (Eigen::Index m = 0; m < modes.cols(); ++m) {
      const Eigen::Index column = add(vertexNumbers[vertex] + static_cast<int>(m));
      for (const int k : {i, (i + 2) % 3})
        result.effects.block<4, 1>(4 * k, column) += seenBy(triangle, k, vertex, length) * modes.col(m);
    }
  }
  result.effects.conservativeResize(12, static_cast<Eigen::Index>(result.numbers.size()));
  return result;
}

bool Relaxation::minimise() {
  int count = 0;
  std::vector<int> sideNumbers(sides_.count(), -1);
  for (int side = 0; side < sides_.count(); ++side)
    if (mayChange(side)) sideNumbers[side] = count++;
  std::vector<int> vertexNumbers;
  std::vector<Matrix> vertexModes;
  for (int vertex = 0; vertex < static_cast<int>(mesh_.vertices.size()); ++vertex) {
    vertexModes.push_back(allowedModes(vertex, lengthAt(vertex)));
    vertexNumbers.push_back(count);
    count += static_cast<int>(vertexModes.back().cols());
  }
  if (count == 0) return true;
  std::vector<MatrixEntry> entries;
  Vector slope = Vector::Zero(count);
  for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
    const auto [effects, numbers] = modesOf(t, sideNumbers, vertexNumbers, vertexModes);
    const CompositeTriangle element = elementOf(t);
    const MomentMatrix ofMoments = element.energy();
    const Matrix energy = effects.transpose() * ofMoments * effects;
    Moments gradient = ofMoments * differenceOf(t, element);
    if (!forces_[t].isZero(0)) gradient += element.loadProduct(forces_[t]);
    const Vector by = effects.transpose() * gradient;
    for (size_t i = 0; i < numbers.size(); ++i) {
      slope[numbers[i]] += by[static_cast<Eigen::Index>(i)];
      for (size_t j = 0; j < numbers.size(); ++j)
        if (numbers[i] >= numbers[j])
          entries.push_back(
              {numbers[j], numbers[i], energy(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))});
    }
  }
  auto [pattern, values] = assembled(count, entries);
  // A linear function is no stress. What this adds moves the minimum by as little.
  constexpr double regularised = 1e-12;
  for (int c = 0; c < count; ++c) values[pattern.columnStart[c]] *= 1 + regularised;  // the diagonal
  auto solver = multifrontalSolver(pattern, {});
  if (!solver->factorise(values)) return false;
  Vector amounts = -slope;
  solver->condense(amounts);
  solver->expand(amounts);
  if (!amounts.allFinite()) return false;
  for (int side = 0; side < sides_.count(); ++side) {
    if (sideNumbers[side] >= 0) {
      moments_[side][0] += amounts[sideNumbers[side]] * normalMode(side);
      moments_[side][1] -= amounts[sideNumbers[side]] * normalMode(side);
    }
    for (const int vertex : sides_.all()[side].vertices) {
      const Matrix& modes = vertexModes[vertex];
      const Eigen::Vector4d by = modesOf(side, vertex, lengthAt(vertex)) *
                                 (modes * amounts.segment(vertexNumbers[vertex], modes.cols()));
      moments_[side][0] += by.head<2>();
      moments_[side][1] += by.tail<2>();
    }
  }
  return true;
}

}  // namespace mortier
