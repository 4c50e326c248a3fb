#include "report/log.h"

#include <algorithm>
#include <cmath>

#include "base/digits.h"
#include "base/formatted.h"
#include "report/clock.h"

namespace mortier {

namespace {

/// What became of end nodes whose normal motion is prescribed.
std::string heldEnds(const ContactInterface& interface) {
  if (interface.heldEnds() == 0) return "";
  const bool merged = interface.pair().coupling != CouplingKind::interpolation;
  return "; " + counted(interface.heldEnds(), "held end") +
         " without a condition: " + (merged ? "merged into the next node" : "left out");
}

/// What a reader may have meant as a circle.
std::string polygon(const ContactInterface& interface) {
  if (interface.polygonTurn() == 0) return "";
  return formatted("; a polygon, not a circle: it turns by %.3g degrees at a node",
                   interface.polygonTurn() * 180 / M_PI);
}

/// A line for each law of a body, with its parameters.
std::string materials(const Body& body, const Units& units) {
  std::string text;
  if (body.rigid()) return text;
  for (const LawDescription& law : body.material().laws()) {
    text += "material   " + body.name() + " " + law.text();
    for (const auto& [name, value, unit] : law.parameters) {
      const auto known = unitOf(unit);
      text += formatted(", %s %.6g", name.c_str(), value) +
              (known ? " " + units.nameOf(known->dimension) : std::string());
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string word(Status status) {
  return status == Status::converged ? "converged" : status == Status::failed ? "failed" : "unheld";
}

std::string logHeader(const RunFacts& facts, const Model& model) {
  std::string text;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    text += (b == 0 ? "bodies     " : ", ") + body.name() + " " + std::to_string(body.dofs()) + " dofs, " +
            lawsOf(body);
  }
  text += facts.plane == "space" ? "; in space\n" : "; plane " + facts.plane + "\n";
  if (!facts.start.empty())
    text += "start      " + facts.start + formatted(" at t = %.5g ", facts.startTime) + facts.units.time +
            (facts.asDrawn.empty() ? "\n" : "; as drawn: " + joined(facts.asDrawn) + "\n");
  for (const Body& body : model.bodies) {
    text += materials(body, facts.units);
    if (body.patches() != nullptr)
      text += "material   " + body.name() + " volumetric strain averaged over " +
              std::to_string(body.patches()->count()) + " patches of " + body.elementsWord() + "\n";
  }
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const double least = interface.initialDistance().size() > 0 ? interface.initialDistance().minCoeff() : 0;
    constexpr double noticeable = 1e-6;
    const double size = model.bodies[interface.pair().nonmortar.body].extent();
    const std::string pressed = least < -noticeable * size
                                    ? formatted("; interference %.3g ", -least) + facts.units.length
                                    : std::string();
    const std::string chosen = k < facts.choices.size() ? facts.choices[k] : "";
    text +=
        formatted("interface  %s, %zu nonmortar (%s) x %zu mortar (%s) nodes, overlap %.3f%s%s%s%s%s\n",
                  facts.variants[k].c_str(), interface.nonmortarNodes().size(),
                  model.bodies[interface.pair().nonmortar.body].name().c_str(),
                  interface.mortarNodes().size(), model.bodies[interface.pair().mortar.body].name().c_str(),
                  interface.overlap(), chosen.empty() ? "" : "; ", chosen.c_str(),
                  heldEnds(interface).c_str(), pressed.c_str(), polygon(interface).c_str());
  }
  for (size_t k = 0; k < model.ties.size(); ++k) {
    const Tie& tie = model.ties[k];
    const Body& nonmortar = model.bodies[tie.pair().nonmortar.body];
    constexpr double noticeable = 1e-6;
    const bool apart = tie.distance() > noticeable * nonmortar.extent();
    text += formatted(
        "tie        %s, %zu nonmortar nodes (%s) on %s, overlap %.3f%s\n", facts.ties[k].c_str(),
        tie.nonmortarNodes().size(), nonmortar.name().c_str(),
        model.bodies[tie.pair().mortar.body].name().c_str(), tie.overlap(),
        apart ? formatted("; apart by up to %.3g ", tie.distance()).append(facts.units.length).c_str() : "");
  }
  return text;
}

namespace {

std::string logStatus(const RunReport& report, const std::string& folder) {
  const double wall = processSeconds();
  const double share = wall > 0 ? std::min(1.0, report.solveSeconds / wall) : 0;
  std::string text = "status " + word(report.status);
  if (report.status != Status::converged) text += " after " + counted(report.steps, "step");
  return text +
         formatted("   newton %d   factorisations %d   %.3g s (solve %.0f%%)   %.0f MiB   ",
                   report.iterations, report.factorisations, wall, 100 * share, peakMemory()) +
         folder + "\n";
}

std::string logVerification(const Certificate& w) {
  return formatted(
      "verification (worst step)  |force balance| %.1e   material residual %.1e   |gap| on active %.1e   "
      "penetration of open %.1e   complementarity %.1e   sign %.1e   rounding %.1e\n",
      w.forceBalance, w.materialResidual, w.gapOnActive, w.openPenetration, w.complementarity, w.sign,
      w.rounding);
}

std::string line(const std::string& text) {
  return "           " + text + "\n";
}

std::string logBound(const EnergyBound& bound) {
  if (!bound.obstacle.empty()) return line("no guaranteed bound: " + bound.obstacle);
  const double relative = bound.relative();
  if (!std::isfinite(relative)) return line("guaranteed: bound above 100 %, refine the meshes");
  constexpr double rounding = 1e-12;
  if (bound.bound <= rounding * bound.norm) return line("guaranteed: below rounding");
  std::string text = formatted("guaranteed: at most %.2g %%", 100 * relative);
  if (bound.oscillation > rounding)
    text += formatted(", %.1g %% of it for data between the nodes", 100 * bound.oscillation);
  return line(text);
}

std::string logAccuracy(const RunFacts& facts, const Model& model, const Accuracy& accuracy) {
  std::string text = "accuracy   estimated error of the stress, meshes only: ";
  if (accuracy.all == 0) {
    text += "below rounding\n";
  } else {
    text += formatted("%.2g %%", 100 * accuracy.all);
    for (size_t b = 0; b < model.bodies.size(); ++b)
      text +=
          (b == 0 ? " (" : ", ") + model.bodies[b].name() + formatted(" %.2g %%", 100 * accuracy.bodies[b]);
    text += "), largest in " + accuracy.worstBody + " at " +
            placeText(accuracy.worst, model.bodies.front().dimension()) + "\n";
  }
  constexpr double ofGeometries = 1e-7;  // their own tolerance, of the size
  double sagitta = 0;
  double size = 0;
  for (const ContactInterface& interface : model.interfaces) sagitta = std::max(sagitta, interface.sagitta());
  for (const Body& body : model.bodies) size = std::max(size, body.extent());
  if (sagitta > ofGeometries * size)
    text +=
        formatted("           not in it: contact between polygons that are off their curves by up to %.2g ",
                  sagitta) +
        facts.units.length + formatted(", %.2g of the size\n", sagitta / size);
  if (accuracy.largest > 0 && accuracy.largestTime < accuracy.time)
    text += formatted("           largest of the run: %.2g %% of its largest stress, at t = %.5g %s\n",
                      100 * accuracy.largest, accuracy.largestTime, facts.units.time.c_str());
  if (accuracy.bound) text += logBound(*accuracy.bound);
  if (accuracy.all == 0 && accuracy.largest == 0) return text;
  for (const std::string& doubt : facts.doubts) text += "           not reliable: " + doubt + "\n";
  constexpr double coarse = 0.3;
  if (const double most = std::max(accuracy.all, accuracy.largest); most > 1)
    text += "           not reliable: above 100 %, the meshes do not resolve the stress\n";
  else if (most > coarse)
    text +=
        "           not reliable: above 30 %, mesh too coarse: the estimate is 0.8 to 2 times the error\n";
  return text;
}

std::string logPeaks(const RunReport& report, const StepReport& last, const Units& units) {
  const Peaks& peaks = report.peaks;
  std::string text;
  const auto add = [&](const char* name, const Peak& peak, double end, const std::string& unit) {
    constexpr double same = 1e-9;
    if (!(peak.value > (1 + same) * end)) return;
    text += (text.empty() ? "peaks      " : ", ") + std::string(name) +
            formatted(" %.5g %s at t = %.5g %s (%.5g at the end)", peak.value, unit.c_str(), peak.time,
                      units.time.c_str(), end);
  };
  add("von Mises", peaks.vonMises, last.vonMises, units.stress);
  add("pressure", peaks.pressure, last.maxPressure, units.stress);
  add("contact force", peaks.contactForce, last.contactForce, units.forcePerDepth());
  add("displacement", peaks.displacement, last.displacement, units.length);
  return text.empty() ? text : text + "\n";
}

/// What is known of the error of a quantity.
std::string errorText(const RunFacts& facts, const Accuracy& accuracy, size_t i, double value) {
  const QuantityError error = errorOf(facts, accuracy, i);
  const std::optional<RoundChange> change = changeInRounds(facts, i);
  std::string text;
  if (error.order > 0)
    text += formatted(" (no limit: stresses are unbounded there, about like r^-%.1f)", error.order);
  else if (change && change->grows)
    text += formatted(" (grows with every round, the last time by %.2g %%: stresses are unbounded there)",
                      100 * change->size / value);
  else if (change && value != 0)
    text += formatted(" (changed by %.2g %% in the last round)", 100 * change->size / std::abs(value));
  const std::optional<EnergyBound>& bound = accuracy.bound;
  const Enclosure* enclosure = bound && !bound->quantities.empty() ? &bound->quantities[i] : nullptr;
  if (enclosure != nullptr && enclosure->obstacle.empty())
    return text + formatted(" +- %.2g (guaranteed)", enclosure->error(value));
  if (enclosure != nullptr && enclosure->estimate)
    return text + formatted(" +- %.2g (an estimate)", *enclosure->estimate);
  if (text.empty() && error.obstacle.empty()) text += formatted(" +- %.2g", error.size);
  if (text.empty()) text += " (no estimate: " + error.obstacle + ")";
  if (enclosure != nullptr && bound->obstacle.empty()) text += " (no bound: " + enclosure->obstacle + ")";
  return text;
}

std::string logQuantities(const RunFacts& facts, const Model& model, const Solved& solved) {
  const std::vector<Quantity>& quantities = facts.quantities;
  const std::vector<double> values = evaluate(quantities, model, solved.state);
  std::string text;
  bool estimated = false;
  for (size_t i = 0; i < quantities.size(); ++i) {
    text += (i == 0 ? "quantities " : ", ") + quantities[i].name + formatted(" %.7g ", values[i]) +
            quantities[i].unit(facts.units);
    const int dimension = model.bodies[quantities[i].body].dimension();
    if (const std::optional<SpacePoint> place = placeOf(quantities[i], model, solved.state))
      text += " at " + placeText(*place, dimension);
    const std::string error = errorText(facts, solved.accuracy, i, values[i]);
    estimated = estimated || (error.find("+-") != std::string::npos && error.find('(') == std::string::npos);
    text += error;
  }
  if (!text.empty()) text += "\n";
  if (estimated) text += "           +-: estimated error because of the meshes, no bound\n";
  return text;
}

std::string logRanges(const RunFacts& facts, const std::vector<QuantityRange>& ranges) {
  std::string text;
  for (size_t i = 0; i < ranges.size(); ++i) {
    const QuantityRange& range = ranges[i];
    const char* unit = facts.units.time.c_str();
    text += (i == 0 ? "range      " : ", ") + facts.quantities[i].name +
            formatted(" %.5g (t = %.5g %s) to %.5g (t = %.5g %s)", range.smallest, range.smallestTime, unit,
                      range.largest, range.largestTime, unit);
  }
  return text.empty() ? text : text + "\n";
}

std::string logTimeError(const RunFacts& facts, const RunReport& report) {
  if (!(facts.tolerance > 0)) return "";
  return formatted(
      "accuracy   estimated error in time of displacement and stress, worst step: %.2g (tolerance %.2g%s)\n",
      report.timeError, facts.tolerance, report.timeError > facts.tolerance ? ", not reached" : "");
}

std::string logSpecial(const SpecialConditions& special) {
  if (special.idle == 0 && special.dependent == 0) return "";
  std::string text = "conditions ";
  if (special.idle > 0)
    text +=
        formatted(" %d idle: both sides are held there%s", special.idle, special.dependent > 0 ? ";" : "");
  if (special.dependent > 0)
    text +=
        formatted(" %d dependent on others: the contact forces are one choice of many", special.dependent);
  return text + "\n";
}

}  // namespace

std::string logEnd(const RunFacts& facts, const Model& model, const Solved& solved,
                   const std::string& place) {
  const RunReport& report = solved.report;
  return logStatus(report, place) + logVerification(report.worst) + logSpecial(report.special) +
         logAccuracy(facts, model, solved.accuracy) + logTimeError(facts, report) +
         logPeaks(report, solved.last, facts.units) + asLines(warningsOf(report, model, facts.units)) +
         logQuantities(facts, model, solved) + logRanges(facts, report.quantities);
}

}  // namespace mortier
