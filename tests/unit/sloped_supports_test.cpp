// Supports of sloped sides with many nodes, whose directions are sorted.
#include "fem/supports.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "mesh/generate.h"

namespace mortier::sloped_supports_test {

constexpr int bottom = 1;

// More than 16 directions: where a comparison is no order, std::sort then runs past their ends.
TEST(SlopedSupports, haveOneDirectionAtAllNodesOfAStraightSide) {
  constexpr int cells = 33;
  for (int i = 1; i < 24; ++i) {
    TriangleMesh mesh = rectangleMesh({{0, 0}, {1, 0.1}, cells, 2});
    const Eigen::Rotation2Dd turn(2 * M_PI * i / 24 + 0.01);
    for (Point& x : mesh.vertices) x = turn * x;
    const Supports supports(mesh, {{bottom, alongNormal, [](double, double, double) { return 0.0; }}});
    ASSERT_EQ(supports.nodes().size(), cells + 1u);
    const SpacePoint& first = supports.nodes().front().directions[0];
    EXPECT_LE((first.head<2>() - turn * Point(0, -1)).norm(), 1e-14);
    for (const NodeSupport& support : supports.nodes()) EXPECT_EQ(support.directions[0], first);
  }
}

}  // namespace mortier::sloped_supports_test
