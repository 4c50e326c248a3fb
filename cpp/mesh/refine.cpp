#include "mesh/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace mortier {
namespace {

constexpr int none = -1;

/// The triangle turned so that its longest side is the base; of equal ones that with the larger vertex
/// numbers, so that two triangles choose alike.
std::array<int, 3> onItsLongestSide(const TriangleMesh& mesh, std::array<int, 3> triangle) {
  const auto side = [&](int k) { return rankOfSide(mesh.vertices, triangle[k], triangle[(k + 1) % 3]); };
  const int longest = side(0) < side(1) ? (side(1) < side(2) ? 2 : 1) : (side(0) < side(2) ? 2 : 0);
  std::rotate(triangle.begin(), triangle.begin() + longest, triangle.end());
  return triangle;
}

class Bisection {
 public:
  Bisection(const TriangleMesh& mesh, const CurvedEdges& curves) : old_(mesh), curves_(curves) {
    for (const auto& triangle : mesh.triangles) triangles_.push_back(onItsLongestSide(mesh, triangle));
    numberEdges();
    for (size_t e = 0; e < mesh.edgeCurves.size(); ++e)
      if (mesh.hasCurve(e)) ownCurves_[mesh.boundaryEdges[e]] = &mesh.edgeCurves[e];
    cut_.assign(triangleOf_.size(), 0);
  }

  RefinedMesh run(const std::vector<char>& marked) {
    for (size_t t = 0; t < marked.size(); ++t)
      if (marked[t] != 0) cut(sides_[t][0]);
    close();
    result_.mesh = old_;
    addVertices();
    addTriangles();
    while (putBackWhatTurnsOver()) {
    }
    addBoundary();
    addMiddles();
    return std::move(result_);
  }

 private:
  void numberEdges() {
    std::unordered_map<int64_t, int> number;
    const auto vertices = static_cast<int64_t>(old_.vertices.size());
    for (size_t t = 0; t < triangles_.size(); ++t) {
      const auto& v = triangles_[t];
      std::array<int, 3> sides{};
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(v[k], v[(k + 1) % 3]);
        const auto [found, isNew] =
            number.try_emplace(low * vertices + high, static_cast<int>(triangleOf_.size()));
        if (isNew)
          triangleOf_.push_back({static_cast<int>(t), none});
        else
          triangleOf_[found->second][1] = static_cast<int>(t);
        sides[k] = found->second;
      }
      sides_.push_back(sides);
    }
  }

  void cut(int edge) {
    if (cut_[edge] != 0) return;
    cut_[edge] = 1;
    fresh_.push_back(edge);
  }

  /// A triangle with a side that is cut has its base cut.
  void close() {
    while (!fresh_.empty()) {
      const int edge = fresh_.back();
      fresh_.pop_back();
      for (const int t : triangleOf_[edge])
        if (t != none) cut(sides_[t][0]);
    }
  }

  [[nodiscard]] double curvature(int a, int b) const {
    const auto found = curves_.find({a, b});
    if (found != curves_.end()) return found->second;
    const auto reversed = curves_.find({b, a});
    return reversed != curves_.end() ? -reversed->second : 0;
  }

  void addVertices() {
    middle_.assign(triangleOf_.size(), none);
    result_.curves = curves_;
    for (size_t t = 0; t < sides_.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int edge = sides_[t][k];
        if (cut_[edge] == 0 || middle_[edge] != none) continue;
        addVertex(edge, triangles_[t][k], triangles_[t][(k + 1) % 3]);
      }
  }

  void addVertex(int edge, int a, int b) {
    const auto m = static_cast<int>(result_.mesh.vertices.size());
    middle_[edge] = m;
    result_.cutEdges.push_back({a, b});
    if (const auto own = ownCurves_.find({a, b}); own != ownCurves_.end()) {  // of one triangle, as its side
      places_[m] = own->second->middle();
      result_.mesh.vertices.push_back(own->second->at(places_[m]));
      moved_[m] = {a, b};
      return;
    }
    const double bend = curvature(a, b);
    result_.mesh.vertices.push_back(middleOfArc(old_.vertices[a], old_.vertices[b], bend));
    if (bend == 0) return;
    moved_[m] = {a, b};
    result_.curves.erase({a, b});
    result_.curves.erase({b, a});
    result_.curves[{a, m}] = result_.curves[{m, b}] = bend;
  }

  void addTriangles() {
    result_.mesh.triangles.clear();
    result_.mesh.regions.clear();
    for (size_t t = 0; t < sides_.size(); ++t) {
      const auto& [ab, bc, ca] = sides_[t];
      add(triangles_[t], {middle_[ab], middle_[bc], middle_[ca]});
      const size_t pieces = result_.mesh.triangles.size() - result_.parents.size();
      result_.parents.insert(result_.parents.end(), pieces, static_cast<int>(t));
      result_.mesh.regions.insert(result_.mesh.regions.end(), pieces, old_.regions[t]);
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
    TriangleMesh& mesh = result_.mesh;
    for (size_t begin = 0, end = 0; begin < mesh.triangles.size() && !moved_.empty(); begin = end) {
      while (end < mesh.triangles.size() && result_.parents[end] == result_.parents[begin]) ++end;
      const double share = doubleArea(old_, result_.parents[begin]) / 4;
      for (size_t t = begin; t < end; ++t) {
        if (doubleArea(mesh, static_cast<int>(t)) > least * share) continue;
        for (const int v : mesh.triangles[t]) any = putBack(v) || any;
      }
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
    std::map<std::array<int, 2>, int> edges;
    for (size_t t = 0; t < sides_.size(); ++t)
      for (int k = 0; k < 3; ++k)
        if (cut_[sides_[t][k]] != 0)
          edges[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = middle_[sides_[t][k]];
    result_.mesh.boundaryEdges.clear();
    result_.mesh.boundaryLabels.clear();
    result_.mesh.edgeCurves.clear();
    const auto push = [&](int a, int b, size_t from, const EdgeCurve& curve) {
      result_.mesh.boundaryEdges.push_back({a, b});
      result_.mesh.boundaryLabels.push_back(old_.boundaryLabels[from]);
      if (!old_.edgeCurves.empty()) result_.mesh.edgeCurves.push_back(curve);
      from_.push_back(from);
    };
    for (size_t e = 0; e < old_.boundaryEdges.size(); ++e) {
      const auto [a, b] = old_.boundaryEdges[e];
      const auto found = edges.find({a, b});
      const EdgeCurve curve = old_.hasCurve(e) ? old_.edgeCurves[e] : EdgeCurve{};
      if (found == edges.end()) {
        push(a, b, e, curve);
        continue;
      }
      const auto place = places_.find(found->second);
      const bool onCurve = place != places_.end();
      push(a, found->second, e, onCurve ? EdgeCurve{curve.curve, curve.from, place->second} : EdgeCurve{});
      push(found->second, b, e, onCurve ? EdgeCurve{curve.curve, place->second, curve.to} : EdgeCurve{});
    }
  }

  void addMiddles() {
    TriangleMesh& mesh = result_.mesh;
    if (old_.edgeMiddles.empty() && result_.curves.empty()) return;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    mesh.edgeMiddles.clear();
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
      const auto& [a, b] = mesh.boundaryEdges[e];
      const auto curve = result_.curves.find({a, b});
      const bool whole = mesh.boundaryEdges[e] == old_.boundaryEdges[from_[e]];
      if (whole && !old_.edgeMiddles.empty() && old_.edgeMiddles[from_[e]].allFinite())
        mesh.edgeMiddles.push_back(old_.edgeMiddles[from_[e]]);
      else if (mesh.hasCurve(e))
        mesh.edgeMiddles.push_back(mesh.edgeCurves[e].at(mesh.edgeCurves[e].middle()));
      else if (isStraight(old_, from_[e]))
        mesh.edgeMiddles.emplace_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
      else if (curve != result_.curves.end())
        mesh.edgeMiddles.push_back(middleOfArc(mesh.vertices[a], mesh.vertices[b], curve->second));
      else
        mesh.edgeMiddles.emplace_back(unknown, unknown);
    }
  }

  const TriangleMesh& old_;
  const CurvedEdges& curves_;
  std::vector<std::array<int, 3>> triangles_;   // on their longest sides
  std::vector<std::array<int, 3>> sides_;       // of each triangle, the numbers of its edges
  std::vector<std::array<int, 2>> triangleOf_;  // of each edge
  std::vector<char> cut_;                       // edges
  std::vector<int> fresh_;                      // edges that are cut, and their triangles not yet looked at
  std::vector<int> middle_;                     // of edges that are cut
  std::map<std::array<int, 2>, const EdgeCurve*> ownCurves_;  // of the mesh, by the vertices of their edges
  std::map<int, double> places_;                              // of new vertices on them
  std::map<int, std::array<int, 2>> moved_;  // new vertices on arcs or curves, and the ends of their edges
  std::vector<size_t> from_;                 // of each boundary edge, the one before
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
