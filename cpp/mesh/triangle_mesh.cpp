#include "mesh/triangle_mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/digits.h"
#include "base/fault_error.h"

namespace mortier {
namespace {

// Doubled area over the squared longest edge; below it the sign of the area is not to be trusted.
constexpr double degenerateRatio = 1e-12;

// Squared edge lengths [m^2] whose products with the ratio above neither underflow nor overflow.
constexpr double smallestSquare = 1e-280, largestSquare = 1e280;

std::string text(double value) {
  char digits[32];
  return std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

std::string numbers(const std::array<int, 3>& t) {
  return std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1);
}

std::string numbers(const std::array<int, 2>& e) {
  return std::to_string(e[0] + 1) + " " + std::to_string(e[1] + 1);
}

double longestEdgeSquared(const TriangleMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const Point &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
  return std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()});
}

class Validator {
 public:
  Validator(TriangleMesh& mesh, const FaultPlace& place) : mesh_(mesh), place_(place) {}

  void run() {
    checkSizes();
    checkVertices();
    checkTriangles();
    checkNoneUnused();
    collectEdges();
    checkSharing();
    checkAndOrientLabelledEdges();
  }

 private:
  // One side of a triangle, filed under the smaller of its two vertices.
  struct Side {
    int far;       // the larger vertex
    int triangle;  // whose side it is
    bool rising;   // the triangle runs from the smaller to the larger vertex
    bool labelled;
  };

  [[noreturn]] void fail(MeshPart part, int index, const std::string& what,
                         const std::string& id = {}) const {
    const std::string message = (place_ ? place_(part, index) : mesh_.name) + ": " + what;
    if (id.empty()) throw InputError(message);
    throw FaultError(message, id);
  }

  void checkSizes() const {
    if (mesh_.regions.size() != mesh_.triangles.size() ||
        mesh_.boundaryLabels.size() != mesh_.boundaryEdges.size()) {
      fail(MeshPart::whole, 0, "numbers of labels, expected one for each triangle and each boundary edge");
    }
    if (mesh_.triangles.empty()) fail(MeshPart::whole, 0, "0 triangles, expected 1 or more");
  }

  void checkVertices() const {
    for (int v = 0; v < int(mesh_.vertices.size()); ++v) {
      const Point& p = mesh_.vertices[v];
      if (p.allFinite()) continue;
      fail(MeshPart::vertex, v,
           "vertex " + std::to_string(v + 1) + " at (" + text(p.x()) + ", " + text(p.y()) +
               "), expected finite coordinates");
    }
  }

  bool isVertex(int v) const { return v >= 0 && v < int(mesh_.vertices.size()); }

  std::string range() const { return "expected vertices from 1 to " + std::to_string(mesh_.vertices.size()); }

  void checkTriangles() const {
    for (int t = 0; t < int(mesh_.triangles.size()); ++t) {
      const auto& v = mesh_.triangles[t];
      const auto failHere = [&](const std::string& what, const std::string& id = {}) {
        fail(MeshPart::triangle, t, "triangle " + std::to_string(t + 1) + " (" + numbers(v) + ")" + what, id);
      };
      if (!isVertex(v[0]) || !isVertex(v[1]) || !isVertex(v[2])) failHere(", " + range());
      const double square = longestEdgeSquared(mesh_, t);
      const double area = doubleArea(mesh_, t);
      if (square > 0 && !(square > smallestSquare && square < largestSquare)) {
        failHere(": longest edge " + text(std::sqrt(square)) + ", expected between 1e-140 and 1e140");
      }
      if (area > degenerateRatio * square) continue;
      if (area < -degenerateRatio * square)
        failHere(" is clockwise, expected counterclockwise", "clockwise-triangle");
      failHere(" is degenerate: area " + digits(area / 2, 4) + ", longest edge " +
                   digits(std::sqrt(square), 4) + ", expected three corners that are not in line",
               "degenerate-triangle");
    }
  }

  void checkNoneUnused() const {
    std::vector<char> used(mesh_.vertices.size(), 0);
    for (const auto& t : mesh_.triangles) used[t[0]] = used[t[1]] = used[t[2]] = 1;
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused == used.end()) return;
    const int v = int(unused - used.begin());
    fail(MeshPart::vertex, v,
         "vertex " + std::to_string(v + 1) + " is unused, expected a corner of a triangle", "unused-vertex");
  }

  // Counting sort by the smaller vertex, then by the larger one: equal edges become neighbours.
  void collectEdges() {
    first_.assign(mesh_.vertices.size() + 1, 0);
    const auto forEachSide = [this](const auto& visit) {
      for (int t = 0; t < int(mesh_.triangles.size()); ++t) {
        const auto& v = mesh_.triangles[t];
        for (int k = 0; k < 3; ++k) visit(t, v[k], v[(k + 1) % 3]);
      }
    };
    forEachSide([this](int, int a, int b) { ++first_[std::min(a, b) + 1]; });
    for (size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    sides_.resize(3 * mesh_.triangles.size());
    std::vector<size_t> next(first_.begin(), first_.end() - 1);
    forEachSide([&](int t, int a, int b) {
      sides_[next[std::min(a, b)]++] = {std::max(a, b), t, a < b, false};
    });
    for (size_t v = 0; v + 1 < first_.size(); ++v) {
      std::sort(sides_.begin() + first_[v], sides_.begin() + first_[v + 1], [](const Side& a, const Side& b) {
        return a.far != b.far ? a.far < b.far : a.triangle < b.triangle;
      });
    }
  }

  // The sides that lie on one edge: [begin, end) in sides_.
  std::pair<size_t, size_t> sidesOn(int near, int far) const {
    const auto begin = std::lower_bound(sides_.begin() + first_[near], sides_.begin() + first_[near + 1], far,
                                        [](const Side& s, int v) { return s.far < v; });
    auto end = begin;
    while (end != sides_.begin() + first_[near + 1] && end->far == far) ++end;
    return {size_t(begin - sides_.begin()), size_t(end - sides_.begin())};
  }

  void checkSharing() const {
    for (int near = 0; near + 1 < int(first_.size()); ++near) {
      for (size_t begin = first_[near]; begin < first_[near + 1];) {
        size_t end = begin + 1;
        while (end < first_[near + 1] && sides_[end].far == sides_[begin].far) ++end;
        if (end - begin > 1) checkShared(near, begin, end);
        begin = end;
      }
    }
  }

  void checkShared(int near, size_t begin, size_t end) const {
    const size_t several = std::min<size_t>(end - begin, 3);
    if (several == 2 && sides_[begin].rising != sides_[begin + 1].rising) return;
    for (size_t i = begin; i < begin + several; ++i) {
      for (size_t j = i + 1; j < begin + several; ++j) failIfRepeated(sides_[i].triangle, sides_[j].triangle);
    }
    const int t0 = sides_[begin].triangle, t1 = sides_[begin + 1].triangle;
    const std::string edge = numbers(std::array<int, 2>{near, sides_[begin].far});
    if (several == 2) {
      fail(MeshPart::triangle, t1,
           "triangles " + std::to_string(t0 + 1) + " and " + std::to_string(t1 + 1) +
               " lie on the same side of edge " + edge + ", expected one on each side",
           "overlapping-triangles");
    }
    fail(MeshPart::triangle, sides_[begin + 2].triangle,
         "edge " + edge + " is shared by " + std::to_string(end - begin) + " triangles, expected 2 at most",
         "overlapping-triangles");
  }

  void failIfRepeated(int t0, int t1) const {
    auto v0 = mesh_.triangles[t0], v1 = mesh_.triangles[t1];
    std::sort(v0.begin(), v0.end());
    std::sort(v1.begin(), v1.end());
    if (v0 != v1) return;
    fail(MeshPart::triangle, t1,
         "triangle " + std::to_string(t1 + 1) + " (" + numbers(mesh_.triangles[t1]) + ") repeats triangle " +
             std::to_string(t0 + 1) + ", expected it once",
         "repeated-triangle");
  }

  void checkAndOrientLabelledEdges() {
    for (int e = 0; e < int(mesh_.boundaryEdges.size()); ++e) {
      auto& edge = mesh_.boundaryEdges[e];
      const auto failHere = [&](const std::string& what, const std::string& id = {}) {
        fail(MeshPart::edge, e, "edge " + std::to_string(e + 1) + " (" + numbers(edge) + ")" + what, id);
      };
      if (!isVertex(edge[0]) || !isVertex(edge[1])) failHere(", " + range());
      const auto [near, far] = std::minmax(edge[0], edge[1]);
      const auto [begin, end] = sidesOn(near, far);
      if (begin == end)
        failHere(" is not an edge of a triangle, expected an edge of the boundary", "label-inside");
      if (end - begin > 1)
        failHere(" lies between two triangles, expected an edge of the boundary", "label-inside");
      Side& side = sides_[begin];
      if (side.labelled) {
        int other = 0;
        while (std::minmax(mesh_.boundaryEdges[other][0], mesh_.boundaryEdges[other][1]) !=
               std::minmax(edge[0], edge[1]))
          ++other;
        const Point& a = mesh_.vertices[edge[0]];
        const Point& b = mesh_.vertices[edge[1]];
        std::ostringstream text;
        text << " from (" << a.x() << ", " << a.y() << ") to (" << b.x() << ", " << b.y()
             << ") is labelled twice, " << mesh_.boundaryLabels[other] << " and " << mesh_.boundaryLabels[e]
             << ", expected once";
        failHere(text.str(), "label-twice");
      }
      side.labelled = true;
      const auto turned = side.rising ? std::array<int, 2>{near, far} : std::array<int, 2>{far, near};
      if (edge != turned && mesh_.hasCurve(e)) std::swap(mesh_.edgeCurves[e].from, mesh_.edgeCurves[e].to);
      edge = turned;
    }
  }

  TriangleMesh& mesh_;
  const FaultPlace& place_;
  std::vector<size_t> first_;  // sides of the edges whose smaller vertex is v: first_[v] to first_[v + 1]
  std::vector<Side> sides_;
};

}  // namespace

double doubleArea(const TriangleMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const Point u = mesh.vertices[b] - mesh.vertices[a], v = mesh.vertices[c] - mesh.vertices[a];
  return cross(u, v);
}

double extent(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  Point lower = mesh.vertices[0], upper = lower;
  for (const Point& p : mesh.vertices) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  return (upper - lower).maxCoeff();
}

double aspectRatio(const TriangleMesh& mesh, int t) {
  const double equilateral = 2 / std::sqrt(3.0);  // its edge over its height
  return longestEdgeSquared(mesh, t) / doubleArea(mesh, t) / equilateral;
}

void validate(TriangleMesh& mesh, const FaultPlace& place) {
  Validator(mesh, place).run();
}

}  // namespace mortier
