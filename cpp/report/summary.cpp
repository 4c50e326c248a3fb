#include "report/log.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/error.h"
#include "material/stress.h"
#include "report/clock.h"
#include "report/fields.h"
#include "time/measure.h"

namespace mortier {

namespace {

using Json = nlohmann::ordered_json;

/// JSON has no word for NaN; nlohmann would write null.
void requireFiniteNumbers(const Json& json, const std::string& path) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw OutputError(path + " is not finite; the run is not valid");
  if (json.is_structured())
    for (const auto& [key, value] : json.items())
      requireFiniteNumbers(value, std::string(path).append(": ").append(key));
}

Json finiteOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json laws(const Material& material) {
  Json list = Json::array();
  for (const LawDescription& law : material.laws()) {
    list.push_back({{"law", law.text()}});
    for (const LawDescription::Parameter& each : law.parameters) list.back()[each.name] = each.value;
  }
  return list;
}

Json bodies(const Model& model) {
  Json list = Json::array();
  for (const Body& body : model.bodies)
    list.push_back({{"name", body.name()},
                    {"material", lawsOf(body)},
                    {"laws", body.rigid() ? Json::array() : laws(body.material())},
                    {body.elementsWord(), body.elements()},
                    {"nodes", body.nodes()},
                    {"dofs", body.dofs()},
                    {"free_dofs", body.freeDofs()}});
  return list;
}

/// [x, y], in space [x, y, z].
Json jsonOf(const SpacePoint& vector, int dimension) {
  Json json = {vector.x(), vector.y()};
  if (dimension == 3) json.push_back(vector.z());
  return json;
}

Json interfaces(const RunFacts& facts, const Model& model, const State& state) {
  Json list = Json::array();
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const SpacePoint force = resultant(model, state, k);
    const int dimension = interface.dimension();
    const Sliding sliding = slidingOf(model, state, k);
    list.push_back({{"variant", facts.variants[k]},
                    {"nonmortar", model.bodies[interface.pair().nonmortar.body].name()},
                    {"mortar", model.bodies[interface.pair().mortar.body].name()},
                    {"nonmortar_nodes", interface.nonmortarNodes().size()},
                    {"mortar_nodes", interface.mortarNodes().size()},
                    {"overlap", interface.overlap()},
                    {"sagitta", interface.sagitta()},
                    {"resultant", jsonOf(force, dimension)},
                    {"sliding", {{"slip", sliding.slip}, {"edges", sliding.edges}}},
                    {"held_ends", interface.heldEnds()}});
    if (!interface.hasFriction()) continue;
    list.back()["friction_work"] = state.frictionWorkOf[k];
    if (model.bodies[interface.pair().nonmortar.body].axisymmetric()) continue;
    const SpacePoint couple = frictionCouple(model, state, k);
    list.back()["couple"] = dimension == 2 ? Json(couple.z()) : jsonOf(couple, dimension);
  }
  return list;
}

Json ties(const RunFacts& facts, const Model& model, const State& state) {
  Json list = Json::array();
  for (size_t k = 0; k < model.ties.size(); ++k) {
    const Tie& tie = model.ties[k];
    const ContactPair& pair = tie.pair();
    const Vector forces = -(tie.sides().front().C.transpose() * state.tieForce[k]);
    SpacePoint sum = SpacePoint::Zero();
    for (Eigen::Index dof = 0; dof < forces.size(); ++dof) sum[dof % tie.dimension()] += forces[dof];
    list.push_back({{"variant", facts.ties[k]},
                    {"nonmortar", model.bodies[pair.nonmortar.body].name()},
                    {"mortar", model.bodies[pair.mortar.body].name()},
                    {"nonmortar_nodes", tie.nonmortarNodes().size()},
                    {"overlap", tie.overlap()},
                    {"distance", tie.distance()},
                    {"resultant", jsonOf(sum, tie.dimension())}});
  }
  return list;
}

Json rounds(const RunFacts& facts, const char* elements) {
  Json list = Json::array();
  for (const RoundFacts& round : facts.rounds)
    list.push_back({{elements, round.elements},
                    {"unknowns", round.unknowns},
                    {"steps", round.steps},
                    {"mesh", finiteOrNull(round.mesh)},
                    {"time", round.time},
                    {"seconds", round.seconds}});
  return list;
}

Json finalState(const Model& model, const State& state, const StepReport& last) {
  Point vonMises(infinity, -infinity);
  const int dimension = model.bodies.front().dimension();
  SpacePoint least = SpacePoint::Constant(infinity);
  SpacePoint largest = -least;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Matrix& stress = state.bodies[b].stress;
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      const double value =
          mortier::vonMises(stress.col(i).head(model.bodies[b].material().tensorComponents()));
      vonMises = {std::min(vonMises[0], value), std::max(vonMises[1], value)};
    }
    const Vector moved = model.bodies[b].moved(state.bodies[b].displacement);
    const Eigen::Map<const Matrix> u(moved.data(), dimension, model.bodies[b].nodes());
    least.head(dimension) = least.head(dimension).cwiseMin(u.rowwise().minCoeff());
    largest.head(dimension) = largest.head(dimension).cwiseMax(u.rowwise().maxCoeff());
  }
  Json json = {{"time", state.time},
               {"von_mises_min", vonMises[0]},
               {"von_mises_max", vonMises[1]},
               {"interpenetration", last.penetration},
               {"displacement_min", jsonOf(least, dimension)},
               {"displacement_max", jsonOf(largest, dimension)},
               {"contact_force", last.contactForce},
               {"contact_resultant",
                jsonOf({last.resultantX, last.resultantY, last.resultantZ.value_or(0)}, dimension)},
               {"elastic_energy", last.energy},
               {"max_pressure", last.maxPressure},
               {"viscoplastic_fraction", last.viscoplasticFraction},
               {"active_nodes", last.active}};
  if (anyFriction(model)) json["friction_work"] = state.frictionWork;
  if (anyDistanceMoves(model)) json["gap_work"] = state.gapWork;
  return json;
}

Json jsonOf(const Peaks& peaks) {
  const auto of = [](const Peak& peak) { return Json{{"value", peak.value}, {"time", peak.time}}; };
  Json json = {{"von_mises", of(peaks.vonMises)},         {"pressure", of(peaks.pressure)},
               {"contact_force", of(peaks.contactForce)}, {"displacement", of(peaks.displacement)},
               {"elastic_energy", of(peaks.energy)},      {"sliding", of(peaks.sliding)}};
  if (peaks.strain.value > 0) {  // contact follows the bodies
    json["strain"] = of(peaks.strain);
    json["rotation"] = of(peaks.rotation);
  }
  return json;
}

Json jsonOf(const BodyOverlap& overlap, int dimension) {
  Json json = {{"depth", overlap.depth}, {"area", overlap.area}, {"explained", overlap.explained}};
  if (!(overlap.depth > 0)) return json;
  json["at"] = jsonOf(overlap.place, dimension);
  json["time"] = overlap.time;
  for (const int k : {0, 1})
    json["between"].push_back({{"body", overlap.bodies[k]}, {"label", overlap.labels[k]}});
  return json;
}

Json jsonOf(const QuantityRange& range) {
  return {{"start", range.start},
          {"smallest", {{"value", range.smallest}, {"time", range.smallestTime}}},
          {"largest", {{"value", range.largest}, {"time", range.largestTime}}}};
}

Json jsonOf(const std::vector<SeveralSolutions>& several) {
  Json list = Json::array();
  for (const SeveralSolutions& step : several) {
    Json solutions = Json::array();
    for (const ListedSolution& each : step.listed)
      solutions.push_back({{"index", each.index},
                           {"residual", each.residual},
                           {"contact_force", each.contact},
                           {"friction_force", each.friction},
                           {"sets", each.sets}});
    list.push_back({{"step", step.step}, {"time", step.time}, {"solutions", std::move(solutions)}});
  }
  return list;
}

/// Where to look at, and why it is hard there.
Json jsonOf(const StuckPlace& stuck, const RunFacts& facts, const Model& model) {
  return {{"body", model.bodies[stuck.body].name()},
          {model.bodies[stuck.body].dimension() == 3 ? "tetrahedron" : "triangle", stuck.triangle},
          {"at", jsonOf(stuck.at, model.bodies[stuck.body].dimension())},
          {"material_residual", stuck.residual},
          {"time", stuck.time},
          {"driven_by", facts.driving}};
}

Json jsonOf(const RunFacts& facts, const Model& model, const Accuracy& accuracy) {
  Json bodies = Json::object();
  for (size_t b = 0; b < model.bodies.size(); ++b) bodies[model.bodies[b].name()] = accuracy.bodies[b];
  Json json = {{"energy_error", accuracy.all},
               {"bodies", std::move(bodies)},
               {"largest_of_run", {{"energy_error", accuracy.largest}, {"time", accuracy.largestTime}}},
               {"not_reliable", facts.doubts}};
  if (!accuracy.worstBody.empty())
    json["largest"] = {{"body", accuracy.worstBody},
                       {"at", jsonOf(accuracy.worst, model.bodies.front().dimension())}};
  if (accuracy.bound) json["bound"] = jsonOfBound<Json>(*accuracy.bound);
  return json;
}

}  // namespace

std::string summaryText(const std::string& path, const RunFacts& facts, const Model& model,
                        const Solved& solved) {
  const auto& [state, last, report, accuracy, files] = solved;
  const Json bodyList = bodies(model);
  Json json;
  json["scene"] = facts.scene;
  json["title"] = facts.title;
  if (facts.units.given)
    json["units"] = {{"length", facts.units.length},
                     {"force", facts.units.force},
                     {"stress", facts.units.stress},
                     {"time", facts.units.time}};
  json["plane"] = facts.plane;
  json["settings"] = facts.settings;
  json["status"] = word(report.status);
  if (report.status != Status::converged)
    json["reason"] = report.reason;
  else if (!report.shortfall.empty() && !(facts.accuracy > 0))
    json["reason"] = report.shortfall;
  if (report.stuck) json["stuck"] = jsonOf(*report.stuck, facts, model);
  json["contact"] = facts.contact;
  json["nonmortar"] = facts.nonmortar;
  json["projection"] = facts.projection;
  json["scheme"] = facts.scheme;
  if (!facts.start.empty()) json["start"] = {{"result", facts.start}, {"time", facts.startTime}};
  const int dimension = model.bodies.front().dimension();
  const char* elements = model.bodies.front().elementsWord();
  for (const char* count : {elements, "nodes", "dofs", "free_dofs"})
    json[count] = std::accumulate(bodyList.begin(), bodyList.end(), size_t{0},
                                  [&](size_t sum, const Json& body) { return sum + size_t(body[count]); });
  json["bodies"] = bodyList;
  json["interfaces"] = interfaces(facts, model, state);
  if (!model.ties.empty()) json["ties"] = ties(facts, model, state);
  json["steps"] = report.steps;
  if (facts.tolerance > 0) {
    json["tolerance"] = facts.tolerance;
    json["pilot_iterations"] = report.pilotIterations;
  } else {
    json["planned_steps"] = facts.plannedSteps;
  }
  json["rejected_attempts"] = report.rejected;
  json["guarded_steps"] = report.guarded;
  json["newton_iterations"] = report.iterations;
  json["max_iterations_in_a_step"] = report.maxIterationsInAStep;
  json["factorisations"] = report.factorisations;
  json["rungs"] = report.rungs;
  json["contact_matrices"] = solvesSparse(model, facts.solver) ? "sparse" : "dense";
  json["idle_conditions"] = report.special.idle;
  json["dependent_conditions"] = report.special.dependent;
  json["threads"] = facts.threads;
  json["solve_time_s"] = report.solveSeconds;
  json["final"] = finalState(model, state, last);
  json["verification"] = {{"force_balance", report.worst.forceBalance},
                          {"material_residual", report.worst.materialResidual},
                          {"gap_on_active", report.worst.gapOnActive},
                          {"open_penetration", report.worst.openPenetration},
                          {"sign", report.worst.sign},
                          {"complementarity", report.worst.complementarity},
                          {"rounding", report.worst.rounding}};
  if (anyFriction(model)) {
    json["verification"]["friction"] = report.worst.friction;
    json["ambiguous_steps"] = report.ambiguousSteps;
    if (facts.solver.listSolutions) json["several_solutions"] = jsonOf(report.several);
  }
  json["overlap"] = jsonOf(report.overlap, dimension);
  json["peaks"] = jsonOf(report.peaks);
  const std::vector<double> values = evaluate(facts.quantities, model, state);
  for (size_t i = 0; i < values.size(); ++i) {
    Json& quantity = json["quantities"][facts.quantities[i].name];
    quantity = {{"value", values[i]}, {"unit", facts.quantities[i].unit(facts.units)}};
    const QuantityError error = errorOf(facts, accuracy, i);
    quantity["estimated_error"] = error.obstacle.empty() ? Json(error.size) : Json(nullptr);
    if (!error.obstacle.empty()) quantity["no_estimate"] = error.obstacle;
    if (const auto place = placeOf(facts.quantities[i], model, state))
      quantity["at"] = jsonOf(*place, dimension);
    if (error.order > 0) quantity["unbounded_order"] = error.order;
    if (i < report.quantities.size()) quantity.update(jsonOf(report.quantities[i]));
    const std::optional<RoundChange> change = changeInRounds(facts, i);
    quantity["change_in_last_round"] = change ? Json(change->size) : Json(nullptr);
    if (change && change->grows) quantity["grows_with_rounds"] = true;
    if (accuracy.bound) quantity["bound"] = jsonOfBound<Json>(*accuracy.bound, i, values[i]);
  }
  Json& errors = json["accuracy"] = jsonOf(facts, model, accuracy);
  if (facts.tolerance > 0) {
    errors["time"] = report.timeError;
    errors["time_reached"] = report.status == Status::converged && report.shortfall.empty();
  }
  if (facts.accuracy > 0) {
    errors["asked"] = facts.accuracy;
    if (!facts.aim.empty()) errors["quantity"] = facts.aim;
    errors["reached"] = facts.reached;
    errors["mesh"] = finiteOrNull(facts.rounds.empty() ? accuracy.largest : facts.rounds[facts.best].mesh);
    if (!facts.rounds.empty()) errors["round"] = facts.best + 1;
    errors["time"] = report.timeError;
    json["rounds"] = rounds(facts, elements);
  }
  json["peak_memory_mib"] = peakMemory();
  json["wall_time_s"] = processSeconds();
  if (facts.processes > 0) json["processes"] = facts.processes;
  json["versions"] = Json::object();
  for (const auto& [name, version] : facts.versions) json["versions"][name] = version;
  json["scene_text"] = facts.sceneText;
  requireFiniteNumbers(json, path);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace mortier
