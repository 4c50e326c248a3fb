// The gap that contact leaves between two surfaces, as an error of the nonmortar tetrahedra; where the nodes
// of the mortar side are farther apart than the rows of contact, of the mortar ones, which resolve it when
// they are refined.
#include <algorithm>

#include "time/mesh_error.h"

namespace mortier {
namespace {

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
    const auto& surface = behind_.at({sides[side].body, sides[side].label});
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
