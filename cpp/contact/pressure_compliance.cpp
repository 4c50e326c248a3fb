#include "contact/pressure_compliance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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

/// h2 of a surface, the geometric mean of its directions [m].
double spacingOf(const Eigen::Matrix3d& spacing) {
  const double trace = spacing.trace();
  return std::sqrt(std::sqrt(std::max(0.0, (trace * trace - (spacing * spacing).trace()) / 2)));
}

/// |way|/h2 in the direction of the way, along the surface.
double partOf(const Eigen::Matrix3d& spacing, const SpacePoint& normal, const SpacePoint& way) {
  if (way.isZero(0)) return 0;
  const SpacePoint n = normal.normalized();
  const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - n * n.transpose();
  const double size = spacing.trace();
  if (!(size > 0)) return infinity;
  const SpacePoint along = P * way;
  const Eigen::Matrix3d whole = P * spacing * P + size * n * n.transpose();
  return std::sqrt(along.dot(whole.inverse() * along));
}

/// Calls visit(i, j) for the pairs of rows of one part that are nearer than such a distance.
template <class Visit>
void forEachPair(const std::vector<SurfaceRow>& rows, Eigen::Matrix3d SurfaceRow::*spacing, Visit visit) {
  std::vector<int> order(rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::pair(rows[i].place.x(), i) < std::pair(rows[j].place.x(), j); });
  const auto squareOf = [&](const SurfaceRow& row) { return (row.*spacing).trace(); };
  double range = 0;
  for (const SurfaceRow& row : rows) range = std::max(range, std::sqrt(squareOf(row)));
  for (size_t a = 0; a < order.size(); ++a)
    for (size_t b = a + 1; b < order.size(); ++b) {
      const SurfaceRow& one = rows[order[a]];
      const SurfaceRow& other = rows[order[b]];
      const SpacePoint way = other.place - one.place;
      if (!(way.x() < range)) break;
      if (one.part == other.part && way.squaredNorm() < std::max(squareOf(one), squareOf(other)))
        visit(order[a], order[b]);
    }
}

/// A row, and one whose pressure is compared with its own.
struct NearRow {
  int row = 0, other = 0;
  double area = 0;    ///< k l l of the pair, over a length in space; 0 where another entry has it [m^2]
  double weight = 0;  ///< of the other row in the means of the row
  Eigen::Vector2d way{0, 0};  ///< to it, over the distance of the mortar nodes
};

/// The values at rows of the linear functions that fit the pressures near them best.
Eigen::SparseMatrix<double> linearFits(Eigen::Index n, const std::vector<NearRow>& near) {
  constexpr double rounding = 1e-12;
  const auto termsOf = [](const NearRow& pair) { return Eigen::Vector3d(1, pair.way.x(), pair.way.y()); };
  std::vector<Eigen::Matrix3d> moments(n, Eigen::Matrix3d::Zero());
  for (const NearRow& pair : near) {
    const Eigen::Vector3d terms = termsOf(pair);
    moments[pair.row] += pair.weight * terms * terms.transpose();
  }
  std::vector<Eigen::Vector3d> atRow;
  Eigen::CompleteOrthogonalDecomposition<Matrix> factors;
  factors.setThreshold(rounding);  // on a line, and where few rows are near, some slopes are not known
  for (const Eigen::Matrix3d& each : moments)
    atRow.emplace_back(factors.compute(each).solve(Eigen::Vector3d::UnitX()));
  Triplets entries;
  for (const NearRow& pair : near)
    if (pair.weight > 0)
      entries.emplace_back(pair.row, pair.other, pair.weight * termsOf(pair).dot(atRow[pair.row]));
  return assembled(n, n, entries);
}

/// \param ofMissing  times 1/E2
void assemble(const std::vector<NearRow>& near, const Vector& weights, double ofMissing,
              PressureCompliance& result) {
  const Eigen::Index n = weights.size();
  Triplets entries;
  for (const auto& [i, j, area, weight, way] : near) {
    if (!(area > 0)) continue;
    const double a = ofMissing * area;
    for (const int row : {i, j})
      for (const int column : {i, j})
        entries.emplace_back(row, column, (row == column ? a : -a) / (weights[row] * weights[column]));
  }
  if (entries.empty()) return;
  result.S = assembled(n, n, entries);
  result.means = linearFits(n, near);
}

/// With c = 0.4 a force on one node of a line gets about the compliance that the mortar mesh lacks.
constexpr double ofMissing = 0.4;

}  // namespace

PressureCompliance pressureCompliance(const CommonRefinement& refinement, const std::vector<int>& nodes,
                                      const Vector& weights, const Vector& lengths,
                                      const std::vector<double>& mirrors, double compliance) {
  const SmoothPart& part = refinement.part();
  constexpr double rounding = 1e-12;
  const auto n = static_cast<Eigen::Index>(nodes.size());
  PressureCompliance result{{n, n}, {n, n}, Vector::Zero(n)};
  if (!(compliance > 0) || n == 0) return result;
  const Spacing spacing(refinement);
  const std::vector<Place> places = placesOf(part, nodes);
  const double around = part.closed ? part.length() : 0;
  for (int row = 0; row < n; ++row) result.spacing[row] = spacing.at(nodes[row]);
  const double largest = weights.maxCoeff();
  std::vector<NearRow> near;
  const auto add = [&](int row, int of, double along, bool once) {
    const double h = (result.spacing[row] + result.spacing[of]) / 2;
    const double own = result.spacing[row];
    // The weight of a quadratic node on the axis is zero but for rounding.
    const bool counts = once && std::min(weights[row], weights[of]) > rounding * largest;
    const double depth = std::sqrt(weights[row] / lengths[row] * weights[of] / lengths[of]);
    near.push_back({row,
                    of,
                    counts ? std::max(0.0, 1 - std::abs(along) / h) * lengths[row] * lengths[of] * depth : 0,
                    std::max(0.0, 1 - std::abs(along) / own) * lengths[of],
                    {along / own, 0}});
  };
  const double range = result.spacing.maxCoeff();
  for (int i = 0; i < n; ++i) add(i, i, 0, false);
  forEachPair(places, around, range, [&](int i, int j, double distance) {
    add(i, j, distance, true);
    add(j, i, -distance, false);
  });
  for (const double mirror : mirrors)
    forEachImage(places, mirror, range, [&](int i, int j, double along) { add(i, j, along, i < j); });
  assemble(near, weights, ofMissing * compliance, result);
  return result;
}

SurfaceSpacing::SurfaceSpacing(const ContactSurface& surface) : surface_(surface) {
  std::map<int, double> triangles;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.places[t];
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const SpacePoint& edge : {SpacePoint(b - a), SpacePoint(c - b), SpacePoint(a - c)})
      sum += edge * edge.transpose();
    for (int k = 0; k < 3; ++k) {
      const int vertex = surface.triangles[t][k];
      const auto [at, first] = atVertices_.try_emplace(vertex, Eigen::Matrix3d::Zero());
      at->second += 2.0 / 3 / (surface.degree * surface.degree) * sum;
      ++triangles[vertex];
    }
  }
  for (auto& [vertex, tensor] : atVertices_) tensor /= triangles[vertex];
}

Eigen::Matrix3d SurfaceSpacing::at(const RayHit& hit) const {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (int k = 0; hit.triangle >= 0 && k < 3; ++k)
    result += std::clamp(hit.mu[k], 0.0, 1.0) * atVertices_.at(surface_.triangles[hit.triangle][k]);
  return result;
}

Eigen::Vector2d SurfaceRow::alongIt(const SpacePoint& way) const {
  const SpacePoint across = normal.unitOrthogonal();
  return {way.dot(across), way.dot(normal.cross(across))};
}

Eigen::Matrix3d SurfaceSpacing::ofVertices(int node) const {
  return surface_.degree * surface_.degree * atVertices_.at(node);
}

Eigen::SparseMatrix<double> linearFits(const std::vector<SurfaceRow>& rows, const Vector& areas) {
  std::vector<NearRow> near;
  const auto add = [&](int i, int j) {
    const SurfaceRow& row = rows[i];
    const SpacePoint way = rows[j].place - row.place;
    const double own = std::max(0.0, 1 - partOf(row.fitted, row.normal, way));
    if (own > 0) near.push_back({i, j, 0, own * areas[j], row.alongIt(way) / spacingOf(row.fitted)});
  };
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) add(i, i);
  forEachPair(rows, &SurfaceRow::fitted, [&](int i, int j) {
    add(i, j);
    add(j, i);
  });
  return linearFits(areas.size(), near);
}

PressureCompliance pressureCompliance(const std::vector<SurfaceRow>& rows, const Vector& areas,
                                      double compliance) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  PressureCompliance result{{n, n}, {n, n}, Vector::Zero(n)};
  if (!(compliance > 0)) return result;
  for (Eigen::Index i = 0; i < n; ++i) result.spacing[i] = spacingOf(rows[i].spacing);
  std::vector<NearRow> near;
  const auto add = [&](int i, int j, bool once) {
    const SurfaceRow& row = rows[i];
    const SpacePoint way = rows[j].place - row.place;
    const Eigen::Matrix3d mean = (row.spacing + rows[j].spacing) / 2;
    const double own = std::max(0.0, 1 - partOf(row.spacing, row.normal, way));
    const double k = once ? std::max(0.0, 1 - partOf(mean, row.normal + rows[j].normal, way)) : 0;
    if (!(own > 0) && !(k > 0)) return;
    near.push_back({i, j, k > 0 ? k * areas[i] * areas[j] / spacingOf(mean) : 0, own * areas[j],
                    row.alongIt(way) * (own > 0 ? 1 / result.spacing[i] : 0)});
  };
  for (int i = 0; i < n; ++i)
    if (result.spacing[i] > 0) add(i, i, false);
  forEachPair(rows, &SurfaceRow::spacing, [&](int i, int j) {
    add(i, j, true);
    add(j, i, false);
  });
  // In space the integral of k/h over the disc of radius h is pi/3 h, that over the line h.
  assemble(near, areas, 3 / M_PI * ofMissing * compliance, result);
  return result;
}

}  // namespace mortier
