#include "mesh/boundary_line.h"

#include <algorithm>
#include <unordered_map>

#include "base/error.h"
#include "base/formatted.h"
#include "mesh/triangle_mesh.h"

namespace mortier {
namespace {

[[noreturn]] void fail(const TriangleMesh& mesh, int label, const std::string& what) {
  throw InputError(mesh.name + ": boundary " + labelText(mesh, label) + " " + what);
}

std::string describeVertex(const TriangleMesh& mesh, int v) {
  return formatted("vertex %d at (%g, %g)", v + 1, mesh.vertices[v].x(), mesh.vertices[v].y());
}

[[noreturn]] void failMissing(const TriangleMesh& mesh, int label) {
  std::string present;
  for (int l : boundaryLabels(mesh)) present += " " + std::to_string(l);
  fail(mesh, label,
       "is missing, expected one of" + (present.empty() ? " none: no edge is labelled" : present));
}

/// The vertices along a label.
BoundaryLine verticesOf(const TriangleMesh& mesh, int label) {
  constexpr int none = -1;
  std::vector<int> next(mesh.vertices.size(), none), previous(mesh.vertices.size(), none);
  std::vector<int> starts;  // of the edges that carry the label
  for (const auto& [a, b] : sidesWith(mesh, label)) {
    if (next[a] != none || previous[b] != none)
      fail(mesh, label,
           "branches in " + describeVertex(mesh, next[a] != none ? a : b) + ", expected one line");
    next[a] = b;
    previous[b] = a;
    starts.push_back(a);
  }
  if (starts.empty()) failMissing(mesh, label);

  // A line that is not closed has one vertex that no edge leads to; a closed one may start anywhere.
  const auto isHead = [&](int v) { return previous[v] == none; };
  const auto head = std::find_if(starts.begin(), starts.end(), isHead);
  BoundaryLine line;
  line.closed = head == starts.end();
  const int first = line.closed ? starts.front() : *head;
  line.nodes.push_back(first);
  for (int v = next[first]; v != none; v = next[v]) {
    line.nodes.push_back(v);
    if (v == first) break;
  }

  if (line.nodes.size() != starts.size() + 1) {
    std::vector<char> reached(mesh.vertices.size(), 0);
    for (int v : line.nodes) reached[v] = 1;
    const auto other = std::find_if(starts.begin(), starts.end(), [&](int v) { return !reached[v]; });
    fail(mesh, label,
         "is not connected: " + describeVertex(mesh, first) + " and " + describeVertex(mesh, *other) +
             " are in separate pieces, expected one line");
  }
  for (int v : line.nodes) line.points.push_back(mesh.vertices[v]);
  return line;
}

/// The edge of the boundary that each element of the line is.
std::vector<size_t> edgesOf(const BoundaryLine& line, const TriangleMesh& mesh, int label) {
  std::unordered_map<int, size_t> edgeFrom;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    if (mesh.boundaryLabels[e] == label) edgeFrom[mesh.boundaryEdges[e][0]] = e;
  std::vector<size_t> edges;
  for (size_t i = 0; i + 1 < line.nodes.size(); ++i) edges.push_back(edgeFrom.at(line.nodes[i]));
  return edges;
}

}  // namespace

BoundaryLine boundaryLine(const TriangleMesh& mesh, int label) {
  BoundaryLine line = verticesOf(mesh, label);
  if (mesh.edgeMiddles.empty()) return line;
  for (const size_t e : edgesOf(line, mesh, label)) {
    line.middles.push_back(mesh.edgeMiddles[e]);
    if (!mesh.edgeCurves.empty()) line.curves.push_back(mesh.edgeCurves[e]);
  }
  return line;
}

BoundaryLine boundaryLine(const TriangleMesh& mesh, const ElementNodes& nodes, int label) {
  BoundaryLine line = boundaryLine(mesh, label);
  if (nodes.degree == 1) return line;
  for (const size_t e : edgesOf(line, mesh, label)) {
    line.middleNodes.push_back(nodes.middles[e]);
    line.middlePoints.push_back(nodes.places[nodes.middles[e]]);
  }
  return line;
}

}  // namespace mortier
