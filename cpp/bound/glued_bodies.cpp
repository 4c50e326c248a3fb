#include "bound/quantity_bound.h"

#include "base/dense_templates.h"

namespace mortier {
namespace {

/// Of directions, and of jumps where supports prescribe them.
constexpr double rounding = 1e-12;
/// What a solution may leave over of the right-hand side.
constexpr double accurate = 1e-9;

}  // namespace

GluedBodies::GluedBodies(const std::vector<LoadedBody>& bodies, const std::vector<Facing>& facing)
    : bodies_(bodies), facing_(facing), kept_(bodies.size()), rows_(facing.size()) {
  std::vector<std::vector<int>> placeOf;
  placeOf.reserve(bodies.size());
  for (const LoadedBody& body : bodies) placeOf.emplace_back(body.body().freeDofs(), -1);
  const auto parts = [&](size_t i, int side) {
    return bodies[facing[i].bodies[side]].body().parts(facing[i].vertices[side], facing[i].normal);
  };
  for (size_t i = 0; i < facing.size(); ++i)
    for (int side = 0; side < 2; ++side)
      for (const auto& [equation, value] : parts(i, side))
        if (equation >= 0 && std::abs(value) > rounding) placeOf[facing[i].bodies[side]][equation] = 0;
  for (size_t b = 0; b < bodies.size(); ++b)
    for (size_t e = 0; e < placeOf[b].size(); ++e)
      if (placeOf[b][e] == 0) {
        kept_[b].push_back(static_cast<int>(e));
        placeOf[b][e] = size_++;
      }
  for (size_t i = 0; i < facing.size(); ++i)
    for (int side = 0; side < 2; ++side)
      for (const auto& [equation, value] : parts(i, side))
        if (equation >= 0 && std::abs(value) > rounding)
          rows_[i].push_back({placeOf[facing[i].bodies[side]][equation], side == 0 ? value : -value});
  for (size_t b = 0; b < bodies.size(); ++b) {
    const std::vector<double> values = bodies[b].tangent();
    solvers_.push_back(multifrontalSolver(bodies[b].body().pattern(), kept_[b]));
    if (solvers_[b]->factorise(values)) continue;
    solvers_[b] = suiteSparseSolver(bodies[b].body().pattern(), kept_[b]);
    if (!solvers_[b]->factorise(values)) solvers_[b].reset();
  }
}

double GluedBodies::jump(const std::vector<Vector>& v, size_t facing) const {
  const auto& [bodies, vertices, normal, gap, weight] = facing_[facing];
  return normal.dot(v[bodies[0]].segment<2>(2 * vertices[0]) - v[bodies[1]].segment<2>(2 * vertices[1]));
}

std::optional<GluedBodies::Solution> GluedBodies::solve(const Given& given) const {
  std::vector<size_t> glue;
  const double largest = given.jumps.size() > 0 ? given.jumps.cwiseAbs().maxCoeff() : 0;
  for (size_t i = 0; i < facing_.size(); ++i) {
    if (given.glued[i] == 0) continue;
    if (!rows_[i].empty()) {
      glue.push_back(i);
    } else if (std::abs(given.jumps[static_cast<Eigen::Index>(i)] - jump(given.held, i)) >
               rounding * largest) {
      return std::nullopt;
    }
  }
  const auto all = size_ + static_cast<Eigen::Index>(glue.size());
  Matrix A = Matrix::Zero(all, all);
  Vector right = Vector::Zero(all);
  std::vector<Vector> condensed;
  Eigen::Index first = 0;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    if (!solvers_[b]) return std::nullopt;
    const LoadedBody& body = bodies_[b];
    condensed.push_back(body.body().gather(body.leftOver(given.loads[b], body.stressOf(given.held[b]))));
    solvers_[b]->condense(condensed[b]);
    const auto kept = static_cast<Eigen::Index>(kept_[b].size());
    if (kept > 0) A.block(first, first, kept, kept) = solvers_[b]->schurComplement();
    right.segment(first, kept) = condensed[b](kept_[b]);
    first += kept;
  }
  const double scale = size_ > 0 ? A.diagonal().head(size_).cwiseAbs().maxCoeff() : 1;
  for (size_t k = 0; k < glue.size(); ++k) {
    const auto row = size_ + static_cast<Eigen::Index>(k);
    for (const auto& [place, value] : rows_[glue[k]]) {
      A(row, place) += scale * value;
      A(place, row) += scale * value;
    }
    right[row] = scale * (given.jumps[static_cast<Eigen::Index>(glue[k])] - jump(given.held, glue[k]));
  }
  Vector x = A.partialPivLu().solve(right);
  const auto fails = [&] {
    return !x.allFinite() ||
           !((A * x - right).cwiseAbs().maxCoeff() <= accurate * right.cwiseAbs().maxCoeff());
  };
  if (all > 0 && fails()) {  // conditions may depend on each other
    x = A.completeOrthogonalDecomposition().solve(right);
    if (fails()) return std::nullopt;
  }
  Solution solution{{}, Vector::Zero(static_cast<Eigen::Index>(facing_.size()))};
  for (size_t k = 0; k < glue.size(); ++k)
    solution.forces[static_cast<Eigen::Index>(glue[k])] = scale * x[size_ + static_cast<Eigen::Index>(k)];
  first = 0;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const auto kept = static_cast<Eigen::Index>(kept_[b].size());
    condensed[b](kept_[b]) = x.segment(first, kept);
    solvers_[b]->expand(condensed[b]);
    solution.displacements.emplace_back(bodies_[b].body().spread(condensed[b]) + given.held[b]);
    first += kept;
  }
  return solution;
}

}  // namespace mortier
