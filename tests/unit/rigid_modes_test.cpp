#include "fem/rigid_modes.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "unit/plate.h"

namespace mortier::rigid_modes_test {

using namespace plate;

TEST(RigidModes, supportsLeaveTheRestFree) {
  struct Case {
    std::vector<Condition> supports;
    int motions;
    std::string words;  ///< of the only motion, either way
  };
  const Case cases[] = {
      {{}, 3, ""},
      {{{bottom, 1, constant(0)}}, 1, "translation along (1, 0)translation along (-1, 0)"},
      {{{left, 0, constant(0)}}, 1, "translation along (0, 1)translation along (0, -1)"},
      {{{left, 0, constant(0)}, {right, 0, constant(0)}},
       1,
       "translation along (0, 1)translation along (0, -1)"},
      {{{left, 1, constant(0)}}, 2, ""},  // along x, and about any point of x = 0
      {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, 0, ""},
      {{{left, 0, constant(0)}, {left, 1, constant(0)}}, 0, ""},
  };
  for (const auto& [supports, motions, words] : cases) {
    const Body plate = body({supports, {}, {}});
    const Matrix modes = rigidModes(plate);
    ASSERT_EQ(modes.cols(), motions);
    if (motions == 0) continue;
    EXPECT_EQ(Eigen::FullPivLU<Matrix>(modes).rank(), motions);
    for (Eigen::Index i = 0; i < modes.cols(); ++i) {
      EXPECT_LE(strainOf(plate, modes.col(i)).cwiseAbs().maxCoeff(), 1e-13);
      EXPECT_NEAR(modes.col(i).cwiseAbs().maxCoeff(), 1, 0.5);
      for (int dof = 0; dof < plate.dofs(); ++dof) {
        if (plate.equations()[dof] >= 0) continue;
        EXPECT_EQ(modes(dof, i), 0);
      }
    }
    if (motions == 1) {
      EXPECT_NE(words.find(describeRigidMotion(plate, modes.col(0))), std::string::npos);
    }
  }
  const Body plate = body();
  const Vector turn = field(plate.mesh(), [](const Point& x) { return Point(-(x.y() - 3), x.x() + 0.5); });
  EXPECT_EQ(describeRigidMotion(plate, turn), "rotation about (-0.5, 3)");
}

Body elastic(TriangleMesh mesh, std::vector<Condition> supports = {}) {
  validate(mesh);
  return {"body", std::move(mesh), elasticMaterial({1, 0.3}), {std::move(supports), {}, {}}};
}

/// Triangles whose outer sides are those of a regular polygon, hinged at its corners. The first side has
/// label 1.
TriangleMesh ring(int sides) {
  TriangleMesh mesh;
  mesh.name = "ring";
  for (const double radius : {1.0, 1.5})
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * (radius == 1 ? i : i + 0.5) / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  for (int i = 0; i < sides; ++i) mesh.triangles.push_back({i, sides + i, (i + 1) % sides});
  mesh.regions.assign(sides, 1);
  mesh.boundaryEdges = {{0, sides}};
  mesh.boundaryLabels = {1};
  return mesh;
}

// n bars and n hinges in the plane: 3 n - 2 n motions, of which three are those of the whole.
TEST(RigidModes, ringsOfHingedTrianglesMoveAsLinkages) {
  for (const int sides : {3, 4, 5, 12}) {
    const Body body = elastic(ring(sides));
    const Matrix modes = rigidModes(body);
    ASSERT_EQ(modes.cols(), sides);
    EXPECT_EQ(Eigen::FullPivLU<Matrix>(modes).rank(), sides);
    for (Eigen::Index i = 0; i < modes.cols(); ++i)
      EXPECT_LE(strainOf(body, modes.col(i)).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(rigidModes(elastic(ring(sides), {{1, 0, constant(0)}, {1, 1, constant(0)}})).cols(), sides - 3);
  }
}

TEST(RigidModes, aPartBesideAndAFlapAreNamedWithTheirPlace) {
  TriangleMesh mesh = plateMesh();
  const auto first = static_cast<int>(mesh.vertices.size());
  const auto corner = static_cast<int>(std::find_if(mesh.vertices.begin(), mesh.vertices.end(),
                                                    [](const Point& x) { return x == Point(2, 1); }) -
                                       mesh.vertices.begin());
  TriangleMesh apart = mesh;
  TriangleMesh flap = mesh;
  apart.vertices.insert(apart.vertices.end(), {Point(5, 0), Point(6, 0), Point(5, 3)});
  apart.triangles.push_back({first, first + 1, first + 2});
  apart.regions.push_back(1);
  flap.vertices.insert(flap.vertices.end(), {Point(3, 1), Point(3, 3)});
  flap.triangles.push_back({corner, first, first + 1});
  flap.regions.push_back(1);
  const std::vector<Condition> held{{left, 0, constant(0)}, {left, 1, constant(0)}};
  const Body beside = elastic(apart, held);
  ASSERT_EQ(rigidModes(beside).cols(), 3);
  EXPECT_NE(describeRigidMotion(beside, rigidModes(beside).col(0)).find("of its part around (5.333, 1)"),
            std::string::npos);
  const Body hinged = elastic(flap, held);
  ASSERT_EQ(rigidModes(hinged).cols(), 1);
  EXPECT_EQ(describeRigidMotion(hinged, rigidModes(hinged).col(0)),
            "rotation about (2, 1), of its part around (2.667, 1.667)");
  EXPECT_EQ(rigidModes(elastic(plateMesh(), held)).cols(), 0);
}

// Lengths cancel: the same mesh in other units has the same motions.
TEST(RigidModes, unitsDoNotMatter) {
  for (const double unit : {1e-9, 1e9}) {
    TriangleMesh mesh = ring(5);
    for (Point& x : mesh.vertices) x *= unit;
    EXPECT_EQ(rigidModes(elastic(std::move(mesh))).cols(), 5);
  }
}

TEST(RigidModes, meshesThatFallToPiecesAreRefused) {
  TriangleMesh mesh;
  for (int i = 0; i < 400; ++i) {
    mesh.vertices.insert(mesh.vertices.end(), {Point(2 * i, 0), Point(2 * i + 1, 0), Point(2 * i, 1)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    mesh.regions.push_back(1);
  }
  EXPECT_THROW(rigidModes(elastic(mesh)), UnheldBodyError);
  EXPECT_THROW(rigidModes(elastic(ring(400))), InputError);
}

}  // namespace mortier::rigid_modes_test
