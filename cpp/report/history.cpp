#include "report/history.h"

namespace mortier {

History::History(const std::string& folder, const std::vector<Quantity>& quantities)
    : file_(folder + "/history.csv") {
  file_ << "step,time[s],time_step[s],estimate,rejections,guarded,rung,iterations,factorisations,active,"
           "joined,left,penetration[m^2],"
           "max_pressure[Pa],contact_force[N/m],contact_resultant_x[N/m],contact_resultant_y[N/m],"
           "von_mises_max[Pa],displacement_max[m],elastic_energy[J/"
           "m],viscoplastic_fraction,force_balance,material_residual,gap_on_active,"
           "sign,complementarity,open_penetration,rounding";
  for (const Quantity& quantity : quantities) file_ << ',' << quantity.name << '[' << quantity.unit() << ']';
  file_ << '\n';
}

void History::add(const StepReport& r, const std::vector<double>& values) {
  const Certificate& c = r.certificate;
  file_ << r.step << ',' << r.time << ',' << r.timeStep << ',' << r.estimate << ',' << r.rejections << ','
        << (r.guarded ? 1 : 0) << ',' << nameOf(r.rung) << ',' << r.iterations << ',' << r.factorisations
        << ',' << r.active << ',' << r.joined << ',' << r.left << ',' << r.penetration << ',' << r.maxPressure
        << ',' << r.contactForce << ',' << r.resultantX << ',' << r.resultantY << ',' << r.vonMises << ','
        << r.displacement << ',' << r.energy << ',' << r.viscoplasticFraction << ',' << c.forceBalance << ','
        << c.materialResidual << ',' << c.gapOnActive << ',' << c.sign << ',' << c.complementarity << ','
        << c.openPenetration << ',' << c.rounding;
  for (const double value : values) file_ << ',' << value;
  file_ << '\n';
}

}  // namespace mortier
