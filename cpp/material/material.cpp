#include "material/material.h"

#include <numeric>

#include "material/interior_path.h"

namespace mortier {

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
