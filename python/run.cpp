#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <utility>

#include "base/printable.h"
#include "bind.h"
#include "fields.h"
#include "solution.h"
#include "worker.h"

namespace py = pybind11;

namespace mortier::python {

namespace {

/// The steps of a run that goes on when the next one is asked for.
class Steps {
 public:
  Steps(const Scene& scene, RunOptions options)
      : worker_([this, scene, options = std::move(options)](Worker& worker) {
          solution_ = solveScene(scene, options, false, [&](std::shared_ptr<Step> step) {
            step_ = std::move(step);
            worker.park();
          });
        }) {}

  /// None after the last one.
  std::shared_ptr<Step> next() {
    if (!worker_.go()) return {};
    return std::exchange(step_, {});
  }
  /// After the last step; where the run could not go on, what it came to.
  [[nodiscard]] std::shared_ptr<Solution> solution() const { return std::make_shared<Solution>(solution_); }

 private:
  std::shared_ptr<Step> step_;
  Solution solution_;
  Worker worker_;
};

std::shared_ptr<Solution> run(const Scene& scene, const std::string& out, int threads, double checkpoint,
                              bool keepAll) {
  const RunOptions options{out, checkpoint, threads};
  auto solution = std::make_shared<Solution>();
  interruptibly([&] { *solution = solveScene(scene, options, keepAll); });
  return solution;
}

py::dict historyOf(const py::object& self) {
  py::dict all;
  for (const auto& [name, column] : self.cast<Solution&>().history)
    all[py::str(name)] = std::visit(
        [&self](const auto& values) -> py::object {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          if constexpr (std::is_arithmetic_v<Value>)
            return view(values.data(), {static_cast<py::ssize_t>(values.size())}, self);
          else
            return py::cast(values);
        },
        column);
  return all;
}

}  // namespace

void bindRun(py::module_& module) {
  py::class_<Solution, std::shared_ptr<Solution>>(module, "Solution")
      .def_property_readonly("steps", [](const Solution& solution) { return solution.steps; })
      .def_property_readonly("history", &historyOf)
      .def_readonly("summary", &Solution::summary)
      .def_readonly("folder", &Solution::folder)
      .def_property_readonly("code", [](const Solution& s) { return static_cast<int>(s.ending.code); })
      .def_property_readonly("reason", [](const Solution& s) { return printable(s.ending.reason); });
  py::class_<Steps>(module, "Steps")
      .def(py::init([](const Scene& scene, int threads) {
        return std::make_unique<Steps>(scene, RunOptions{"", 0, threads});
      }))
      .def("next", &Steps::next)
      .def_property_readonly("solution", &Steps::solution);
  module.def("run", &run);
}

}  // namespace mortier::python
