#include "scene.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>

#include "base/error.h"
#include "base/printable.h"
#include "bind.h"
#include "lint/lint.h"
#include "mesh/read.h"
#include "worker.h"

namespace py = pybind11;

namespace mortier::python {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<long long, py::array::c_style | py::array::forcecast>;

/// \throws InputError
void require(bool holds, const std::string& of, const std::string& what, const py::array& is,
             const std::string& expected) {
  if (holds) return;
  throw InputError(of + ": " + what + " of shape " + std::string(py::str(is.attr("shape"))) + ", expected " +
                   expected);
}

int vertexOf(long long value, const std::string& of, const char* what) {
  constexpr long long most = 1LL << 30;
  if (value < 0 || value > most)
    throw InputError(of + ": " + what + " holds " + std::to_string(value) + ", expected an integer >= 0");
  return static_cast<int>(value);
}

template <size_t columns>
std::vector<std::array<int, columns>> rowsOf(const Integers& table, const std::string& of, const char* what) {
  const auto width = static_cast<py::ssize_t>(columns);
  require(table.ndim() == 2 && table.shape(1) == width, of, what, table,
          "(n, " + std::to_string(columns) + ")");
  std::vector<std::array<int, columns>> rows(table.shape(0));
  for (size_t i = 0; i < rows.size() * columns; ++i)
    rows[i / columns][i % columns] = vertexOf(table.data()[i], of, what);
  return rows;
}

std::vector<int> labelsOf(const Integers& labels, size_t count, const std::string& of, const char* what) {
  require(labels.ndim() == 1 && labels.shape(0) == static_cast<py::ssize_t>(count), of, what, labels,
          "(" + std::to_string(count) + ",)");
  std::vector<int> all(count);
  for (size_t i = 0; i < count; ++i) all[i] = vertexOf(labels.data()[i], of, what);
  return all;
}

/// Coordinates survive bit by bit. \throws InputError, OutputError
void writeMesh(const std::string& path, const std::string& of, const Numbers& points,
               const Integers& triangles, const Integers& edges, const Integers& labels,
               const std::optional<Integers>& regions) {
  TriangleMesh mesh;
  mesh.name = of;
  require(points.ndim() == 2 && points.shape(1) == 2, of, "points", points, "(n, 2)");
  for (py::ssize_t v = 0; v < points.shape(0); ++v)
    mesh.vertices.emplace_back(points.at(v, 0), points.at(v, 1));
  mesh.triangles = rowsOf<3>(triangles, of, "triangles");
  mesh.boundaryEdges = rowsOf<2>(edges, of, "edges");
  mesh.boundaryLabels = labelsOf(labels, mesh.boundaryEdges.size(), of, "labels");
  mesh.regions = regions ? labelsOf(*regions, mesh.triangles.size(), of, "regions")
                         : std::vector<int>(mesh.triangles.size(), 0);
  validate(mesh);
  writeMedit(mesh, path);
}

/// Faults as dicts, what `mortier check --json` says.
py::list check(const std::string& path, const std::vector<std::string>& settings) {
  LintReport report;
  interruptibly([&] { report = lint(path, settings); });
  using py::literals::operator""_a;
  py::list faults;
  for (const Fault& fault : report.faults.all())
    faults.append(py::dict("id"_a = fault.kind->id, "severity"_a = word(fault.kind->severity),
                           "place"_a = printable(fault.place), "message"_a = printable(fault.message),
                           "remedy"_a = fault.kind->remedy, "more"_a = fault.more));
  return faults;
}

}  // namespace

void bindScene(py::module_& module) {
  py::class_<Scene>(module, "Scene")
      .def(py::init([](const std::string& path, const std::vector<std::string>& settings) {
        std::unique_ptr<Scene> scene;
        interruptibly([&] { scene = std::make_unique<Scene>(path, settings); });
        return scene;
      }))
      .def_property_readonly("path", [](const Scene& scene) { return scene.resolved.description.path; })
      .def_property_readonly("settings",
                             [](const Scene& scene) { return scene.resolved.description.settings; })
      .def_property_readonly("text", [](const Scene& scene) { return scene.resolved.description.text; })
      .def_property_readonly("title", [](const Scene& scene) { return scene.resolved.description.title; })
      .def_property_readonly("is_adaptive", [](const Scene& scene) {
        const SceneDescription& of = scene.resolved.description;
        return of.time.controlled() || of.accuracy.asked() > 0;
      });
  module.def("check", &check);
  module.def("write_mesh", &writeMesh);
}

}  // namespace mortier::python
