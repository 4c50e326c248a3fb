#include "material/rate_law.h"

namespace mortier {

void RateLaw::takeSlopesBeside(const Matrix& stress, const Matrix& strain, double modulus,
                               Matrix& slopes) const {
  constexpr double part = 1e-6;
  constexpr double leastStrain = 1e-20;  // as good as none, and its powers are numbers
  if (slopes.allFinite()) return;
  Vector along(stress.rows());
  if (stress.rows() == 4)
    along << 1, -0.7, 0.5, 0;  // in the plane: in plane stress s33 is 0
  else
    along << 1, -0.7, 0.5, 0.2, 0.3, -0.4;
  const auto beside = [&](Vector x, double least) {
    const double size = stress.rows() == 4 ? x.head<3>().norm() : x.norm();
    x += (size > 0 ? part * size : least) * along;
    return x;
  };
  Matrix rate(stress.rows(), 1);
  Matrix own(slopes.rows(), 1);
  for (Eigen::Index i = 0; i < slopes.cols(); ++i) {
    if (slopes.col(i).allFinite()) continue;
    evaluate(beside(stress.col(i), leastStrain * modulus), beside(strain.col(i), leastStrain), rate, &own);
    slopes.col(i) = own;
  }
}

}  // namespace mortier
