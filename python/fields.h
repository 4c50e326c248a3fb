// NumPy's view of a step: arrays that are read only, whose memory the step owns and which keep it alive.
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <variant>
#include <vector>

#include "solution.h"

namespace mortier::python {

/// Of the owner's memory, without a copy.
template <class Number>
pybind11::array view(const Number* data, const std::vector<pybind11::ssize_t>& shape,
                     pybind11::handle owner) {
  static const Number none{};  // of an empty vector
  pybind11::array array(pybind11::dtype::of<Number>(), shape, {}, data != nullptr ? data : &none, owner);
  pybind11::detail::array_proxy(array.ptr())->flags &= ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// name -> value, in the order of the columns of history.csv.
pybind11::dict namedValues(const std::vector<std::string>& names, const std::vector<HistoryValue>& values);

}  // namespace mortier::python
