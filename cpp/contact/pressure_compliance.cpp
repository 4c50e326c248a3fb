#include "contact/pressure_compliance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortier {
namespace {

/// Distance of the mortar nodes at the points that nodes face: at a vertex the mean of both sides, linear
/// between.
class Spacing {
 public:
  explicit Spacing(const CommonRefinement& refinement) : refinement_(refinement) {
    const MortarLine& line = refinement.mortar();
    const int last = line.elements();
    const auto length = [&](int e) { return (line.points[e + 1] - line.points[e]).norm() / line.degree(); };
    for (int i = 0; i <= last; ++i) {
      const int before = i > 0 ? i - 1 : line.closed ? last - 1 : 0;
      const int after = i < last ? i : line.closed ? 0 : last - 1;
      means_.push_back((length(before) + length(after)) / 2);
    }
  }

  [[nodiscard]] double at(int node) const {
    const auto& [facing, place] = refinement_.facingOfNode(node);
    const Eigen::Index quadratic = facing.psi.size() - 2;  // the middle stands for half of each end
    const double part = facing.psi[1] + (quadratic > 0 ? facing.psi[2] / 2 : 0);
    const double xi = std::clamp(part, 0.0, 1.0);
    return (1 - xi) * means_[place.mortar] + xi * means_[place.mortar + 1];
  }

 private:
  const CommonRefinement& refinement_;
  std::vector<double> means_;
};

/// A row and the abscissa of its node.
struct Place {
  double s = 0;
  int row = 0;
};

std::vector<Place> placesOf(const SmoothPart& part, const std::vector<int>& nodes) {
  std::vector<Place> places;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const int middle = nodes[i] - (part.elements() + 1);
    places.push_back(
        {middle < 0 ? part.s[nodes[i]] : (part.s[middle] + part.s[middle + 1]) / 2, static_cast<int>(i)});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.s < b.s; });
  return places;
}

/// Calls visit(row, other row, distance) for the pairs that are nearer than `range`, each once.
template <class Visit>
void forEachPair(const std::vector<Place>& places, double around, double range, Visit visit) {
  const size_t n = places.size();
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 1; k < n && (i + k < n || around > 0); ++k) {
      const Place& other = places[(i + k) % n];
      const double distance = other.s - places[i].s + (i + k < n ? 0 : around);
      if (!(distance < range)) break;
      visit(places[i].row, other.row, distance);
    }
}

/// Calls visit(row, other row, to the image of the other one along the line) for those that are nearer.
template <class Visit>
void forEachImage(const std::vector<Place>& places, double mirror, double range, Visit visit) {
  for (const Place& place : places)
    for (const Place& other : places) {
      const double along = 2 * mirror - other.s - place.s;
      if (std::abs(place.s - mirror) < range && std::abs(along) < range) visit(place.row, other.row, along);
    }
}

}  // namespace

PressureCompliance pressureCompliance(const CommonRefinement& refinement, const std::vector<int>& nodes,
                                      const Vector& weights, const Vector& lengths,
                                      const std::vector<double>& mirrors, double compliance) {
  const SmoothPart& part = refinement.part();
  constexpr double ofMissing = 0.4;
  constexpr double rounding = 1e-12;
  const auto n = static_cast<Eigen::Index>(nodes.size());
  PressureCompliance result{{n, n}, {n, n}, Vector::Zero(n)};
  if (!(compliance > 0) || n == 0) return result;
  const Spacing spacing(refinement);
  const std::vector<Place> places = placesOf(part, nodes);
  const double around = part.closed ? part.length() : 0;
  for (int row = 0; row < n; ++row) result.spacing[row] = spacing.at(nodes[row]);
  const double largest = weights.maxCoeff();
  Triplets entries;
  Triplets near;  // pairs within h2, with the distance of the second along the line
  Matrix moments = Matrix::Zero(n, 3);
  const auto addNear = [&](int row, int of, double along) {
    const double weight = (1 - std::abs(along) / result.spacing[row]) * lengths[of];
    if (!(weight > 0)) return;
    near.emplace_back(row, of, along);
    moments.row(row) += weight * Eigen::RowVector3d(1, along, along * along);
  };
  for (int i = 0; i < n; ++i) addNear(i, i, 0);
  const auto add = [&](int i, int j, double distance) {
    const double h = (result.spacing[i] + result.spacing[j]) / 2;
    // The weight of a quadratic node on the axis is zero but for rounding.
    if (distance < h && std::min(weights[i], weights[j]) > rounding * largest) {
      const double depth = std::sqrt(weights[i] / lengths[i] * weights[j] / lengths[j]);
      const double a = ofMissing * compliance * (1 - distance / h) * lengths[i] * lengths[j] * depth;
      for (const int row : {i, j})
        for (const int column : {i, j})
          entries.emplace_back(row, column, (row == column ? a : -a) / (weights[row] * weights[column]));
    }
  };
  const double range = result.spacing.maxCoeff();
  forEachPair(places, around, range, [&](int i, int j, double distance) {
    add(i, j, distance);
    addNear(i, j, distance);
    addNear(j, i, -distance);
  });
  for (const double mirror : mirrors)
    forEachImage(places, mirror, range, [&](int i, int j, double along) {
      if (i < j) add(i, j, std::abs(along));
      addNear(i, j, along);
    });
  if (entries.empty()) return result;
  for (auto& pair : near) {  // the value there of the linear function that fits those pressures best
    const auto m = moments.row(pair.row());
    const double weight = (1 - std::abs(pair.value()) / result.spacing[pair.row()]) * lengths[pair.col()];
    const double whole = m[0] * m[2] - m[1] * m[1];
    const double share =
        whole > rounding * m[0] * m[2] ? weight * (m[2] - m[1] * pair.value()) / whole : weight / m[0];
    pair = {pair.row(), pair.col(), share};
  }
  result.S = assembled(n, n, entries);
  result.means = assembled(n, n, near);
  return result;
}

}  // namespace mortier
