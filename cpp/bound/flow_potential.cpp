#include "bound/flow_potential.h"

#include <algorithm>

namespace mortier {
namespace {

/// Whether G is the gradient of a convex function for the product s : t. In plane strain B is a cylinder and
/// all projections are one; without Poisson's effect E is a multiple of the identity.
bool associated(const LawDescription& law, int components) {
  return law.name == "Perzyna" &&
         (components == 4 || law.variant == "frobenius" || parameterOf(law, "poisson") == 0);
}

/// A group of triangles small enough for caches.
constexpr int group = 1024;

}  // namespace

double parameterOf(const LawDescription& law, const std::string& name) {
  for (const LawDescription::Parameter& each : law.parameters)
    if (each.name == name) return each.value;
  return 0;
}

std::string FlowPotential::obstacleOf(const Model& model) {
  for (const Body& body : model.bodies) {
    if (body.material().linear()) continue;
    for (const LawDescription& law : body.material().laws()) {
      if (law.name == "elastic") continue;
      if (law.name != "Perzyna") return body.name() + " follows a law without a bound: " + law.text();
      if (!associated(law, body.material().components()))
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
    beyond = std::max(beyond, 4 * parameterOf(law, "yield_stress"));
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
