#include "report/contact_table.h"

namespace mortier {

ContactFields contactFields(const Model& model, const State& state, size_t interface) {
  const ContactInterface& of = model.interfaces[interface];
  const ContactPair& pair = of.pair();
  const Vector gap = of.gap(state.bodies[pair.nonmortar.body].displacement,
                            state.bodies[pair.mortar.body].displacement, state.time);
  const Vector& force = state.contactForce[interface];
  const Vector none = Vector::Zero(of.rows());
  const std::vector<Point>& places = model.bodies[pair.nonmortar.body].elementNodes().places;
  ContactFields fields{of.nonmortarNodes(),
                       {},
                       (0 - gap.array()).matrix(),
                       force,
                       of.contactPressure(force),
                       none,
                       none,
                       none,
                       std::vector<signed char>(of.rows(), 0)};
  if (of.hasFriction()) {
    fields.friction = state.frictionForce[interface];
    fields.shear = of.contactPressure(fields.friction);
    fields.slip =
        of.slip(state.bodies[pair.nonmortar.body].displacement, state.bodies[pair.mortar.body].displacement);
    fields.slipping = state.slipping[interface];
  }
  for (const int vertex : fields.vertex) fields.place.push_back(places[vertex]);
  return fields;
}

ContactTable::ContactTable(const std::string& folder, const Model& model)
    : model_(model), rough_(anyFriction(model)), file_(folder + "/contact.csv") {
  file_ << "step,time,interface,vertex,x,y,gap,force,pressure,active";
  if (rough_) file_ << ",friction,shear,slip,slipping";
  file_ << '\n';
}

void ContactTable::add(const State& state, int step) {
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactFields fields = contactFields(model_, state, k);
    for (size_t i = 0; i < fields.vertex.size(); ++i) {
      const Point& p = fields.place[i];
      file_ << step << ',' << state.time << ',' << k << ',' << fields.vertex[i] << ',' << p[0] << ',' << p[1]
            << ',' << fields.gap[i] << ',' << fields.force[i] << ',' << fields.pressure[i] << ','
            << (fields.force[i] > 0 ? 1 : 0);
      if (rough_)
        file_ << ',' << fields.friction[i] << ',' << fields.shear[i] << ',' << fields.slip[i] << ','
              << static_cast<int>(fields.slipping[i]);
      file_ << '\n';
    }
  }
}

}  // namespace mortier
