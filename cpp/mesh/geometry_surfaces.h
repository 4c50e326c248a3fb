// The surfaces of a geometry, which new vertices of the boundary of its mesh are put onto.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/types.h"

namespace mortier {

/// The point of a surface that is nearest to another one, nearly: it is on the surface.
struct SurfaceFoot {
  SpacePoint at{0, 0, 0};      ///< [m]
  SpacePoint normal{0, 0, 0};  ///< there, of length one, to either side; not finite where there is none
};

/// Surfaces by numbers of their own.
class GeometrySurfaces {
 public:
  virtual ~GeometrySurfaces() = default;
  /// Of each surface at a point; none where it is not found.
  [[nodiscard]] virtual std::vector<std::optional<SurfaceFoot>> feet(
      const std::vector<std::pair<int, SpacePoint>>& points) const = 0;
  /// Nearly the point that is nearest to x on the curves that two surfaces share, where these are known.
  [[nodiscard]] virtual std::optional<SpacePoint> onSharedCurve(int one, int other,
                                                                const SpacePoint& x) const = 0;
  [[nodiscard]] virtual bool isPlane(int surface) const = 0;
};

/// A point on several surfaces.
struct SharedPoint {
  SpacePoint at{0, 0, 0};
  std::vector<SpacePoint> normals;  ///< by surfaces, as of SurfaceFoot
  double off = 0;                   ///< farthest of the distances to the surfaces [m]
};

/// The point next to x that is on all of the surfaces: by Newton's method, along the normals of the surfaces
/// only. None where it is not found, or no surface is given.
std::optional<SharedPoint> sharedPoint(const GeometrySurfaces& geometry, const std::vector<int>& surfaces,
                                       const SpacePoint& x);

/// The geometry behind the boundary of a mesh.
struct BoundaryGeometry {
  std::shared_ptr<const GeometrySurfaces> surfaces = nullptr;  ///< none where nothing is known
  std::vector<std::array<int, 3>> triangles = {};              ///< of the boundary, labelled or not
  std::vector<int> numbers = {};                               ///< of the surface that each is of
};

struct RoundBody;
struct Sweep;
struct TriangleMesh;

/// Of a ball or a cylinder: by the labels of roundMesh().
std::shared_ptr<const GeometrySurfaces> surfacesOf(const RoundBody& body);

/// Of a swept plane mesh: side k from edge k of its boundary, then the plane where the sweep begins and the
/// one where it ends.
std::shared_ptr<const GeometrySurfaces> surfacesOf(const TriangleMesh& plane, const Sweep& sweep);

struct MeshSource;

/// Of a geometry that Gmsh reads, by its numbers. It is read again when a surface is first asked for.
std::shared_ptr<const GeometrySurfaces> gmshSurfaces(const MeshSource& source);

}  // namespace mortier
