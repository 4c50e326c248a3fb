#include "fields.h"

#include <pybind11/stl.h>

#include <functional>

#include "bind.h"
#include "time/mesh_error.h"

namespace py = pybind11;

namespace mortier::python {

namespace {

using Size = py::ssize_t;

/// Nodes of a side of contact, in the order of the line; its arrays are views of the step's memory.
struct Contact {
  py::object step;
  size_t interface;
  [[nodiscard]] Step& of() const { return step.cast<Step&>(); }
  [[nodiscard]] const ContactFields& fields() const {
    Step& from = of();
    from.contact.resize(from.state.contactForce.size());
    std::optional<ContactFields>& found = from.contact[interface];
    if (!found) found = contactFields(*from.of->model, from.state, interface);
    return *found;
  }
};

const CellFields& cellsOf(Step& step, size_t body) {
  step.cells.resize(step.state.bodies.size());
  if (!step.cells[body]) step.cells[body] = cellFields(step.of->model->bodies[body], step.state.bodies[body]);
  return *step.cells[body];
}

/// Square root of the estimated share of each triangle, in the energy norm of its body, as in the files.
const std::vector<Vector>& errorsOf(Step& step) {
  if (step.errors.empty())
    for (const ErrorEstimate& each : MeshErrorEstimator (*step.of->model)(step.state))
      step.errors.emplace_back((each.error / (each.energy > 0 ? each.energy : 1)).cwiseSqrt());
  return step.errors;
}

/// Body name -> array, of a matrix with a column a triangle or a vector with an entry each.
using OfBody = std::function<py::array(Step& step, size_t body, py::handle owner)>;
auto byBodies(OfBody array) {
  return [array = std::move(array)](const py::object& self) {
    auto& step = self.cast<Step&>();
    py::dict all;
    for (size_t b = 0; b < step.of->model->bodies.size(); ++b)
      all[py::str(step.of->model->bodies[b].name())] = array(step, b, self);
    return all;
  };
}

/// A vector, of Eigen's or of the standard library.
template <class Values>
py::array column(const Values& values, py::handle owner) {
  return view(values.data(), {static_cast<Size>(values.size())}, owner);
}
py::array rowsOf(const Matrix& m, py::handle owner) {
  return view(m.data(), {m.cols(), m.rows()}, owner);
}

}  // namespace

py::dict namedValues(const std::vector<std::string>& names, const std::vector<HistoryValue>& values) {
  py::dict all;
  for (size_t c = 0; c < values.size(); ++c)
    all[py::str(names[c].substr(0, names[c].find('[')))] =
        std::visit([](const auto& value) { return py::object(py::cast(value)); }, values[c]);
  return all;
}

void bindFields(py::module_& module) {
  const auto bodyAt = [](const Step& step, size_t b) -> const Body& { return step.of->model->bodies[b]; };
  const auto placesOf = []<class Place>(const std::vector<Place>& places, py::handle owner) {
    return view(places.front().data(), {static_cast<Size>(places.size()), Place::RowsAtCompileTime}, owner);
  };
  const auto cellNodes = [](const std::vector<int>& nodes, Size width, py::handle owner) {
    return view(nodes.data(), {static_cast<Size>(nodes.size()) / width, width}, owner);
  };
  py::class_<Step, std::shared_ptr<Step>> step(module, "Step");
  step.def_property_readonly("number", [](const Step& of) { return of.report.step; });
  step.def_property_readonly("time", [](const Step& of) { return of.state.time; });
  step.def_property_readonly("values", [](const Step& of) {
    return namedValues(historyColumns(*of.of->model, of.of->facts.quantities, of.of->facts.units), of.row);
  });
  const auto field = [&step](const char* name, OfBody array) {
    step.def_property_readonly(name, byBodies(std::move(array)));
  };
  field("points", [=](Step& of, size_t b, py::handle self) {
    return bodyAt(of, b).withMesh(
        [&](const auto&, const auto& nodes) { return placesOf(nodes.places, self); });
  });
  field("triangles", [=](Step& of, size_t b, py::handle self) {
    const ElementNodes& nodes = bodyAt(of, b).elementNodes();
    return cellNodes(nodes.elements, nodes.perElement(), self);
  });
  field("tetrahedra", [=](Step& of, size_t b, py::handle self) {
    const SpaceElements* space = bodyAt(of, b).space();
    if (space == nullptr) throw py::attribute_error("tetrahedra: none in the plane");
    return cellNodes(space->nodes().elements, space->nodes().perElement(), self);
  });
  field("regions",
        [=](Step& of, size_t b, py::handle self) { return column(bodyAt(of, b).regions(), self); });
  field("displacement", [](Step& of, size_t b, py::handle self) {
    of.moved.resize(of.state.bodies.size());
    Vector& u = of.moved[b];
    if (u.size() == 0) u = of.of->model->bodies[b].moved(of.state.bodies[b].displacement);
    const Size dimension = of.of->model->bodies[b].dimension();
    return view(u.data(), {u.size() / dimension, dimension}, self);
  });
  field("stress", [](Step& of, size_t b, py::handle self) { return rowsOf(cellsOf(of, b).stress, self); });
  field("stress_at_points", [](Step& of, size_t b, py::handle self) {
    const CellFields& cells = cellsOf(of, b);
    const Matrix& s = cells.stressAtPoints;
    return view(s.data(), {s.cols(), s.rows() / cells.stress.rows(), cells.stress.rows()}, self);
  });
  field("von_mises",
        [](Step& of, size_t b, py::handle self) { return column(cellsOf(of, b).vonMises, self); });
  field("viscoplastic_strain",
        [](Step& of, size_t b, py::handle self) { return rowsOf(cellsOf(of, b).viscoplasticStrain, self); });
  field("viscoplastic",
        [](Step& of, size_t b, py::handle self) { return column(cellsOf(of, b).viscoplastic, self); });
  field("error", [](Step& of, size_t b, py::handle self) { return column(errorsOf(of)[b], self); });
  step.def_property_readonly("contact", [](const py::object& self) {
    std::vector<Contact> all;
    const size_t count = self.cast<Step&>().state.contactForce.size();
    for (size_t k = 0; k < count; ++k) all.push_back({self, k});
    return all;
  });

  const auto bodyOf = [](const Contact& c, ContactSide ContactPair::*side) {
    const Model& model = *c.of().of->model;
    return model.bodies[(model.interfaces[c.interface].pair().*side).body].name();
  };
  py::class_<Contact> contact(module, "Contact");
  contact.def_property_readonly("nonmortar",
                                [bodyOf](const Contact& c) { return bodyOf(c, &ContactPair::nonmortar); });
  contact.def_property_readonly("mortar",
                                [bodyOf](const Contact& c) { return bodyOf(c, &ContactPair::mortar); });
  const auto nodal = [&contact](const char* name, auto ContactFields::*values) {
    contact.def_property_readonly(name,
                                  [values](const Contact& c) { return column(c.fields().*values, c.step); });
  };
  nodal("vertex", &ContactFields::vertex);
  nodal("gap", &ContactFields::gap);
  nodal("force", &ContactFields::force);
  nodal("pressure", &ContactFields::pressure);
  const auto along = [&contact](const char* name, auto ContactFields::*values) {
    contact.def_property_readonly(name, [values](const Contact& c) {
      const Matrix& all = c.fields().*values;
      return all.rows() == 1 ? view(all.data(), {all.cols()}, c.step) : rowsOf(all, c.step);
    });
  };
  along("friction", &ContactFields::friction);
  along("shear", &ContactFields::shear);
  along("slip", &ContactFields::slip);
  nodal("slipping", &ContactFields::slipping);
  contact.def_property_readonly("position", [](const Contact& c) -> py::object {
    const std::vector<SpacePoint>& p = c.fields().place;
    const py::array all =
        view(p.empty() ? nullptr : p.front().data(), {static_cast<Size>(p.size()), 3}, c.step);
    const int dimension = c.of().of->model->bodies.front().dimension();
    return all[py::make_tuple(py::ellipsis(), py::slice(0, dimension, 1))];
  });
}

}  // namespace mortier::python
