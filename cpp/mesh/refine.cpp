#include "mesh/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

/// Of an edge, in place of the vertex that cuts it.
constexpr int none = -1, due = -2;

/// The triangle turned so that its longest side is the base; of equal ones that with the larger vertex
/// numbers, so that two triangles choose alike.
std::array<int, 3> onItsLongestSide(const TriangleMesh& mesh, std::array<int, 3> triangle) {
  const auto side = [&](int k) { return rankOfSide(mesh.vertices, triangle[k], triangle[(k + 1) % 3]); };
  const int longest = side(0) < side(1) ? (side(1) < side(2) ? 2 : 1) : (side(0) < side(2) ? 2 : 0);
  std::rotate(triangle.begin(), triangle.begin() + longest, triangle.end());
  return triangle;
}

/// A triangle is cut through its base, and its halves through its other sides. So unlike in space
/// (refine_space.cpp), where halves have longest edges of their own, all edges to be cut are known before the
/// first cut.
class Bisection {
 public:
  Bisection(const TriangleMesh& mesh, const CurvedEdges& curves) : old_(mesh) {
    result_.mesh = mesh;
    result_.curves = curves;
    for (auto& triangle : result_.mesh.triangles) {
      stopIfInterrupted();
      triangle = onItsLongestSide(mesh, triangle);
    }
    sides_ = sortedSides(result_.mesh);
    triangles_ = std::exchange(result_.mesh.triangles, {});
    edges_.resize(sides_.size());
    for (size_t i = 0; i < sides_.size(); ++i) {
      const bool isNew = i == 0 || sides_[i].vertices != sides_[i - 1].vertices;
      edges_[sides_[i].place] = isNew ? static_cast<int>(i) : edges_[sides_[i - 1].place];
    }
    middle_.assign(sides_.size(), none);
    for (size_t e = 0; e < mesh.edgeCurves.size(); ++e)
      if (mesh.hasCurve(e)) ownCurves_[edgeOf(mesh.boundaryEdges[e])] = &mesh.edgeCurves[e];
  }

  RefinedMesh run(const std::vector<char>& marked) {
    for (size_t t = 0; t < marked.size(); ++t)
      if (marked[t] != 0) cut(edges_[3 * t]);
    close();
    addVertices();
    addTriangles();
    while (putBackWhatTurnsOver()) {
    }
    addBoundary();
    return std::move(result_);
  }

 private:
  [[nodiscard]] int edgeOf(const std::array<int, 2>& ends) const {
    return edges_[sidesOn(sides_, ends).front().place];
  }

  void cut(int edge) {
    if (std::exchange(middle_[edge], due) != due) fresh_.push_back(edge);
  }

  /// A triangle with a side that is cut has its base cut.
  void close() {
    while (!fresh_.empty()) {
      const auto edge = static_cast<size_t>(fresh_.back());
      fresh_.pop_back();
      for (size_t i = edge; i < sides_.size() && sides_[i].vertices == sides_[edge].vertices; ++i)
        cut(edges_[3 * sides_[i].element()]);
    }
  }

  /// In the order in which triangles have their edges.
  void addVertices() {
    for (size_t place = 0; place < edges_.size(); ++place) {
      stopIfInterrupted();
      const std::array<int, 3>& triangle = triangles_[place / 3];
      if (middle_[edges_[place]] == due)
        addVertex(edges_[place], triangle[place % 3], triangle[(place + 1) % 3]);
    }
  }

  void addVertex(int edge, int a, int b) {
    CurvedEdges& curves = result_.curves;
    const auto m = static_cast<int>(result_.mesh.vertices.size());
    middle_[edge] = m;
    if (const auto own = ownCurves_.find(edge); own != ownCurves_.end()) {  // of one triangle, as its side
      places_[m] = own->second->middle();
      result_.mesh.vertices.push_back(own->second->at(places_[m]));
      moved_[m] = {a, b};
      return;
    }
    const auto forwards = curves.extract({a, b}), backwards = curves.extract({b, a});
    const double bend = !forwards.empty() ? forwards.mapped() : !backwards.empty() ? -backwards.mapped() : 0;
    result_.mesh.vertices.push_back(middleOfArc(old_.vertices[a], old_.vertices[b], bend));
    if (bend == 0) return;
    moved_[m] = {a, b};
    curves[{a, m}] = curves[{m, b}] = bend;
  }

  void addTriangles() {
    result_.mesh.regions.clear();
    for (size_t t = 0; t < triangles_.size(); ++t) {
      stopIfInterrupted();
      const int* edges = &edges_[3 * t];
      add(triangles_[t], {middle_[edges[0]], middle_[edges[1]], middle_[edges[2]]});
      result_.parents.resize(result_.mesh.triangles.size(), static_cast<int>(t));
      result_.mesh.regions.resize(result_.mesh.triangles.size(), old_.regions[t]);
    }
  }

  /// \param middles  of the sides; none where they are not cut
  void add(const std::array<int, 3>& triangle, const std::array<int, 3>& middles) {
    const auto& [a, b, c] = triangle;
    const auto& [m, bc, ca] = middles;
    if (m == none) {
      result_.mesh.triangles.push_back(triangle);
      return;
    }
    add({c, a, m}, {ca, none, none});
    add({b, c, m}, {bc, none, none});
  }

  /// \returns whether a vertex went back to its chord.
  bool putBackWhatTurnsOver() {
    constexpr double least = 0.25;  // of the share of the area that a piece has on straight edges
    bool any = false;
    for (size_t t = 0; t < result_.parents.size() && !moved_.empty(); ++t) {
      const double share = doubleArea(old_, result_.parents[t]) / 4;
      if (doubleArea(result_.mesh, static_cast<int>(t)) > least * share) continue;
      for (const int v : result_.mesh.triangles[t]) any = putBack(v) || any;
    }
    return any;
  }

  bool putBack(int v) {
    const auto found = moved_.find(v);
    if (found == moved_.end()) return false;
    const auto [a, b] = found->second;
    result_.mesh.vertices[v] = (old_.vertices[a] + old_.vertices[b]) / 2;
    result_.curves.erase({a, v});
    result_.curves.erase({v, b});
    places_.erase(v);
    moved_.erase(found);
    result_.offCurve.push_back(v);
    return true;
  }

  void addBoundary() {
    TriangleMesh& mesh = result_.mesh;
    mesh.boundaryEdges.clear();
    mesh.boundaryLabels.clear();
    mesh.edgeCurves.clear();
    mesh.edgeMiddles.clear();
    const bool anyMiddle = !old_.edgeMiddles.empty() || !result_.curves.empty();
    const auto push = [&](int a, int b, size_t from, const EdgeCurve& curve) {
      mesh.boundaryEdges.push_back({a, b});
      mesh.boundaryLabels.push_back(old_.boundaryLabels[from]);
      if (!old_.edgeCurves.empty()) mesh.edgeCurves.push_back(curve);
      if (anyMiddle) mesh.edgeMiddles.push_back(middleOf({a, b}, from, curve));
    };
    for (size_t e = 0; e < old_.boundaryEdges.size(); ++e) {
      const auto [a, b] = old_.boundaryEdges[e];
      const int m = middle_[edgeOf({a, b})];
      const EdgeCurve whole = old_.hasCurve(e) ? old_.edgeCurves[e] : EdgeCurve{};
      const auto place = places_.find(m);
      const bool onCurve = place != places_.end();
      if (m == none) {
        push(a, b, e, whole);
        continue;
      }
      push(a, m, e, onCurve ? EdgeCurve{whole.curve, whole.from, place->second} : EdgeCurve{});
      push(m, b, e, onCurve ? EdgeCurve{whole.curve, place->second, whole.to} : EdgeCurve{});
    }
  }

  /// Of an edge of the boundary. \param from  that of which it is a part or the whole
  [[nodiscard]] Point middleOf(const std::array<int, 2>& edge, size_t from, const EdgeCurve& curve) const {
    const Point& a = result_.mesh.vertices[edge[0]];
    const Point& b = result_.mesh.vertices[edge[1]];
    const bool isWhole = edge == old_.boundaryEdges[from] && !old_.edgeMiddles.empty();
    if (isWhole && old_.edgeMiddles[from].allFinite()) return old_.edgeMiddles[from];
    if (curve.known()) return curve.at(curve.middle());
    if (isStraight(old_, from)) return (a + b) / 2;
    const auto bend = result_.curves.find(edge);
    if (bend != result_.curves.end()) return middleOfArc(a, b, bend->second);
    return Point::Constant(std::numeric_limits<double>::quiet_NaN());
  }

  const TriangleMesh& old_;
  std::vector<std::array<int, 3>> triangles_;  // on their longest sides
  ElementSides<2> sides_;                      // of these
  std::vector<int> edges_;                     // by places of sides, the first of those on the same edge
  std::vector<int> middle_;                    // of edges
  std::vector<int> fresh_;                     // edges that are cut, and their triangles not yet looked at
  std::map<int, const EdgeCurve*> ownCurves_;  // of the mesh, by their edges
  std::map<int, double> places_;               // of new vertices on them
  std::map<int, std::array<int, 2>> moved_;    // new vertices on arcs or curves, and the ends of their edges
  RefinedMesh result_;
};

}  // namespace

bool isStraight(const TriangleMesh& mesh, size_t edge) {
  const auto& [a, b] = mesh.boundaryEdges[edge];
  return !mesh.edgeMiddles.empty() && mesh.edgeMiddles[edge] == (mesh.vertices[a] + mesh.vertices[b]) / 2;
}

RefinedMesh bisect(const TriangleMesh& mesh, const CurvedEdges& curves, const std::vector<char>& marked) {
  return Bisection(mesh, curves).run(marked);
}

Point middleOfArc(const Point& a, const Point& b, double curvature) {
  const Point half = (b - a) / 2;
  const double part = std::abs(curvature) * half.norm();
  // The sagitta over the half chord; to the right.
  const double slope = curvature * half.norm() / (1 + std::sqrt(std::max(0.0, 1 - part * part)));
  return a + half + slope * Point(half.y(), -half.x());
}

}  // namespace mortier
