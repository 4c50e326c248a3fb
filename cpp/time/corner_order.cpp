#include "time/corner_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "mesh/boundary_line.h"
#include "time/nodal_forces.h"

namespace mortier {
namespace {

constexpr double leastOrderOfCorner = 0.15;  // corners of a polygon that stands for a curve have less
constexpr double nextTo = 1.5;               // edges

/// The least root of a function in (0, 1).
double leastRoot(const std::function<double(double)>& f) {
  constexpr double first = 0.02;
  constexpr double step = 0.01;
  constexpr int halvings = 30;
  for (double low = first; low + step < 1; low += step) {
    double begin = low;
    double end = low + step;
    if ((f(begin) > 0) == (f(end) > 0)) continue;
    for (int i = 0; i < halvings; ++i) {
      const double middle = (begin + end) / 2;
      ((f(middle) > 0) == (f(begin) > 0) ? begin : end) = middle;
    }
    return (begin + end) / 2;
  }
  return 1;
}

/// Both sides alike, by the factor of l sin w. \param alsoOther  of fields that are not symmetric about its
/// middle
double alike(double angle, double factor, bool alsoOther) {
  const auto symmetric = [&](double l) { return std::sin(l * angle) + factor * l * std::sin(angle); };
  const auto other = [&](double l) { return std::sin(l * angle) - factor * l * std::sin(angle); };
  return std::min(leastRoot(symmetric), alsoOther ? leastRoot(other) : 1.0);
}

double heldAndFree(double angle, double kappa) {
  const auto off = [&](double l) {
    return 4 * kappa * std::pow(std::sin(l * angle), 2) + 4 * std::pow(l * std::sin(angle), 2) -
           (kappa + 1) * (kappa + 1);
  };
  const double root = leastRoot(off);
  if (root < 1) return root;
  // The root is complex where angles are large: its real part is about where the function is largest.
  constexpr double step = 0.01;
  double best = step;
  for (double l = step; l < 1; l += step)
    if (off(l) > off(best)) best = l;
  return best < 1 - 2 * step ? best : 1;
}

/// kappa of an isotropic material, from what it makes of two stresses.
double kappaOf(const Body& body) {
  const int components = body.material().components();
  Matrix stress = Matrix::Zero(components, body.points());
  Matrix strain = stress;
  const auto compliance = [&](int component) {
    stress.setZero();
    stress.row(component).setOnes();
    body.material().elasticStrain(stress, strain);
    return strain(component, 0);
  };
  const double shear = compliance(1);  // (1 + nu)/E
  if (components > 3) return 3 - 4 * (shear / compliance(3) - 1);
  const double all = compliance(0);  // (1 - nu)/E
  const double poisson = (shear - all) / (shear + all);
  return (3 - poisson) / (1 + poisson);
}

/// What the conditions of a label hold of an edge of it.
SideSupport supportOf(const Body& body, int label, const Point& along) {
  bool across = false;
  bool other = false;
  for (const PrescribedDisplacement& held : body.conditions().displacements) {
    if (!held.actsOn(label)) continue;
    const bool x = held.component == alongX;
    if (held.component != alongX && held.component != alongY)
      (held.component == alongNormal ? across : other) = true;
    else if (std::abs(x ? along.y() : along.x()) > M_SQRT1_2)
      across = true;
    else
      other = true;
  }
  return across && other ? SideSupport::held : across || other ? SideSupport::sliding : SideSupport::free;
}

/// A corner of the boundary: how wide it is, and what holds its sides.
struct BoundaryCorner {
  double angle = 0;
  std::vector<SideSupport> sides;
};

/// Corners by vertices near a place.
std::vector<std::pair<int, BoundaryCorner>> cornersNear(const Body& body, const Point& place) {
  const TriangleMesh& mesh = body.mesh();
  std::vector<std::pair<int, BoundaryCorner>> corners;
  const auto at = [&](int vertex) {
    return std::find_if(corners.begin(), corners.end(), [&](const auto& c) { return c.first == vertex; });
  };
  for (size_t k = 0; k < mesh.boundaryEdges.size(); ++k)
    for (int end = 0; end < 2; ++end) {
      const int v = mesh.boundaryEdges[k][end];
      const Point along = mesh.vertices[mesh.boundaryEdges[k][1 - end]] - mesh.vertices[v];
      if (!((mesh.vertices[v] - place).norm() < nextTo * along.norm())) continue;
      if (at(v) == corners.end()) corners.emplace_back(v, BoundaryCorner{});
      at(v)->second.sides.push_back(supportOf(body, mesh.boundaryLabels[k], along.normalized()));
    }
  for (const auto& triangle : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const auto corner = at(triangle[i]);
      if (corner == corners.end()) continue;
      const Point a = mesh.vertices[triangle[(i + 1) % 3]] - mesh.vertices[triangle[i]];
      const Point b = mesh.vertices[triangle[(i + 2) % 3]] - mesh.vertices[triangle[i]];
      corner->second.angle += std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0));
    }
  return corners;
}

/// Whether the stress grows towards a vertex: its mean square within two edges over that within four.
bool growsTowards(const Body& body, const Matrix& stress, int vertex) {
  constexpr double grows = 1.1;
  const TriangleMesh& mesh = body.mesh();
  double edge = 0;
  for (const auto& [a, b] : mesh.boundaryEdges)
    if (a == vertex || b == vertex) edge = std::max(edge, (mesh.vertices[a] - mesh.vertices[b]).norm());
  std::array<double, 2> square{};
  std::array<double, 2> area{};
  const std::vector<Point> places = body.places();
  for (int i = 0; i < body.points(); ++i)
    for (int k = 0; k < 2; ++k) {
      const double far = (places[i] - mesh.vertices[vertex]).norm();
      if (!(far < 2 * (k + 1) * edge)) continue;
      square[k] += body.weights()[i] * stress.col(i).squaredNorm();
      area[k] += body.weights()[i];
    }
  return area[0] > 0 && square[0] / area[0] > grows * square[1] / area[1];
}

}  // namespace

double orderOfCorner(double angle, SideSupport first, SideSupport second, double kappa) {
  if (first > second) std::swap(first, second);
  double l = 1;
  if (first == second && first == SideSupport::sliding) {
    constexpr double straight = 1e-3;
    for (int k = 1; k <= 4; ++k)
      if (const double root = k * M_PI / angle - 1; root > straight) l = std::min(l, root);
  } else if (first == second) {
    l = alike(angle, first == SideSupport::free ? 1 : 1 / kappa, true);
  } else if (first == SideSupport::free && second == SideSupport::held) {
    l = heldAndFree(angle, kappa);
  } else {
    const bool freeSide = first == SideSupport::free;
    l = alike(2 * angle, freeSide ? 1 : 1 / kappa, !freeSide);
  }
  return 1 - l >= leastOrderOfCorner ? 1 - l : 0;
}

double cornerOrder(const Body& body, const Matrix& stress, const Point& place) {
  if (body.rigid() || body.space() != nullptr) return 0;
  double order = 0;
  for (const auto& [vertex, corner] : cornersNear(body, place)) {
    if (corner.sides.size() != 2) continue;
    const double own = orderOfCorner(corner.angle, corner.sides[0], corner.sides[1], kappaOf(body));
    if (own > order && growsTowards(body, stress, vertex)) order = own;
  }
  return order;
}

bool contactEndsAt(const Model& model, const State& state, const Point& place) {
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactPair& pair = model.interfaces[k].pair();
    if (model.interfaces[k].dimension() == 3 || !(state.contactForce[k].maxCoeff() > 0)) continue;
    std::array<BoundaryLine, 2> lines;
    for (int side = 0; side < 2; ++side) {
      const ContactSide& of = side == 0 ? pair.nonmortar : pair.mortar;
      lines[side] = boundaryLine(model.bodies[of.body].mesh(), of.label);
    }
    for (int side = 0; side < 2; ++side) {
      const BoundaryLine& own = lines[side];
      const BoundaryLine& other = lines[1 - side];
      if (own.closed) continue;
      const size_t last = own.points.size() - 1;
      for (const auto& [end, next] : {std::pair(size_t{0}, size_t{1}), std::pair(last, last - 1)}) {
        const double edge = (own.points[end] - own.points[next]).norm();
        if (!((own.points[end] - place).norm() < nextTo * edge)) continue;
        const auto far = [&, end = end](const Point& x) { return (x - own.points[end]).norm() > edge / 2; };
        if (other.closed || (far(other.points.front()) && far(other.points.back()))) return true;
      }
    }
  }
  return false;
}

}  // namespace mortier
