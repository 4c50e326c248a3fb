#include "time/error_norms.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/simplices.h"

namespace mortier {

ErrorNorms larger(const ErrorNorms& a, const ErrorNorms& b) {
  return {std::max(a.stress, b.stress), std::max(a.displacement, b.displacement),
          std::max(a.friction, b.friction)};
}

double relative(const ErrorNorms& error, const ErrorNorms& scale) {
  const auto part = [](double e, double of) { return e > 0 ? e / of : 0; };
  const double s = part(error.stress, scale.stress);
  const double u = part(error.displacement, scale.displacement);
  const double f = part(error.friction, scale.friction);
  return std::isfinite(s) && std::isfinite(u) && std::isfinite(f) ? std::max({s, u, f}) : 1;
}

void addTo(std::vector<Matrix>& sum, double factor, const std::vector<Matrix>& part) {
  for (size_t b = 0; b < part.size(); ++b) {
    if (sum.size() == b) sum.emplace_back(Matrix::Zero(part[b].rows(), part[b].cols()));
    sum[b] += factor * part[b];
  }
}

void addTo(SlipAndWork& sum, double factor, const SlipAndWork& part) {
  for (size_t k = 0; k < part.slip.size(); ++k) {
    if (sum.slip.size() == k) sum.slip.emplace_back(Vector::Zero(part.slip[k].size()));
    sum.slip[k] += factor * part.slip[k];
  }
  sum.work += factor * part.work;
  addTo(sum.strain, factor, part.strain);
}

void addTo(std::vector<Response>& sum, const std::vector<Response>& part) {
  for (size_t b = 0; b < sum.size(); ++b) {
    sum[b].displacement += part[b].displacement;
    sum[b].stress += part[b].stress;
  }
}

ErrorMeasure::ErrorMeasure(const Model& model) : model_(model), hasFriction_(anyFriction(model)) {
  for (const Body& body : model.bodies) {
    for (const double weight : body.weights()) area_ += weight;
    extent_ = std::max(extent_, body.extent());
  }
}

ErrorMeasure::StressNorms ErrorMeasure::normsOf(const Matrix& stress, size_t body) const {
  Matrix strain;
  model_.bodies[body].material().elasticStrain(stress, strain);
  StressNorms norms;
  for (Eigen::Index i = 0; i < stress.cols(); ++i) {
    const double weight = model_.bodies[body].weights()[i];
    norms.energy += weight * stress.col(i).dot(strain.col(i));
    norms.strain += weight / area_ * strain.col(i).squaredNorm();
  }
  return norms;
}

/// Over the area or volume of all bodies, an equal part of each element at each of its vertices.
double ErrorMeasure::meanSquare(const Vector& displacement, size_t body) const {
  const Body& in = model_.bodies[body];
  const size_t points = in.pointsOfTriangle();
  return in.withMesh([&]<class Mesh>(const Mesh& mesh, const auto&) {
    constexpr int dimension = ofTetrahedra<Mesh> ? 3 : 2;
    double sum = 0;
    for (size_t i = 0; i < in.weights().size(); ++i)
      for (const int vertex : elementsOf(mesh)[i / points])
        sum += in.weights()[i] / (dimension + 1) / area_ *
               displacement.segment<dimension>(dimension * vertex).squaredNorm();
    return sum;
  });
}

ErrorNorms ErrorMeasure::sizeOf(const State& state) const {
  constexpr double little = 1e-6;
  constexpr double roundedMotion = 1e-10;  // over the extent, the strain that is nothing beside it
  double stress = 0;
  double displacement = 0;
  double strain = 0;
  for (size_t b = 0; b < state.bodies.size(); ++b) {
    const StressNorms norms = normsOf(state.bodies[b].stress, b);
    stress += norms.energy;
    strain += norms.strain;
    displacement += meanSquare(state.bodies[b].displacement, b);
  }
  if (strain > 0)
    stress = std::max(stress, stress / strain * displacement * std::pow(roundedMotion / extent_, 2));
  return {std::sqrt(stress), std::max(std::sqrt(displacement), extent_ * std::sqrt(strain)),
          hasFriction_ ? std::max(state.frictionWork, little * stress) : 0};
}

ErrorNorms ErrorMeasure::sizeOf(const std::vector<Response>& error) const {
  double stress = 0;
  double displacement = 0;
  for (size_t b = 0; b < error.size(); ++b) {
    stress += normsOf(error[b].stress, b).energy;
    displacement += meanSquare(error[b].displacement, b);
  }
  return {std::sqrt(stress), std::sqrt(displacement), 0};
}

}  // namespace mortier
