// The extension mortier._core; the package in mortier/ is what users see.
#include <pybind11/pybind11.h>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/printable.h"
#include "bind.h"
#include "commands/run.h"
#include "law.h"

namespace py = pybind11;

namespace {

/// As the exit codes of the program (mortier/errors.py), with the same line.
void raise(const char* type, const std::exception& error) {
  const py::object made = py::module_::import("mortier.errors").attr(type)(mortier::printable(error.what()));
  PyErr_SetObject(py::type::handle_of(made).ptr(), made.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(std::move(thrown));
  } catch (const mortier::python::PythonError& error) {
    error.restore();
  } catch (const mortier::InputError& error) {
    raise("InputError", error);
  } catch (const mortier::UnheldBodyError& error) {
    raise("FreeMotion", error);
  } catch (const mortier::OutputError& error) {
    raise("OutputError", error);
  } catch (const mortier::InterruptedError& error) {  // by what stopped another run of the process
    PyErr_SetString(PyExc_KeyboardInterrupt, error.what());
  } catch (const mortier::Interrupted& error) {
    PyErr_SetString(PyExc_KeyboardInterrupt, error.what());
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  py::register_local_exception_translator(&translate);
  module.attr("version") = mortier::version;
  mortier::python::bindScene(module);
  mortier::python::bindFields(module);
  mortier::python::bindLaw(module);
  mortier::python::bindRun(module);
}
