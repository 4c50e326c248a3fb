#include "material/material.h"

#include <numeric>

#include "material/interior_path.h"

namespace mortier {

ComponentMatrix moduliAt(const Linearisation& law, int point) {
  const Eigen::Index n = law.predictor.rows();
  ComponentMatrix moduli(n, n);
  for (Eigen::Index k = 0; k < n; ++k) moduli.col(k) = stressOf(law, PointVector::Unit(n, k), point);
  return moduli;
}

void setModuli(const ComponentMatrix& moduli, int point, Linearisation& law) {
  const Eigen::Index n = moduli.rows();
  const Eigen::Index block = n < 6 ? 3 : 6;
  const bool symmetric = law.moduli.rows() < block * block;
  Eigen::Index next = 0;
  for (Eigen::Index j = 0; j < block; ++j)
    for (Eigen::Index i = symmetric ? j : 0; i < block; ++i) law.moduli(next++, point) = moduli(i, j);
  if (n == block) return;
  auto beyond = law.beyond.col(point);
  beyond.head(block + 1) = moduli.row(block).head(block + 1).transpose();
  if (beyond.size() == 7 && n == 4) beyond.tail<3>() = moduli.col(3).head<3>();
  if (n == 5) beyond.tail<5>() << moduli.row(4).head<3>().transpose(), moduli(4, 4), moduli(4, 3);
}

Linearisation Material::room(int points) const {
  if (components() >= 6)
    return {Matrix(components(), points), Matrix(symmetricTangent() ? 21 : 36, points),
            Matrix(components() > 6 ? 7 : 0, points)};
  Linearisation room{Matrix(components(), points), Matrix(symmetricTangent() ? 6 : 9, points)};
  if (components() > 3) room.beyond.resize(components() > 4 ? 9 : symmetricTangent() ? 4 : 7, points);
  return room;
}

void Material::choosePenalty(const Matrix& stress, Vector& penalty) const {
  penalty.resize(stress.cols());
  choosePenalty(stress, penalty, 0, static_cast<int>(stress.cols()));
}

void Material::viscoplasticRate(const Matrix& stress, Matrix& rate, const Matrix* strain) const {
  rate.resizeLike(stress);
  viscoplasticRate({stress, strain}, rate, 0, static_cast<int>(stress.cols()));
}

void Material::elasticStrain(const Matrix& stress, Matrix& strain) const {
  strain.resizeLike(stress);
  elasticStrain(stress, strain, 0, static_cast<int>(stress.cols()));
}

std::unique_ptr<InteriorPath> Material::interiorPath(double weight, const Matrix& stress0,
                                                     const Matrix* strain0) const {
  if (linear()) return nullptr;
  std::vector<int> points(stress0.cols());
  std::iota(points.begin(), points.end(), 0);
  std::unique_ptr<InteriorPath> path = interiorPath({weight, stress0, strain0}, std::move(points));
  return path->points() > 0 ? std::move(path) : nullptr;
}

}  // namespace mortier
