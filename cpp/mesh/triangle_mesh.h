// Triangle meshes with labels: the only geometry of the rest of the code.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "base/types.h"

namespace mortier {

// A curve by points of it. x(t), 0 <= t <= 1, is piece by piece the polynomial of degree 8 through nine
// points of the curve, at Chebyshev's places with both ends (barycentric formula; Berrut, Trefethen 2004).
// Pieces are halved until they are the curve to a tolerance, so that a jump of a curvature, or a kink, lies
// in a piece that is small enough.

struct SampledCurve {
  std::vector<double> knots;  ///< t at the ends of the pieces, from 0 to 1
  std::vector<Point> points;  ///< eight a piece, and the last one [m]

  [[nodiscard]] Point at(double t) const;
};

/// Empty where thousands of pieces are not the curve.
/// \param points  of the curve at places t in [0, 1] [m]
/// \param tolerance  of the distance between x(t) and the curve's point at t [m]
SampledCurve sampled(const std::function<std::vector<Point>(const std::vector<double>&)>& points,
                     double tolerance);

/// The stretch of a curve that an edge stands for, from its first vertex to its second.
struct EdgeCurve {
  std::shared_ptr<const SampledCurve> curve = nullptr;  ///< none where it is not known
  double from = 0;                                      ///< t at the first vertex, may be the larger one
  double to = 1;

  [[nodiscard]] bool known() const { return curve != nullptr; }
  [[nodiscard]] Point at(double t) const { return curve->at(t); }
  /// t where the stretch meets the straight line through x along n; at the end next to that line where it
  /// does not. \pre known
  [[nodiscard]] double meeting(const Point& x, const Point& n) const;
  /// t where it is equally far from both its ends. \pre known
  [[nodiscard]] double middle() const;
};

/// A conforming mesh of triangles of one body.
struct TriangleMesh {
  std::string name;                               ///< where it came from, for messages
  std::vector<Point> vertices;                    ///< [m]
  std::vector<std::array<int, 3>> triangles;      ///< vertex numbers, counterclockwise
  std::vector<int> regions;                       ///< label of each triangle
  std::vector<std::array<int, 2>> boundaryEdges;  ///< vertex numbers, the body to the left
  std::vector<int> boundaryLabels;                ///< label of each boundary edge
  std::map<std::string, int> labelNames = {};     ///< boundary labels that have a name
  std::map<std::string, int> regionNames = {};
  /// By boundary edge a point between its ends on the curve that it stands for [m], halfway where it is known
  /// to be straight, not finite where nothing is known; empty where nothing is at all.
  std::vector<Point> edgeMiddles = {};
  /// By boundary edge what it stands for where that is known and no circle; empty where no edge has such a
  /// curve. Its middle is in `edgeMiddles`.
  std::vector<EdgeCurve> edgeCurves = {};
  // Where groups of a file share sides or elements, until the scene chooses (mesh/regions.h): the groups of
  // each label, and of each region, that stands for several.
  std::map<int, std::vector<int>> sharedLabels = {};
  std::map<int, std::vector<int>> sharedRegions = {};
  std::string changed = {};  ///< what the reader made of other cells; empty: none were there

  /// Whether the curve of a boundary edge is known.
  [[nodiscard]] bool hasCurve(size_t edge) const { return !edgeCurves.empty() && edgeCurves[edge].known(); }
};

/// Twice the signed area of triangle `t` [m^2]; positive when counterclockwise.
double doubleArea(const TriangleMesh& mesh, int t);

/// Largest extent of the bounding box [m].
double extent(const TriangleMesh& mesh);

/// Ratio of longest edge to the height on it, over that of the equilateral triangle: 1 is best.
double aspectRatio(const TriangleMesh& mesh, int t);

/// What a fault of a mesh is about; `index` counts from 0, the message from 1 as Medit files do.
enum class MeshPart { whole, vertex, triangle, edge };

/// The head of a message about one item of a mesh, e.g. `upper.mesh:14`.
using FaultPlace = std::function<std::string(MeshPart part, int index)>;

/// Checks everything the solver relies on and orients boundary edges with the body to their left: finite
/// coordinates, triangles counterclockwise and not degenerate, none repeated, no vertex out of range or
/// unused, every edge shared by two triangles at most, labelled edges on the boundary, each labelled once.
/// Boundary edges without a label are free. A triangle is degenerate when its height is 1e-12 of its longest
/// edge or less: no absolute length enters. \throws InputError with the first fault, headed by `place` or,
/// without one, by `mesh.name`.
void validate(TriangleMesh& mesh, const FaultPlace& place = {});

// Bodies of revolution: a mesh in the half plane x >= 0 turns about the axis x = 0. Then x is the radius r
// and y the coordinate z along the axis; what is integrated over the mesh or its sides is of the whole ring,
//   int f dV = int f 2 pi r dA,   int f dS = int f 2 pi r ds.

/// 2 pi r [m].
inline double circumference(const Point& place) {
  return 2 * std::numbers::pi * place.x();
}

/// Vertices that only rounding keeps from the axis are put on it.
/// \throws InputError with the first vertex on the other side of it. \param beside  the key that asks for it
TriangleMesh meshAboutAxis(TriangleMesh mesh, const char* beside = "plane = \"axisymmetric\"");

// Labels in messages.

/// `label 3 "top"`, or `label 3` where the mesh (of triangles or tetrahedra) has no name for it.
template <class Mesh>
std::string labelText(const Mesh& mesh, int label) {
  for (const auto& [name, number] : mesh.labelNames)
    if (number == label) return "label " + std::to_string(label) + " \"" + name + "\"";
  return "label " + std::to_string(label);
}

}  // namespace mortier
