#include "contact/interface.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/digits.h"
#include "base/error.h"
#include "contact/end_rows.h"
#include "contact/interface_entries.h"
#include "mesh/triangle_mesh.h"

namespace mortier {
namespace {

/// Bodies whose distance is below this part of the shorter line touch.
constexpr double touching = 1e-12;
/// The same where the scene rejects bodies that do not; coordinates may have nine digits.
constexpr double touchingInFile = 1e-9;
/// The largest penetration as meshed, as a part of the shorter line: far above that of two meshes of one
/// curve, far below that of bodies in the wrong place.
constexpr double largestPenetration = 1e-2;

double lengthOf(const BoundaryLine& line) {
  double length = 0;
  for (size_t i = 1; i < line.points.size(); ++i) length += (line.points[i] - line.points[i - 1]).norm();
  return length;
}

/// The widest angle between outward normals of two lines, in degrees, for a message.
double angleBetween(const std::vector<SmoothPart>& parts, const BoundaryLine& mortar) {
  const auto angleOf = [](const Point& d) { return std::atan2(d.y(), d.x()); };
  std::vector<double> across;
  for (size_t j = 1; j < mortar.points.size(); ++j)
    across.push_back(angleOf(mortar.points[j] - mortar.points[j - 1]));
  std::sort(across.begin(), across.end());
  double widest = 0;
  for (const SmoothPart& part : parts)
    for (int e = 0; e < part.elements(); ++e) {
      const double opposite = std::remainder(angleOf(part.direction(e)) + M_PI, 2 * M_PI);
      const auto above = std::lower_bound(across.begin(), across.end(), opposite);
      for (const double each : {above == across.end() ? across.front() : *above,
                                above == across.begin() ? across.back() : *(above - 1)})
        widest = std::max(widest, M_PI - std::abs(std::remainder(each - opposite, 2 * M_PI)));
    }
  return widest * 180 / M_PI;
}

/// Columns 2 node + component of a line to dofs of its mesh.
void scatter(const Eigen::SparseMatrix<double>& values, const ElementLine& line,
             const std::vector<int>& rowOf, Triplets& entries) {
  forEachEntry(values, [&](int row, int column, double value) {
    entries.emplace_back(rowOf[row], 2 * line.number(column / 2) + column % 2, value);
  });
}

/// The same with every direction turned by +90 degrees.
ConstraintRows turned(const ConstraintRows& rows) {
  Triplets entries;
  forEachEntry(rows, [&](int row, int dof, double value) {
    entries.emplace_back(row, dof ^ 1, dof % 2 == 0 ? value : -value);
  });
  return assembled<ConstraintRows>(rows.rows(), rows.cols(), entries);
}

/// \throws InputError when the distances are not as `initial` demands.
void requireAllowed(double least, double most, InitialGap initial, double shorter, const std::string& names) {
  const auto refuse = [&](const std::string& what, double by, const std::string& expected,
                          const std::string& fault = "") {
    throw InputError(names + what + digits(by, 6) + " as meshed, expected " + expected, fault);
  };
  const auto penetrate = [&](const std::string& expected) {
    refuse(" penetrate each other by ", -least, expected, "contact-penetration");
  };
  if (initial == InitialGap::asMeshed && least < -largestPenetration * shorter)
    penetrate("at most " + digits(largestPenetration * shorter, 6) +
              " (a hundredth of the shorter line); initial = \"close\" would let them touch");
  if (initial != InitialGap::reject) return;
  const std::string expected = "bodies that touch (initial = \"reject\")";
  if (least < -touchingInFile * shorter) penetrate(expected);
  if (most > touchingInFile * shorter) refuse(" are apart by up to ", most, expected);
}

}  // namespace

void refuseWithoutRows(const std::string& sides) {
  throw InputError(sides + " overlap at no nonmortar node, expected one across the mortar side: a finer " +
                       "nonmortar side, or the sides exchanged",
                   "contact-no-overlap");
}

ContactInterface::ContactInterface(const ContactPair& pair, const TriangleMesh& nonmortarMesh,
                                   const TriangleMesh& mortarMesh, const InterfaceOptions& options)
    : ContactInterface(pair, ContactMesh{nonmortarMesh, elementNodes(nonmortarMesh, 1)},
                       ContactMesh{mortarMesh, elementNodes(mortarMesh, 1)}, options) {}

ContactInterface::ContactInterface(const ContactPair& pair, const ContactMesh& nonmortarMesh,
                                   const ContactMesh& mortarMesh, const InterfaceOptions& options)
    : pair_(pair), friction_(options.friction), given_(options.gap), axisymmetric_(options.axisymmetric) {
  stabilised_ = options.stabilised;
  const BoundaryLine nonmortar = boundaryLine(nonmortarMesh.mesh, nonmortarMesh.nodes, pair.nonmortar.label);
  const BoundaryLine mortar = boundaryLine(mortarMesh.mesh, mortarMesh.nodes, pair.mortar.label);
  const std::string names = sidesText(pair, nonmortarMesh.mesh, mortarMesh.mesh);
  const double shorter = std::min(lengthOf(nonmortar), lengthOf(mortar));

  const std::vector<SmoothPart> parts = partsFacing(nonmortar, mortar);
  std::vector<CommonRefinement> facing;
  facing.reserve(parts.size());
  const MortarLine across(mortar);
  for (const SmoothPart& part : parts) facing.emplace_back(part, across);
  if (options.follows) {
    C1_.resize(0, 2 * static_cast<Eigen::Index>(nonmortarMesh.nodes.count()));
    C2_.resize(0, 2 * static_cast<Eigen::Index>(mortarMesh.nodes.count()));
    drawLines(nonmortar, mortar, options);
    follow(Vector::Zero(C1_.cols()), Vector::Zero(C2_.cols()));
  } else if (std::all_of(facing.begin(), facing.end(),
                         [](const CommonRefinement& each) { return each.empty(); })) {
    if (const double angle = angleBetween(parts, mortar); angle < 120)
      throw InputError(names + " do not face each other: their outward normals make an angle of " +
                       digits(angle, 6) + " degrees, expected 180, or 120 at least");
  } else {
    assemble(facing, nonmortarMesh, mortarMesh, options);
  }
  if (rows() == 0) refuseWithoutRows(names);
  if (!follows()) overlap_ /= shorter;
  for (const BoundaryLine* each : {&nonmortar, &mortar})
    polygonTurn_ = std::max(polygonTurn_, turnOfPolygon(each->points, each->closed, sharpTurn));
  mortarNodes_ = mortar.nodes;
  if (mortar.closed) mortarNodes_.pop_back();
  mortarNodes_.insert(mortarNodes_.end(), mortar.middleNodes.begin(), mortar.middleNodes.end());

  if (!options.gap) settleDistance(options.initial, shorter, names);
}

void ContactInterface::settleDistance(InitialGap initial, double shorter, const std::string& names) {
  std::vector<double> distances;
  for (int row = 0; row < rows(); ++row) {
    double& distance = distance_[row];
    if (std::abs(distance) < touching * shorter && !follows()) distance = 0;
    if (faces(row)) distances.push_back(distance);
  }
  if (distances.empty()) return;
  const auto [least, most] = std::minmax_element(distances.begin(), distances.end());
  requireAllowed(*least, *most, initial, shorter, names);
}

void ContactInterface::assemble(const std::vector<CommonRefinement>& facing, const ContactMesh& nonmortarMesh,
                                const ContactMesh& mortarMesh, const InterfaceOptions& options) {
  Entries entries;
  std::vector<double> distances;
  std::vector<double> lengths;
  std::vector<int> corners;
  const auto placeOf = [&](int node) { return asSpacePoint(nonmortarMesh.nodes.places[node]); };
  const auto givenOf = [&](int node) { return given_(placeOf(node), 0); };
  for (const CommonRefinement& refinement : facing) {
    if (refinement.empty()) continue;
    const SmoothPart& part = refinement.part();
    std::vector<char> merged = mergedNodes(refinement, pair_.coupling, options);
    heldEnds_ += static_cast<int>(std::count(merged.begin(), merged.end(), 1));
    mergeCorners(refinement, corners, merged);
    const DistanceAt distance = [&](int element, double s, const FacingPair& pair) {
      if (!options.gap)
        return options.initial == InitialGap::close ? 0.0 : distanceOfCurves(element, s, pair);
      const EdgeNodes nodes = part.nodesOf(element);
      double gap = 0;
      for (Eigen::Index j = 0; j < nodes.size(); ++j) gap += pair.phi[j] * givenOf(part.number(nodes[j]));
      return gap;
    };
    Coupling coupling =
        couple(pair_.coupling, refinement, distance, merged, axisymmetric_, {},
               {options.stabilised, options.mortarCompliance, merged, symmetricEnds(refinement, options)});
    if (options.gap) {  // it holds at the nodes
      Vector given(part.traceNodes());
      for (int j = 0; j < part.traceNodes(); ++j) given[j] = givenOf(part.number(j));
      coupling.distance = coupling.N * given;
    }
    const auto firstRow = static_cast<int>(nonmortarNodes_.size());
    std::vector<int> rowOf(coupling.nodes.size());
    std::iota(rowOf.begin(), rowOf.end(), firstRow);
    entries.add(coupling, refinement, rowOf);
    for (const int node : coupling.nodes) {
      nonmortarNodes_.push_back(part.number(node));
      normals_.push_back(asSpacePoint(refinement.directionAt(node)));
    }
    overlap_ += refinement.length();
    distances.insert(distances.end(), coupling.distance.begin(), coupling.distance.end());
    if (!options.gap && options.initial != InitialGap::close)
      sagitta_ = std::max(sagitta_, unknownSagitta(refinement));
    penetration_.add(refinement, distance, axisymmetric_);
    lengths.insert(lengths.end(), coupling.lengths.begin(), coupling.lengths.end());
    if (!distanceMoves()) continue;
    forEachEntry(coupling.N, [&](int row, int node, double value) {
      entries.given.emplace_back(firstRow + row, part.number(node), value);
    });
    for (int j = 0; j < part.traceNodes(); ++j)
      gapNodes_.emplace_back(part.number(j), placeOf(part.number(j)));
  }
  const auto n = static_cast<Eigen::Index>(nonmortarNodes_.size());
  C1_.resize(n, 2 * static_cast<Eigen::Index>(nonmortarMesh.nodes.count()));
  C2_.resize(n, 2 * static_cast<Eigen::Index>(mortarMesh.nodes.count()));
  setRows(entries);
  distance_ = Eigen::Map<const Vector>(distances.data(), n);
  lengths_ = Eigen::Map<const Vector>(lengths.data(), n);
  if (distanceMoves()) N_ = assembled(n, nonmortarMesh.nodes.count(), entries.given);
}

void ContactInterface::Entries::add(const Coupling& coupling, const CommonRefinement& refinement,
                                    const std::vector<int>& rowOf) {
  scatter(coupling.C1, refinement.part(), rowOf, nonmortar);
  scatter(coupling.C2, refinement.mortar(), rowOf, mortar);
  forEachEntry(coupling.mass, [&](int row, int column, double value) {
    mass.emplace_back(rowOf[row], rowOf[column], value);
  });
  const auto& [S, meansOf, spacing] = coupling.yielding;
  forEachEntry(S, [&, &to = compliance](int row, int column, double value) {
    to.emplace_back(rowOf[row], rowOf[column], value);
  });
  forEachEntry(meansOf, [&, &to = means](int row, int column, double value) {
    to.emplace_back(rowOf[row], rowOf[column], value);
  });
  forEachEntry(coupling.ends, [&, &to = ends](int row, int column, double value) {
    to.emplace_back(rowOf[row], rowOf[column], value);
  });
  for (Eigen::Index i = 0; i < spacing.size(); ++i) spacings.emplace_back(rowOf[i], spacing[i]);
}

void ContactInterface::setRows(const Entries& entries) {
  const auto n = static_cast<Eigen::Index>(nonmortarNodes_.size());
  C1_ = assembled<ConstraintRows>(n, C1_.cols(), entries.nonmortar);
  C2_ = assembled<ConstraintRows>(n, C2_.cols(), entries.mortar);
  mass_ = assembled(n, n, entries.mass);
  compliance_ = assembled(n, n, entries.compliance);
  fits_ = means_ = assembled(n, n, entries.means);
  ends_ = assembled(n, n, entries.ends);
  if (ends_.nonZeros() <= n) ends_ = {};
  weights_ = mass_ * Vector::Ones(n);
  if (ends_.size() > 0) weights_ = forcesAtEnds(ends_, weights_);
  mortarSpacing_ = Vector::Zero(n);
  for (const auto& [row, spacing] : entries.spacings) mortarSpacing_[row] = spacing;
  if (!friction_.any()) return;
  T1_ = turned(C1_);
  T2_ = turned(C2_);
}

Vector ContactInterface::givenAt(double t) const {
  Vector gap = Vector::Zero(N_.cols());
  for (const auto& [node, place] : gapNodes_) gap[node] = given_(place, t);
  return gap;
}

Vector ContactInterface::distance(double t) const {
  return distanceMoves() ? Vector(N_ * nodalGap(t)) : distance_;
}

Vector ContactInterface::gap(const Vector& uNonmortar, const Vector& uMortar, double t) const {
  return jump(uNonmortar, uMortar) - distance(t);
}

void ContactInterface::subtractForces(const Vector& p, Vector& fNonmortar, Vector& fMortar) const {
  fNonmortar -= C1_.transpose() * p;
  fMortar -= C2_.transpose() * p;
}

Vector ContactInterface::frictionBound(const Vector& p) const {
  // The weight of a quadratic node on the axis is zero but for rounding.
  return (friction_.coefficient * p + friction_.limit * weights()).cwiseMax(0);
}

void ContactInterface::subtractFriction(const Vector& t, Vector& fNonmortar, Vector& fMortar) const {
  fNonmortar -= T1_.transpose() * t;
  fMortar -= T2_.transpose() * t;
}

Vector ContactInterface::nodalPressure(const Vector& p) const {
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(mass_).solve(
      ends_.size() > 0 ? Vector(ends_.transpose() * p) : p);
}

Vector ContactInterface::contactPressure(const Vector& p) const {
  return stabilised_ && fits_.nonZeros() > 0 ? Vector(fits_ * nodalPressure(p)) : nodalPressure(p);
}

double ContactInterface::pressureRoughness(const Vector& p) const {
  if (means_.nonZeros() == 0 || !(p.maxCoeff() > 0)) return 0;
  const Vector pressure = nodalPressure(p);
  const Vector off = means_ * pressure - pressure;
  std::vector<char> inside(p.size(), 1);
  forEachEntry(means_, [&](int row, int column, double) {
    if (!(p[column] > 0)) inside[row] = 0;
  });
  double most = 0;
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if (inside[i] != 0 && p[i] > 0) most = std::max(most, std::abs(off[i]));
  return most / pressure.maxCoeff();
}

std::vector<GapSquare> ContactInterface::gapSquares(const Vector& p, const Vector& uNonmortar,
                                                    const Vector& uMortar, double t) const {
  std::vector<int> pressed;
  for (int row = 0; row < rows(); ++row)
    if (p[row] > 0) pressed.push_back(nonmortarNodes_[row]);
  std::sort(pressed.begin(), pressed.end());
  const auto presses = [&](int vertex) { return std::binary_search(pressed.begin(), pressed.end(), vertex); };
  return penetration_.squares(uNonmortar, uMortar, presses, nodalGap(t));
}

}  // namespace mortier
