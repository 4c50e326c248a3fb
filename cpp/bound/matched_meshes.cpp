#include "bound/matched_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "bound/side_datum.h"

namespace mortier {
namespace {

/// Points of an edge that are closer than this part of it are one.
constexpr double samePoint = 1e-6;
/// Directions of contact that make a smaller angle are one [rad].
constexpr double sameDirection = 1e-9;
/// Sides that make a smaller angle are parallel [rad]: tractions are those of a pressure along the direction
/// of contact, whatever the sides, which coordinates of a few digits turn from it.
constexpr double parallel = 1e-3;
/// Pieces of a side whose tractions are not linear: no more, and until these leave no more than a part of
/// the tractions.
constexpr size_t mostPieces = 16;
constexpr double negligible = 0.0001;

/// Sides of more pieces than these are cut by triangles that become larger from the side on.
constexpr size_t fewPieces = 3;
/// Of these, twice the area over the square of a side.
constexpr double thinnest = 0.1;

using Edge = std::array<int, 2>;

/// Where edges of a mesh are to be cut, by their vertices in ascending order: parts of the way from the
/// first.
class Cuts {
 public:
  void add(Edge edge, double part) {
    if (edge[0] > edge[1]) {
      std::swap(edge[0], edge[1]);
      part = 1 - part;
    }
    if (part <= samePoint || part >= 1 - samePoint) return;
    std::set<double>& parts = parts_[edge];
    const auto above = parts.lower_bound(part - samePoint);
    if (above == parts.end() || *above > part + samePoint) parts.insert(part);
  }
  [[nodiscard]] const std::map<Edge, std::set<double>>& all() const { return parts_; }

 private:
  std::map<Edge, std::set<double>> parts_;
};

class Cutter {
 public:
  Cutter(const TriangleMesh& mesh, const Cuts& cuts) {
    result_.mesh = mesh;
    result_.mesh.edgeMiddles.clear();
    result_.mesh.edgeCurves.clear();
    result_.parents.resize(mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) result_.parents[t] = static_cast<int>(t);
    findTriangles(cuts);
    for (const auto& [edge, parts] : cuts.all()) cut(edge, parts);
    cutBoundary();
  }
  CutMesh take() { return std::move(result_); }
  [[nodiscard]] int vertexAt(Edge edge, double part) const {
    if (edge[0] > edge[1]) {
      std::swap(edge[0], edge[1]);
      part = 1 - part;
    }
    if (part <= samePoint) return edge[0];
    if (part >= 1 - samePoint) return edge[1];
    for (const auto& [at, vertex] : vertices_.at(edge))
      if (std::abs(at - part) <= samePoint) return vertex;
    return -1;
  }

 private:
  static Edge sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  void findTriangles(const Cuts& cuts) {
    std::vector<char> at(result_.mesh.vertices.size(), 0);
    for (const auto& [edge, parts] : cuts.all())
      for (const int vertex : edge) at[vertex] = 1;
    for (size_t t = 0; t < result_.mesh.triangles.size(); ++t) {
      const auto& v = result_.mesh.triangles[t];
      for (int k = 0; k < 3; ++k) {
        if (at[v[k]] == 0 || at[v[(k + 1) % 3]] == 0) continue;
        const Edge edge = sorted(v[k], v[(k + 1) % 3]);
        if (cuts.all().contains(edge)) triangleOf_[edge] = static_cast<int>(t);
      }
    }
  }

  void cut(const Edge& edge, const std::set<double>& parts) {
    TriangleMesh& mesh = result_.mesh;
    const int t = triangleOf_.at(edge);
    int k = 0;
    while (sorted(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]) != edge) ++k;
    const int a = mesh.triangles[t][k];
    const int b = mesh.triangles[t][(k + 1) % 3];
    const int c = mesh.triangles[t][(k + 2) % 3];
    std::vector<int> chain{a};
    for (const double part : parts) {
      const auto vertex = static_cast<int>(mesh.vertices.size());
      mesh.vertices.emplace_back((1 - part) * mesh.vertices[edge[0]] + part * mesh.vertices[edge[1]]);
      result_.added.push_back({edge, part});
      vertices_[edge].emplace_back(part, vertex);
      chain.push_back(vertex);
    }
    if (a != edge[0]) std::reverse(chain.begin() + 1, chain.end());
    chain.push_back(b);
    std::vector<std::array<int, 3>> pieces;
    while (chain.size() > fewPieces + 1)
      if (!addRow(chain, c, pieces)) break;
    for (size_t i = 1; i + 1 < chain.size(); ++i) pieces.push_back({chain[i], chain[i + 1], c});
    mesh.triangles[t] = {a, chain[1], c};
    int last = t;
    for (const auto& piece : pieces) {
      last = static_cast<int>(mesh.triangles.size());
      mesh.triangles.push_back(piece);
      mesh.regions.push_back(mesh.regions[t]);
      result_.parents.push_back(result_.parents[t]);
    }
    if (const auto other = triangleOf_.find(sorted(b, c)); other != triangleOf_.end() && other->second == t)
      other->second = last;
  }

  /// Triangles between a chain of vertices and one of half as many from the same first to the same last
  /// vertex, as far towards c as its pieces are long. \returns whether none of them or to c is turned over
  bool addRow(std::vector<int>& chain, int c, std::vector<std::array<int, 3>>& pieces) {
    TriangleMesh& mesh = result_.mesh;
    const size_t vertices = mesh.vertices.size();
    const size_t n = chain.size() - 1;
    const auto at = [&](int vertex) -> const Point& { return mesh.vertices[vertex]; };
    std::vector<int> upper{chain[0]};
    std::vector<std::array<int, 3>> row;
    for (size_t i = 0; i < n; i += 2) {
      const size_t end = std::min(i + 2, n);
      if (end < n) {
        const Point way = at(c) - at(chain[end]);
        const double length = (at(chain[std::min(end + 2, n)]) - at(chain[i])).norm() / 4;
        const double part = std::min(0.5, length / way.norm());
        upper.push_back(static_cast<int>(mesh.vertices.size()));
        result_.added.push_back({{chain[end], c}, part});
        mesh.vertices.emplace_back(at(chain[end]) + part * way);
      } else {
        upper.push_back(chain[n]);
      }
      const int first = upper[upper.size() - 2];
      const int last = upper.back();
      if (first != chain[i]) row.push_back({chain[i], chain[i + 1], first});
      if (end == i + 2) {
        row.push_back({chain[i + 1], last, first});
        if (last != chain[end]) row.push_back({chain[i + 1], chain[end], last});
      }
    }
    std::vector<std::array<int, 3>> all = row;
    for (size_t i = 0; i + 1 < upper.size(); ++i) all.push_back({upper[i], upper[i + 1], c});
    const bool good = std::all_of(all.begin(), all.end(), [&](const std::array<int, 3>& v) {
      const Point p = at(v[1]) - at(v[0]);
      const Point q = at(v[2]) - at(v[0]);
      return cross(p, q) > thinnest * p.squaredNorm();
    });
    if (!good) {
      mesh.vertices.resize(vertices);
      result_.added.resize(result_.added.size() - (upper.size() - 2));
      return false;
    }
    pieces.insert(pieces.end(), row.begin(), row.end());
    chain = std::move(upper);
    return true;
  }

  void cutBoundary() {
    TriangleMesh& mesh = result_.mesh;
    const size_t count = mesh.boundaryEdges.size();
    for (size_t e = 0; e < count; ++e) {
      const auto [a, b] = mesh.boundaryEdges[e];
      const auto found = vertices_.find(sorted(a, b));
      if (found == vertices_.end()) continue;
      std::vector<int> chain{a};
      for (const auto& [part, vertex] : found->second) chain.push_back(vertex);
      if (a > b) std::reverse(chain.begin() + 1, chain.end());
      chain.push_back(b);
      mesh.boundaryEdges[e] = {chain[0], chain[1]};
      for (size_t i = 1; i + 1 < chain.size(); ++i) {
        mesh.boundaryEdges.push_back({chain[i], chain[i + 1]});
        mesh.boundaryLabels.push_back(mesh.boundaryLabels[e]);
      }
    }
  }

  CutMesh result_;
  std::map<Edge, int> triangleOf_;
  std::map<Edge, std::vector<std::pair<double, int>>> vertices_;
};

/// The row of C at a vertex of the nonmortar line, by the direction of contact at a corner; -1 for none.
int rowAt(const ContactInterface& interface, int vertex, const Point& normal) {
  for (int row = 0; row < interface.rows(); ++row)
    if (interface.nonmortarNodes()[row] == vertex &&
        interface.normals()[row].head<2>().dot(normal) > 1 - samePoint)
      return row;
  return -1;
}

/// What is wrong with a piece for tractions that are equal on both sides; empty where nothing is.
std::string faultOf(const RefinedPiece& piece, const TriangleMesh& nonmortar, const TriangleMesh& mortar) {
  const auto across = [&](const TriangleMesh& mesh, const Edge& edge) {
    const Point along = mesh.vertices[edge[1]] - mesh.vertices[edge[0]];
    return std::abs(along.dot(piece.normals[0])) <= parallel * along.norm();
  };
  if ((piece.normals[0] - piece.normals[1]).norm() > sameDirection || !across(nonmortar, piece.nonmortar))
    return "is not straight";
  return across(mortar, piece.mortar) ? "" : "is not parallel on both sides";
}

/// Cuts a side from a to b under tractions that are not linear in the middle of the piece that leaves most,
/// or at a jump: what the pieces leave is smaller, over lengths that are shorter.
void cutLoaded(const Edge& edge, const Point& a, const Point& b, const Datum& value, double t, Cuts& cuts) {
  struct Piece {
    double begin, end;
    SideDatum datum;
    [[nodiscard]] double left() const { return datum.off * (end - begin); }
  };
  const auto piece = [&](double begin, double end) {
    return Piece{begin, end, onSide(value, a + begin * (b - a), a + end * (b - a), t)};
  };
  std::vector<Piece> pieces{piece(0, 1)};
  if (pieces[0].datum.linear() || !pieces[0].datum.known) return;
  while (pieces.size() < mostPieces) {
    Piece& worst = *std::max_element(pieces.begin(), pieces.end(),
                                     [](const Piece& u, const Piece& v) { return u.left() < v.left(); });
    double size = 0;
    for (const Piece& each : pieces) size = std::max(size, each.datum.size);
    if (worst.left() <= negligible * size) break;
    const std::vector<double>& jumps = worst.datum.jumps;
    double at = worst.begin + (worst.end - worst.begin) * (jumps.empty() ? 0.5 : jumps[jumps.size() / 2]);
    if (std::min(at - worst.begin, worst.end - at) <= 2 * samePoint) at = (worst.begin + worst.end) / 2;
    if (worst.end - worst.begin <= 4 * samePoint) break;
    cuts.add(edge, at);
    const double end = std::exchange(worst.end, at);
    worst = piece(worst.begin, at);
    pieces.push_back(piece(at, end));
  }
}

/// All sides of a body that are to be cut so.
void cutLoaded(const Body& body, double t, Cuts& cuts) {
  const TriangleMesh& mesh = body.mesh();
  const auto& conditions = body.conditions();
  for (const Condition& traction : conditions.tractions)
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
      const int label = mesh.boundaryLabels[e];
      if (label != traction.label ||
          std::any_of(conditions.displacements.begin(), conditions.displacements.end(),
                      [&](const Condition& held) { return held.actsOn(label); }))
        continue;
      const auto& [a, b] = mesh.boundaryEdges[e];
      cutLoaded({a, b}, mesh.vertices[a], mesh.vertices[b], traction.value, t, cuts);
    }
}

/// How far the ends of a piece are from the vertices that stand for them.
double apartIn(const RefinedPiece& piece, const TriangleMesh& nonmortar, const TriangleMesh& mortar) {
  const auto off = [](double part) {
    const double from = std::min(part, 1 - part);
    return from <= samePoint ? std::abs(from) : 0;
  };
  double most = 0;
  for (int end = 0; end < 2; ++end) {
    const auto lengthOf = [](const TriangleMesh& mesh, const Edge& edge) {
      return (mesh.vertices[edge[1]] - mesh.vertices[edge[0]]).norm();
    };
    most = std::max({most, off(piece.nonmortarAt[end]) * lengthOf(nonmortar, piece.nonmortar),
                     off(piece.mortarAt[end]) * lengthOf(mortar, piece.mortar)});
  }
  return most;
}

}  // namespace

Vector CutMesh::displacement(const Vector& u) const {
  Vector result(u.size() + 2 * static_cast<Eigen::Index>(added.size()));
  result.head(u.size()) = u;
  for (size_t i = 0; i < added.size(); ++i)
    result.segment<2>(u.size() + 2 * static_cast<Eigen::Index>(i)) =
        (1 - added[i].part) * result.segment<2>(2 * added[i].ends[0]) +
        added[i].part * result.segment<2>(2 * added[i].ends[1]);
  return result;
}

MatchedMeshes matchedMeshes(const Model& model, std::optional<double> loadsAt) {
  MatchedMeshes result;
  std::vector<Cuts> cuts(model.bodies.size());
  for (size_t b = 0; loadsAt && b < model.bodies.size(); ++b) cutLoaded(model.bodies[b], *loadsAt, cuts[b]);
  std::vector<std::vector<RefinedPiece>> pieces;
  for (const ContactInterface& interface : model.interfaces) {
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    pieces.push_back(interface.pieces());
    for (const RefinedPiece& piece : pieces.back()) {
      result.apart = std::max(result.apart, apartIn(piece, model.bodies[nonmortar.body].mesh(),
                                                    model.bodies[mortar.body].mesh()));
      const std::string fault =
          faultOf(piece, model.bodies[nonmortar.body].mesh(), model.bodies[mortar.body].mesh());
      if (!fault.empty()) {
        result.obstacle = "the contact line of " + model.bodies[nonmortar.body].name() + " and " +
                          model.bodies[mortar.body].name() + " " + fault;
        return result;
      }
      for (int end = 0; end < 2; ++end) {
        cuts[nonmortar.body].add(piece.nonmortar, piece.nonmortarAt[end]);
        cuts[mortar.body].add(piece.mortar, piece.mortarAt[end]);
      }
    }
  }
  std::vector<Cutter> cutters;
  for (size_t b = 0; b < model.bodies.size(); ++b) cutters.emplace_back(model.bodies[b].mesh(), cuts[b]);
  for (size_t k = 0; k < pieces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    for (const RefinedPiece& piece : pieces[k]) {
      MatchedPiece matched;
      matched.interface = static_cast<int>(k);
      for (int end = 0; end < 2; ++end) {
        matched.vertices[0][end] = cutters[nonmortar.body].vertexAt(piece.nonmortar, piece.nonmortarAt[end]);
        matched.vertices[1][end] = cutters[mortar.body].vertexAt(piece.mortar, piece.mortarAt[end]);
      }
      matched.normal = piece.normals[0];
      matched.distance = piece.distances;
      matched.length = piece.length;
      for (int end = 0; end < 2; ++end) {
        matched.rows[end] = rowAt(interface, piece.nonmortar[end], matched.normal);
        for (int at = 0; at < 2; ++at)
          matched.values[end][at] = end == 0 ? 1 - piece.nonmortarAt[at] : piece.nonmortarAt[at];
      }
      // A vertex without a row of its own is merged into its neighbour.
      for (int end = 0; end < 2; ++end)
        if (matched.rows[end] < 0) matched.rows[end] = matched.rows[1 - end];
      if (matched.vertices[0][0] != matched.vertices[0][1] &&
          matched.vertices[1][0] != matched.vertices[1][1])
        result.pieces.push_back(matched);
    }
  }
  for (Cutter& cutter : cutters) result.bodies.push_back(cutter.take());
  return result;
}

}  // namespace mortier
