#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/digits.h"
#include "base/printable.h"
#include "lint/lint.h"
#include "mesh/boundary_line.h"
#include "mesh/triangle_mesh.h"
#include "scene/resolve.h"

namespace mortier {
namespace {

using Kind = SampledDatum::Kind;

/// The `file:line` with which the messages about an expression begin.
std::string placeOf(const Expression& expression) {
  return expression.where.substr(0, expression.where.find(": "));
}

void checkDatum(const LintInput& input, const SampledDatum& datum, Faults& faults) {
  constexpr double large = 0.2;
  const BodyDescription& body = input.scene.bodies[datum.body];
  const std::string subject = "body " + body.name + ": ";
  const std::string& length = input.scene.units.length;
  if (datum.kind == Kind::displacement) {
    const double most = datum.largestIn(input.scene.time);
    if (body.isTool()) return;  // it does not strain
    if (most > large * datum.size && !isFollowed(input.scene, body.name))
      faults.add("large-displacement", placeOf(*datum.value),
                 subject + "a displacement of " + digits(most, 4) + " " + length +
                     " is prescribed on a body of " + digits(datum.size, 4) + " " + length);
  } else if ((datum.kind == Kind::traction || datum.kind == Kind::force) && mayFlow(body) &&
             datum.largest(0) > 0) {
    faults.add("initial-load", placeOf(*datum.value),
               subject + "a load of " + digits(datum.largest(0), 4) + " " +
                   (datum.kind == Kind::force ? input.scene.units.bodyForce() : input.scene.units.stress) +
                   " acts at t = 0: it comes at once, the body responds elastically before it flows");
  }
}

/// Whether a condition of its own label holds an edge along an axis: the node in its middle too.
bool holdsEdge(const std::vector<ConditionDescription>& conditions, int label, const Point& from,
               const Point& to, std::optional<int> axis) {
  return std::any_of(conditions.begin(), conditions.end(), [&](const ConditionDescription& c) {
    return c.kind == ConditionDescription::Kind::displacement && c.actsOn(label) &&
           axisOf(c.component, from, to) == axis;
  });
}

/// A traction that acts on held nodes only.
void checkHeldLoads(const LintInput& input, size_t b, Faults& faults) {
  const TriangleMesh& mesh = *input.meshes[b];
  const auto& conditions = input.scene.bodies[b].conditions;
  const std::vector<char> held = heldDofs(mesh, conditions);
  for (const ConditionDescription& c : conditions) {
    if (c.kind != ConditionDescription::Kind::traction || c.point) continue;
    const auto edges = sidesWith(mesh, c.label);
    bool all = !edges.empty();
    for (const auto& [from, to] : edges) {
      const auto axis = axisOf(c.component, mesh.vertices[from], mesh.vertices[to]);
      for (const int v : {from, to}) all = all && axis && held[2 * v + *axis] != 0;
      if (input.scene.degree > 1)
        all = all && holdsEdge(conditions, c.label, mesh.vertices[from], mesh.vertices[to], axis);
    }
    if (all)
      faults.add("load-on-support", c.where,
                 "body " + input.scene.bodies[b].name + ": every node of " + labelText(mesh, c.label) +
                     " is held in the direction of its traction");
  }
}

/// The first of some times, and how many there are beside it.
std::string firstOf(const std::vector<double>& times) {
  return shortest(times.front()) +
         (times.size() > 1 ? " and at " + counted(times.size() - 1, "more time") : "");
}

/// A message for all kinks of a datum: a table may have any number of them.
void checkKinks(const LintInput& input, const SampledDatum& datum, Faults& faults) {
  constexpr double onStep = 1e-6;
  constexpr size_t longest = 120;
  const TimePlan& time = input.scene.time;
  if (time.controlled()) return;
  const double step = time.step();
  const std::vector<double>& breaks = datum.value->breaks;
  const std::string subject =
      (breaks.empty() ? "\"" + printable(datum.value->text, longest) + "\"" : std::string("the table")) +
      " changes at t = ";
  std::vector<double> between;
  const Formulas* formula = datum.value->formula.get();
  for (const double kink : formula != nullptr ? kinksInTime(*formula) : breaks) {
    const double passed = (kink - time.begin) / step;
    if (passed > 0 && kink <= time.end * (1 + onStep) && std::abs(passed - std::round(passed)) > onStep)
      between.push_back(kink);
  }
  if (!between.empty())
    faults.add("kink-between-steps", placeOf(*datum.value),
               subject + firstOf(between) + ", within a step: steps are " + shortest(step) + " " +
                   input.scene.units.time + " long");
}

}  // namespace

void lintLoads(const LintInput& input, Faults& faults) {
  const std::vector<SampledDatum> data = sampledData(input);
  bool any = false;
  bool complete = true;
  for (const SampledDatum& datum : data) {
    checkDatum(input, datum, faults);
    checkKinks(input, datum, faults);
    any = any || changesInTime(datum, input.scene.time) ||
          (datum.kind != Kind::distance && datum.largest(0) > 0);
  }
  for (size_t b = 0; b < input.meshes.size(); ++b) {
    complete = complete && input.meshes[b] != nullptr;
    if (input.meshes[b] != nullptr && !input.scene.bodies[b].isTool()) checkHeldLoads(input, b, faults);
  }
  if (!complete) return;
  // What presses or stresses bodies from the start.
  constexpr double noticeable = 1e-6;
  for (size_t k = 0; k < input.interference.size(); ++k) {
    const auto body = static_cast<size_t>(bodyIndex(input.scene, input.scene.contacts[k].nonmortar().body));
    any = any || input.interference[k] > noticeable * extent(*input.meshes[body]);
  }
  for (const BodyDescription& body : input.scene.bodies) {
    const auto given = [](const StressDescription& stress) {
      return std::any_of(stress.begin(), stress.end(), [](const auto& part) { return part.has_value(); });
    };
    any = any || given(body.initialStress) ||
          std::any_of(body.regions.begin(), body.regions.end(),
                      [&](const RegionDescription& region) { return given(region.initialStress); });
  }
  if (!any && !input.scene.goesOn())
    faults.add(
        "no-load", input.where({"body"}),
        "no traction, body force, prescribed displacement, temperature, interference or initial stress is "
        "other than 0");
}

void lintTime(const LintInput& input, Faults& faults) {
  constexpr double loose = 1e-6;
  constexpr double large = 4e9;  // bytes
  const SceneDescription& scene = input.scene;
  const bool equalSteps = !scene.time.controlled();
  if (scene.solver.tolerance > loose)
    faults.add("tolerance-loose", input.where({"solver", "tolerance"}),
               "tolerance = " + shortest(scene.solver.tolerance) + " shows in the results");
  // Numbers that a node and a triangle have in a file of fields; by Euler's formula a mesh has about as many
  // edges, each with a node of quadratic displacements, as vertices and triangles together.
  constexpr double ofNode = 6;
  const bool quadratic = scene.degree > 1;
  const double ofTriangle = quadratic ? 21.5 : 11;
  double bytes = 0;
  for (const TriangleMesh* mesh : input.meshes) {
    if (mesh == nullptr) continue;
    const auto vertices = static_cast<double>(mesh->vertices.size());
    const auto triangles = static_cast<double>(mesh->triangles.size());
    const double nodes = quadratic ? 2 * vertices + triangles : vertices;
    bytes += sizeof(double) * (ofNode * nodes + ofTriangle * triangles);
  }
  const int kept = equalSteps && scene.every > 0 ? 1 + scene.time.steps / scene.every : 1;
  if (bytes * kept > large)
    faults.add("output-large", input.where({"output", "every"}),
               std::to_string(kept) + " kept states, about " + shortest(std::round(bytes * kept / 1e8) / 10) +
                   " GB in all");
}

}  // namespace mortier
