#include "bound/flow_potential.h"

#include <algorithm>
#include <limits>

namespace mortier {
namespace {

/// A group of triangles small enough for caches.
constexpr int group = 1024;

/// A place in a part by its barycentric coordinates, and its share of the part's area: as one of the vertices
/// of small triangles, or as the centroid of one.
struct Place {
  Eigen::Vector3d at;
  double share = 0;
  bool vertex = false;
};

/// Of the four small triangles that halve the sides of a part.
std::vector<Place> placesInParts() {
  std::vector<Place> places;
  const Eigen::Matrix3d corners = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d middles;
  for (int k = 0; k < 3; ++k) middles.col(k) = (corners.col((k + 1) % 3) + corners.col((k + 2) % 3)) / 2;
  for (int k = 0; k < 3; ++k) {
    places.push_back({corners.col(k), 1. / 12, true});
    places.push_back({middles.col(k), 3. / 12, true});
    places.push_back({(middles.rowwise().sum() - middles.col(k) + corners.col(k)) / 3, 1. / 4});
  }
  places.push_back({corners.rowwise().mean(), 1. / 4});
  return places;
}

}  // namespace

double leastViscosity(const Body& body) {
  double least = std::numeric_limits<double>::infinity();
  for (const LawDescription& law : body.material().laws())
    if (law.projected) least = std::min(least, law.projected->viscosity);
  return least;
}

std::string FlowPotential::obstacleOf(const Model& model) {
  for (const Body& body : model.bodies) {
    if (body.material().linear()) continue;
    for (const LawDescription& law : body.material().laws()) {
      if (!law.flows) continue;
      if (!law.projected) return body.name() + " follows a law without a bound: " + law.text();
      if (!law.projected->hasPotential)
        return "the flow of " + body.name() + " has no potential: " + law.text();
    }
  }
  return "";
}

// A shear r adds r/(2 lambda) to the rate beyond yield, whatever part of the body it acts on.
FlowPotential::FlowPotential(const Body& body, const std::vector<int>& parents)
    : material_(body.material()), parents_(parents) {
  constexpr int shear = 2;
  double beyond = 0;
  for (const LawDescription& law : material_.laws())
    if (law.projected) beyond = std::max(beyond, 4 * law.projected->yieldStress);
  stress_.setZero(material_.components(), body.points());
  stress_.row(shear).setConstant(beyond);
  Matrix more;
  material_.viscoplasticRate(stress_, rate_);
  material_.viscoplasticRate(2 * stress_, more);
  fluidity_.setZero(static_cast<Eigen::Index>(parents.size()));
  for (size_t t = 0; t < parents.size(); ++t)
    fluidity_[static_cast<Eigen::Index>(t)] = (more(shear, parents[t]) - rate_(shear, parents[t])) / beyond;
}

int FlowPotential::together(int first) const {
  const auto own = static_cast<int>(stress_.cols());
  return first < own ? std::min(group, own - first) : 1;
}

Matrix FlowPotential::rates(int first, const Matrix& stress) {
  const int begin = parents_[first];
  stress_.middleCols(begin, stress.cols()) = stress;
  material_.viscoplasticRate({stress_}, rate_, begin, begin + static_cast<int>(stress.cols()));
  return rate_.middleCols(begin, stress.cols());
}

Vector FlowPotential::means(bool atVertices, int first, const Matrix& s, const Matrix& t,
                            const Matrix& rates) {
  static const std::vector<Place> places = placesInParts();
  Vector result = Vector::Zero(t.cols());
  Matrix values(t.rows(), t.cols());
  for (int part = 0; part < 3; ++part)
    for (const Place& place : places) {
      if (place.vertex != atVertices) continue;
      for (Eigen::Index i = 0; i < t.cols(); ++i)
        values.col(i) = s.middleCols<3>(9 * i + 3 * part) * place.at;
      const Matrix flows = this->rates(first, values);
      for (Eigen::Index i = 0; i < t.cols(); ++i) {
        if (fluidity_[first + i] == 0) continue;
        const PointVector own = t.col(i);
        const PointVector rate = rates.col(i);
        const FlowExcess excess{own, rate, fluidity_[first + i]};
        result[i] += place.share / 3 *
                     (atVertices ? excess.above(values.col(i), flows.col(i))
                                 : excess.below(values.col(i), flows.col(i)));
      }
    }
  return result;
}

double FlowExcess::above(const PointVector& s, const PointVector& rateOfS) const {
  const PointVector d = s - t;
  const PointVector dr = (rateOfS - rate) / fluidity;
  const double D = dr.squaredNorm() - 2 * rate.dot(d - dr) / fluidity;
  return fluidity / 2 * std::clamp(D, 0.0, d.squaredNorm());
}

double FlowExcess::below(const PointVector& s, const PointVector& rateOfS) const {
  const PointVector dP = s - t - (rateOfS - rate) / fluidity;
  return std::max(0.0, fluidity / 2 * dP.squaredNorm() + rateOfS.dot(dP));
}

}  // namespace mortier
