// Normals of the surfaces behind triangles, and how far these are off them: exact on surfaces of second
// degree, of third order or better elsewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include "contact/interface.h"
#include "contact/surface.h"
#include "mesh/shape.h"

namespace mortier::curved_surfaces_test {

using Place = std::function<SpacePoint(double u, double v)>;

/// A plate of cells x cells whose upper side (label 3) is a surface over the parameters (u, v) in [0, 1]^2.
/// \param shaken  by how much inner nodes are moved over the surface, of a cell
TetrahedronMesh plateUnder(const Place& place, int cells, double shaken, bool turnedOver = false) {
  TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {cells, cells, 1}});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-shaken / cells, shaken / cells);
  constexpr double thickness = 0.1;
  const double out = turnedOver ? -1 : 1;
  for (SpacePoint& x : mesh.vertices) {
    double u = x.x();
    double v = x.y();
    if (u > 0 && u < 1 && v > 0 && v < 1) {
      u += any(random);
      v += any(random);
    }
    constexpr double h = 1e-5;
    const SpacePoint n = (place(u + h, v) - place(u - h, v)).cross(place(u, v + h) - place(u, v - h));
    x = place(u, v) + out * (x.z() - 1) * thickness * n.normalized();
  }
  validate(mesh);
  return mesh;
}

SpacePoint normalOf(const std::function<double(const SpacePoint&)>& level, const SpacePoint& x) {
  SpacePoint gradient;
  constexpr double h = 1e-5;
  for (int c = 0; c < 3; ++c) {
    const SpacePoint step = h * SpacePoint::Unit(c);
    gradient[c] = (level(x + step) - level(x - step)) / (2 * h);
  }
  return gradient;
}

struct Curved {
  const char* name;
  Place place;
  std::function<double(const SpacePoint&)> level;  ///< 0 on it
  bool second;                                     ///< of second degree
};

const std::vector<Curved>& surfaces() {
  static const std::vector<Curved> all{
      {"cylinder", [](double u, double v) { return SpacePoint(std::sin(u), v, std::cos(u)); },
       [](const SpacePoint& x) { return std::hypot(x.x(), x.z()) - 1; }, true},
      {"cone",
       [](double u, double v) {
         return SpacePoint((1 + v) * std::sin(u), 0.5 * (1 + v), (1 + v) * std::cos(u));
       },
       [](const SpacePoint& x) { return std::hypot(x.x(), x.z()) - 2 * x.y(); }, true},
      {"ellipsoid",
       [](double u, double v) {
         return SpacePoint(std::sin(u) * std::cos(v), 2 * std::sin(v), 0.7 * std::cos(u) * std::cos(v));
       },
       [](const SpacePoint& x) { return SpacePoint(x.x(), x.y() / 2, x.z() / 0.7).norm() - 1; }, true},
      {"torus",
       [](double u, double v) {
         const double r = 2 + std::cos(u + 0.3);
         return SpacePoint(r * std::sin(v), r * std::cos(v), -std::sin(u + 0.3));
       },
       [](const SpacePoint& x) { return std::hypot(std::hypot(x.x(), x.y()) - 2, x.z()) - 1; }, false}};
  return all;
}

struct Off {
  double normal = 0;   ///< largest error inside [rad]
  double surface = 0;  ///< largest distance of the patch, from triangles without a vertex at the rim [m]
  double chord = 0;    ///< the same of the triangles [m]
  double expected = 0;
};

Off offOf(const Curved& curved, int cells, double shaken, bool exact) {
  TetrahedronMesh mesh = plateUnder(curved.place, cells, shaken);
  if (exact)
    for (size_t i = 0; i < mesh.boundaryTriangles.size(); ++i) {
      auto& own = mesh.boundaryNormals.emplace_back();
      for (int k = 0; k < 3; ++k) {
        own[k] = SpacePoint::Constant(std::nan(""));
        if (mesh.boundaryLabels[i] == 3)
          own[k] = normalOf(curved.level, mesh.vertices[mesh.boundaryTriangles[i][k]]).normalized();
      }
    }
  const ContactSurface surface(mesh, spaceNodes(mesh, 1), 3);
  const int rim = 2;
  std::vector<char> inside(mesh.vertices.size(), 0);
  const TetrahedronMesh flat = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {cells, cells, 1}});
  for (size_t v = 0; v < flat.vertices.size(); ++v) {
    const double margin =
        std::min(flat.vertices[v].head<2>().minCoeff(), 1 - flat.vertices[v].head<2>().maxCoeff());
    inside[v] = margin * cells > rim - 0.5 ? 1 : 0;
  }
  Off off;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    bool all = true;
    for (int k = 0; k < 3; ++k) {
      if (inside[surface.triangles[t][k]] == 0) {
        all = false;
        continue;
      }
      const SpacePoint n = normalOf(curved.level, surface.places[t][k]).normalized();
      off.normal = std::max(off.normal, surface.vertexNormals[t][k].n.cross(n).norm());
    }
    if (!all) continue;
    off.expected = std::max(off.expected, surface.offsetError(static_cast<int>(t)));
    for (const Eigen::Vector3d& l :
         {Eigen::Vector3d(0.2, 0.5, 0.3), {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.3, 0.3, 0.4}}) {
      SpacePoint x = SpacePoint::Zero();
      for (int k = 0; k < 3; ++k) x += l[k] * surface.places[t][k];
      const auto away = [&](const SpacePoint& y) {
        return std::abs(curved.level(y) / normalOf(curved.level, y).norm());
      };
      off.chord = std::max(off.chord, away(x));
      off.surface = std::max(off.surface, away(x + surface.offset(static_cast<int>(t), l)));
    }
  }
  return off;
}

// Differences of the level functions are exact to about 1e-11.
TEST(CurvedSurfaces, normalsAreExactOnQuadricsAndOfSecondOrderElsewhere) {
  constexpr double rounding = 1e-9;
  for (const Curved& curved : surfaces())
    for (const double shaken : {0.0, 0.2}) {
      const Off coarse = offOf(curved, 8, shaken, false);
      const Off fine = offOf(curved, 16, shaken, false);
      std::cout << curved.name << " " << shaken << ": normals " << coarse.normal << " " << fine.normal
                << ", surfaces " << coarse.surface << " " << fine.surface << " of " << coarse.chord << " "
                << fine.chord << "\n";
      EXPECT_LE(fine.normal, curved.second ? rounding : coarse.normal / 3) << curved.name;
      EXPECT_LE(coarse.surface, 0.02 * coarse.chord) << curved.name;
      EXPECT_LE(fine.surface, coarse.surface / 5) << curved.name;
    }
}

TEST(CurvedSurfaces, normalsOfTheGeometryAreTaken) {
  for (const Curved& curved : surfaces()) {
    if (!curved.second) continue;
    const Off off = offOf(curved, 8, 0.2, true);
    EXPECT_LE(off.normal, 1e-15) << curved.name;
    EXPECT_LE(off.surface, 0.02 * off.chord) << curved.name;
  }
}

}  // namespace mortier::curved_surfaces_test
