#include "solver/uncarried_load.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/dense_templates.h"

namespace mortier {
namespace {

/// The generators of all forces that contact can exert, as loads on rigid motions, each of length one.
Matrix directionsOf(const ContactProblem& problem) {
  constexpr int sides = 16;  // of the polygons around the cones of space
  const auto& [node, law, components] = problem.along;
  const Eigen::Index normals = problem.G.rows() - problem.along.conditions();
  std::vector<char> slips(normals, 0);
  std::vector<Vector> directions;
  const auto add = [&](const Vector& direction) {
    if (const double size = direction.norm(); size > 0) directions.emplace_back(direction / size);
  };
  for (size_t k = 0; k < node.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Matrix along = problem.G.middleRows(normals + components * row, components).transpose();
    slips[node[k]] = 1;
    const int corners = components == 1 ? 2 : sides;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * M_PI * i / corners;
      const Vector way =
          components == 1
              ? Vector((1 - 2 * i) * along)
              : Vector(along * Point(std::cos(angle), std::sin(angle)) / std::cos(M_PI / corners));
      add(problem.G.row(node[k]).transpose() + law.coefficient[row] * way);
      if (law.limit[row] > 0) add(way);
    }
  }
  for (Eigen::Index i = 0; i < normals; ++i)
    if (slips[i] == 0) add(problem.G.row(i).transpose());
  Matrix result(problem.G.cols(), static_cast<Eigen::Index>(directions.size()));
  for (size_t i = 0; i < directions.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = directions[i];
  return result;
}

}  // namespace

std::optional<Vector> uncarriedLoad(const ContactProblem& problem, const Vector& load) {
  constexpr double rounding = 1e-12;
  constexpr double uncarried = 1e-6;  // of the load: less may be that of forces that were not found exactly
  constexpr double resisted = 1e-9;   // of the motion
  const Matrix A = directionsOf(problem);
  Vector x = Vector::Zero(A.cols());
  std::vector<int> used;
  Vector rest = load;
  const double size = load.norm();
  // Each round the columns in use are fewer than the motions, or one of them is left again.
  for (Eigen::Index round = 0; round < 3 * A.cols() + 3; ++round) {
    Eigen::Index entering = 0;
    const Vector drive = A.transpose() * rest;
    if (A.cols() == 0 || !(drive.maxCoeff(&entering) > rounding * size)) break;
    if (std::find(used.begin(), used.end(), entering) != used.end()) break;  // what is left is rounding
    used.push_back(static_cast<int>(entering));
    while (!used.empty()) {
      const Vector best = Matrix(A(Eigen::all, used)).colPivHouseholderQr().solve(load);
      double step = 1;
      for (size_t k = 0; k < used.size(); ++k)
        if (const auto i = static_cast<Eigen::Index>(k); !(best[i] > 0))
          step = std::min(step, x[used[k]] / (x[used[k]] - best[i]));
      for (size_t k = 0; k < used.size(); ++k)
        x[used[k]] += step * (best[static_cast<Eigen::Index>(k)] - x[used[k]]);
      if (step == 1) break;
      const double least = rounding * x.maxCoeff();
      const auto drops = [&](int i) { return x[i] <= least; };
      for (const int i : used)
        if (drops(i)) x[i] = 0;
      used.erase(std::remove_if(used.begin(), used.end(), drops), used.end());
    }
    rest = load - A * x;
  }
  const double left = rest.norm();
  if (!(left > uncarried * size)) return std::nullopt;
  if (A.cols() > 0 && (A.transpose() * rest).maxCoeff() > resisted * left) return std::nullopt;
  return rest;
}

}  // namespace mortier
