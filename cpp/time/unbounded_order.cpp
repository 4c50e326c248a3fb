#include "time/singular_places.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "mesh/simplices.h"

namespace mortier {
namespace {

constexpr int discs = 4;             // of 2, 4, 8 and 16 edges; balls in space
constexpr double leastOrder = 0.15;  // jumps and smooth peaks have an order about 0
constexpr double mostOrder = 0.6;    // corners, cracks and ends of contact have at most 1/2
constexpr double largestSpread =
    0.2;  // the order of a peak that the mesh does not resolve grows with the radius

/// The size of an element times the factorial of the dimension: of the box of its edges at a vertex.
template <class Place, size_t corners>
double boxOf(const std::vector<Place>& vertices, const std::array<int, corners>& element) {
  Eigen::Matrix<double, corners - 1, corners - 1> edges;
  for (size_t k = 1; k < corners; ++k) edges.col(k - 1) = vertices[element[k]] - vertices[element[0]];
  return std::abs(edges.determinant());
}

/// A length of the edges at the vertex next to a place.
template <class Place, size_t corners>
double edgeAt(const std::vector<Place>& vertices, const std::vector<std::array<int, corners>>& elements,
              const Place& place) {
  const auto far = [&](const Place& at) { return (at - place).squaredNorm(); };
  const auto nearest = std::min_element(vertices.begin(), vertices.end(),
                                        [&](const Place& a, const Place& b) { return far(a) < far(b); });
  const auto vertex = static_cast<int>(nearest - vertices.begin());
  double size = 0;
  int around = 0;
  for (const auto& element : elements)
    if (std::count(element.begin(), element.end(), vertex) > 0) {
      size += boxOf(vertices, element);
      ++around;
    }
  return std::pow(size / around, 1.0 / (corners - 1));
}

template <class Mesh>
double orderIn(const Body& body, const Matrix& stress, const Mesh& mesh, const SpacePoint& at) {
  using Place = typename decltype(mesh.vertices)::value_type;
  const auto& elements = elementsOf(mesh);
  const Place place = at.head<Place::RowsAtCompileTime>();
  const double edge = edgeAt(mesh.vertices, elements, place);
  if (!(edge * (1 << discs) < body.extent() / 2)) return 0;
  constexpr double dimension = Place::RowsAtCompileTime;
  std::array<double, discs> energy{};
  const size_t points = body.points() / elements.size();
  for (size_t t = 0; t < elements.size(); ++t) {
    Place centre = Place::Zero();
    for (const int v : elements[t]) centre += mesh.vertices[v];
    const double r = (centre / (dimension + 1) - place).norm();
    for (size_t i = t * points; i < (t + 1) * points; ++i)
      for (int k = 0; k < discs; ++k)
        if (r < edge * (2 << k))
          energy[k] += body.weights()[i] * stress.col(static_cast<Eigen::Index>(i)).squaredNorm();
  }
  if (!(energy[0] > 0)) return 0;
  std::array<double, discs - 1> order{};
  for (int k = 0; k + 1 < discs; ++k) order[k] = (dimension - std::log2(energy[k + 1] / energy[k])) / 2;
  const auto [low, high] = std::minmax_element(order.begin(), order.end());
  const double mean = std::accumulate(order.begin(), order.end(), 0.0) / order.size();
  return *low >= leastOrder && mean <= mostOrder && *high - *low <= largestSpread ? mean : 0;
}

}  // namespace

double unboundedOrder(const Model& model, const State& state, const SpacePoint& place) {
  double order = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    order = std::max(order, body.withMesh([&](const auto& mesh, const auto&) {
      return orderIn(body, state.bodies[b].stress, mesh, place);
    }));
  }
  return order;
}

}  // namespace mortier
