#include "mesh/shape.h"

#include <cmath>
#include <limits>

namespace mortier {
namespace {

/// A circle that the edges of some labels stand for.
struct Circle {
  int label = 0;
  Point centre;
  double radius = 1;  ///< negative where the body lies outside [m]
};

void putMiddlesOn(TriangleMesh& mesh, const std::vector<Circle>& circles) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  mesh.edgeMiddles.assign(mesh.boundaryEdges.size(), Point(unknown, unknown));
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    for (const Circle& circle : circles) {
      if (mesh.boundaryLabels[e] != circle.label) continue;
      const auto& [a, b] = mesh.boundaryEdges[e];
      const Point along = (mesh.vertices[b] - mesh.vertices[a]).normalized();
      mesh.edgeMiddles[e] = circle.centre + circle.radius * Point(along.y(), -along.x());
    }
}

struct Maker {
  Cut cut;
  TriangleMesh operator()(const Rectangle& rectangle) const { return rectangleMesh(rectangle, cut); }
  TriangleMesh operator()(const Quadrilateral& quadrilateral) const {
    return quadrilateralMesh(quadrilateral, cut);
  }
  TriangleMesh operator()(const Outline& outline) const { return outlineMesh(outline); }
  TriangleMesh operator()(const Annulus& annulus) const {
    TriangleMesh mesh = annulusMesh(annulus, cut);
    putMiddlesOn(mesh, {{1, annulus.centre, -annulus.inner}, {2, annulus.centre, annulus.outer}});
    return mesh;
  }
  TriangleMesh operator()(const HalfDisc& disc) const {
    TriangleMesh mesh = halfDiscMesh(disc, cut);
    const Point centre = disc.lowest + Point(0, disc.radius);
    putMiddlesOn(mesh, {{1, centre, disc.radius}, {3, centre, disc.radius}});
    return mesh;
  }
};

}  // namespace

TriangleMesh shapeMesh(const MeshShape& shape) {
  return std::visit(Maker{shape.cut}, shape.of);
}

}  // namespace mortier
