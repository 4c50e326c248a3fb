#include "report/contact_table.h"

namespace mortier {

ContactTable::ContactTable(const std::string& folder, const Model& model)
    : model_(model), file_(folder + "/contact.csv") {
  file_ << "step,time,interface,vertex,x,y,gap,force,pressure,active\n";
}

void ContactTable::add(const State& state, int step) {
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    const ContactPair& pair = interface.pair();
    const Vector gap = interface.gap(state.bodies[pair.nonmortar.body].displacement,
                                     state.bodies[pair.mortar.body].displacement);
    const Vector& force = state.contactForce[k];
    const Vector pressure = interface.contactPressure(force);
    const std::vector<Point>& places = model_.bodies[pair.nonmortar.body].elementNodes().places;
    const std::vector<int>& nodes = interface.nonmortarNodes();
    for (size_t i = 0; i < nodes.size(); ++i) {
      const Point& p = places[nodes[i]];
      file_ << step << ',' << state.time << ',' << k << ',' << nodes[i] << ',' << p[0] << ',' << p[1] << ','
            << 0 - gap[i] << ',' << force[i] << ',' << pressure[i] << ',' << (force[i] > 0 ? 1 : 0) << '\n';
    }
  }
}

}  // namespace mortier
