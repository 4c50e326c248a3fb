#include "report/history.h"

namespace mortier {

std::vector<std::string> historyColumns(const Model& model, const std::vector<Quantity>& quantities,
                                        const Units& units) {
  const auto in = [](const std::string& name, const std::string& unit) { return name + '[' + unit + ']'; };
  std::vector<std::string> names{"step",
                                 in("time", units.time),
                                 in("time_step", units.time),
                                 "estimate",
                                 "rejections",
                                 "guarded",
                                 "rung",
                                 "iterations",
                                 "factorisations",
                                 "active",
                                 "joined",
                                 "left",
                                 in("penetration", units.area()),
                                 in("max_pressure", units.stress),
                                 in("contact_force", units.forcePerDepth()),
                                 in("contact_resultant_x", units.forcePerDepth()),
                                 in("contact_resultant_y", units.forcePerDepth()),
                                 in("von_mises_max", units.stress),
                                 in("displacement_max", units.length),
                                 in("elastic_energy", units.energyPerDepth()),
                                 "viscoplastic_fraction",
                                 "force_balance",
                                 "material_residual",
                                 "gap_on_active",
                                 "sign",
                                 "complementarity",
                                 "open_penetration",
                                 "rounding"};
  if (anyFriction(model)) names.emplace_back("ambiguous");
  for (size_t k = 0; k < model.interfaces.size(); ++k)
    if (model.interfaces[k].hasFriction())
      names.push_back(in("friction_work_" + std::to_string(k), units.energyPerDepth()));
  for (const Quantity& quantity : quantities) names.push_back(in(quantity.name, quantity.unit(units)));
  return names;
}

std::vector<HistoryValue> historyRow(const StepReport& r) {
  const Certificate& c = r.certificate;
  std::vector<HistoryValue> row{r.step,
                                r.time,
                                r.timeStep,
                                r.estimate,
                                r.rejections,
                                r.guarded ? 1 : 0,
                                std::string_view(nameOf(r.rung)),
                                r.iterations,
                                r.factorisations,
                                r.active,
                                r.joined,
                                r.left,
                                r.penetration,
                                r.maxPressure,
                                r.contactForce,
                                r.resultantX,
                                r.resultantY,
                                r.vonMises,
                                r.displacement,
                                r.energy,
                                r.viscoplasticFraction,
                                c.forceBalance,
                                c.materialResidual,
                                c.gapOnActive,
                                c.sign,
                                c.complementarity,
                                c.openPenetration,
                                c.rounding};
  if (!r.frictionWork.empty()) row.emplace_back(r.solutions.ambiguous ? 1 : 0);
  row.insert(row.end(), r.frictionWork.begin(), r.frictionWork.end());
  row.insert(row.end(), r.quantities.begin(), r.quantities.end());
  return row;
}

History::History(const std::string& folder, const Model& model, const std::vector<Quantity>& quantities,
                 const Units& units)
    : file_(folder + "/history.csv") {
  const char* comma = "";
  for (const std::string& name : historyColumns(model, quantities, units)) {
    file_ << comma << name;
    comma = ",";
  }
  file_ << '\n';
}

void History::add(const StepReport& report) {
  const char* comma = "";
  for (const HistoryValue& value : historyRow(report)) {
    file_ << comma;
    std::visit([&](const auto& each) { file_ << each; }, value);
    comma = ",";
  }
  file_ << '\n';
}

}  // namespace mortier
