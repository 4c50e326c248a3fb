// Laws of scenes as Python callables of NumPy arrays, many points at once (docs/python.md).
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>

#include "base/error.h"
#include "bind.h"
#include "law.h"
#include "scene/registered_laws.h"

namespace py = pybind11;

namespace mortier::python {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Shared by threads without the interpreter lock, which the last owner takes; when the interpreter has ended
/// its objects are gone.
template <class T>
std::shared_ptr<T> shared(T objects) {
  return {new T(std::move(objects)), [](T* old) {
            if (Py_IsInitialized() == 0) return;
            const py::gil_scoped_acquire held;
            delete old;
          }};
}

struct Callables {
  py::object rate;
  py::object derivative;  ///< or None
};

class PythonLaw final : public RateLaw {
 public:
  /// The interpreter lock is held.
  PythonLaw(std::shared_ptr<Callables> callables, py::dict parameters, bool needsTotalStrain,
            std::string name)
      : callables_(std::move(callables)),
        parameters_(shared(std::move(parameters))),
        needsTotalStrain_(needsTotalStrain),
        name_(std::move(name)) {}

  [[nodiscard]] bool needsTotalStrain() const override { return needsTotalStrain_; }
  [[nodiscard]] bool takes(int /*components*/) const override { return true; }
  void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const override {
    const py::gil_scoped_acquire held;
    try {
      rate = rateAt(stress, strain);
      if (slopes == nullptr) return;
      if (callables_->derivative.is_none())
        difference(stress, strain, *slopes);
      else
        *slopes = derivativeAt(stress, strain);
    } catch (const py::error_already_set& error) {
      throw PythonError(error);
    }
  }

 private:
  /// As rows of points.
  static Numbers rowsOf(const Matrix& columns) {
    Numbers rows({columns.cols(), columns.rows()});
    std::copy_n(columns.data(), columns.size(), rows.mutable_data());
    return rows;
  }

  [[nodiscard]] Numbers call(const py::object& callable, const Matrix& stress, const Matrix& strain) const {
    return Numbers(callable(rowsOf(stress), rowsOf(strain), **(*parameters_)));
  }

  void requireShape(const Numbers& is, bool right, const char* what, const std::string& expected) const {
    if (!right)
      throw InputError("law \"" + name_ + "\": " + what + " of shape " +
                       std::string(py::str(is.attr("shape"))) + ", expected " + expected);
  }

  [[nodiscard]] Matrix rateAt(const Matrix& stress, const Matrix& strain) const {
    const Numbers rates = call(callables_->rate, stress, strain);
    const Eigen::Index n = stress.rows();
    const bool right = rates.ndim() == 2 && rates.shape(0) == stress.cols() && rates.shape(1) == n;
    requireShape(rates, right, "a rate",
                 "(" + std::to_string(stress.cols()) + ", " + std::to_string(n) + ")");
    return Eigen::Map<const Matrix>(rates.data(), n, stress.cols());
  }

  /// (points, n, n): [point, component of the rate, of the stress]; (points, n, 2n) with those of the strain;
  /// n = 4, in space 6.
  [[nodiscard]] Matrix derivativeAt(const Matrix& stress, const Matrix& strain) const {
    const Numbers all = call(callables_->derivative, stress, strain);
    const Eigen::Index n = stress.rows();
    const py::ssize_t directions = slopeRows(n) / n;
    const bool right =
        all.ndim() == 3 && all.shape(0) == stress.cols() && all.shape(1) == n && all.shape(2) == directions;
    requireShape(all, right, "a derivative",
                 "(" + std::to_string(stress.cols()) + ", " + std::to_string(n) + ", " +
                     std::to_string(directions) + ")");
    Matrix slopes(slopeRows(n), stress.cols());
    for (py::ssize_t i = 0; i < all.shape(0); ++i)
      for (py::ssize_t c = 0; c < n; ++c)
        for (py::ssize_t k = 0; k < directions; ++k) slopes(n * k + c, i) = all.at(i, c, k);
    return slopes;
  }

  /// Central differences, each as large as rounding asks beside the largest component, in one call.
  void difference(const Matrix& stress, const Matrix& strain, Matrix& slopes) const {
    constexpr double part = 6e-6;  // the third root of what doubles resolve
    const Eigen::Index points = stress.cols();
    const Eigen::Index n = stress.rows();
    const Eigen::Index directions = slopeRows(n) / n;
    const Eigen::Index known = n == 4 ? 3 : n;  // in plane stress the last strain is not
    const auto stepOf = [&](const Matrix& of, Eigen::Index i) {
      const double all = of.topRows(known).cwiseAbs().maxCoeff();
      const double own = of.col(i).head(known).cwiseAbs().maxCoeff();
      const double size = own > 0 ? own : all;
      return size > 0 ? part * size : part * part;
    };
    Matrix s = stress.replicate(1, 2 * directions);
    Matrix e = strain.replicate(1, 2 * directions);
    for (Eigen::Index k = 0; k < directions; ++k)
      for (Eigen::Index i = 0; i < points; ++i) {
        Matrix& moved = k < n ? s : e;
        const double h = stepOf(k < n ? stress : strain, i);
        moved(k % n, 2 * k * points + i) += h;
        moved(k % n, (2 * k + 1) * points + i) -= h;
      }
    const Matrix rates = rateAt(s, e);
    for (Eigen::Index k = 0; k < directions; ++k)
      for (Eigen::Index i = 0; i < points; ++i) {
        const Matrix& of = k < n ? s : e;
        const Eigen::Index above = 2 * k * points + i;
        const Eigen::Index below = above + points;
        const double h = of(k % n, above) - of(k % n, below);
        slopes.col(i).segment(n * k, n) =
            std::isfinite(h) ? Vector((rates.col(above) - rates.col(below)) / h) : Vector::Zero(n);
      }
  }

  std::shared_ptr<Callables> callables_;
  std::shared_ptr<py::dict> parameters_;
  bool needsTotalStrain_;
  std::string name_;
};

void registerCallable(const std::string& name, const py::object& rate, const py::object& derivative,
                      bool needsTotalStrain) {
  const auto callables = shared(Callables{rate, derivative});
  registerLaw(name, [=](const LawParameters& parameters) -> std::shared_ptr<const RateLaw> {
    const py::gil_scoped_acquire held;
    py::dict numbers;
    for (const auto& [key, value] : parameters.all()) numbers[py::str(key)] = value;
    return std::make_shared<PythonLaw>(callables, numbers, needsTotalStrain, name);
  });
}

}  // namespace

PythonError::PythonError(const py::error_already_set& error)
    : std::runtime_error("a law in Python raised an error"), error_(shared(error)) {}

void bindLaw(py::module_& module) {
  module.def("register_law", &registerCallable);
  module.def("forget_law", &forgetLaw);
}

}  // namespace mortier::python
