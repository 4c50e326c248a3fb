#include "fem/data_misfit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/dense_templates.h"
#include "mesh/element_nodes.h"

namespace mortier {
namespace {

using Monomials = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

Monomials termsOf(const std::array<double, 3>& b, int degree) {
  if (degree == 0) return Monomials::Ones(1);
  if (degree == 1) return Monomials{{b[0], b[1], b[2]}};
  return Monomials{{b[0] * b[0], b[1] * b[1], b[2] * b[2], b[0] * b[1], b[1] * b[2], b[2] * b[0]}};
}

Eigen::VectorXd projectionOf(const ResolvedTriangle& resolved, int degree) {
  const auto count = static_cast<Eigen::Index>(termsOf({}, degree).size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  for (const auto& [at, weight, value] : resolved.samples) {
    const Monomials terms = termsOf(at, degree);
    normal += weight * terms * terms.transpose();
    right += weight * value * terms;
  }
  return normal.completeOrthogonalDecomposition().solve(right);
}

template <class Place>
Misfit misfitOf(const Resolved<Place>& resolved, const std::vector<double>& w) {
  Misfit result;
  for (size_t i = 0; i < w.size(); ++i) {
    const auto& [at, weight, value] = resolved.samples[i];
    result.square += weight * w[i] * w[i];
    result.most = std::max(result.most, std::abs(w[i]));
  }
  return result;
}

/// |w|_-1/2^2 by the first waves of a function, and |W| |w| of the others: of a narrow peak |W| |w| of all
/// is far more.
double minusHalfNorm(const ResolvedEdge& edge, const std::vector<double>& w, const Misfit& of) {
  constexpr int waves = 64;
  constexpr double smooth = 4;  // of so few waves
  const double pi = std::numbers::pi;
  const double all = std::sqrt(of.primitive * of.square);
  if (!(of.square > smooth * smooth * pi * pi * of.primitive)) return all;
  double sum = 0;
  double square = of.square;
  double primitive = of.primitive;
  for (int k = 1; k <= waves; ++k) {
    double amplitude = 0;
    for (size_t i = 0; i < w.size(); ++i)
      amplitude += 2 * edge.samples[i].weight * w[i] * std::cos(k * pi * edge.samples[i].at);
    const double part = amplitude * amplitude / 2;
    sum += part / (k * pi);
    square -= part;
    primitive -= part / (k * pi * k * pi);
  }
  return std::min(all, sum + std::sqrt(std::max(0.0, square) * std::max(0.0, primitive)));
}

/// With what is known of a function that is 0 at the ends of an edge by its samples in order.
Misfit alongEdge(const ResolvedEdge& edge, const std::vector<double>& w) {
  Misfit result = misfitOf(edge, w);
  double before = 0;
  double meanPrimitive = 0;
  for (size_t i = 0; i < w.size(); ++i) {
    const double part = edge.samples[i].weight;
    const double primitive = before + part * w[i] / 2;
    result.primitive += part * primitive * primitive;
    meanPrimitive += part * primitive;
    before += part * w[i];
    const double from = i > 0 ? edge.samples[i - 1].at : 0;
    const double change = i > 0 ? w[i] - w[i - 1] : w[i];
    if (edge.samples[i].at > from) result.slope += change * change / (edge.samples[i].at - from);
  }
  result.primitive = std::max(0.0, result.primitive - meanPrimitive * meanPrimitive);
  result.minusHalf = minusHalfNorm(edge, w, result);
  if (!w.empty() && edge.samples.back().at < 1)
    result.slope += w.back() * w.back() / (1 - edge.samples.back().at);
  return result;
}

Box boxOf(const Point& low, const Point& high, double t) {
  return {{low.x(), high.x()}, {low.y(), high.y()}, {t, t}};
}

}  // namespace

ResolvedEdge onEdge(const Datum& datum, const std::vector<Point>& nodes, double t) {
  const Point& a = nodes[0];
  const Point along = nodes[1] - a;
  const Point bend = nodes.size() > 2 ? Point(nodes[2] - (a + nodes[1]) / 2) : Point::Zero();
  const auto placeOf = [&](double s) { return Point(a + s * along + 4 * s * (1 - s) * bend); };
  const auto value = [&](double s) {
    const Point place = placeOf(s);
    return datum(place.x(), place.y(), t);
  };
  if (!datum.enclosure) return resolveOnEdge(value);
  return resolveOnEdge(value, [&](double from, double to) {
    // A parabola lies within its ends and where the tangents there meet.
    const Point p = placeOf(from);
    const Point q = placeOf(to);
    const Point r = p + (to - from) / 2 * (along + 4 * (1 - 2 * from) * bend);
    return datum.enclosure(boxOf(p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r), t));
  });
}

ResolvedTriangle onTriangle(const Datum& datum, const std::vector<Point>& nodes, double t) {
  std::array<Point, 3> bend{Point::Zero(), Point::Zero(), Point::Zero()};
  Point most = Point::Zero();
  for (size_t k = 3; k < nodes.size(); ++k) {
    bend[k - 3] = nodes[k] - (nodes[k - 3] + nodes[(k - 2) % 3]) / 2;
    most += bend[k - 3].cwiseAbs();
  }
  const auto onStraight = [&](const std::array<double, 3>& b) {
    return Point(b[0] * nodes[0] + b[1] * nodes[1] + b[2] * nodes[2]);
  };
  const auto value = [&](const std::array<double, 3>& b) {
    const Point place =
        onStraight(b) + 4 * (b[0] * b[1] * bend[0] + b[1] * b[2] * bend[1] + b[2] * b[0] * bend[2]);
    return datum(place.x(), place.y(), t);
  };
  if (!datum.enclosure) return resolveOnTriangle(value);
  return resolveOnTriangle(value, [&](const std::array<std::array<double, 3>, 3>& part) {
    const Point p = onStraight(part[0]);
    const Point q = onStraight(part[1]);
    const Point r = onStraight(part[2]);
    return datum.enclosure(boxOf(p.cwiseMin(q).cwiseMin(r) - most, p.cwiseMax(q).cwiseMax(r) + most, t));
  });
}

std::vector<double> projection(const ResolvedTriangle& triangle, int degree,
                               const std::vector<std::array<double, 3>>& places) {
  const Eigen::VectorXd factors = projectionOf(triangle, degree);
  std::vector<double> values;
  for (const auto& place : places) values.push_back(factors.dot(termsOf(place, degree)));
  return values;
}

Misfit misfit(const ResolvedTriangle& triangle, int degree) {
  const Eigen::VectorXd factors = projectionOf(triangle, degree);
  std::vector<double> off;
  for (const auto& [at, weight, value] : triangle.samples)
    off.push_back(value - factors.dot(termsOf(at, degree)));
  return misfitOf(triangle, off);
}

std::vector<std::array<double, 3>> lineProjection(const std::vector<LineEdge>& edges, int degree) {
  constexpr double enough = 1e-10;  // of the right hand side
  constexpr int most = 200;
  const int n = degree + 1;
  std::map<int, Eigen::Index> numbers;
  for (const LineEdge& edge : edges)
    for (int a = 0; a < n; ++a) numbers.emplace(edge.nodes[a], static_cast<Eigen::Index>(numbers.size()));
  const auto size = static_cast<Eigen::Index>(numbers.size());
  Vector right = Vector::Zero(size);
  Vector diagonal = Vector::Zero(size);
  // Of an edge of length 1: of the ends, then the middle.
  Eigen::Matrix3d mass{{4, -1, 2}, {-1, 4, 2}, {2, 2, 16}};
  mass /= 30;
  if (degree == 1) mass.topLeftCorner<2, 2>() << 1.0 / 3, 1.0 / 6, 1.0 / 6, 1.0 / 3;
  const auto at = [&](const LineEdge& edge, int a) { return numbers.at(edge.nodes[a]); };
  for (const LineEdge& edge : edges)
    for (int a = 0; a < n; ++a) {
      for (const auto& [s, weight, value] : edge.datum.samples)
        right[at(edge, a)] += edge.length * weight * value * edgeShapes(degree, s)[a];
      diagonal[at(edge, a)] += edge.length * mass(a, a);
    }
  const auto times = [&](const Vector& x) {
    Vector product = Vector::Zero(size);
    for (const LineEdge& edge : edges)
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) product[at(edge, a)] += edge.length * mass(a, b) * x[at(edge, b)];
    return product;
  };
  // Conjugate gradients: scaled by its diagonal the mass matrix has a small condition on any line.
  Vector x = Vector::Zero(size);
  Vector left = right;
  Vector direction = left.cwiseQuotient(diagonal);
  double square = left.dot(direction);
  const double small = enough * enough * square;
  for (int i = 0; i < most && square > small; ++i) {
    const Vector product = times(direction);
    const double step = square / direction.dot(product);
    x += step * direction;
    left -= step * product;
    const Vector scaled = left.cwiseQuotient(diagonal);
    const double next = left.dot(scaled);
    direction = scaled + next / square * direction;
    square = next;
  }
  std::vector<std::array<double, 3>> values(edges.size());
  for (size_t e = 0; e < edges.size(); ++e)
    for (int a = 0; a < n; ++a) values[e][a] = x[at(edges[e], a)];
  return values;
}

Misfit interpolationMisfit(const ResolvedEdge& edge, const std::array<double, 3>& values, int degree) {
  std::vector<double> w;
  for (const auto& [at, weight, value] : edge.samples) {
    const EdgeValues shapes = edgeShapes(degree, at);
    double interpolant = 0;
    for (Eigen::Index k = 0; k < shapes.size(); ++k) interpolant += shapes[k] * values[k];
    w.push_back(value - interpolant);
  }
  return alongEdge(edge, w);
}

}  // namespace mortier
