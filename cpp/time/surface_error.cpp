// The gap that contact leaves between two surfaces, as an error of the nonmortar tetrahedra; where the nodes
// of the mortar side are farther apart than the rows of contact, of the mortar ones, which resolve it when
// they are refined.
#include <algorithm>

#include "time/mesh_error.h"

namespace mortier {
namespace {

std::array<int, 3> ascending(std::array<int, 3> triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

/// By points, the three vertices of the triangle that they lie on.
std::vector<std::array<int, 3>> trianglesOf(const Eigen::SparseMatrix<double>& traces, int vertices) {
  std::vector<std::array<int, 3>> triangles(static_cast<size_t>(traces.rows()));
  std::vector<int> found(triangles.size(), 0);
  for (int node = 0; node < vertices; ++node)  // ascending
    for (Eigen::SparseMatrix<double>::InnerIterator entry(traces, node); entry; ++entry)
      if (int& count = found[entry.row()]; count < 3) triangles[entry.row()][count++] = node;
  return triangles;
}

}  // namespace

void MeshErrorEstimator::addSurface(int body, int label) {
  const auto [place, isNew] = surfaces_.try_emplace({body, label});
  if (!isNew) return;
  const TetrahedronMesh& mesh = model_.bodies[body].space()->mesh();
  std::map<std::array<int, 3>, int>& surface = place->second;
  std::vector<char> on(mesh.vertices.size(), 0);
  for (const auto& triangle : trianglesOn(mesh, label)) {
    surface[ascending(triangle)] = 0;
    for (const int v : triangle) on[v] = 1;
  }
  for (size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const std::array<int, 4>& v = mesh.tetrahedra[e];
    if (on[v[0]] + on[v[1]] + on[v[2]] + on[v[3]] < 3) continue;
    for (const auto& [a, b, c] : {std::array{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}})
      if (const auto found = surface.find(ascending({v[a], v[b], v[c]})); found != surface.end())
        found->second = static_cast<int>(e);
  }
}

void MeshErrorEstimator::addSurfaceGaps(size_t interface, const State& state,
                                        std::vector<ErrorEstimate>& estimates) const {
  const ContactInterface& contact = model_.interfaces[interface];
  const auto& [nonmortar, mortar, coupling] = contact.pair();
  if (coupling == CouplingKind::interpolation) return;
  const ContactInterface::SurfacePoints& points = contact.surfacePoints();
  const Matrix jump =
      points.jump(state.bodies[nonmortar.body].displacement, state.bodies[mortar.body].displacement);
  const Vector apart = contact.pointDistances(state.time);
  const Vector pressure = points.rows * contact.contactPressure(state.contactForce[interface]);
  std::array<std::vector<std::array<int, 3>>, 2> triangles;
  const std::array<ContactSide, 2> sides{nonmortar, mortar};
  for (size_t s = 0; s < 2; ++s) {
    const TetrahedronMesh& mesh = model_.bodies[sides[s].body].space()->mesh();
    triangles[s] = trianglesOf(points.traces[s], static_cast<int>(mesh.vertices.size()));
  }
  const auto elementOf = [&](size_t side, Eigen::Index point) {
    const auto& surface = surfaces_.at({sides[side].body, sides[side].label});
    const auto found = surface.find(triangles[side][point]);
    return found == surface.end() ? 0 : found->second;
  };
  for (Eigen::Index i = 0; i < jump.cols(); ++i) {
    double gap = points.normals[i].dot(jump.col(i)) - apart[i];
    if (!(pressure[i] > 0)) gap = std::max(gap, 0.0);
    const std::array<int, 2> elements{elementOf(0, i), elementOf(1, i)};
    const Compliance compliance =
        complianceOf(state, nonmortar.body, elements[0]) + complianceOf(state, mortar.body, elements[1]);
    const double ofMortar = points.sizes[1][i] / model_.bodies[mortar.body].degree();
    const size_t coarser = ofMortar > points.sizes[0][i] ? 1 : 0;
    double energy = compliance.elastic / (compliance.all * compliance.all) * gap * gap /
                    std::max(points.sizes[0][i], ofMortar);
    // Where the surfaces have parted the exact pressure is 0, and the product of the pressure and the gap is
    // all that there is: less on coarse triangles at the edge of contact.
    if (gap < 0) energy = std::min(energy, compliance.elastic / compliance.all * pressure[i] * -gap);
    estimates[sides[coarser].body].error[elements[coarser]] += points.areas[i] * energy;
  }
}

}  // namespace mortier
