#include "bound/side_tractions.h"

#include <algorithm>

#include "base/dense_templates.h"
#include "bound/composite_triangle.h"
#include "material/stress.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

/// Outward normal times length, the body to the left.
Point across(const TriangleMesh& mesh, const Side& side) {
  return acrossFrom(mesh.vertices[side.vertices[0]], mesh.vertices[side.vertices[1]]);
}

void listByVertex(size_t vertices, const std::vector<std::array<int, 2>>& pairs, std::vector<int>& start,
                  std::vector<int>& all) {
  start.assign(vertices + 1, 0);
  for (const auto& [vertex, item] : pairs) ++start[vertex + 1];
  for (size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
  all.resize(pairs.size());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (const auto& [vertex, item] : pairs) all[next[vertex]++] = item;
}

/// Makes the moments of a vertex those of balanced tractions.
class VertexBalance {
 public:
  VertexBalance(const TriangleMesh& mesh, const Sides& sides, const std::vector<Stress>& stress,
                const std::vector<BodyLoad>& forces, const std::vector<KnownTraction>& known,
                SideMoments& moments)
      : mesh_(mesh), sides_(sides), stress_(stress), forces_(forces), known_(known), moments_(moments) {}

  void balance(int vertex) {
    if (!walkRound(vertex)) solve(vertex);
  }

 private:
  [[nodiscard]] int endAt(int side, int vertex) const {
    return sides_.all()[side].vertices[0] == vertex ? 0 : 1;
  }
  [[nodiscard]] double length(int side) const { return across(mesh_, sides_.all()[side]).norm(); }
  [[nodiscard]] int cornerAt(int triangle, int vertex) const {
    const auto& v = mesh_.triangles[triangle];
    return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
  }
  /// integral over K of s grad phi - f phi, less the moments that its two sides have.
  [[nodiscard]] Point leftOver(int triangle, int vertex) const {
    const int i = cornerAt(triangle, vertex);
    Point left = tractionMatrix(hatGradient(mesh_, triangle, i)) * stress_[triangle];
    if (!forces_[triangle].isZero(0)) left -= nodalForces(mesh_, triangle, forces_[triangle]).col(i);
    for (const int k : {i, (i + 2) % 3}) {
      const int side = sides_.of(triangle, k);
      left -= (sides_.left(triangle, k) ? 1 : -1) * moments_[side][endAt(side, vertex)];
    }
    return left;
  }

  /// The triangles of an inner vertex in their order: the change of the first side gives all others, and is
  /// taken such that the sum of squares over the lengths is least. \returns whether the vertex is an inner
  /// one.
  bool walkRound(int vertex) {
    for (const int side : sides_.sidesAt(vertex))
      if (sides_.all()[side].triangles[1] < 0) return false;
    changes_.clear();
    const int first = *sides_.trianglesAt(vertex).begin();
    int triangle = first;
    Point sum(0, 0);
    Point mean(0, 0);
    double weights = 0;
    do {
      const int i = cornerAt(triangle, vertex);
      // Counterclockwise: in by the side i, out by the one before.
      const int in = sides_.of(triangle, i);
      const double weight = 1 / length(in);
      const double sign = sides_.left(triangle, i) ? 1 : -1;
      changes_.push_back({in, sign, sum});
      mean += weight * sum;
      weights += weight;
      sum -= leftOver(triangle, vertex);  // what is taken out by the next side by its own moments
      const int out = sides_.of(triangle, (i + 2) % 3);
      const auto& behind = sides_.all()[out].triangles;
      triangle = behind[0] == triangle ? behind[1] : behind[0];
    } while (triangle != first && changes_.size() <= sides_.sidesAt(vertex).size());
    if (changes_.size() != sides_.sidesAt(vertex).size()) return false;  // two rounds that meet at the vertex
    mean /= weights;
    for (const Change& change : changes_)
      moments_[change.side][endAt(change.side, vertex)] += change.sign * (change.by - mean);
    return true;
  }

  /// The same for any vertex.
  void solve(int vertex) {
    const std::span<const int> around = sides_.sidesAt(vertex);
    const auto columns = static_cast<Eigen::Index>(around.size());
    Eigen::Index rows = 2 * static_cast<Eigen::Index>(sides_.trianglesAt(vertex).size());
    for (const int side : around)
      if (sides_.all()[side].triangles[1] < 0) rows += known_[side].count;
    Matrix A = Matrix::Zero(rows, 2 * columns);
    Vector b = Vector::Zero(rows);
    const auto root = [&](Eigen::Index c) { return std::sqrt(length(around.begin()[c])); };
    Eigen::Index row = 0;
    for (const int triangle : sides_.trianglesAt(vertex)) {
      const int i = cornerAt(triangle, vertex);
      b.segment<2>(row) = leftOver(triangle, vertex);
      for (const int k : {i, (i + 2) % 3}) {
        const auto c = std::find(around.begin(), around.end(), sides_.of(triangle, k)) - around.begin();
        A.block<2, 2>(row, 2 * c) =
            (sides_.left(triangle, k) ? 1 : -1) * root(c) * Eigen::Matrix2d::Identity();
      }
      row += 2;
    }
    for (Eigen::Index c = 0; c < columns; ++c) {
      const int side = around.begin()[c];
      if (sides_.all()[side].triangles[1] >= 0) continue;
      const int end = endAt(side, vertex);
      for (int k = 0; k < known_[side].count; ++k, ++row) {
        A.block<1, 2>(row, 2 * c) = root(c) * known_[side].known[k].transpose();
        b[row] = known_[side].known[k].dot(known_[side].moments[end] - moments_[side][end]);
      }
    }
    const Vector change = Eigen::CompleteOrthogonalDecomposition<Matrix>(A).solve(b);
    for (Eigen::Index c = 0; c < columns; ++c)
      moments_[around.begin()[c]][endAt(around.begin()[c], vertex)] += root(c) * change.segment<2>(2 * c);
  }

  struct Change {
    int side = 0;
    double sign = 1;
    Point by{0, 0};
  };
  const TriangleMesh& mesh_;
  const Sides& sides_;
  const std::vector<Stress>& stress_;
  const std::vector<BodyLoad>& forces_;
  const std::vector<KnownTraction>& known_;
  SideMoments& moments_;
  std::vector<Change> changes_;
};

}  // namespace

Point hatGradient(const TriangleMesh& mesh, int triangle, int i) {
  const auto& v = mesh.triangles[triangle];
  return -acrossFrom(mesh.vertices[v[(i + 1) % 3]], mesh.vertices[v[(i + 2) % 3]]) / 2;
}

Eigen::Vector3d symmetricPart(const Point& v, const Point& g) {
  return fromCartesian({v.x() * g.x(), v.y() * g.y(), (v.x() * g.y() + v.y() * g.x()) / 2});
}

Eigen::Vector3d strainIn(const TriangleMesh& mesh, int triangle, const Vector& displacement) {
  Eigen::Vector3d strain = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i)
    strain += symmetricPart(displacement.segment<2>(2 * mesh.triangles[triangle][i]),
                            hatGradient(mesh, triangle, i));
  return strain / (doubleArea(mesh, triangle) / 2);
}

void takeForces(const TriangleMesh& mesh, int triangle, const Stress& stress, Vector& forces) {
  for (int i = 0; i < 3; ++i)
    forces.segment<2>(2 * mesh.triangles[triangle][i]) -=
        tractionMatrix(hatGradient(mesh, triangle, i)) * stress;
}

Sides::Sides(const TriangleMesh& mesh) : ofTriangle_(3 * mesh.triangles.size()) {
  const ElementSides<2> all = sortedSides(mesh);
  sides_.reserve(all.size() / 2 + mesh.boundaryEdges.size());
  std::vector<std::array<int, 2>> atVertices;
  forEachPlace(all, [&](std::span<const ElementSide<2>> on) {
    const auto& v = mesh.triangles[on[0].element()];
    const int k = on[0].corner();
    Side& side = sides_.emplace_back(Side{{v[k], v[(k + 1) % 3]}, {on[0].element(), -1}, -1});
    if (on.size() > 1) side.triangles[1] = on[1].element();
    for (const int vertex : side.vertices) atVertices.push_back({vertex, count() - 1});
    for (const ElementSide<2>& each : on)
      ofTriangle_[each.place] = 2 * (count() - 1) + (&each != &on[0] ? 1 : 0);
  });
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const auto on = sidesOn(all, mesh.boundaryEdges[e]);
    if (!on.empty()) sides_[ofTriangle_[on[0].place] >> 1].boundary = static_cast<int>(e);
  }
  listByVertex(mesh.vertices.size(), atVertices, sideStart_, sidesAt_);
  std::vector<std::array<int, 2>> trianglesOf;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int vertex : mesh.triangles[t]) trianglesOf.push_back({vertex, static_cast<int>(t)});
  listByVertex(mesh.vertices.size(), trianglesOf, triangleStart_, trianglesAt_);
}

Eigen::Matrix<double, 2, 3> nodalForces(const TriangleMesh& mesh, int triangle, const BodyLoad& load) {
  const auto& v = mesh.triangles[triangle];
  return CompositeTriangle({mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]},
                           Eigen::Matrix3d::Identity())
      .nodalForces(load);
}

SideMoments balancedMoments(const TriangleMesh& mesh, const Sides& sides, const std::vector<Stress>& stress,
                            const std::vector<BodyLoad>& forces, const std::vector<KnownTraction>& known) {
  SideMoments moments(sides.count());
  for (int e = 0; e < sides.count(); ++e) {
    const Side& side = sides.all()[e];
    const Point n = across(mesh, side);
    Point mean = tractionMatrix(n) * stress[side.triangles[0]];
    if (side.triangles[1] >= 0) mean = (mean + tractionMatrix(n) * stress[side.triangles[1]]) / 2;
    moments[e] = {mean / 2, mean / 2};
  }
  VertexBalance vertices(mesh, sides, stress, forces, known, moments);
  for (int vertex = 0; vertex < static_cast<int>(mesh.vertices.size()); ++vertex) vertices.balance(vertex);
  return moments;
}

Moments momentsOf(const Sides& sides, const SideMoments& moments, int triangle) {
  Moments result;
  for (int k = 0; k < 3; ++k) {
    const auto& [first, second] = moments[sides.of(triangle, k)];
    if (sides.left(triangle, k)) {
      result.segment<2>(4 * k) = first;
      result.segment<2>(4 * k + 2) = second;
    } else {
      result.segment<2>(4 * k) = -second;
      result.segment<2>(4 * k + 2) = -first;
    }
  }
  return result;
}

}  // namespace mortier
