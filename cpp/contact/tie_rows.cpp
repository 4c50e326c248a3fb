// The rows of a tie: along which directions the jump of which nodes vanishes, or gives way.
#include <algorithm>
#include <cmath>

#include "contact/interface_entries.h"
#include "contact/tie_jumps.h"

namespace mortier {

void Tie::setRows(const Jumps& jumps, const TieOptions& options) {
  const auto points = static_cast<Eigen::Index>(jumps.elements.size());
  points_ = {jumps.elements, Eigen::Map<const Vector>(jumps.weights.data(), points),
             Eigen::Map<const Vector>(jumps.sizes.data(), points),
             options.stiffness > 0 ? 1 / options.stiffness : 0};
  along_ = options.along;
  const auto count = static_cast<Eigen::Index>(jumps.rowOf.size());
  Vector scale(count);
  for (Eigen::Index i = 0; i < count; ++i) scale[i] = 1 / jumps.lengths.at(static_cast<int>(i));
  // Of the sides, and the row functions by points.
  std::vector<ConstraintRows> values;
  for (size_t k = 0; k < sides_.size(); ++k) {
    sides_[k].traces = assembled(points, nodesOfSides_[k], jumps.traces[k]);
    values.emplace_back(scale.asDiagonal() *
                        assembled<ConstraintRows>(count, nodesOfSides_[k], jumps.sides[k]));
  }
  values.emplace_back(scale.asDiagonal() * assembled<ConstraintRows>(count, points, jumps.functions));
  // Directions of the rows of nodes, and which of them are held.
  const bool atNodes = pair_.coupling == CouplingKind::interpolation;
  std::vector<Eigen::Matrix3d> frames(count, Eigen::Matrix3d::Identity());
  std::vector<std::array<char, 3>> held(count, std::array<char, 3>{});
  const auto isHeld = [](const TieOptions::Held& by, int node, const SpacePoint& d) {
    return by && by(node, d);
  };
  std::map<int, int> parts;  // that meet at a node
  for (const auto& [key, row] : jumps.rowOf) ++parts[key.first];
  for (const auto& [key, row] : jumps.rowOf) {
    const int node = key.first;
    if (options.frame && options.along == std::array{true, true, true}) frames[row] = options.frame(node);
    const bool taken = parts[node] > 1 || (options.taken && options.taken(node));
    for (int c = 0; c < dimension_; ++c)
      held[row][c] = taken || isHeld(options.nonmortarHeld, node, frames[row].row(c)) ? 1 : 0;
  }
  const auto moves = [&](int row, const SpacePoint& d) {
    const std::array by{&options.nonmortarHeld, &options.mortarHeld, &options.offsetHeld};
    for (size_t k = 0; k < sides_.size(); ++k)
      for (ConstraintRows::InnerIterator entry(values[k], row); entry; ++entry)
        if (!isHeld(*by[k], static_cast<int>(entry.col()), d)) return true;
    return false;
  };
  // A held direction goes to neighbours that are not held along it; it stays where there are none.
  const auto takers = [&](int row, const SpacePoint& direction) {
    constexpr double nearly = 0.5;
    std::vector<int> result;
    for (const int neighbour : jumps.neighbours.at(row)) {
      bool takes = neighbour != row;
      for (int c = 0; c < dimension_ && takes; ++c)
        takes = held[neighbour][c] == 0 || std::abs(frames[neighbour].row(c).dot(direction)) < nearly;
      if (takes) result.push_back(neighbour);
    }
    return result;
  };
  std::vector<std::array<int, 3>> rowOf(count, std::array{-1, -1, -1});
  std::vector<std::array<std::vector<int>, 3>> goesTo(count);
  std::vector<std::pair<int, int>> heldRows;  // and axes
  int rows = 0;
  std::set<int> done;
  for (const auto& [key, row] : jumps.rowOf) {
    const int node = key.first;
    const bool dropped = atNodes && ((options.taken && options.taken(node)) || !done.insert(node).second);
    for (int c = 0; c < dimension_; ++c) {
      if (!options.along[c]) continue;
      const SpacePoint d = frames[row].row(c);
      if (held[row][c] != 0 && !atNodes) goesTo[row][c] = takers(row, d);
      if (!goesTo[row][c].empty() || dropped) continue;
      if (moves(row, d))
        rowOf[row][c] = rows++;
      else if (options.kind == TieKind::kinematic)
        heldRows.emplace_back(row, c);
    }
  }
  using Entries = std::vector<Triplets>;
  const auto addRowTo = [&](Entries& into, int from, int to, const SpacePoint& d, double factor) {
    for (size_t k = 0; k < values.size(); ++k)
      for (ConstraintRows::InnerIterator entry(values[k], from); entry; ++entry)
        for (int c = 0; c < dimension_; ++c)
          if (const double value = factor * entry.value() * d[c]; value != 0)
            into[k].emplace_back(to, dimension_ * static_cast<int>(entry.col()) + c, value);
  };
  const auto rowsOf = [&](const Entries& of, size_t side, int number) {
    return assembled<ConstraintRows>(number, static_cast<Eigen::Index>(dimension_) * nodesOfSides_[side],
                                     of[side]);
  };
  Entries entries(values.size());
  const auto addRow = [&](int from, int to, const SpacePoint& d, double factor) {
    addRowTo(entries, from, to, d, factor);
  };
  Entries heldEntries(values.size());
  std::set<int> nodes;
  for (const auto& [key, row] : jumps.rowOf) {
    for (int c = 0; c < dimension_; ++c) {
      const SpacePoint d = frames[row].row(c);
      if (rowOf[row][c] >= 0) {
        addRow(row, rowOf[row][c], d, 1);
        nodes.insert(key.first);
        continue;
      }
      const std::vector<int>& to = goesTo[row][c];
      for (const int taker : to)
        for (int k = 0; k < dimension_; ++k)
          if (const double part = frames[taker].row(k).dot(d); rowOf[taker][k] >= 0 && part != 0)
            addRow(row, rowOf[taker][k], d,
                   scale[taker] / scale[row] * part / static_cast<double>(to.size()));
    }
  }
  nodes_.assign(nodes.begin(), nodes.end());
  std::vector<int> nodeOf(count);
  for (const auto& [key, row] : jumps.rowOf) nodeOf[row] = key.first;
  for (const auto& [row, c] : heldRows) {
    addRowTo(heldEntries, row, static_cast<int>(heldNodes_.size()), frames[row].row(c), 1);
    heldNodes_.push_back(nodeOf[row]);
  }
  for (size_t k = 0; k < sides_.size(); ++k) {
    sides_[k].C = rowsOf(entries, k, rows);
    heldRows_.push_back(rowsOf(heldEntries, k, static_cast<int>(heldNodes_.size())));
  }
  setCompliance(options.stiffness, assembled(rows, dimension_ * points, entries.back()), points_.weights);
}

// A row for each rigid motion phi: sum_a w_a phi(x_a) . (u1 - u2)(x_a), over the side and the root of the
// mean square of phi.
void Tie::setMeanRows(const std::map<int, double>& parts, const Jumps& jumps, const RigidTrace& point,
                      const TieOptions& options) {
  const int n = dimension_;
  double whole = 0;
  SpacePoint centre = SpacePoint::Zero();
  for (const auto& [node, part] : parts) {
    whole += part;
    centre += part * jumps.placeOf(node);
  }
  centre /= whole;
  using Motion = std::function<SpacePoint(const SpacePoint&)>;
  std::vector<Motion> motions;
  for (int c = 0; c < n; ++c)
    if (options.along[c] && (!options.axisymmetric || c == 1))
      motions.emplace_back([c](const SpacePoint&) { return SpacePoint(SpacePoint::Unit(c)); });
  const bool turns = !options.axisymmetric && options.along == std::array{true, true, true};
  for (int c = n == 3 ? 0 : 2; c < 3 && turns; ++c)
    motions.emplace_back(
        [c, &centre](const SpacePoint& x) { return SpacePoint(SpacePoint::Unit(c).cross(x - centre)); });
  std::vector<double> weights;
  for (const auto& [node, part] : parts)
    if (part > 0) weights.push_back(part);
  std::array<Triplets, 2> entries;
  Triplets functions;
  int row = 0;
  for (const Motion& motion : motions) {
    double square = 0;
    for (const auto& [node, part] : parts) square += part * motion(jumps.placeOf(node)).squaredNorm();
    if (!(square > 0)) continue;
    const double scale = 1 / std::sqrt(whole * square);
    int number = 0;
    for (const auto& [node, part] : parts) {
      if (!(part > 0)) continue;
      const SpacePoint x = jumps.placeOf(node);
      const SpacePoint value = scale * part * motion(x);
      for (int c = 0; c < n; ++c) {
        entries[0].emplace_back(row, n * node + c, value[c]);
        functions.emplace_back(row, n * number + c, value[c]);
        for (const auto& [of, shape] : point.at(x))
          entries[1].emplace_back(row, n * of + c, -shape * value[c]);
      }
      ++number;
    }
    ++row;
  }
  for (size_t k = 0; k < sides_.size(); ++k)
    sides_[k].C = assembled<ConstraintRows>(row, static_cast<Eigen::Index>(n) * nodesOfSides_[k],
                                            k < 2 ? entries[k] : Triplets());
  for (const auto& [node, part] : parts) nodes_.push_back(node);
  setCompliance(options.stiffness, assembled(row, n * static_cast<Eigen::Index>(weights.size()), functions),
                Eigen::Map<const Vector>(weights.data(), static_cast<Eigen::Index>(weights.size())));
}

void Tie::setCompliance(double stiffness, const Eigen::SparseMatrix<double>& functions,
                        const Vector& weights) {
  if (!(stiffness > 0)) return;
  layer_ = functions;
  for (int column = 0; column < layer_.outerSize(); ++column)
    layer_.col(column) /= stiffness * weights[column / dimension_];
  compliance_ = functions * layer_.transpose();
}

}  // namespace mortier
