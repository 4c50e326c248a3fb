#include "bound/part_stress.h"

#include <Eigen/Dense>

#include "material/stress.h"

namespace mortier {

PartStress addedIn(const LoadedBody& loaded, int triangle, const Linearisation& law,
                   Eigen::Index components) {
  const CompositeTriangle element = loaded.elementOf(triangle);
  const BodyLoad& f = loaded.forceOn(triangle);
  const std::array<Stress, 9> plane = element.stressOf(
      loaded.momentsOf(triangle) - element.momentsOf(loaded.stress()[triangle]) - element.momentsOfLoad(f),
      f);
  PartStress result;
  for (int i = 0; i < 9; ++i) {
    result[i].resize(components);
    result[i].head<3>() = fromCartesian(plane[i]);
  }
  if (components > 3) {
    const int parent = loaded.parents()[triangle];
    const auto D = moduliAt(law.moduli, parent);
    const Eigen::Vector3d beyond =
        Eigen::Map<const Eigen::Matrix3d>(D.data()).inverse() * law.beyond.col(parent).head<3>();
    for (PointVector& each : result) each[3] = beyond.dot(each.head<3>());
  }
  return result;
}

std::vector<Place> placesIn(int cuts) {
  std::vector<Place> places;
  const double n = cuts;
  for (int i = 0; i <= cuts; ++i)
    for (int j = 0; i + j <= cuts; ++j) {
      const int l = cuts - i - j;
      const int sides = (i == 0 ? 1 : 0) + (j == 0 ? 1 : 0) + (l == 0 ? 1 : 0);
      const int meet = sides == 0 ? 6 : sides == 1 ? 3 : 1;
      places.push_back({{i / n, j / n, l / n}, meet / (3 * n * n), true});
      if (l > 0) places.push_back({{(i + 1. / 3) / n, (j + 1. / 3) / n, (l - 2. / 3) / n}, 1 / (n * n)});
      if (l > 1) places.push_back({{(i + 2. / 3) / n, (j + 2. / 3) / n, (l - 4. / 3) / n}, 1 / (n * n)});
    }
  return places;
}

double product(const PointMatrix& A, const PointVector* v, const PointVector* w) {
  const PointVector sum = w[0] + w[1] + w[2];
  return (v[0].dot(A * w[0]) + v[1].dot(A * w[1]) + v[2].dot(A * w[2]) + (v[0] + v[1] + v[2]).dot(A * sum)) /
         12;
}

}  // namespace mortier
