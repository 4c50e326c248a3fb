#include "time/corner_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace mortier {
namespace {

constexpr int discs = 4;             // of 2, 4, 8 and 16 edges
constexpr double leastOrder = 0.15;  // jumps and smooth peaks have an order about 0
constexpr double mostOrder = 0.6;    // corners, cracks and ends of contact have at most 1/2
constexpr double largestSpread =
    0.2;  // the order of a peak that the mesh does not resolve grows with the radius

double doubled(const TriangleMesh& mesh, size_t t) {
  return doubleArea(mesh, static_cast<int>(t));
}

/// A length of the edges at the vertex next to a place.
double edgeAt(const TriangleMesh& mesh, const Point& place) {
  const auto far = [&](const Point& at) { return (at - place).squaredNorm(); };
  const auto nearest = std::min_element(mesh.vertices.begin(), mesh.vertices.end(),
                                        [&](const Point& a, const Point& b) { return far(a) < far(b); });
  const auto vertex = static_cast<int>(nearest - mesh.vertices.begin());
  double area = 0;
  int around = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), vertex) > 0) {
      area += doubled(mesh, t);
      ++around;
    }
  return std::sqrt(area / around);
}

double orderIn(const Body& body, const Matrix& stress, const Point& place) {
  const TriangleMesh& mesh = body.mesh();
  const double edge = edgeAt(mesh, place);
  if (!(edge * (1 << discs) < body.extent() / 2)) return 0;
  std::array<double, discs> energy{};
  const size_t points = body.points() / mesh.triangles.size();
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const double r = ((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3 - place).norm();
    for (size_t i = t * points; i < (t + 1) * points; ++i)
      for (int k = 0; k < discs; ++k)
        if (r < edge * (2 << k))
          energy[k] += body.weights()[i] * stress.col(static_cast<Eigen::Index>(i)).squaredNorm();
  }
  if (!(energy[0] > 0)) return 0;
  std::array<double, discs - 1> order{};
  for (int k = 0; k + 1 < discs; ++k) order[k] = 1 - std::log2(energy[k + 1] / energy[k]) / 2;
  const auto [low, high] = std::minmax_element(order.begin(), order.end());
  const double mean = std::accumulate(order.begin(), order.end(), 0.0) / order.size();
  return *low >= leastOrder && mean <= mostOrder && *high - *low <= largestSpread ? mean : 0;
}

}  // namespace

double unboundedOrder(const Model& model, const State& state, const Point& place) {
  double order = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b)
    order = std::max(order, orderIn(model.bodies[b], state.bodies[b].stress, place));
  return order;
}

}  // namespace mortier
