#ifdef MORTIER_GMSH
#include <gmshc.h>

#include <Eigen/Geometry>

#include "base/error.h"
#include "mesh/gmsh_library.h"

namespace mortier {
namespace {

struct SurfaceNodes {
  std::vector<size_t> tags;
  std::vector<double> places;
  std::vector<double> parameters;  // two of each
};

SurfaceNodes nodesOn(const Gmsh& gmsh, int surface) {
  Gmsh::Array<size_t> tags;
  Gmsh::Array<double> places;
  Gmsh::Array<double> parameters;
  gmsh.call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags.data, &tags.size, &places.data,
                                             &places.size, &parameters.data, &parameters.size, 2, surface, 1,
                                             1);
  return {gmsh.take(tags), gmsh.take(places), gmsh.take(parameters)};
}

SpacePoint pointOf(const std::vector<double>& list, size_t i) {
  return {list[3 * i], list[3 * i + 1], list[3 * i + 2]};
}

}  // namespace

std::map<size_t, SpacePoint> normalsOn(const Gmsh& gmsh, int surface) {
  constexpr double onSurface = 1e-6;
  constexpr double whole = 0.5;
  std::map<size_t, SpacePoint> found;
  if (shapeOf(gmsh, 2, surface).empty()) return found;
  try {
    SurfaceNodes nodes = nodesOn(gmsh, surface);
    const size_t n = nodes.tags.size();
    if (nodes.parameters.size() != 2 * n || nodes.places.size() != 3 * n) return found;
    Gmsh::Array<double> normals;
    Gmsh::Array<double> values;
    gmsh.call<decltype(gmshModelGetNormal)>("gmshModelGetNormal", surface, nodes.parameters.data(),
                                            nodes.parameters.size(), &normals.data, &normals.size);
    gmsh.call<decltype(gmshModelGetValue)>("gmshModelGetValue", 2, surface, nodes.parameters.data(),
                                           nodes.parameters.size(), &values.data, &values.size);
    const std::vector<double> normal = gmsh.take(normals);
    const std::vector<double> value = gmsh.take(values);
    if (normal.size() != 3 * n || value.size() != 3 * n) return found;
    Eigen::AlignedBox3d box;
    for (size_t i = 0; i < n; ++i) box.extend(pointOf(nodes.places, i));
    for (size_t i = 0; i < n; ++i) {
      const SpacePoint own = pointOf(normal, i);
      const double off = (pointOf(value, i) - pointOf(nodes.places, i)).norm();
      if (own.allFinite() && own.norm() > whole && off <= onSurface * box.diagonal().norm())
        found[nodes.tags[i]] = own.normalized();
    }
  } catch (const InputError&) {
    found.clear();  // Gmsh has no parameters for it
  }
  return found;
}

}  // namespace mortier

#endif
