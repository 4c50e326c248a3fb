#include <algorithm>
#include <cmath>
#include <optional>

#include "base/datum.h"
#include "base/dense_templates.h"
#include "bound/loaded_body.h"
#include "bound/unresolved_data.h"
#include "material/stress.h"

namespace mortier {
namespace {

/// Directions that make a smaller angle are one [rad], and displacements that differ by less, over the
/// largest.
constexpr double same = 1e-9;

bool isAlong(const Point& a, const Point& b) {
  return std::abs(cross(a, b)) <= same * a.norm() * b.norm();
}
/// Takes a direction from those in which the traction is known.
void hold(KnownTraction& known, const Point& direction) {
  if (known.count == 2)
    known = {1, {Point(-direction.y(), direction.x()), Point(0, 0)}, known.moments};
  else if (known.count == 1 && std::abs(known.known[0].dot(direction)) > 1e-9)
    known.count = 0;
}

class Reading {
 public:
  Reading(const MatchedBody& place, double t) : place_(place), mesh_(place.cut.mesh), t_(t) {
    const auto triangles = static_cast<Eigen::Index>(mesh_.triangles.size());
    data_.forces.assign(triangles, BodyLoad::Zero());
    data_.known.resize(place.sides.count());
    data_.load = Vector::Zero(place.body.dofs());
    data_.carried = data_.strained = Vector::Zero(triangles);
    data_.meanCarried.assign(triangles, Stress::Zero());
    data_.meanStrained = data_.meanCarried;
  }

  BodyData read() {
    readForces();
    for (int e = 0; e < place_.sides.count(); ++e)
      if (place_.sides.all()[e].triangles[1] < 0) readSide(e);
    readStresses();
    return std::move(data_);
  }

 private:
  [[nodiscard]] std::string ofBody(const std::string& what) const {
    return what + " of " + place_.own.name();
  }
  void refuse(const std::string& why) {
    if (data_.obstacle.empty()) data_.obstacle = why;
  }
  void isBeyond(const std::string& what) {
    if (data_.beyond.empty()) data_.beyond = what;
  }
  [[nodiscard]] std::array<Point, 3> cornersOf(int t) const {
    const auto& v = mesh_.triangles[t];
    return {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]};
  }

  void readForces() {
    const std::vector<BodyForce>& forces = place_.body.conditions().forces;
    if (forces.empty()) return;
    const int triangles = static_cast<int>(mesh_.triangles.size());
    std::vector<Datum> values;
    values.reserve(forces.size());
    for (const BodyForce& force : forces) values.push_back(force.value);
    DataOnTriangles data(values, t_, triangles);
    for (int t = 0; t < triangles; ++t) {
      const std::array<Point, 3> x = cornersOf(t);
      const double area = doubleArea(mesh_, t) / 2;
      Eigen::Matrix<double, 2, 3> linear = Eigen::Matrix<double, 2, 3>::Zero();
      double rest = 0;
      bool known = true;
      for (size_t i = 0; i < forces.size(); ++i) {
        const TriangleDatum datum = data.on(static_cast<int>(i), x);
        for (int k = 0; k < 3; ++k) linear(forces[i].component, k) += datum.linear[k];
        rest += datum.rest * std::sqrt(area);
        data_.error = std::max(data_.error, 2 * area * datum.error);
        known = known && datum.known;
      }
      if (!known) refuse(ofBody("the body force") + " is not known to be bounded");
      addForce(t, x, area, linear);
      if (rest > same * same * linear.norm() * std::sqrt(area)) {
        isBeyond(ofBody("the body force") + " is not constant on triangles");
        data_.carried[t] += rest * carriesForce(x, place_.compliances[t]);
      }
      const Eigen::Matrix<double, 2, 3> nodal = nodalForces(mesh_, t, data_.forces[t]);
      for (int k = 0; k < 3; ++k) data_.load.segment<2>(2 * mesh_.triangles[t][k]) += nodal.col(k);
    }
  }

  /// A linear force is its mean, a multiple of CompositeTriangle::turningForce(), and sum of c_k (l_i - l_j)
  /// t_k, t_k the sides, which l_i l_j t_k (x) t_k carry without tractions.
  void addForce(int t, const std::array<Point, 3>& x, double area,
                const Eigen::Matrix<double, 2, 3>& values) {
    const Point mean = values.rowwise().mean();
    data_.forces[t].head<2>() = mean;
    const Eigen::Matrix<double, 2, 3> off = values.colwise() - mean;
    if (!(off.norm() > 1e-13 * mean.norm())) return;
    isBeyond(ofBody("the body force") + " is not constant on triangles");
    const CompositeTriangle element(x, place_.compliances[t]);
    Matrix fields(6, 4);
    std::array<Point, 3> along;
    for (int k = 0; k < 4; ++k) {
      Eigen::Matrix<double, 2, 3> at = element.turningForce() * area;
      if (k < 3) {
        const int i = (k + 1) % 3;
        const int j = (k + 2) % 3;
        along[k] = x[j] - x[i];
        at.setZero();
        at.col(i) = along[k];
        at.col(j) = -along[k];
      }
      fields.col(k) = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(at.data());
    }
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> wanted(off.data());
    const Vector c = fields.colPivHouseholderQr().solve(Vector(-wanted));
    data_.forces[t][2] = -area * c[3];
    data_.carried[t] += area * std::abs(c[3]) * element.restNorm();
    data_.meanCarried[t] -= area * c[3] * element.restMean();
    Eigen::Matrix3d stresses;
    for (int k = 0; k < 3; ++k)
      stresses.col(k) = c[k] * Stress(along[k].x() * along[k].x(), along[k].y() * along[k].y(),
                                      along[k].x() * along[k].y());
    // Integrals of (l_i l_j)^2 and of (l_i l_j)(l_i l_k): area/90 and area/180.
    const Stress sum = stresses.rowwise().sum();
    double energy = sum.dot(place_.compliances[t] * sum) * area / 180;
    for (int k = 0; k < 3; ++k)
      energy += stresses.col(k).dot(place_.compliances[t] * stresses.col(k)) * area / 180;
    data_.carried[t] += std::sqrt(energy);
    data_.meanCarried[t] += area / 12 * sum;
  }

  void readSide(int e) {
    const Side& side = place_.sides.all()[e];
    KnownTraction& known = data_.known[e];
    known.count = 2;
    known.known = {Point(1, 0), Point(0, 1)};
    if (side.boundary < 0) return;
    const int label = mesh_.boundaryLabels[side.boundary];
    const SideTriangle beside(mesh_, side);
    const auto direction = [&](int component) -> Point {
      return component == alongX        ? Point(1, 0)
             : component == alongY      ? Point(0, 1)
             : component == alongNormal ? beside.outward()
                                        : Point(beside.along().normalized());
    };
    for (const Condition& held : place_.body.conditions().displacements) {
      if (held.label != label) continue;
      const std::optional<Point> along = heldAlong(side, direction(held.component));
      if (!along) data_.curvedSupport = true;
      hold(known, along.value_or(direction(held.component)));
      readDisplacement(e, along.value_or(direction(held.component)), held.value);
    }
    for (const Condition& traction : place_.body.conditions().tractions)
      if (traction.label == label) readTraction(e, beside, direction(traction.component), traction.value);
  }

  void readDisplacement(int e, const Point& direction, const Datum& value) {
    const Side& side = place_.sides.all()[e];
    const SideDatum datum =
        onSide(value, mesh_.vertices[side.vertices[0]], mesh_.vertices[side.vertices[1]], t_);
    const std::string what =
        ofBody("the displacement prescribed on label " + std::to_string(mesh_.boundaryLabels[side.boundary]));
    const double size = std::max(datum.size, place_.displacement.lpNorm<Eigen::Infinity>());
    for (int end = 0; end < 2; ++end)
      if (std::abs(direction.dot(place_.displacement.segment<2>(2 * side.vertices[end])) - datum.ends[end]) >
          same * size)
        return datum.linear() && side.vertices[end] < place_.own.nodes()
                   ? refuse(what + " is not that of its nodes")
                   : refuse(what + " is not linear beside contact or loads on the same label");
    if (datum.linear()) return;
    if (!datum.known) return refuse(what + " is not known to be bounded");
    if (!std::isfinite(datum.slope)) return refuse(what + " is not known to be continuous");
    isBeyond(what + " is not linear on sides");
    moveSide(place_, e, direction, datum, data_);
  }

  void readTraction(int e, const SideTriangle& beside, const Point& direction, const Datum& value) {
    const Side& side = place_.sides.all()[e];
    const SideDatum datum = onSide(value, beside.p, beside.q, t_);
    const double length = beside.length();
    for (int end = 0; end < 2; ++end) {
      const Point moment = length * datum.moments[end] * direction;
      data_.known[e].moments[end] += moment;
      data_.load.segment<2>(2 * side.vertices[end]) += moment;
    }
    data_.error = std::max(data_.error, length * datum.momentError);
    if (datum.linear()) return;
    const std::string what =
        ofBody("the traction on label " + std::to_string(mesh_.boundaryLabels[side.boundary]));
    if (!datum.known) return refuse(what + " is not known to be bounded");
    isBeyond(what + " is not linear on sides");
    const int t = side.triangles[0];
    data_.carried[t] += datum.off * std::sqrt(length) * carriesTraction(beside, place_.compliances[t]);
  }

  /// The direction, that of a side but for rounded coordinates, along which the supports of both its ends
  /// hold it; none where there is none.
  [[nodiscard]] std::optional<Point> heldAlong(const Side& side, const Point& direction) const {
    constexpr double nearly = 1e-3;
    const std::vector<NodeSupport>& supports = place_.body.supports().nodes();
    std::optional<Point> found;
    bool alone = false;  // at a node that is held along no other direction
    for (const int vertex : side.vertices) {
      const auto at = std::lower_bound(supports.begin(), supports.end(), vertex,
                                       [](const NodeSupport& each, int node) { return each.node < node; });
      if (at == supports.end() || at->node != vertex) return std::nullopt;
      const auto end = at->directions.begin() + at->count;
      const auto own = std::find_if(at->directions.begin(), end, [&](const SpacePoint& each) {
        return std::abs(cross(each.head<2>(), direction)) <= nearly;
      });
      const bool one = at->count == 1;
      if (own == end && one) return std::nullopt;
      if (own == end || (found && !one)) continue;
      const Point along = own->head<2>();
      if (alone && !isAlong(*found, along)) return std::nullopt;
      found = along.dot(direction) > 0 ? along : Point(-along);
      alone = one;
    }
    return found ? found : direction;
  }

  /// What initial and thermal stresses are beside those at the points of the body.
  void readStresses() {
    const Conditions& conditions = place_.own.conditions();
    std::vector<Datum> values;
    for (const InitialStress& each : conditions.initialStresses) values.push_back(each.value);
    if (place_.own.heated()) values.push_back(conditions.temperature);
    const auto varies = [](const Datum& value) { return !value.constant(); };
    if (std::none_of(values.begin(), values.end(), varies)) return;
    const int triangles = static_cast<int>(mesh_.triangles.size());
    DataOnTriangles data(values, place_.own.heated() ? t_ : 0, triangles);
    DataOnTriangles atStart(values, 0, triangles);
    const Matrix given = place_.own.initialStress();
    const Matrix heat = place_.own.heated() ? place_.own.thermalStrain(t_) : Matrix();
    const Linearisation elastic = elasticLaw(place_.own);
    for (int t = 0; t < triangles; ++t) {
      const int parent = place_.cut.parents[t];
      const std::array<Point, 3> x = cornersOf(t);
      const Stress centre = toCartesian(given.col(parent).head<3>());
      // Later ones replace earlier ones.
      std::array<int, 3> of{-1, -1, -1};
      for (size_t i = 0; i < conditions.initialStresses.size(); ++i) {
        const InitialStress& each = conditions.initialStresses[i];
        if (each.component < 3 && (!each.region || mesh_.regions[t] == *each.region))
          of[each.component] = static_cast<int>(i);
      }
      Stress off = Stress::Zero();  // root of mean squares
      Stress mean = Stress::Zero();
      bool known = true;
      const double area = doubleArea(mesh_, t) / 2;
      const auto add = [&](DataOnTriangles& from, int i, double centreValue, const Stress& per) {
        const TriangleDatum datum = from.on(i, x);
        known = known && datum.known;
        off += datum.distanceTo(centreValue) * per.cwiseAbs();
        mean += ((datum.linear[0] + datum.linear[1] + datum.linear[2]) / 3 - centreValue) * per;
      };
      for (int c = 0; c < 3; ++c)
        if (of[c] >= 0) add(atStart, of[c], centre[c], Stress::Unit(c));
      if (place_.own.heated()) {
        const Vector& perKelvin = conditions.expansion.col(parent);
        PointVector strain = PointVector::Zero(place_.own.material().components());
        strain.head(perKelvin.size()) = perKelvin;
        const Stress stress = -toCartesian(stressOf(elastic, strain, parent).head<3>());
        Eigen::Index at = 0;
        perKelvin.cwiseAbs().maxCoeff(&at);
        const double degrees = perKelvin[at] != 0 ? heat(at, parent) / perKelvin[at] : 0;
        add(data, static_cast<int>(values.size()) - 1, degrees, stress);
      }
      if (!known) refuse(ofBody("the initial stress or temperature") + " is not known to be bounded");
      if (!(off.norm() > 1e-13 * centre.norm())) continue;
      isBeyond(ofBody("the initial stress or temperature") + " is not constant on triangles");
      data_.strained[t] += std::sqrt(area * off.dot(place_.compliances[t].cwiseAbs() * off));
      data_.meanStrained[t] += area * mean;
    }
  }

  const MatchedBody& place_;
  const TriangleMesh& mesh_;
  double t_;
  BodyData data_;
};

}  // namespace

BodyData readData(const MatchedBody& place, double t) {
  return Reading(place, t).read();
}

}  // namespace mortier
