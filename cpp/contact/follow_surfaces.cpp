// Rows that follow the bodies in space: the surfaces as drawn, moved, and coupled anew.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "contact/interface_entries.h"
#include "contact/tangents.h"

namespace mortier {

struct ContactInterface::Surfaces {
  ContactSurface nonmortar, mortar;  ///< as drawn
  InterfaceOptions options;
  std::map<PartVertex, int> rowOf;
  std::vector<SpacePoint> along;  ///< by rows: a direction of slip, as drawn
};

namespace {

/// What is fixed at the nodes of a surface as drawn, once for all: what is asked may not outlive it.
FixedDirections tableOf(const FixedDirections& fixed, const ContactSurface& surface) {
  if (!fixed) return {};
  std::map<int, std::vector<SpacePoint>> table;
  for (const auto& triangle : surface.triangles)
    for (int k = 0; k < 3; ++k)
      if (std::vector<SpacePoint> found = fixed(triangle[k]); !found.empty())
        table.emplace(triangle[k], std::move(found));
  return [table = std::move(table)](int node) {
    const auto found = table.find(node);
    return found == table.end() ? std::vector<SpacePoint>() : found->second;
  };
}

/// Vertices held along the normals of a surface as drawn.
InterfaceOptions::Held heldAcross(const InterfaceOptions::Held& held, const ContactSurface& surface) {
  if (!held) return {};
  std::set<int> nodes;
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (held(surface.triangles[t][k], surface.vertexNormals[t][k].n)) nodes.insert(surface.triangles[t][k]);
  return [nodes = std::move(nodes)](int node, const SpacePoint&) { return nodes.contains(node); };
}

}  // namespace

void ContactInterface::drawSurfaces(ContactSurface nonmortar, ContactSurface mortar,
                                    const InterfaceOptions& options) {
  // Contact acts along the normal of the stiffer body, which hardly bends.
  const bool own = !(options.stiffness < 1);
  nonmortar.faceAlongNormals(own);
  mortar.faceAlongNormals(!own);
  InterfaceOptions kept = options;
  kept.nonmortarHeld = {};
  kept.mortarHeld = heldAcross(options.mortarHeld, mortar);
  kept.nonmortarFixed = tableOf(options.nonmortarFixed, nonmortar);
  kept.mortarFixed = tableOf(options.mortarFixed, mortar);
  auto surfaces =
      std::make_shared<Surfaces>(Surfaces{std::move(nonmortar), std::move(mortar), std::move(kept), {}, {}});
  const bool mayMerge = surfaces->nonmortar.degree == 1 && options.nonmortarHeld &&
                        pair_.coupling != CouplingKind::interpolation;
  const VertexTable vertices = verticesOf(surfaces->nonmortar);
  const auto held = [&](const auto& each) {
    return mayMerge && options.nonmortarHeld(each.first.first, each.second.normal);
  };
  const bool allHeld = std::ranges::all_of(vertices, held);
  for (const auto& each : vertices) {
    if (!allHeld && held(each)) {
      ++heldEnds_;
      continue;
    }
    surfaces->rowOf.emplace(each.first, static_cast<int>(nonmortarNodes_.size()));
    nonmortarNodes_.push_back(each.first.first);
    surfaces->along.push_back(tangentsTo(each.second.normal)[0]);
  }
  nonmortarLine_ = surfaces->nonmortar.nodes();
  surfaces_ = std::move(surfaces);
}

void ContactInterface::followSurfaces(const Vector& u1, const Vector& u2, bool keepRows,
                                      const MortarMotion* motion) {
  const auto& [drawnNonmortar, drawnMortar, options, rowOf, drawnAlong] = *surfaces_;
  const Vector& moved2 = motion != nullptr ? motion->moved : u2;
  const ContactSurface nonmortar = drawnNonmortar.moved(u1, options.nonmortarFixed);
  const ContactSurface mortar = drawnMortar.moved(moved2, options.mortarFixed);
  RefinedSurfaces surfaces(nonmortar, mortar, true);
  surfaces.rowOf = rowOf;
  // Directions of slip turn with the surface.
  surfaces.slipsAlong.assign(drawnAlong.size(), SpacePoint(0, 0, 0));
  for (size_t t = 0; t < nonmortar.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (const auto row = rowOf.find({nonmortar.triangles[t][k], nonmortar.parts[t]}); row != rowOf.end())
        surfaces.slipsAlong[row->second] += nonmortar.turns[t][k] * drawnAlong[row->second];
  for (auto& [key, vertex] : surfaces.refinement.vertices)
    if (const auto row = rowOf.find(key); keepRows && row != rowOf.end())
      vertex.faces = faces_[row->second] != 0;
  assemble(surfaces, options);
  if (motion != nullptr) {
    C2_ = ConstraintRows(C2_ * motion->change);
    if (hasFriction()) T2_ = ConstraintRows(T2_ * motion->change);
  }
  distanceHere_ = distance_;
  distance_ += jump(u1, u2);
  for (SurfacePoints* points : {&points_, &nearest_}) {
    const Matrix jumps = points->jump(u1, u2);
    for (Eigen::Index i = 0; i < jumps.cols(); ++i)
      points->distances[i] += points->normals[i].dot(jumps.col(i));
  }
}

}  // namespace mortier
