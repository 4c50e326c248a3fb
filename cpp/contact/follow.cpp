// Rows that follow the bodies: the lines as drawn, moved, and coupled anew.
#include <algorithm>
#include <map>
#include <utility>

#include "contact/element_tree.h"
#include "contact/interface_entries.h"

namespace mortier {

struct ContactInterface::Lines {
  BoundaryLine nonmortar;  ///< as drawn
  BoundaryLine mortar;
  std::vector<std::shared_ptr<const SmoothPart>> nonmortarParts, mortarParts;
  std::vector<std::vector<char>> merged;  ///< by nonmortar parts and vertices
  std::vector<std::map<int, int>> rowOf;  ///< by nonmortar parts and node numbers
  double stiffness = 1;
  bool stabilised = false;
  double mortarCompliance = 0;
  std::vector<std::vector<char>> symmetric;  ///< by nonmortar parts and vertices
  double shorter = 0;                        ///< of the two lines [m]
  double apart = 0;  ///< distance of a node that faces nothing: the length of its line [m]
};

namespace {

std::vector<std::shared_ptr<const SmoothPart>> shared(std::vector<SmoothPart> parts) {
  std::vector<std::shared_ptr<const SmoothPart>> result;
  for (SmoothPart& part : parts) result.push_back(std::make_shared<const SmoothPart>(std::move(part)));
  return result;
}

/// moved(); an end on the axis x = 0 keeps a normal along it, without which its node may face nothing.
SmoothPart movedTo(const std::shared_ptr<const SmoothPart>& drawn, const Vector& u, bool axisymmetric) {
  constexpr double along = 1e-6;
  SmoothPart part = moved(drawn, u);
  if (!axisymmetric || part.closed) return part;
  for (const size_t end : {size_t{0}, part.points.size() - 1})
    if (const Point& before = drawn->normals[end]; part.points[end].x() == 0 && std::abs(before.x()) < along)
      part.normals[end] = {0, before.y() > 0 ? 1 : -1};
  return part;
}

double lengthOf(const std::vector<std::shared_ptr<const SmoothPart>>& parts) {
  double length = 0;
  for (const auto& part : parts) length += part->length();
  return length;
}

}  // namespace

void ContactInterface::drawLines(const BoundaryLine& nonmortar, const BoundaryLine& mortar,
                                 const InterfaceOptions& options) {
  auto lines = std::make_shared<Lines>();
  lines->nonmortar = nonmortar;
  lines->mortar = mortar;
  lines->nonmortarParts = shared(partsFacing(nonmortar, mortar));
  lines->mortarParts = shared(smoothParts(mortar, Kinks::ofStraightElements));
  lines->stiffness = options.stiffness;
  lines->stabilised = options.stabilised;
  lines->mortarCompliance = options.mortarCompliance;
  lines->apart = lengthOf(lines->nonmortarParts);
  lines->shorter = std::min(lines->apart, lengthOf(lines->mortarParts));
  for (const auto& drawn : lines->nonmortarParts) {
    const SmoothPart& part = *drawn;
    const bool merges = pair_.coupling != CouplingKind::interpolation;
    const std::vector<char>& merged =
        lines->merged.emplace_back(merges ? mergedNodes(CommonRefinement(part), pair_.coupling, options)
                                          : std::vector<char>(part.nodes.size(), 0));
    lines->symmetric.push_back(symmetricEnds(CommonRefinement(part), options));
    heldEnds_ += static_cast<int>(std::count(merged.begin(), merged.end(), 1));
    std::map<int, int>& rowOf = lines->rowOf.emplace_back();
    const auto add = [&](int node) {
      if (!rowOf.try_emplace(node, static_cast<int>(nonmortarNodes_.size())).second) return;
      nonmortarNodes_.push_back(node);
    };
    const bool middles = rowDegree(pair_.coupling, part.degree()) == 2;
    for (int i = 0; i <= part.elements(); ++i) {
      if (merged[i] == 0) add(part.nodes[i]);
      if (middles && i < part.elements() && merged[i] == 0 && merged[i + 1] == 0) add(part.middles[i]);
    }
  }
  nonmortarLine_ = nonmortar.nodes;
  if (nonmortar.closed) nonmortarLine_.pop_back();
  nonmortarLine_.insert(nonmortarLine_.end(), nonmortar.middleNodes.begin(), nonmortar.middleNodes.end());
  lines_ = std::move(lines);
}

void ContactInterface::follow(const Vector& u1, const Vector& u2, bool keepRows, const MortarMotion* motion) {
  if (surfaces_ != nullptr)
    followSurfaces(u1, u2, keepRows, motion);
  else
    followLines(u1, u2, keepRows, motion);
}

void ContactInterface::followLines(const Vector& u1, const Vector& u2, bool keepRows,
                                   const MortarMotion* motion) {
  const Lines& lines = *lines_;
  const Vector& moved2 = motion != nullptr ? motion->moved : u2;
  // Contact acts along the normal of the stiffer body, which hardly bends.
  const double mortarShare = lines.stiffness < 1 ? 1 : 0;
  std::vector<SmoothPart> across;
  for (const auto& part : lines.mortarParts) across.push_back(movedTo(part, moved2, axisymmetric_));
  const MortarLine mortar(across, lines.mortar.closed);

  const auto n = static_cast<Eigen::Index>(nonmortarNodes_.size());
  Entries entries;
  const std::vector<char> facedBefore = std::move(faces_);
  const std::vector<ContactDirections> directionsBefore = std::exchange(directions_, {});
  faces_.assign(n, 0);
  normals_.resize(n, SpacePoint(0, 0, 0));
  penetration_ = {};
  lengths_ = Vector::Zero(n);
  distanceHere_ = Vector::Constant(n, lines.apart);
  overlap_ = 0;
  std::vector<int> corners;
  for (size_t k = 0; k < lines.nonmortarParts.size(); ++k) {
    const std::map<int, int>& rowOf = lines.rowOf[k];
    const SmoothPart part = movedTo(lines.nonmortarParts[k], u1, axisymmetric_);
    const CommonRefinement facing(part, mortar, mortarShare, keepRows ? &directionsBefore[k] : nullptr);
    directions_.push_back(facing.directions());
    for (int node = 0; node < part.traceNodes(); ++node)
      if (const auto row = rowOf.find(part.number(node)); row != rowOf.end())
        normals_[row->second].head<2>() = facing.directionAt(node);
    if (facing.empty()) continue;
    std::vector<char> merged = lines.merged[k];
    mergeCorners(facing, corners, merged);
    std::vector<char> only;
    for (int node = 0; node < part.traceNodes() && keepRows; ++node) {
      const auto row = rowOf.find(part.number(node));
      only.push_back(row != rowOf.end() && facedBefore[row->second] != 0 ? 1 : 0);
    }
    const Coupling coupling = couple(pair_.coupling, facing, distanceOfCurves, merged, axisymmetric_, only,
                                     {lines.stabilised, lines.mortarCompliance, merged, lines.symmetric[k]});
    std::vector<int> rows;
    for (const int node : coupling.nodes) rows.push_back(rowOf.at(part.number(node)));
    entries.add(coupling, facing, rows);
    for (size_t i = 0; i < rows.size(); ++i) {
      faces_[rows[i]] = 1;
      distanceHere_[rows[i]] = coupling.distance[static_cast<Eigen::Index>(i)];
      lengths_[rows[i]] = coupling.lengths[static_cast<Eigen::Index>(i)];
    }
    overlap_ += facing.length() / lines.shorter;
    penetration_.add(facing, distanceOfCurves, axisymmetric_);
  }
  for (int row = 0; row < n; ++row)  // no force has a pressure there
    if (faces_[row] == 0) {
      entries.mass.emplace_back(row, row, 1);
      entries.ends.emplace_back(row, row, 1);
    }
  setRows(entries);
  if (motion != nullptr) {
    C2_ = ConstraintRows(C2_ * motion->change);
    if (hasFriction()) T2_ = ConstraintRows(T2_ * motion->change);
  }
  distance_ = distanceHere_ + jump(u1, u2);
  penetration_.setMoved(u1, u2);
}

}  // namespace mortier
