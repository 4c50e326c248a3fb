#include "report/history.h"

namespace mortier {

std::vector<std::string> historyColumns(const std::vector<Quantity>& quantities) {
  std::vector<std::string> names{"step",
                                 "time[s]",
                                 "time_step[s]",
                                 "estimate",
                                 "rejections",
                                 "guarded",
                                 "rung",
                                 "iterations",
                                 "factorisations",
                                 "active",
                                 "joined",
                                 "left",
                                 "penetration[m^2]",
                                 "max_pressure[Pa]",
                                 "contact_force[N/m]",
                                 "contact_resultant_x[N/m]",
                                 "contact_resultant_y[N/m]",
                                 "von_mises_max[Pa]",
                                 "displacement_max[m]",
                                 "elastic_energy[J/m]",
                                 "viscoplastic_fraction",
                                 "force_balance",
                                 "material_residual",
                                 "gap_on_active",
                                 "sign",
                                 "complementarity",
                                 "open_penetration",
                                 "rounding"};
  for (const Quantity& quantity : quantities) names.push_back(quantity.name + '[' + quantity.unit() + ']');
  return names;
}

std::vector<HistoryValue> historyRow(const StepReport& r, const std::vector<double>& values) {
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
  row.insert(row.end(), values.begin(), values.end());
  return row;
}

History::History(const std::string& folder, const std::vector<Quantity>& quantities)
    : file_(folder + "/history.csv") {
  const char* comma = "";
  for (const std::string& name : historyColumns(quantities)) {
    file_ << comma << name;
    comma = ",";
  }
  file_ << '\n';
}

void History::add(const StepReport& report, const std::vector<double>& values) {
  const char* comma = "";
  for (const HistoryValue& value : historyRow(report, values)) {
    file_ << comma;
    std::visit([&](const auto& each) { file_ << each; }, value);
    comma = ",";
  }
  file_ << '\n';
}

}  // namespace mortier
