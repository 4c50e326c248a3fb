#include "fields.h"

#include <pybind11/stl.h>

#include <functional>

#include "bind.h"
#include "time/space_error.h"

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
  [[nodiscard]] py::array column(const Vector& values) const {
    return view(values.data(), {values.size()}, step);
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
    for (const ErrorEstimate& each : SpaceErrorEstimator (*step.of->model)(step.state))
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
  const auto nodesOf = [](const Step& step, size_t b) -> const ElementNodes& {
    return step.of->model->bodies[b].elementNodes();
  };
  py::class_<Step, std::shared_ptr<Step>>(module, "Step")
      .def_property_readonly("number", [](const Step& step) { return step.report.step; })
      .def_property_readonly("time", [](const Step& step) { return step.state.time; })
      .def_property_readonly(
          "values",
          [](const Step& step) { return namedValues(historyColumns(step.of->facts.quantities), step.row); })
      .def_property_readonly(
          "points", byBodies([nodesOf](Step& step, size_t b, py::handle self) {
            const std::vector<Point>& places = nodesOf(step, b).places;
            return view(places.front().data(), {static_cast<Size>(places.size()), 2}, self);
          }))
      .def_property_readonly("triangles", byBodies([nodesOf](Step& step, size_t b, py::handle self) {
                               const ElementNodes& nodes = nodesOf(step, b);
                               const Size width = nodes.perTriangle();
                               const auto count = static_cast<Size>(nodes.triangles.size()) / width;
                               return view(nodes.triangles.data(), {count, width}, self);
                             }))
      .def_property_readonly("regions", byBodies([](Step& step, size_t b, py::handle self) {
                               const std::vector<int>& regions = step.of->model->bodies[b].mesh().regions;
                               return view(regions.data(), {static_cast<Size>(regions.size())}, self);
                             }))
      .def_property_readonly("displacement", byBodies([](Step& step, size_t b, py::handle self) {
                               const Vector& u = step.state.bodies[b].displacement;
                               return view(u.data(), {u.size() / 2, 2}, self);
                             }))
      .def_property_readonly("stress", byBodies([](Step& step, size_t b, py::handle self) {
                               return rowsOf(cellsOf(step, b).stress, self);
                             }))
      .def_property_readonly(
          "stress_at_points", byBodies([](Step& step, size_t b, py::handle self) {
            const CellFields& cells = cellsOf(step, b);
            const Size width = cells.stress.rows();
            const Size points = cells.stressAtPoints.rows() / width;
            return view(cells.stressAtPoints.data(), {cells.stressAtPoints.cols(), points, width}, self);
          }))
      .def_property_readonly("von_mises", byBodies([](Step& step, size_t b, py::handle self) {
                               const Vector& s = cellsOf(step, b).vonMises;
                               return view(s.data(), {s.size()}, self);
                             }))
      .def_property_readonly("viscoplastic_strain", byBodies([](Step& step, size_t b, py::handle self) {
                               return rowsOf(cellsOf(step, b).viscoplasticStrain, self);
                             }))
      .def_property_readonly("viscoplastic", byBodies([](Step& step, size_t b, py::handle self) {
                               const std::vector<int>& flows = cellsOf(step, b).viscoplastic;
                               return view(flows.data(), {static_cast<Size>(flows.size())}, self);
                             }))
      .def_property_readonly("error", byBodies([](Step& step, size_t b, py::handle self) {
                               const Vector& error = errorsOf(step)[b];
                               return view(error.data(), {error.size()}, self);
                             }))
      .def_property_readonly("contact", [](const py::object& self) {
        std::vector<Contact> all;
        const size_t count = self.cast<Step&>().state.contactForce.size();
        for (size_t k = 0; k < count; ++k) all.push_back({self, k});
        return all;
      });

  const auto bodyOf = [](const Contact& c, ContactSide ContactPair::*side) {
    const Model& model = *c.of().of->model;
    return model.bodies[(model.interfaces[c.interface].pair().*side).body].name();
  };
  py::class_<Contact>(module, "Contact")
      .def_property_readonly("nonmortar",
                             [bodyOf](const Contact& c) { return bodyOf(c, &ContactPair::nonmortar); })
      .def_property_readonly("mortar", [bodyOf](const Contact& c) { return bodyOf(c, &ContactPair::mortar); })
      .def_property_readonly("vertex",
                             [](const Contact& c) {
                               const std::vector<int>& v = c.fields().vertex;
                               return view(v.data(), {static_cast<Size>(v.size())}, c.step);
                             })
      .def_property_readonly("position",
                             [](const Contact& c) {
                               const std::vector<Point>& p = c.fields().place;
                               const double* data = p.empty() ? nullptr : p.front().data();
                               return view(data, {static_cast<Size>(p.size()), 2}, c.step);
                             })
      .def_property_readonly("gap", [](const Contact& c) { return c.column(c.fields().gap); })
      .def_property_readonly("force", [](const Contact& c) { return c.column(c.fields().force); })
      .def_property_readonly("pressure", [](const Contact& c) { return c.column(c.fields().pressure); });
}

}  // namespace mortier::python
