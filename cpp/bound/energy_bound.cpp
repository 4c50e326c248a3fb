#include "bound/energy_bound.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/disjoint_sets.h"
#include "bound/lift.h"
#include "bound/matched_meshes.h"
#include "bound/relaxation.h"
#include "fem/rigid_modes.h"
#include "linear/condensing_solver.h"
#include "material/stress.h"

namespace mortier {
namespace {

/// What may be left of forces that balance, over the largest: rounding, also of thin triangles.
constexpr double strict = 1e-9;

/// Sweeps of the relaxation. More are not worthwhile where what they would still take away, as their gains go
/// down geometrically, is a small part of the energy.
constexpr int fewestSweeps = 3;
constexpr int mostSweeps = 6;
constexpr double worthwhile = 0.05;

/// A body of fewer triangles is solved directly: sweeps are slow on coarse meshes of thin triangles.
constexpr size_t few = 10000;

/// Sweeps, and a direct solution where these are slow, or it costs little.
void relax(Relaxation& relaxation, size_t triangles) {
  if (triangles < few && relaxation.minimise()) return;
  double energy = relaxation.energies().sum();
  double gain = 0;
  for (int i = 1; i <= mostSweeps; ++i) {
    const double before = energy;
    const double gainBefore = gain;
    relaxation.sweep();
    energy = relaxation.energies().sum();
    gain = before - energy;
    const bool fades = i > 1 && gain < gainBefore;
    const double left = fades ? gain * gain / (gainBefore - gain) : gain > 0 ? energy : 0;
    if (i >= fewestSweeps && left <= worthwhile * energy) return;
  }
  relaxation.minimise();
}

/// (p, q, r) of (s11, s22, s12), and the same for strains.
Eigen::Matrix3d toBasis() {
  Eigen::Matrix3d B;
  for (int c = 0; c < 3; ++c) B.col(c) = fromCartesian(Eigen::Vector3d::Unit(c));
  return B;
}

/// p^ by rows: the nodal forces spread over their row functions. A row of which little faces the mortar side
/// is taken together with its neighbour, as its force would press on a point.
std::vector<Vector> spreadPressures(const Model& model, const State& state, const MatchedMeshes& meshes) {
  constexpr double little = 0.25;  // of the neighbour
  std::vector<Vector> widths;
  std::vector<DisjointSets> together;
  for (const ContactInterface& interface : model.interfaces) {
    widths.emplace_back(Vector::Zero(interface.rows()));
    together.emplace_back(interface.rows());
  }
  for (const MatchedPiece& piece : meshes.pieces)
    for (int k = 0; k < 2; ++k)
      widths[piece.interface][piece.rows[k]] += piece.length * (piece.values[k][0] + piece.values[k][1]) / 2;
  for (const MatchedPiece& piece : meshes.pieces) {
    const Vector& width = widths[piece.interface];
    const auto [a, b] = piece.rows;
    if (std::min(width[a], width[b]) < little * std::max(width[a], width[b]))
      together[piece.interface].join(a, b);
  }
  std::vector<Vector> spread;
  for (size_t i = 0; i < widths.size(); ++i) {
    const Eigen::Index rows = widths[i].size();
    Vector width = Vector::Zero(rows);
    Vector force = Vector::Zero(rows);
    for (int row = 0; row < rows; ++row) {
      width[together[i].of(row)] += widths[i][row];
      force[together[i].of(row)] += std::max(state.contactForce[i][row], 0.0);
    }
    spread.emplace_back(Vector::Zero(rows));
    for (int row = 0; row < rows; ++row)
      if (const int set = together[i].of(row); width[set] > 0) spread[i][row] = force[set] / width[set];
  }
  return spread;
}

/// p^ at begin and end of a piece.
std::array<double, 2> pressureOn(const MatchedPiece& piece, const std::vector<Vector>& spread) {
  std::array<double, 2> p{};
  for (int k = 0; k < 2; ++k)
    for (int end = 0; end < 2; ++end) p[end] += piece.values[k][end] * spread[piece.interface][piece.rows[k]];
  return p;
}

/// Moments of a linear function by its values at both ends.
std::array<double, 2> momentsOfLinear(const std::array<double, 2>& values, double length) {
  return {length / 6 * (2 * values[0] + values[1]), length / 6 * (values[0] + 2 * values[1])};
}

/// How far data are from linear functions on sides, and constants on triangles.
struct Oscillation {
  double off = 0;
  double all = 0;
  void add(double weight, double deviation, double value) {
    off += weight * deviation * deviation;
    all += weight * value * value;
  }
  /// Of a function on a side.
  void addLinear(double length, const std::function<double(double)>& value) {
    const double first = value(0);
    const double last = value(1);
    for (const double s : {0.25, 0.5, 0.75}) {
      const double v = value(s);
      add(length, v - ((1 - s) * first + s * last), std::max({std::abs(v), std::abs(first), std::abs(last)}));
    }
  }
  [[nodiscard]] double relative() const { return all > 0 ? std::sqrt(off / all) : 0; }
};

/// A body on its matched mesh, loaded by given contact pressures instead of the other bodies.
class LoadedBody {
 public:
  LoadedBody(const Model& model, const State& state, const CutMesh& cut, int index)
      : cut_(cut),
        body_(model.bodies[index].name(), cut.mesh,
              std::shared_ptr<const Material>(std::shared_ptr<void>(), &model.bodies[index].material()),
              model.bodies[index].conditions()),
        sides_(cut.mesh),
        displacement_(cut.displacement(state.bodies[index].displacement)),
        load_(body_.load(state.time)),
        modes_(rigidModes(body_)) {
    const Linearisation law = elasticLaw(model.bodies[index]);
    const Eigen::Matrix3d B = toBasis();
    for (size_t t = 0; t < cut_.parents.size(); ++t) {
      const int parent = cut_.parents[t];
      moduli_.emplace_back(Eigen::Map<const Eigen::Matrix3d>(moduliAt(law.moduli, parent).data()));
      compliances_.emplace_back(B.transpose() * moduli_.back().inverse() * B);
      stress_.emplace_back(toCartesian(state.bodies[index].stress.col(parent).head<3>()));
    }
    readForces(state.time);
    readBoundary(state.time);
  }

  [[nodiscard]] const TriangleMesh& mesh() const { return cut_.mesh; }
  [[nodiscard]] const Matrix& modes() const { return modes_; }
  [[nodiscard]] const Vector& load() const { return load_; }
  [[nodiscard]] LiftedBody lifted() const { return {body_, sides_, moduli_, displacement_}; }
  [[nodiscard]] const Oscillation& oscillation() const { return oscillation_; }
  [[nodiscard]] bool hasCurvedSupport() const { return curvedSupport_; }

  /// A pressure on the side between two vertices, by its moments at the first and at the second.
  void press(const std::array<int, 2>& vertices, const Point& outward, const std::array<double, 2>& moments) {
    const int e = sideBetween(vertices);
    const int first = sides_.all()[e].vertices[0] == vertices[0] ? 0 : 1;
    for (int end = 0; end < 2; ++end) {
      known_[e].moments[end == 0 ? first : 1 - first] -= moments[end] * outward;
      load_.segment<2>(2 * vertices[end]) -= moments[end] * outward;
    }
  }
  [[nodiscard]] int sideBetween(const std::array<int, 2>& vertices) const {
    for (const int e : sides_.sidesAt(vertices[0]))
      if (sides_.all()[e].vertices[0] == vertices[1] || sides_.all()[e].vertices[1] == vertices[1]) return e;
    return -1;
  }

  /// \returns false where the tangent cannot be factorised
  bool balance() {
    std::vector<Stress> stress = stress_;
    if (!equilibrate(stress)) return false;
    moments_ = balancedMoments(mesh(), sides_, stress, forces_, known_);
    Relaxation relaxation(mesh(), sides_, compliances_, stress_, forces_, known_, moments_);
    relax(relaxation, mesh().triangles.size());
    energies_ = relaxation.energies();
    return true;
  }
  [[nodiscard]] const Vector& energies() const { return energies_; }  ///< |s^ - s|^2 by triangles
  [[nodiscard]] double norm() const {
    double sum = 0;
    for (size_t t = 0; t < stress_.size(); ++t)
      sum += doubleArea(mesh(), static_cast<int>(t)) / 2 * stress_[t].dot(compliances_[t] * stress_[t]);
    return sum;
  }
  /// Moments of the side between two vertices, at the first and the second, of the traction on this body.
  [[nodiscard]] std::array<Point, 2> momentsBetween(const std::array<int, 2>& vertices) const {
    const int e = sideBetween(vertices);
    std::array<Point, 2> moments = moments_[e];
    if (sides_.all()[e].vertices[0] != vertices[0]) std::swap(moments[0], moments[1]);
    return moments;
  }
  /// What is left over of the forces and their moments in a triangle, over the largest moment of a side.
  [[nodiscard]] std::array<double, 2> imbalance() const {
    double worst = 0;
    double largest = 0;
    for (int t = 0; t < static_cast<int>(mesh().triangles.size()); ++t) {
      const auto& v = mesh().triangles[t];
      const Moments m = momentsOf(sides_, moments_, t);
      Point force = doubleArea(mesh(), t) / 2 * forces_[t];
      const Point centre = (mesh().vertices[v[0]] + mesh().vertices[v[1]] + mesh().vertices[v[2]]) / 3;
      double couple = 0;
      double size = 0;
      for (int k = 0; k < 3; ++k)
        for (int end = 0; end < 2; ++end) {
          const Point b = m.segment<2>(4 * k + 2 * end);
          const Point arm = mesh().vertices[v[(k + end) % 3]] - centre;
          force += b;
          couple += arm.x() * b.y() - arm.y() * b.x();
          size = std::max(size, arm.norm());
        }
      worst = std::max({worst, force.norm(), std::abs(couple) / size});
      largest = std::max(largest, m.cwiseAbs().maxCoeff());
    }
    return {worst, largest};
  }

 private:
  static Linearisation elasticLaw(const Body& body) {
    Linearisation law = body.material().room(body.points());
    const Matrix none = Matrix::Zero(body.material().components(), body.points());
    body.material().linearise({0, none, none}, none, law, 0, body.points());
    return law;
  }

  void readForces(double t) {
    for (size_t k = 0; k < mesh().triangles.size(); ++k) {
      const auto& v = mesh().triangles[k];
      Point sum(0, 0);
      for (const BodyForce& force : body_.conditions().forces) {
        std::array<double, 3> values{};
        for (int i = 0; i < 3; ++i) {
          const Point at = (mesh().vertices[v[i]] + mesh().vertices[v[(i + 1) % 3]]) / 2;
          values[i] = force.value(at.x(), at.y(), t);
        }
        const double mean = (values[0] + values[1] + values[2]) / 3;
        sum += mean * Point::Unit(force.component);
        for (const double value : values) oscillation_.add(body_.weights()[k], value - mean, value);
      }
      forces_.push_back(sum);
    }
  }

  void readBoundary(double t) {
    known_.resize(sides_.count());
    for (int e = 0; e < sides_.count(); ++e) {
      const Side& side = sides_.all()[e];
      if (side.triangles[1] >= 0) continue;
      known_[e].count = 2;
      known_[e].known = {Point(1, 0), Point(0, 1)};
      if (side.boundary < 0) continue;
      const int label = mesh().boundaryLabels[side.boundary];
      const Point a = mesh().vertices[side.vertices[0]];
      const Point along = mesh().vertices[side.vertices[1]] - a;
      const auto direction = [&](int component) -> Point {
        const Point tangent = along.normalized();
        return component == alongX        ? Point(1, 0)
               : component == alongY      ? Point(0, 1)
               : component == alongNormal ? Point(tangent.y(), -tangent.x())
                                          : tangent;
      };
      for (const PrescribedDisplacement& held : body_.conditions().displacements) {
        if (held.label != label) continue;
        hold(known_[e], direction(held.component));
        if (!holds(side, direction(held.component))) curvedSupport_ = true;
        oscillation_.addLinear(along.norm(), [&](double s) {
          return held.value(a.x() + s * along.x(), a.y() + s * along.y(), t);
        });
      }
      for (const Traction& traction : body_.conditions().tractions) {
        if (traction.label != label) continue;
        const auto value = [&](double s) {
          return traction.value(a.x() + s * along.x(), a.y() + s * along.y(), t);
        };
        oscillation_.addLinear(along.norm(), value);
        const Point d = along.norm() / 6 * direction(traction.component);
        known_[e].moments[0] += (value(0) + 2 * value(0.5)) * d;
        known_[e].moments[1] += (2 * value(0.5) + value(1)) * d;
      }
    }
  }
  /// Whether the supports of both ends of a side hold it along a direction: along a curve theirs is another
  /// one.
  [[nodiscard]] bool holds(const Side& side, const Point& direction) const {
    const std::vector<NodeSupport>& supports = body_.supports().nodes();
    return std::all_of(side.vertices.begin(), side.vertices.end(), [&](int vertex) {
      const auto at = std::lower_bound(supports.begin(), supports.end(), vertex,
                                       [](const NodeSupport& each, int node) { return each.node < node; });
      if (at == supports.end() || at->node != vertex) return false;
      return at->count == 2 || isAlong(at->directions[0], direction);
    });
  }
  static bool isAlong(const Point& a, const Point& b) {
    return std::abs(a.x() * b.y() - a.y() * b.x()) <= strict * a.norm() * b.norm();
  }
  /// Takes a direction from those in which the traction is known.
  static void hold(KnownTraction& known, const Point& direction) {
    if (known.count == 2)
      known = {1, {Point(-direction.y(), direction.x()), Point(0, 0)}, known.moments};
    else if (known.count == 1 && std::abs(known.known[0].dot(direction)) > 1e-9)
      known.count = 0;
  }

  /// Adds what brings finite element stresses into equilibrium with the load.
  bool equilibrate(std::vector<Stress>& stress) const {
    Vector left = load_;
    const auto gradient = [&](size_t t, int i) -> Point {  // |K| grad phi_i
      const auto& v = mesh().triangles[t];
      const Point opposite = mesh().vertices[v[(i + 2) % 3]] - mesh().vertices[v[(i + 1) % 3]];
      return Point(-opposite.y(), opposite.x()) / 2;
    };
    for (size_t t = 0; t < stress.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Point g = gradient(t, i);
        left.segment<2>(2 * mesh().triangles[t][i]) -=
            Point(stress[t][0] * g.x() + stress[t][2] * g.y(), stress[t][2] * g.x() + stress[t][1] * g.y());
      }
    Matrix moduli(body_.material().symmetricTangent() ? 6 : 9, static_cast<Eigen::Index>(moduli_.size()));
    for (size_t t = 0; t < moduli_.size(); ++t) {
      const Eigen::Matrix3d& D = moduli_[t];
      if (moduli.rows() == 6)
        moduli.col(t) << D(0, 0), D(1, 0), D(2, 0), D(1, 1), D(2, 1), D(2, 2);
      else
        moduli.col(t) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(D.data());
    }
    std::vector<double> values(body_.pattern().entries());
    body_.tangent(moduli, values);
    pin(values);
    auto solver = multifrontalSolver(body_.pattern(), {});
    if (!solver->factorise(values)) {
      solver = suiteSparseSolver(body_.pattern(), {});
      if (!solver->factorise(values)) return false;
    }
    Vector x = body_.gather(left);
    solver->condense(x);
    solver->expand(x);
    const Vector d = body_.spread(x);
    const Eigen::Matrix3d back = toBasis().inverse();
    for (size_t t = 0; t < stress.size(); ++t) {
      Eigen::Vector3d strain = Eigen::Vector3d::Zero();
      for (int i = 0; i < 3; ++i) {
        const Point g = gradient(t, i) / body_.weights()[t];
        const Point u = d.segment<2>(2 * mesh().triangles[t][i]);
        strain += fromCartesian({u.x() * g.x(), u.y() * g.y(), (u.x() * g.y() + u.y() * g.x()) / 2});
      }
      stress[t] += back * (moduli_[t] * strain);
    }
    return true;
  }

  /// Springs at as many equations as there are rigid motions: forces in equilibrium leave them at rest.
  void pin(std::vector<double>& values) const {
    if (modes_.cols() == 0) return;
    Matrix motions(body_.freeDofs(), modes_.cols());
    for (Eigen::Index m = 0; m < modes_.cols(); ++m) motions.col(m) = body_.gather(modes_.col(m));
    const Eigen::ColPivHouseholderQR<Matrix> qr(motions.transpose());
    const SparsePattern& pattern = body_.pattern();
    for (Eigen::Index m = 0; m < modes_.cols(); ++m) {
      const int equation = qr.colsPermutation().indices()[m];
      for (int k = pattern.columnStart[equation]; k < pattern.columnStart[equation + 1]; ++k)
        if (pattern.rows[k] == equation) values[k] *= 2;
    }
  }

  const CutMesh& cut_;
  Body body_;
  Sides sides_;
  Vector displacement_;
  Vector load_;
  Matrix modes_;
  std::vector<Eigen::Matrix3d> moduli_, compliances_;
  std::vector<Stress> stress_;
  std::vector<Point> forces_;
  std::vector<KnownTraction> known_;
  Oscillation oscillation_;
  bool curvedSupport_ = false;
  SideMoments moments_;
  Vector energies_;
};

/// Changes pressures by factors 1 + a + b x on each interface such that bodies that contact alone holds are
/// in equilibrium. \returns false where that cannot be
bool balancePressures(const Model& model, const MatchedMeshes& meshes, const std::vector<LoadedBody>& bodies,
                      std::vector<Vector>& spread) {
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
        for (int k = 0; k < 2; ++k) {
          const int row = piece.rows[k];
          const double c = spread[piece.interface][row];
          const auto m = momentsOfLinear(piece.values[k], piece.length);
          for (int end = 0; end < 2; ++end) {
            const Vector work =
                -c * m[end] * modes.middleRows<2>(2 * piece.vertices[side][end]).transpose() * outward;
            left.segment(first, modes.cols()) += work;
            M.block(first, 2 * piece.interface, modes.cols(), 1) += work;
            M.block(first, 2 * piece.interface + 1, modes.cols(), 1) += places[piece.interface][row] * work;
            if (work.size() > 0) size = std::max(size, work.cwiseAbs().maxCoeff());
          }
        }
      }
    }
    first += modes.cols();
  }
  const Vector factors = M.completeOrthogonalDecomposition().solve(-left);
  if (!factors.allFinite() ||
      (M * factors + left).cwiseAbs().maxCoeff() > 1e-9 * std::max(size, left.cwiseAbs().maxCoeff()))
    return false;
  for (size_t k = 0; k < spread.size(); ++k) {
    const auto at = 2 * static_cast<Eigen::Index>(k);
    spread[k].array() *= 1 + factors[at] + factors[at + 1] * places[k].array();
    if (spread[k].minCoeff() < 0) return false;
  }
  return true;
}

}  // namespace

double EnergyBound::relative() const {
  if (!obstacle.empty() || !(bound < norm)) return std::numeric_limits<double>::infinity();
  return bound / (norm - bound);
}

EnergyBound energyBound(const Model& model, const State& state) {
  EnergyBound result;
  const auto none = [&](const std::string& why) {
    result.obstacle = why;
    return result;
  };
  for (const Body& body : model.bodies) {
    if (body.degree() != 1) return none("displacements are quadratic");
    if (!body.material().linear()) return none(body.name() + " is viscoplastic");
  }
  const MatchedMeshes meshes = matchedMeshes(model);
  if (!meshes.obstacle.empty()) return none(meshes.obstacle);

  std::vector<LoadedBody> bodies;
  bodies.reserve(model.bodies.size());
  for (size_t b = 0; b < model.bodies.size(); ++b)
    bodies.emplace_back(model, state, meshes.bodies[b], static_cast<int>(b));

  for (size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].hasCurvedSupport()) return none(model.bodies[b].name() + " is held along a curve");
  std::vector<Vector> spread = spreadPressures(model, state, meshes);
  if (!balancePressures(model, meshes, bodies, spread))
    return none(
        "bodies that contact alone holds are not in equilibrium with a pressure that is nowhere negative");
  std::vector<std::array<double, 2>> pressures;
  for (const MatchedPiece& piece : meshes.pieces) {
    pressures.push_back(pressureOn(piece, spread));
    result.leastPressure = std::min({result.leastPressure, pressures.back()[0], pressures.back()[1]});
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    const auto moments = momentsOfLinear(pressures.back(), piece.length);
    bodies[nonmortar.body].press(piece.vertices[0], piece.normal, moments);
    bodies[mortar.body].press(piece.vertices[1], -piece.normal, moments);
  }

  Oscillation oscillation;
  double largest = 0;
  double stress = 0;
  double norm = 0;
  std::vector<LiftedBody> lifted;
  for (LoadedBody& body : bodies) {
    if (!body.balance()) return none("a tangent is singular");
    stress += body.energies().sum();
    norm += body.norm();
    const auto [worst, size] = body.imbalance();
    result.imbalance = std::max(result.imbalance, worst);
    largest = std::max(largest, size);
    oscillation.off += body.oscillation().off;
    oscillation.all += body.oscillation().all;
    lifted.push_back(body.lifted());
  }
  for (const MatchedPiece& piece : meshes.pieces) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    const auto above = bodies[nonmortar.body].momentsBetween(piece.vertices[0]);
    const auto below = bodies[mortar.body].momentsBetween(piece.vertices[1]);
    for (int end = 0; end < 2; ++end)
      result.mismatch = std::max(result.mismatch, (above[end] + below[end]).norm());
  }
  if (largest > 0) {
    result.imbalance /= largest;
    result.mismatch /= largest;
  }
  if (!(result.imbalance <= strict) || !(result.mismatch <= strict))
    return none("tractions are not in equilibrium to rounding");
  if (!(result.leastPressure >= 0)) return none("a contact pressure is negative");
  const Lift lifting = lift(lifted, model, meshes.pieces, pressures);
  if (!lifting.obstacle.empty()) return none(lifting.obstacle);
  if (!(lifting.leastGap >= 0)) return none("the lifted displacement penetrates");
  double lifts = 0;
  for (const Vector& energies : lifting.energies) lifts += energies.sum();
  result.stress = std::sqrt(stress);
  result.lift = std::sqrt(lifts);
  result.gap = lifting.gap;
  result.leastGap = lifting.leastGap;
  result.norm = std::sqrt(norm);
  result.oscillation = oscillation.relative();
  result.bound = std::sqrt(stress + lifts + 2 * lifting.gap);
  return result;
}

}  // namespace mortier
