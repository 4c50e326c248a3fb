#include "fem/rigid_modes.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <string>

#include "unit/plate.h"

namespace mortier {
namespace {

TEST(RigidModes, supportsLeaveTheRestFree) {
  struct Case {
    std::vector<PrescribedDisplacement> supports;
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

}  // namespace
}  // namespace mortier
