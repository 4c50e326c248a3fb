#include "adapt/adapted_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/interrupt.h"

namespace mortier {
namespace {

constexpr double unknownRate = std::numeric_limits<double>::infinity();
/// The largest reduction of a size in one round.
constexpr double leastReduction = 1.0 / 8;
/// Stresses are unbounded where errors fall like this power of the area, or more slowly; a slower one is not
/// believed.
constexpr double bounded = 1.1;
constexpr double slowest = 0.2;

/// c by halving: the sum grows with it.
double scaleOfSizes(const std::vector<Vector>& errors, double aim, int degree) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  const double power = 1.0 / (degree + 1);
  for (const Vector& error : errors)
    for (const double square : error) {
      if (!(square > 0)) continue;
      const double root = std::pow(std::sqrt(square), power);
      low = std::min(low, root * leastReduction);
      high = std::max(high, root);
    }
  for (int i = 0; i < 60 && high > 0; ++i) {
    stopIfInterrupted();
    const double middle = std::sqrt(low) * std::sqrt(high);
    double sum = 0;
    for (const Vector& error : errors)
      for (const double square : error)
        if (square > 0)
          sum += square *
                 std::pow(std::clamp(middle * std::pow(square, -power / 2), leastReduction, 1.0), 2 * degree);
    (sum > aim * aim ? high : low) = middle;
  }
  return low;
}

/// The fewest triangles that make half of the sum, all bodies together; of those that are equal to six digits
/// the first, so that units and rotations change nothing.
std::vector<std::vector<char>> halfOfTheError(const std::vector<Vector>& errors) {
  constexpr double share = 0.5 - 1e-9;
  constexpr double digits = 0x1p20;
  std::vector<std::pair<size_t, Eigen::Index>> order;
  std::vector<std::vector<char>> marked;
  double total = 0;
  for (size_t b = 0; b < errors.size(); ++b) {
    marked.emplace_back(errors[b].size(), 0);
    total += errors[b].sum();
    for (Eigen::Index t = 0; t < errors[b].size(); ++t) order.emplace_back(b, t);
  }
  const auto of = [&](const auto& which) { return errors[which.first][which.second]; };
  const auto rank = [&](const auto& which) { return std::round(digits * std::log2(of(which))); };
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto& a, const auto& b) { return rank(a) > rank(b); });
  double sum = 0;
  for (const auto& which : order) {
    if (sum >= share * total) break;
    sum += of(which);
    marked[which.first][which.second] = 1;
  }
  return marked;
}

}  // namespace

AdaptedMeshes::AdaptedMeshes(const std::vector<TriangleMesh>& meshes, int degree) : degree_(degree) {
  for (const TriangleMesh& mesh : meshes) {
    KnownCurves curves = curvesBehind(mesh);
    bodies_.push_back({mesh, std::move(curves.edges), std::move(curves.polygons), {}, {}, {}});
    chooseBases(bodies_.back().mesh);
  }
}

std::vector<int> AdaptedMeshes::cut(Adapted& body, const std::vector<char>& marked,
                                    std::vector<double>* byVertex) {
  stopIfInterrupted();
  RefinedMesh refined = bisect(body.mesh, body.curves, marked);
  body.mesh = std::move(refined.mesh);
  body.curves = std::move(refined.curves);
  offCurve_ += refined.offCurve;
  if (byVertex != nullptr)
    for (const auto& [a, b] : refined.cutEdges) byVertex->push_back(((*byVertex)[a] + (*byVertex)[b]) / 2);
  return std::move(refined.parents);
}

void AdaptedMeshes::refineAll() {
  for (Adapted& body : bodies_) cut(body, std::vector<char>(body.mesh.triangles.size(), 1));
}

void AdaptedMeshes::faceCorners(size_t body, int label, size_t otherBody, int otherLabel) {
  Adapted& one = bodies_[body];
  Adapted& other = bodies_[otherBody];
  const std::vector<Point> corners = cornersOf(one.mesh, label);
  cutFacing(one.mesh, one.curves, label, cornersOf(other.mesh, otherLabel));
  cutFacing(other.mesh, other.curves, otherLabel, corners);
}

void AdaptedMeshes::faceSizes(size_t body, int label, size_t otherBody, int otherLabel) {
  while (true) {
    Adapted& one = bodies_[body];
    const std::vector<char> longer = longerThanFacing(one.mesh, label, bodies_[otherBody].mesh, otherLabel);
    if (std::find(longer.begin(), longer.end(), 1) == longer.end()) return;
    cut(one, longer);
  }
}

void AdaptedMeshes::learn(const std::vector<Vector>& errors) {
  constexpr double rounding = 1e-20;  // of the squares of errors: a body without stress has no rates
  double total = 0;
  for (const Vector& error : errors) total += error.sum();
  for (size_t b = 0; b < bodies_.size(); ++b) learnRates(bodies_[b], errors[b], rounding * total);
}

double AdaptedMeshes::unresolved() const {
  double sum = 0;
  for (const Adapted& body : bodies_)
    for (size_t v = 0; v < body.rate.size(); ++v)
      if (body.rate[v] < bounded) sum += body.error[v] / (std::pow(4, std::max(body.rate[v], slowest)) - 1);
  return sum;
}

void AdaptedMeshes::refine(const std::vector<Vector>& errors, double aim) {
  constexpr double negligible = 0.01;
  const double c = scaleOfSizes(errors, aim, degree_);
  const std::vector<std::vector<char>> marked = halfOfTheError(errors);
  learn(errors);
  for (size_t b = 0; b < bodies_.size(); ++b) {
    if (errors[b].isZero(0)) continue;  // a tool
    Vector reduction = Vector::Ones(errors[b].size());
    for (Eigen::Index t = 0; t < reduction.size(); ++t)
      if (errors[b][t] > 0)
        reduction[t] = std::clamp(c * std::pow(errors[b][t], -0.5 / (degree_ + 1)), leastReduction, 1.0);
    cutToSize(bodies_[b], reduction, marked[b]);
    cutAtSingularities(bodies_[b], negligible * aim * aim);
  }
}

void AdaptedMeshes::learnRates(Adapted& body, const Vector& error, double rounding) const {
  constexpr double changed = 0.7;
  const size_t vertices = body.mesh.vertices.size();
  std::vector<double> sum(vertices, 0);
  std::vector<double> area(vertices, 0);
  for (size_t t = 0; t < body.mesh.triangles.size(); ++t)
    for (const int v : body.mesh.triangles[t]) {
      sum[v] += error[static_cast<Eigen::Index>(t)];
      area[v] += doubleArea(body.mesh, static_cast<int>(t)) / 2;
    }
  for (double& each : sum)
    if (each < rounding) each = 0;
  for (size_t v = 0; v < body.error.size(); ++v)
    if (area[v] < changed * body.area[v] && sum[v] > 0 && body.error[v] > 0)
      body.rate[v] = std::log(sum[v] / body.error[v]) / std::log(area[v] / body.area[v]);
  body.rate.resize(vertices, unknownRate);
  body.error = std::move(sum);
  body.area = std::move(area);
}

void AdaptedMeshes::cutToSize(Adapted& body, const Vector& reduction, std::vector<char> marked) {
  const size_t vertices = body.mesh.vertices.size();
  std::vector<double> logArea(vertices, 0);
  std::vector<int> around(vertices, 0);
  const auto logOf = [&](size_t t) { return std::log(doubleArea(body.mesh, static_cast<int>(t)) / 2); };
  for (size_t t = 0; t < body.mesh.triangles.size(); ++t)
    for (const int v : body.mesh.triangles[t]) {
      logArea[v] += logOf(t) + 2 * std::log(reduction[static_cast<Eigen::Index>(t)]);
      ++around[v];
    }
  for (size_t v = 0; v < vertices; ++v) logArea[v] /= around[v];
  // The mean at a vertex hides a single triangle with a large error: those that make half of it have a limit
  // each.
  std::vector<double> limit(marked.size(), std::numeric_limits<double>::infinity());
  for (size_t t = 0; t < marked.size(); ++t)
    if (marked[t] != 0) limit[t] = logOf(t) + 2 * std::log(reduction[static_cast<Eigen::Index>(t)]);
  // A triangle is half as large when it is cut: from there on, cutting it is nearer to what it should be.
  const double slack = std::log(2.0) / 2 + 1e-9;
  for (bool first = true;; first = false) {
    marked.resize(body.mesh.triangles.size(), 0);
    bool any = false;
    for (size_t t = 0; t < marked.size(); ++t) {
      const auto& [a, b, c] = body.mesh.triangles[t];
      const bool large = logOf(t) > std::min((logArea[a] + logArea[b] + logArea[c]) / 3, limit[t]) + slack;
      marked[t] = large || (first && marked[t] != 0) ? 1 : 0;
      any = any || marked[t] != 0;
    }
    if (!any) return;
    std::vector<double> limits;
    for (const int parent : cut(body, marked, &logArea)) limits.push_back(limit[parent]);
    limit = std::move(limits);
    marked.clear();
  }
}

void AdaptedMeshes::cutAtSingularities(Adapted& body, double allowed) {
  constexpr int most = 10;
  for (size_t v = 0; v < body.rate.size(); ++v) {
    if (!(body.rate[v] < bounded)) continue;
    stopIfInterrupted();
    const double rate = std::max(body.rate[v], slowest);
    const auto atVertex = [&](std::vector<char>& marked) {
      double area = 0;
      marked.assign(body.mesh.triangles.size(), 0);
      for (size_t t = 0; t < marked.size(); ++t)
        for (const int other : body.mesh.triangles[t])
          if (other == static_cast<int>(v)) {
            marked[t] = 1;
            area += doubleArea(body.mesh, static_cast<int>(t)) / 2;
          }
      return area;
    };
    std::vector<char> marked;
    const double error = body.error[v] * std::pow(atVertex(marked) / body.area[v], rate);
    const double wanted = error > allowed ? std::ceil(std::log2(error / allowed) / rate) : 0;
    for (int i = 0; i < std::min<double>(most, wanted); ++i) {
      cut(body, marked);
      atVertex(marked);
    }
  }
}

}  // namespace mortier
