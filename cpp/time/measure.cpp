#include "time/measure.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "base/parallel.h"
#include "base/worst.h"
#include "material/stress.h"

namespace mortier {

void compareActive(const ActiveSets& before, const ActiveSets& after, StepReport& report) {
  for (size_t k = 0; k < before.size(); ++k)
    for (size_t i = 0; i < before[k].size(); ++i) {
      report.active += after[k][i];
      report.joined += after[k][i] > before[k][i] ? 1 : 0;
      report.left += after[k][i] < before[k][i] ? 1 : 0;
    }
}

namespace {

/// What a block of a body adds to a report.
struct Part {
  double area = 0;
  double flowing = 0;  ///< area
  double vonMises = 0;
  double energy = 0;
};

/// \param strain  room for the elastic strain, and for the total one where the law depends on that
Part partOf(const Body& body, const BodyState& state, Matrix& strain, int begin, int end) {
  Part part;
  const Material& material = body.material();
  const Matrix& stress = state.stress;
  material.elasticStrain(stress, strain, begin, end);
  for (int i = begin; i < end; ++i) part.energy += body.weights()[i] / 2 * stress.col(i).dot(strain.col(i));
  if (material.needsTotalStrain())
    strain.middleCols(begin, end - begin) += state.viscoplasticStrain.middleCols(begin, end - begin);
  for (int i = begin; i < end; ++i) {
    const double weight = body.weights()[i];
    part.area += weight;
    if (material.flows(stress, i, &strain)) part.flowing += weight;
    part.vonMises = std::max(part.vonMises, vonMises(stress.col(i).head(material.tensorComponents())));
  }
  return part;
}

/// The largest displacement of a node [m].
double largestDisplacement(const Vector& displacement, int dimension, Threads& threads) {
  const auto nodes = static_cast<int>(displacement.size() / dimension);
  std::vector<double> squares(blocksOf(nodes), 0);
  forEachBlock(nodes, threads, [&](int begin, int end) {
    double& square = squares[begin / itemsOfBlock];
    for (Eigen::Index i = begin; i < end; ++i)
      square = std::max(square, displacement.segment(dimension * i, dimension).squaredNorm());
  });
  return std::sqrt(*std::max_element(squares.begin(), squares.end()));
}

}  // namespace

void measure(const Model& model, const State& state, Threads& threads, StepReport& report) {
  if (model.bodies.front().dimension() == 3) report.resultantZ = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const Vector& p = state.contactForce[k];
    report.penetration +=
        interface.interpenetration(state.bodies[interface.pair().nonmortar.body].displacement,
                                   state.bodies[interface.pair().mortar.body].displacement, state.time);
    report.maxPressure = std::max(report.maxPressure, interface.contactPressure(p).maxCoeff());
    report.contactForce += p.sum();
    const SpacePoint force = resultant(model, state, k);
    report.resultantX += force.x();
    report.resultantY += force.y();
    if (report.resultantZ) *report.resultantZ += force.z();
    if (interface.hasFriction()) report.frictionWork.push_back(state.frictionWorkOf[k]);
  }
  Part all;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    std::vector<Part> parts(blocksOf(body.points()));
    Matrix strain(state.bodies[b].stress.rows(), state.bodies[b].stress.cols());
    forEachBlock(body.points(), threads, [&](int begin, int end) {
      parts[begin / itemsOfBlock] = partOf(body, state.bodies[b], strain, begin, end);
    });
    for (const Part& part : parts) {
      all.area += part.area;
      all.flowing += part.flowing;
      all.vonMises = std::max(all.vonMises, part.vonMises);
      all.energy += part.energy;
    }
    const Vector& u = state.bodies[b].displacement;
    const double largest = largestDisplacement(body.turns() ? body.moved(u) : u, body.dimension(), threads);
    report.displacement = std::max(report.displacement, largest);
    report.motion = std::max(report.motion, largest / body.extent());
  }
  report.vonMises = all.vonMises;
  report.energy = all.energy;
  report.viscoplasticFraction = all.flowing / all.area;
}

void raise(Peaks& peaks, const StepReport& report) {
  peaks.vonMises.raise(report.vonMises, report.time);
  peaks.pressure.raise(report.maxPressure, report.time);
  peaks.contactForce.raise(report.contactForce, report.time);
  peaks.displacement.raise(report.displacement, report.time);
  peaks.motion.raise(report.motion, report.time);
  peaks.energy.raise(report.energy, report.time);
}

Sliding slidingOf(const Model& model, const State& state, size_t interface) {
  const ContactInterface& of = model.interfaces[interface];
  if (of.dimension() == 3)
    return slidingInSpace(of, state.bodies[of.pair().nonmortar.body].displacement,
                          state.bodies[of.pair().mortar.body].displacement, state.contactForce[interface]);
  const auto side = [&](const ContactSide& each) {
    const Body& body = model.bodies[each.body];
    return ContactMesh{body.mesh(), body.elementNodes()};
  };
  const ContactPair& pair = of.pair();
  return slidingOf(of, side(pair.nonmortar), side(pair.mortar),
                   state.bodies[pair.nonmortar.body].displacement,
                   state.bodies[pair.mortar.body].displacement, state.contactForce[interface]);
}

Deformation deformationOf(const Body& body, const Vector& displacement) {
  Deformation most;
  body.withMesh([&](const auto& mesh, const auto&) {
    constexpr int n = std::remove_cvref_t<decltype(mesh.vertices.front())>::RowsAtCompileTime;
    using Gradient = Eigen::Matrix<double, n, n>;
    for (size_t element = 0; element < body.elements(); ++element) {
      const std::span<const int> nodes = body.nodesOf(element);  // the vertices first
      Gradient edges, changes;
      for (int k = 0; k < n; ++k) {
        edges.col(k) = mesh.vertices[nodes[k + 1]] - mesh.vertices[nodes[0]];
        changes.col(k) = displacement.segment<n>(n * nodes[k + 1]) - displacement.segment<n>(n * nodes[0]);
      }
      const Gradient gradient = changes * edges.inverse();
      const Gradient strain = (gradient + gradient.transpose()) / 2;
      const Eigen::SelfAdjointEigenSolver<Gradient> principal(strain, Eigen::EigenvaluesOnly);
      most.strain = std::max(most.strain, principal.eigenvalues().cwiseAbs().maxCoeff());
      most.rotation = std::max(most.rotation, (gradient - strain).norm() / M_SQRT2);
    }
  });
  return most;
}

SpacePoint resultant(const Model& model, const State& state, size_t interface) {
  const ContactInterface& of = model.interfaces[interface];
  SpacePoint sum = SpacePoint::Zero();
  const auto subtract = [&](const ConstraintRows& rows, const Vector& by) {
    forEachEntry(rows, [&](int row, int dof, double value) { sum[dof % of.dimension()] -= value * by[row]; });
  };
  subtract(of.C1(), state.contactForce[interface]);
  if (of.hasFriction()) subtract(of.T1(), state.frictionForce[interface]);
  return sum;
}

SpacePoint frictionCouple(const Model& model, const State& state, size_t interface) {
  const ContactInterface& of = model.interfaces[interface];
  const int dimension = of.dimension();
  const auto turned = [&](int body, int axis) {  // by a right angle about the origin
    const Body& turns = model.bodies[body];
    Vector u(turns.dofs());
    for (int node = 0; node < turns.nodes(); ++node) {
      const SpacePoint motion = SpacePoint::Unit(axis).cross(turns.placeOfNode(node));
      for (int c = 0; c < dimension; ++c) u[dimension * node + c] = motion[c];
    }
    return u;
  };
  SpacePoint couple = SpacePoint::Zero();
  for (int axis = dimension == 2 ? 2 : 0; axis < 3; ++axis)
    couple[axis] = -state.frictionForce[interface].dot(
        of.slip(turned(of.pair().nonmortar.body, axis), turned(of.pair().mortar.body, axis)));
  return couple;
}

Certificate worse(const Certificate& a, const Certificate& b) {
  return {worse(a.forceBalance, b.forceBalance),
          worse(a.materialResidual, b.materialResidual),
          worse(a.gapOnActive, b.gapOnActive),
          worse(a.openPenetration, b.openPenetration),
          worse(a.sign, b.sign),
          worse(a.complementarity, b.complementarity),
          worse(a.friction, b.friction),
          worse(a.rounding, b.rounding)};
}

}  // namespace mortier
