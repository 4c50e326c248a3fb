#include <algorithm>
#include <cmath>

#include "base/digits.h"
#include "base/error.h"
#include "contact/sliding.h"
#include "lint/lint.h"
#include "mesh/boundary_line.h"
#include "mesh/triangle_mesh.h"
#include "plan/estimate_doubts.h"
#include "scene/build.h"
#include "scene/memory_need.h"
#include "scene/resolve.h"

namespace mortier {
namespace {

/// A side of a contact, as far as its mesh is known.
struct Side {
  const SideDescription* description = nullptr;
  size_t body = 0;
  const TriangleMesh* mesh = nullptr;
  Point normal{0,
               0};  ///< sum of the outward normals times lengths, over the length: shorter than 1 where bent
  Point first{0, 0};
  double length = 0;
  int edges = 0;
};

Side sideOf(const LintInput& input, const SideDescription& description, int label) {
  Side side;
  side.description = &description;
  side.body = static_cast<size_t>(bodyIndex(input.scene, description.body));
  side.mesh = input.meshes[side.body];
  if (side.mesh == nullptr) return side;
  for (const auto& [a, b] : sidesWith(*side.mesh, label)) {
    const Point along = side.mesh->vertices[b] - side.mesh->vertices[a];
    if (side.edges++ == 0) side.first = side.mesh->vertices[a];
    side.normal += Point(along.y(), -along.x());
    side.length += along.norm();
  }
  if (side.length > 0) side.normal /= side.length;
  return side;
}

std::string name(const Side& side) {
  return labelText(*side.mesh, side.description->label) + " of body " + side.description->body;
}

/// Whether both sides have a direction of their own; a closed line has none.
bool directed(const Side& a, const Side& b) {
  constexpr double bent = 0.5;
  return a.normal.norm() > bent && b.normal.norm() > bent;
}

bool faces(const Side& a, const Side& b) {
  constexpr double opposite = -0.9;
  return a.edges > 0 && b.edges > 0 && directed(a, b) &&
         a.normal.normalized().dot(b.normal.normalized()) < opposite;
}

/// The pair of labels of these bodies that face each other at the least distance, for a remedy.
std::string facingPair(const LintInput& input, const Side& a, const Side& b) {
  double least = INFINITY;
  std::string pair;
  for (const int i : boundaryLabels(*a.mesh))
    for (const int j : boundaryLabels(*b.mesh)) {
      const Side one = sideOf(input, *a.description, i);
      const Side two = sideOf(input, *b.description, j);
      if (!faces(one, two)) continue;
      const double distance = (two.first - one.first).dot(one.normal.normalized());
      const double tolerance = 1e-6 * std::min(one.length, two.length);
      if (distance < -tolerance || distance >= least) continue;
      least = distance;
      pair = labelText(*a.mesh, i) + " of body " + a.description->body + " faces " + labelText(*b.mesh, j) +
             " of body " + b.description->body;
    }
  return pair.empty() ? "no labels of these bodies face each other" : pair;
}

ContactInterface interfaceOf(const ContactDescription& contact, const Side& one, const Side& two,
                             bool swapped) {
  const ContactSide first{static_cast<int>(one.body),
                          swapped ? contact.mortar().label : contact.nonmortar().label};
  const ContactSide second{static_cast<int>(two.body),
                           swapped ? contact.nonmortar().label : contact.mortar().label};
  InterfaceOptions options;
  options.follows = contact.sliding == SlidingKind::finite;
  return {{first, second, contact.variant}, *one.mesh, *two.mesh, options};
}

bool fits(const ContactDescription& contact, const Side& one, const Side& two, bool swapped) {
  try {
    static_cast<void>(interfaceOf(contact, one, two, swapped));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Why the interface cannot be made: the fault behind the message of its constructor.
void diagnose(const LintInput& input, const ContactDescription& contact, const Side& one, const Side& two,
              const InputError& found, Faults& faults) {
  const std::string both = name(one) + " and " + name(two);
  for (const Side* side : {&one, &two}) {
    try {
      static_cast<void>(boundaryLine(*side->mesh, side->description->label));
    } catch (const InputError& error) {
      faults.add("contact-line", side->description->where, error.what());
      return;
    }
  }
  if (contact.nonmortar().label != contact.mortar().label && fits(contact, one, two, true)) {
    faults.add("contact-labels-swapped", contact.where,
               both + " do not meet, with their labels exchanged they do");
    return;
  }
  if (directed(one, two) && !faces(one, two)) {
    const bool same = one.normal.dot(two.normal) > 0.5;
    faults.add(same ? "contact-normals" : "contact-not-facing", contact.where,
               both + (same ? " look the same way" : " do not face each other") + "; " +
                   facingPair(input, one, two));
    return;
  }
  if (found.fault() == "contact-no-overlap")
    faults.add(found.fault(), contact.where,
               both + " face each other nowhere: no normal of the nonmortar side meets the mortar side");
  else
    faults.add(found.fault().empty() ? "contact-line" : found.fault(), contact.where, found.what());
}

void compareMeshes(const LintInput& input, const ContactDescription& contact, const Side& one,
                   const Side& two, Faults& faults) {
  const SceneDescription& scene = input.scene;
  constexpr double different = 10;
  constexpr double coarser = 4;
  constexpr double softer = 2;
  const double h1 = one.length / one.edges;
  const double h2 = two.length / two.edges;
  const double ratio = h1 / h2;
  if (std::max(ratio, 1 / ratio) > different)
    faults.add("contact-size-ratio", contact.where,
               "edges of " + name(one) + " are " + digits(h1, 4) + " " + scene.units.length +
                   " long, those of " + name(two) + " " + digits(h2, 4) + " " + scene.units.length);
  else if (ratio > coarser &&
           (contact.variant == CouplingKind::interpolation ||
            stiffnessRatio(scene, contact.mortar(), contact.nonmortar(), input.meshes) <= softer))
    faults.add("nonmortar-coarser", contact.nonmortar().where,
               "edges of the nonmortar side are " + shortest(std::round(10 * ratio) / 10) +
                   " times as long as those of the mortar side");
}

/// Of random sheared blocks with mu up to 1 none has several solutions, of those above a few in a thousand.
void checkFriction(const ContactDescription& contact, Faults& faults) {
  constexpr double large = 1;
  if (contact.friction.coefficient > large)
    faults.add("friction-large", contact.where,
               "friction = " + shortest(contact.friction.coefficient) +
                   ": above 1 several equilibria may exist; the run returns one");
}

void checkConditions(const LintInput& input, const ContactDescription& contact,
                     const ContactInterface& interface, Faults& faults) {
  using Kind = ConditionDescription::Kind;
  for (const SideDescription* side : {&contact.nonmortar(), &contact.mortar()}) {
    const BodyDescription& body = input.scene.bodies[bodyIndex(input.scene, side->body)];
    const TriangleMesh& mesh = *input.meshes[bodyIndex(input.scene, side->body)];
    for (const ConditionDescription& c : body.conditions) {
      const std::string what = nameOfPlace(c) + " of body " + body.name;
      if (c.actsOn(side->label)) {
        if (c.kind == Kind::traction)
          faults.add("load-on-contact", c.where, what + " is in contact and carries a traction");
        else if (side == &contact.nonmortar())
          faults.add("support-on-contact", c.where, what + " is the nonmortar side and is held");
        continue;
      }
      // A held node with a contact condition of its own: its normal motion is given twice. The mortar
      // coupling gives the condition to its neighbour.
      if (c.kind != Kind::displacement || side != &contact.nonmortar() ||
          contact.variant != CouplingKind::interpolation)
        continue;
      int node = -1;
      const auto isNonmortar = [&](int v, int axis) {
        for (int row = 0; row < interface.rows(); ++row)
          if (interface.nonmortarNodes()[row] == v && interface.normals()[row][axis] != 0) return true;
        return false;
      };
      if (c.point) {
        const int v = vertexAt(mesh, *c.point);
        if (v >= 0 && isNonmortar(v, c.component)) node = v;
      }
      for (const auto& [a, b] : c.point ? std::vector<std::array<int, 2>>() : sidesWith(mesh, c.label)) {
        const auto axis = axisOf(c.component, mesh.vertices[a], mesh.vertices[b]);
        for (const int v : {a, b})
          if (axis && isNonmortar(v, *axis)) node = v;
      }
      if (node >= 0)
        faults.add("contact-meets-support", c.where,
                   what + " holds vertex " + std::to_string(node + 1) +
                       " along the normal of contact, of which it is a nonmortar node");
    }
  }
}

void checkInterface(const ContactDescription& contact, const Side& one, const Side& two,
                    const ContactInterface& interface, bool tool, double smallerExtent,
                    const std::string& length, Faults& faults) {
  constexpr double tiny = 0.25;
  constexpr double large = 0.5;
  const double gap = interface.initialDistance().minCoeff();
  const bool comes = contact.sliding == SlidingKind::finite;  // bodies may come to face each other
  if (interface.overlap() < tiny && !comes)
    faults.add("contact-overlap", contact.where,
               name(one) + " and " + name(two) + " face each other over " +
                   shortest(std::round(1000 * interface.overlap()) / 1000) + " of the shorter one");
  if (const std::string doubt = doubtOfPolygons(interface, length);
      !doubt.empty() && !contact.gap && contact.initial != InitialGap::close)
    faults.add("contact-polygon", contact.where, doubt);
  if (gap > large * smallerExtent && !comes)
    faults.add("gap-large", contact.where,
               "the bodies are at least " + digits(gap, 4) + " " + length + " apart, the smaller one is " +
                   digits(smallerExtent, 4) + " " + length + " wide");
  if (contact.variant == CouplingKind::interpolation && !tool && !meshesMatch(interface))
    faults.add("interpolation-unmatched", contact.where,
               "interpolation on meshes that do not match has an error of order one along the contact line");
}

/// What the prescribed rotation of a tool moves its vertices by at a time; zero of a body (dofs) [m].
Vector turnOf(const LintInput& input, const SideDescription& side, double t) {
  const auto b = static_cast<size_t>(bodyIndex(input.scene, side.body));
  const BodyDescription& body = input.scene.bodies[b];
  const std::vector<Point>& x = input.meshes[b]->vertices;
  Vector u = Vector::Zero(2 * static_cast<Eigen::Index>(x.size()));
  for (const ConditionDescription& c : body.conditions)
    if (body.isTool() && c.turns() && c.kind == ConditionDescription::Kind::displacement)
      for (size_t v = 0; v < x.size(); ++v)
        u.segment<2>(2 * static_cast<Eigen::Index>(v)) =
            c.value.value(0, 0, t) * turned(Point(x[v] - body.reference->head<2>()));
  return u;
}

/// Whether supports slide bodies that touch along each other by more than contact takes into account. Their
/// motion is taken as a rigid one of the nonmortar body.
void checkSliding(const LintInput& input, const ContactDescription& contact, const Side& one, const Side& two,
                  const ContactInterface& interface, Faults& faults) {
  constexpr double touching = 1e-9;
  constexpr double noticeable = 0.5;  // as the log says it
  const ElementNodes nodes1 = elementNodes(*one.mesh, 1);
  const ElementNodes nodes2 = elementNodes(*two.mesh, 1);
  Sliding worst;
  for (const double t : trialTimes(input.scene.time)) {
    const Point by = supportedMotion(input, contact, t);
    const Vector turns = turnOf(input, contact.mortar(), t);
    if (by.isZero(0) && turns.isZero(0)) continue;
    const Vector u = by.replicate(interface.C1().cols() / 2, 1);
    Vector gap = interface.jump(u, turns);
    if (contact.initial != InitialGap::close) gap -= interface.initialDistance();
    const Vector pressed = (gap.array() >= -touching * one.length).cast<double>();
    const Sliding here = slidingOf(interface, {*one.mesh, nodes1}, {*two.mesh, nodes2}, u, turns, pressed);
    if (here.edges > worst.edges) worst = here;
  }
  const bool past = worst.past >= 0 && contact.sliding == SlidingKind::refuse;
  if (!past && !(worst.edges > noticeable)) return;
  faults.add(
      "contact-slides", contact.where,
      "supports move " + name(one) + " by " + digits(worst.slip, 4) + " " + input.scene.units.length +
          " along " + name(two) +
          (past ? std::string(", past its end")
                : ", " + shortest(std::round(10 * worst.edges) / 10) + " times the length of an edge"));
}

}  // namespace

void lintContacts(const LintInput& input, Faults& faults) {
  const auto isTool = [&](const ContactDescription& contact) {
    return input.scene.bodies[bodyIndex(input.scene, contact.mortar().body)].isTool();
  };
  for (size_t k = 0; k < input.scene.contacts.size(); ++k) {
    const ContactDescription& contact = input.scene.contacts[k];
    for (size_t j = 0; j < k; ++j)
      for (const SideDescription* a : {&contact.nonmortar(), &contact.mortar()})
        for (const SideDescription* b :
             {&input.scene.contacts[j].nonmortar(), &input.scene.contacts[j].mortar()})
          if (a->body == b->body && a->label == b->label && !isTool(contact) &&
              !isTool(input.scene.contacts[j]))
            faults.add(
                "contact-side-twice", a->where,
                name(sideOf(input, *a, a->label)) + " is a side of another contact too, at " + b->where);
    const Side one = sideOf(input, contact.nonmortar(), contact.nonmortar().label);
    const Side two = sideOf(input, contact.mortar(), contact.mortar().label);
    if (one.edges == 0 || two.edges == 0) continue;  // named elsewhere
    if (!refinesMeshes(input.scene) && !isTool(contact)) compareMeshes(input, contact, one, two, faults);
    const ContactPair pair{{0, contact.nonmortar().label}, {1, contact.mortar().label}, contact.variant};
    checkFriction(contact, faults);
    const MemoryNeed need = memoryNeed({one.mesh, two.mesh}, {pair}, input.scene.degree,
                                       {contact.friction.any()}, input.scene.solver);
    if (need.all > availableMemory()) continue;  // buildModel reports it
    try {
      const ContactInterface interface = interfaceOf(contact, one, two, false);
      checkInterface(contact, one, two, interface, isTool(contact),
                     std::min(extent(*one.mesh), extent(*two.mesh)), input.scene.units.length, faults);
      checkConditions(input, contact, interface, faults);
      if (contact.sliding != SlidingKind::finite) checkSliding(input, contact, one, two, interface, faults);
      lintApproach(input, contact, interface, faults);
    } catch (const InputError& error) {
      diagnose(input, contact, one, two, error, faults);
    }
  }
}

}  // namespace mortier
