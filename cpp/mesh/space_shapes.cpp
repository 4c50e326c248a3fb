#include "mesh/shape.h"

#include <algorithm>
#include <limits>

#include "base/error.h"

namespace mortier {
namespace {

/// The vertices of a cell by bits: 1 along x, 2 along y, 4 along z. All tetrahedra have its diagonal 0-7, and
/// in a mirrored cell that of the cell that it mirrors.
constexpr std::array<std::array<int, 4>, 6> tetrahedraOfCell{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// \param mirrored  how many cells from the lower end on are mirrored, by axes
TetrahedronMesh boxMesh(const Cuboid& cuboid, const std::array<int, 3>& mirrored) {
  const int nx = cuboid.cells[0], ny = cuboid.cells[1], nz = cuboid.cells[2];
  if (!((cuboid.upper - cuboid.lower).minCoeff() > 0) || nx < 1 || ny < 1 || nz < 1)
    throw InputError("a box without volume or cells");
  TetrahedronMesh mesh;
  mesh.name = "box";
  const auto vertex = [&](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  const SpacePoint size = cuboid.upper - cuboid.lower;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        mesh.vertices.emplace_back(cuboid.lower.x() + size.x() * i / nx, cuboid.lower.y() + size.y() * j / ny,
                                   cuboid.lower.z() + size.z() * k / nz);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::array<int, 3> cell{i, j, k};
        int mirror = 0;
        for (int c = 0; c < 3; ++c)
          if (cell[c] < mirrored[c]) mirror |= 1 << c;
        const auto corner = [&](int bits) {
          bits ^= mirror;
          return vertex(i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2));
        };
        for (const auto& [a, b, c, d] : tetrahedraOfCell)
          mesh.tetrahedra.push_back({corner(a), corner(b), corner(c), corner(d)});
        for (const auto& [axis, end, label] : boxSides) {
          if (cell[axis] != (end == 0 ? 0 : cuboid.cells[axis] - 1)) continue;
          for (const auto& tetrahedron : tetrahedraOfCell)
            for (int left = 0; left < 4; ++left) {
              std::array<int, 3> triangle{};
              bool outside = true;
              for (int a = 0, next = 0; a < 4; ++a) {
                if (a == left) continue;
                outside = outside && ((tetrahedron[a] ^ mirror) >> axis & 1) == end;
                triangle[next++] = corner(tetrahedron[a]);
              }
              if (!outside) continue;
              mesh.boundaryTriangles.push_back(triangle);
              mesh.boundaryLabels.push_back(label);
            }
        }
      }
  mesh.regions.assign(mesh.tetrahedra.size(), 1);
  mesh.labelNames = {{"bottom", 1}, {"right", 2}, {"top", 3}, {"left", 4}, {"front", 5}, {"back", 6}};
  validate(mesh);
  return mesh;
}

}  // namespace

TetrahedronMesh cuboidMesh(const Cuboid& cuboid) {
  return boxMesh(cuboid, {0, 0, 0});
}

TetrahedronMesh tetrahedronAt(const SpacePoint& place, double size) {
  TetrahedronMesh mesh;
  mesh.name = "point";
  mesh.vertices = {place};
  for (int c = 0; c < 3; ++c) mesh.vertices.emplace_back(place + size * SpacePoint::Unit(c));
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.regions = {1};
  mesh.boundaryTriangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  mesh.boundaryLabels.assign(mesh.boundaryTriangles.size(), 1);
  validate(mesh);
  return mesh;
}

TetrahedronMesh roundMesh(const RoundBody& body) {
  if (!(body.radius > 0) || !(body.height > 0)) throw InputError("a round body without volume");
  const auto& [across, along] = body.cells;
  const int rounded = body.ball ? 3 : 2;  // axes
  Cuboid box{{0, 0, 0}, {1, 1, body.height / body.radius}, {across, across, along}};
  std::array<int, 3> mirrored{};  // diagonals lead outwards everywhere
  for (int c = 0; c < rounded; ++c) {
    mirrored[c] = body.keep[c] > 0 ? 0 : across;
    box.lower[c] = body.keep[c] > 0 ? 0 : -1;
    box.upper[c] = body.keep[c] < 0 ? 0 : 1;
    box.cells[c] = body.keep[c] == 0 ? 2 * across : across;
  }
  TetrahedronMesh mesh = boxMesh(box, mirrored);
  for (SpacePoint& x : mesh.vertices) {
    const auto round = x.head(rounded);
    if (const double size = round.norm(); size > 0) x.head(rounded) *= round.cwiseAbs().maxCoeff() / size;
    x = body.centre + body.radius * x;
  }
  for (int& label : mesh.boundaryLabels)
    for (const auto& [axis, end, sideLabel] : boxSides)
      if (label == sideLabel && axis < rounded && body.keep[axis] != (end == 0 ? 1 : -1)) {
        label = roundLabel;
        break;
      }
  mesh.labelNames["round"] = roundLabel;
  for (size_t i = 0; i < mesh.boundaryTriangles.size(); ++i) {
    std::array<SpacePoint, 3>& normals = mesh.boundaryNormals.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      const SpacePoint x = mesh.vertices[mesh.boundaryTriangles[i][k]] - body.centre;
      normals[k] = SpacePoint::Zero();
      if (mesh.boundaryLabels[i] == roundLabel)
        normals[k].head(rounded) = x.head(rounded).normalized();
      else
        normals[k].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  std::erase_if(mesh.labelNames, [&](const auto& named) {
    return std::find(mesh.boundaryLabels.begin(), mesh.boundaryLabels.end(), named.second) ==
           mesh.boundaryLabels.end();
  });
  mesh.name = body.ball ? "ball" : "cylinder";
  validate(mesh);
  mesh.geometry = {surfacesOf(body), mesh.boundaryTriangles, mesh.boundaryLabels};
  return mesh;
}

}  // namespace mortier
