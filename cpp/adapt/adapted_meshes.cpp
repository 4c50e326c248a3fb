#include "adapt/adapted_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interrupt.h"
#include "mesh/element_nodes.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

constexpr double unknownRate = std::numeric_limits<double>::infinity();
/// The largest reduction of a size in one round.
constexpr double leastReduction = 1.0 / 8;
/// Stresses are unbounded where s is less than this; a slower rate is not believed.
constexpr double bounded = 1.1;
constexpr double slowest = 0.2;

double sizeOf(const TriangleMesh& mesh, size_t t) {
  return doubleArea(mesh, static_cast<int>(t)) / 2;
}
double sizeOf(const TetrahedronMesh& mesh, size_t t) {
  return volume(mesh, mesh.tetrahedra[t]);
}
int nodesOf(const TriangleMesh& mesh, int degree) {
  return elementNodes(mesh, degree).count();
}
int nodesOf(const TetrahedronMesh& mesh, int degree) {
  return spaceNodes(mesh, degree).count();
}

/// r_T is the error to minus this power.
double powerOfErrors(int degree, int dimension) {
  return 2.0 / (2 * degree + dimension);
}

/// c by halving: the sum of the squares that sizes c times `size` leave grows with it.
double scaleOfSizes(const std::vector<Vector>& errors, double aim, int degree, double power) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  std::vector<std::pair<double, double>> squares;  ///< and sizes
  for (const Vector& error : errors)
    for (const double square : error) {
      if (!(square > 0)) continue;
      squares.emplace_back(square, std::pow(square, -power / 2));
      const double root = 1 / squares.back().second;
      low = std::min(low, root * leastReduction);
      high = std::max(high, root);
    }
  for (int i = 0; i < 60 && high > 0; ++i) {
    stopIfInterrupted();
    const double middle = std::sqrt(low) * std::sqrt(high);
    double sum = 0;
    for (const auto& [square, size] : squares) {
      const double reduction = std::clamp(middle * size, leastReduction, 1.0);
      double left = square;
      for (int k = 0; k < degree; ++k) left *= reduction * reduction;
      sum += left;
    }
    (sum > aim * aim ? high : low) = middle;
  }
  return low;
}

/// The fewest elements that make half of the sum, all bodies together; of those that are equal to six digits
/// the first, so that units and rotations change nothing.
std::vector<std::vector<char>> halfOfTheError(const std::vector<Vector>& errors) {
  constexpr double share = 0.5 - 1e-9;
  constexpr double digits = 0x1p20;
  struct Ranked {
    double rank;
    size_t body;
    Eigen::Index element;
  };
  std::vector<Ranked> order;
  std::vector<std::vector<char>> marked;
  double total = 0;
  for (size_t b = 0; b < errors.size(); ++b) {
    marked.emplace_back(errors[b].size(), 0);
    total += errors[b].sum();
    for (Eigen::Index t = 0; t < errors[b].size(); ++t)
      order.push_back({std::round(digits * std::log2(errors[b][t])), b, t});
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Ranked& a, const Ranked& b) { return a.rank > b.rank; });
  double sum = 0;
  for (const auto& [rank, body, element] : order) {
    if (sum >= share * total) break;
    sum += errors[body][element];
    marked[body][element] = 1;
  }
  return marked;
}

}  // namespace

AdaptedMeshes::AdaptedMeshes(const std::vector<TriangleMesh>& meshes, int degree)
    : degree_(degree), dimension_(2) {
  for (const TriangleMesh& mesh : meshes) {
    KnownCurves curves = curvesBehind(mesh);
    bodies_.emplace_back(InPlane{mesh, std::move(curves.edges)});
    polygons_.push_back(std::move(curves.polygons));
  }
}

AdaptedMeshes::AdaptedMeshes(const std::vector<TetrahedronMesh>& meshes, std::vector<CurvedFaces> curves,
                             int degree)
    : degree_(degree), dimension_(3), polygons_(meshes.size()) {
  for (size_t b = 0; b < meshes.size(); ++b) bodies_.emplace_back(InSpace{meshes[b], std::move(curves[b])});
}

int AdaptedMeshes::unknowns() const {
  int nodes = 0;
  for (const auto& body : bodies_)
    nodes += std::visit([&](const auto& of) { return nodesOf(of.mesh, degree_); }, body);
  return dimension_ * nodes;
}

template <class Body>
std::vector<int> AdaptedMeshes::cut(Body& body, const std::vector<char>& marked) {
  stopIfInterrupted();
  auto refined = bisect(body.mesh, body.curves, marked);
  body.mesh = std::move(refined.mesh);
  body.curves = std::move(refined.curves);
  body.offCurve.insert(body.offCurve.end(), refined.offCurve.begin(), refined.offCurve.end());
  return std::move(refined.parents);
}

std::vector<SpacePoint> AdaptedMeshes::offCurve(size_t body) const {
  std::vector<SpacePoint> places;
  std::visit(
      [&](const auto& of) {
        for (const int v : of.offCurve) {
          places.emplace_back(SpacePoint::Zero());
          places.back().head<std::decay_t<decltype(of.mesh.vertices[v])>::RowsAtCompileTime>() =
              of.mesh.vertices[v];
        }
      },
      bodies_[body]);
  return places;
}

void AdaptedMeshes::refineAll() {
  for (auto& body : bodies_)
    std::visit([&](auto& of) { cut(of, std::vector<char>(elementsOf(of.mesh).size(), 1)); }, body);
}

void AdaptedMeshes::halveAt(size_t body, const SpacePoint& place) {
  std::visit(
      [&](auto& of) {
        for (int i = 0; i < dimension_; ++i) {
          const auto away = [&](const auto& x) {
            return (x - place.head<std::decay_t<decltype(x)>::RowsAtCompileTime>()).squaredNorm();
          };
          const auto& vertices = of.mesh.vertices;
          const auto nearest =
              std::min_element(vertices.begin(), vertices.end(),
                               [&](const auto& a, const auto& b) { return away(a) < away(b); }) -
              vertices.begin();
          std::vector<char> marked;
          for (const auto& element : elementsOf(of.mesh))
            marked.push_back(std::find(element.begin(), element.end(), nearest) != element.end() ? 1 : 0);
          cut(of, marked);
        }
      },
      bodies_[body]);
}

void AdaptedMeshes::faceCorners(size_t body, int label, size_t otherBody, int otherLabel) {
  auto& one = std::get<InPlane>(bodies_[body]);
  auto& other = std::get<InPlane>(bodies_[otherBody]);
  const std::vector<Point> corners = cornersOf(one.mesh, label);
  cutFacing(one.mesh, one.curves, label, cornersOf(other.mesh, otherLabel));
  cutFacing(other.mesh, other.curves, otherLabel, corners);
}

void AdaptedMeshes::faceSizes(size_t body, int label, size_t otherBody, int otherLabel) {
  while (true) {
    auto& one = std::get<InPlane>(bodies_[body]);
    const std::vector<char> longer = longerThanFacing(one.mesh, label, mesh(otherBody), otherLabel);
    if (std::find(longer.begin(), longer.end(), 1) == longer.end()) return;
    cut(one, longer);
  }
}

void AdaptedMeshes::learn(const std::vector<Vector>& errors) {
  constexpr double rounding = 1e-20;  // of the squares of errors: a body without stress has no rates
  double total = 0;
  for (const Vector& error : errors) total += error.sum();
  for (size_t b = 0; b < bodies_.size(); ++b)
    std::visit([&](auto& body) { learnRates(body, errors[b], rounding * total); }, bodies_[b]);
}

double AdaptedMeshes::unresolved() const {
  double sum = 0;
  for (const auto& each : bodies_)
    std::visit(
        [&](const auto& body) {
          for (size_t v = 0; v < body.rate.size(); ++v)
            if (body.rate[v] < bounded)
              sum += body.error[v] / (std::pow(4, std::max(body.rate[v], slowest)) - 1);
        },
        each);
  return sum;
}

void AdaptedMeshes::refine(const std::vector<Vector>& errors, double aim) {
  constexpr double negligible = 0.01;
  const double power = powerOfErrors(degree_, dimension_);
  const double c = scaleOfSizes(errors, aim, degree_, power);
  const std::vector<std::vector<char>> marked = halfOfTheError(errors);
  learn(errors);
  for (size_t b = 0; b < bodies_.size(); ++b) {
    if (errors[b].isZero(0)) continue;  // a tool
    Vector reduction = Vector::Ones(errors[b].size());
    for (Eigen::Index t = 0; t < reduction.size(); ++t)
      if (errors[b][t] > 0)
        reduction[t] = std::clamp(c * std::pow(errors[b][t], -power / 2), leastReduction, 1.0);
    std::visit(
        [&](auto& body) {
          cutToSize(body, reduction, marked[b]);
          cutAtSingularities(body, negligible * aim * aim);
        },
        bodies_[b]);
  }
}

template <class Body>
void AdaptedMeshes::learnRates(Body& body, const Vector& error, double rounding) const {
  const double changed = dimension_ == 2 ? 0.7 : 0.3;  // in space the errors around a vertex scatter more
  const size_t vertices = body.mesh.vertices.size();
  std::vector<double> sum(vertices, 0);
  std::vector<double> size(vertices, 0);
  for (size_t t = 0; t < elementsOf(body.mesh).size(); ++t)
    for (const int v : elementsOf(body.mesh)[t]) {
      sum[v] += error[static_cast<Eigen::Index>(t)];
      size[v] += sizeOf(body.mesh, t);
    }
  for (double& each : sum)
    if (each < rounding) each = 0;
  for (size_t v = 0; v < body.error.size(); ++v)
    if (size[v] < changed * body.size[v] && sum[v] > 0 && body.error[v] > 0) {
      const double power = std::log(sum[v] / body.error[v]) / std::log(size[v] / body.size[v]);
      body.rate[v] = (dimension_ * power - (dimension_ - 2)) / 2;
    }
  body.rate.resize(vertices, unknownRate);
  constexpr double near = 0.6;  // a singular stress may be largest a vertex away
  body.isPeak.assign(vertices, 1);
  if (dimension_ == 2)
    for (const auto& element : elementsOf(body.mesh))
      for (const int v : element)
        for (const int other : element)
          if (sum[v] * size[other] < near * sum[other] * size[v]) body.isPeak[v] = 0;
  body.error = std::move(sum);
  body.size = std::move(size);
}

template <class Body>
void AdaptedMeshes::cutToSize(Body& body, const Vector& reduction, std::vector<char> marked) {
  const size_t vertices = body.mesh.vertices.size();
  std::vector<double> atVertex(vertices, 0);
  std::vector<int> around(vertices, 0);
  const auto logOf = [&](size_t t) { return std::log(sizeOf(body.mesh, t)); };
  const auto own = [&](size_t t) { return dimension_ * std::log(reduction[static_cast<Eigen::Index>(t)]); };
  for (size_t t = 0; t < elementsOf(body.mesh).size(); ++t)
    for (const int v : elementsOf(body.mesh)[t]) {
      atVertex[v] += own(t);
      ++around[v];
    }
  for (size_t v = 0; v < vertices; ++v) atVertex[v] /= around[v];
  // Of reductions, not of sizes: a mesh whose elements differ in size is not cut where it has no error. The
  // mean hides a single element with a large error: those that make half of it have their own, too.
  std::vector<double> wanted;
  for (size_t t = 0; t < elementsOf(body.mesh).size(); ++t) {
    double mean = 0;
    for (const int v : elementsOf(body.mesh)[t]) mean += atVertex[v];
    mean /= dimension_ + 1;
    wanted.push_back(logOf(t) + (marked[t] != 0 ? std::min(mean, own(t)) : mean));
  }
  // An element is half as large when it is cut: from there on, cutting it is nearer to what it should be. In
  // space the cuts that keep the mesh conforming make many smaller than that.
  const double slack = std::log(2.0) * (dimension_ == 2 ? 0.5 : 0.75) + 1e-9;
  for (bool first = true;; first = false) {
    marked.resize(wanted.size(), 0);
    bool any = false;
    for (size_t t = 0; t < marked.size(); ++t) {
      const bool large = logOf(t) > wanted[t] + slack;
      marked[t] = large || (first && marked[t] != 0) ? 1 : 0;
      any = any || marked[t] != 0;
    }
    if (!any) return;
    std::vector<double> next;
    for (const int parent : cut(body, marked)) next.push_back(wanted[parent]);
    wanted = std::move(next);
    marked.clear();
  }
}

template <class Body>
void AdaptedMeshes::cutAtSingularities(Body& body, double allowed) {
  const int most = dimension_ == 2 ? 6 : 10;
  for (size_t v = 0; v < body.rate.size(); ++v) {
    if (!(body.rate[v] < bounded) || body.isPeak[v] == 0) continue;
    const double rate = std::max(body.rate[v], slowest);
    const double power = (2 * rate + (dimension_ - 2)) / dimension_;  // of the size
    const auto atVertex = [&](std::vector<char>& marked) {
      double size = 0;
      marked.assign(elementsOf(body.mesh).size(), 0);
      for (size_t t = 0; t < marked.size(); ++t)
        for (const int other : elementsOf(body.mesh)[t])
          if (other == static_cast<int>(v)) {
            marked[t] = 1;
            size += sizeOf(body.mesh, t);
          }
      return size;
    };
    if (body.error[v] <= allowed) continue;  // sizes only fall
    stopIfInterrupted();
    std::vector<char> marked;
    const double error = body.error[v] * std::pow(atVertex(marked) / body.size[v], power);
    const double wanted = error > allowed ? std::ceil(std::log2(error / allowed) / power) : 0;
    for (int i = 0; i < std::min<double>(most, wanted); ++i) {
      cut(body, marked);
      atVertex(marked);
    }
  }
}

}  // namespace mortier
