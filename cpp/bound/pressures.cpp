#include "bound/pressures.h"

#include <algorithm>

#include "base/dense_templates.h"
#include "base/disjoint_sets.h"

namespace mortier {

namespace {

/// Force and couple of a force along a normal.
Eigen::Vector3d resultant(const Point& x, const Point& force) {
  return {force.x(), force.y(), cross(x, force)};
}

/// Gives the pressures of an interface the force and the couple of its nodal forces, by factors 1 + a + b x,
/// where that can be.
void matchResultants(const ContactInterface& interface, const TriangleMesh& mesh, const Vector& forces,
                     const std::vector<const MatchedPiece*>& pieces, const CutMesh& cut, Vector& spread) {
  const double scale = extent(mesh);
  const auto placeOf = [&](int node) -> Point {
    return (mesh.vertices[node] - mesh.vertices[interface.nonmortarNodes().front()]) / scale;
  };
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  for (int row = 0; row < interface.rows(); ++row)
    left +=
        resultant(placeOf(interface.nonmortarNodes()[row]), forces[row] * interface.normals()[row].head<2>());
  const double size = left.norm();
  Eigen::Matrix<double, 3, 2> M = Eigen::Matrix<double, 3, 2>::Zero();
  for (const MatchedPiece* piece : pieces)
    for (int k = 0; k < 2 && piece->rows[k] >= 0; ++k) {
      const int row = piece->rows[k];
      const auto m = momentsOfLinear(piece->values[k], piece->length);
      for (int end = 0; end < 2; ++end) {
        const Point x =
            (cut.mesh.vertices[piece->vertices[0][end]] - mesh.vertices[interface.nonmortarNodes().front()]) /
            scale;
        const Eigen::Vector3d part = resultant(x, spread[row] * m[end] * piece->normal);
        left -= part;
        M.col(0) += part;
        M.col(1) += placeOf(interface.nonmortarNodes()[row]).norm() * part;
      }
    }
  const Vector factors = Matrix(M).completeOrthogonalDecomposition().solve(Vector(left));
  if (!factors.allFinite() || !((M * factors - left).norm() <= 1e-12 * size)) return;
  Vector matched = spread;
  for (int row = 0; row < interface.rows(); ++row)
    matched[row] *= 1 + factors[0] + factors[1] * placeOf(interface.nonmortarNodes()[row]).norm();
  if (matched.minCoeff() >= 0) spread = matched;
}

}  // namespace

std::vector<Vector> spreadPressures(const Model& model, const State& state, const MatchedMeshes& meshes) {
  std::vector<Vector> forces;
  for (const Vector& p : state.contactForce) forces.emplace_back(p.cwiseMax(0));
  std::vector<Vector> spread = spreadForces(model, forces, meshes);
  for (size_t i = 0; i < spread.size(); ++i) {
    const ContactInterface& interface = model.interfaces[i];
    const int body = interface.pair().nonmortar.body;
    std::vector<const MatchedPiece*> pieces;
    for (const MatchedPiece& piece : meshes.pieces)
      if (piece.interface == static_cast<int>(i)) pieces.push_back(&piece);
    if (!pieces.empty())
      matchResultants(interface, model.bodies[body].mesh(), forces[i], pieces, meshes.bodies[body],
                      spread[i]);
  }
  return spread;
}

std::vector<Vector> spreadForces(const Model& model, const std::vector<Vector>& forces,
                                 const MatchedMeshes& meshes) {
  constexpr double little = 0.25;  // of the neighbour
  std::vector<Vector> widths;
  std::vector<DisjointSets> together;
  for (const ContactInterface& interface : model.interfaces) {
    widths.emplace_back(Vector::Zero(interface.rows()));
    together.emplace_back(interface.rows());
  }
  for (const MatchedPiece& piece : meshes.pieces)
    for (int k = 0; k < 2 && piece.rows[k] >= 0; ++k)
      widths[piece.interface][piece.rows[k]] += piece.length * (piece.values[k][0] + piece.values[k][1]) / 2;
  for (const MatchedPiece& piece : meshes.pieces) {
    const Vector& width = widths[piece.interface];
    const auto [a, b] = piece.rows;
    if (a >= 0 && std::min(width[a], width[b]) < little * std::max(width[a], width[b]))
      together[piece.interface].join(a, b);
  }
  std::vector<Vector> spread;
  for (size_t i = 0; i < widths.size(); ++i) {
    const Eigen::Index rows = widths[i].size();
    Vector width = Vector::Zero(rows);
    Vector force = Vector::Zero(rows);
    for (int row = 0; row < rows; ++row) {
      width[together[i].of(row)] += widths[i][row];
      force[together[i].of(row)] += forces[i][row];
    }
    spread.emplace_back(Vector::Zero(rows));
    for (int row = 0; row < rows; ++row)
      if (const int set = together[i].of(row); width[set] > 0) spread[i][row] = force[set] / width[set];
  }
  return spread;
}

std::array<double, 2> pressureOn(const MatchedPiece& piece, const std::vector<Vector>& spread) {
  std::array<double, 2> p{};
  for (int k = 0; k < 2 && piece.rows[k] >= 0; ++k)
    for (int end = 0; end < 2; ++end) p[end] += piece.values[k][end] * spread[piece.interface][piece.rows[k]];
  return p;
}

std::array<double, 2> momentsOfLinear(const std::array<double, 2>& values, double length) {
  return {length / 6 * (2 * values[0] + values[1]), length / 6 * (values[0] + 2 * values[1])};
}

void press(const MatchedPiece& piece, const Model& model, const std::array<double, 2>& pressure,
           std::vector<LoadedBody>& bodies) {
  const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
  const auto moments = momentsOfLinear(pressure, piece.length);
  bodies[nonmortar.body].press(piece.vertices[0], piece.normal, moments);
  bodies[mortar.body].press(piece.vertices[1], -piece.normal, moments);
}

bool balancePressures(const Model& model, const MatchedMeshes& meshes, const std::vector<LoadedBody>& bodies,
                      std::vector<Vector>& spread) {
  const std::vector<Vector> weights = spread;
  return balanceBy(weights, model, meshes, bodies, spread) &&
         std::all_of(spread.begin(), spread.end(),
                     [](const Vector& each) { return each.size() == 0 || each.minCoeff() >= 0; });
}

bool balanceBy(const std::vector<Vector>& weights, const Model& model, const MatchedMeshes& meshes,
               const std::vector<LoadedBody>& bodies, std::vector<Vector>& spread) {
  Eigen::Index rows = 0;
  for (const LoadedBody& body : bodies) rows += body.modes().cols();
  if (rows == 0) return true;
  const auto columns = 2 * static_cast<Eigen::Index>(spread.size());
  Matrix M = Matrix::Zero(rows, columns);
  Vector left = Vector::Zero(rows);
  double size = 0;
  std::vector<Vector> places;
  for (size_t k = 0; k < spread.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const TriangleMesh& mesh = model.bodies[interface.pair().nonmortar.body].mesh();
    const Point first = mesh.vertices[interface.nonmortarNodes().front()];
    const double scale = extent(mesh);
    Vector place(interface.rows());
    for (int row = 0; row < interface.rows(); ++row)
      place[row] = (mesh.vertices[interface.nonmortarNodes()[row]] - first).norm() / scale;
    places.push_back(place);
  }
  Eigen::Index first = 0;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Matrix& modes = bodies[b].modes();
    left.segment(first, modes.cols()) = modes.transpose() * bodies[b].load();
    for (const MatchedPiece& piece : meshes.pieces) {
      const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
      for (int side = 0; side < 2; ++side) {
        if ((side == 0 ? nonmortar.body : mortar.body) != static_cast<int>(b)) continue;
        const Point outward = side == 0 ? piece.normal : Point(-piece.normal);
        for (int k = 0; k < 2 && piece.rows[k] >= 0; ++k) {
          const int row = piece.rows[k];
          const auto m = momentsOfLinear(piece.values[k], piece.length);
          for (int end = 0; end < 2; ++end) {
            const Vector unit =
                -m[end] * modes.middleRows<2>(2 * piece.vertices[side][end]).transpose() * outward;
            const Vector work = weights[piece.interface][row] * unit;
            left.segment(first, modes.cols()) += spread[piece.interface][row] * unit;
            M.block(first, 2 * piece.interface, modes.cols(), 1) += work;
            M.block(first, 2 * piece.interface + 1, modes.cols(), 1) += places[piece.interface][row] * work;
            if (work.size() > 0) size = std::max(size, work.cwiseAbs().maxCoeff());
          }
        }
      }
    }
    first += modes.cols();
  }
  const Vector factors = M.completeOrthogonalDecomposition().solve(Vector(-left));
  if (!factors.allFinite() ||
      (M * factors + left).cwiseAbs().maxCoeff() > 1e-9 * std::max(size, left.cwiseAbs().maxCoeff()))
    return false;
  for (size_t k = 0; k < spread.size(); ++k) {
    const auto at = 2 * static_cast<Eigen::Index>(k);
    spread[k].array() += weights[k].array() * (factors[at] + factors[at + 1] * places[k].array());
  }
  return true;
}

}  // namespace mortier
