// What the rate of a law and its 4 x 4 derivatives by the stress cost a point: types in C++ and expressions,
// by Eigen's AutoDiffScalar, beside the other libraries of Debian that the compiler finds.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "clock.h"
#include "material/rate_law.h"
#include "scene/formulas.h"

#if __has_include(<boost/math/differentiation/autodiff.hpp>)
#include <boost/math/differentiation/autodiff.hpp>
#define HAS_BOOST
#endif
#if __has_include(<ceres/jet.h>)
#include <ceres/jet.h>
#define HAS_CERES
#endif
#if __has_include(<adolc/adolc.h>)
#include <adolc/adolc.h>
#define HAS_ADOLC
#endif

namespace {

using mortier::Components;
using mortier::Differentiated;
using mortier::Matrix;

constexpr int points = 4096;
constexpr double exponent = 4.5;

/// 0.3 |s|^(n-1) dev s in any numbers.
template <class Number>
void norton(const Number* s, Number* rate) {
  using std::pow, std::sqrt;
  const Number mean = (s[0] + s[1] + s[3]) / 3.0;
  const Number a = s[0] - mean;
  const Number b = s[1] - mean;
  const Number c = s[3] - mean;
  const Number mises = sqrt(1.5 * (a * a + b * b + c * c + 2.0 * (s[2] * s[2])));
  const Number flow = 0.3 * pow(mises, exponent - 1);
  rate[0] = flow * a;
  rate[1] = flow * b;
  rate[2] = flow * s[2];
  rate[3] = flow * c;
}

struct Norton {
  static constexpr bool needsTotalStrain = false;
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>&) const {
    const Number in[] = {s.c11, s.c22, s.c12, s.c33};
    Number out[4];
    norton(in, out);
    return {out[0], out[1], out[2], out[3]};
  }
};

double unit = 0;
double checksum = 0;

/// `work` fills slopes, 16 x points.
template <class Work>
void measure(const char* name, const Matrix& stress, Work work) {
  Matrix slopes = Matrix::Zero(16, points);
  double least = INFINITY;
  for (int i = 0; i < 20; ++i)
    least = std::min(least, mortier::bench::secondsOf([&] { work(stress, slopes); }));
  const double each = 1e9 * least / points;
  if (unit == 0) {
    unit = each;
    checksum = slopes.norm();
  }
  const double off = std::abs(slopes.norm() / checksum - 1);
  std::printf("%-44s %8.1f ns  %6.1f", name, each, each / unit);
  std::puts(off < 1e-10 ? "" : "   (other numbers)");
}

/// One point after the other; load(s, k) makes a variable, slope(x, k) reads a derivative.
template <class Number, class Load, class Slope>
void onePointAtATime(const Matrix& stress, Matrix& slopes, Load load, Slope slope) {
  for (int i = 0; i < points; ++i) {
    Number in[4];
    Number out[4];
    for (int k = 0; k < 4; ++k) load(in[k], stress(k, i), k);
    norton(in, out);
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 4; ++c) slopes(4 * k + c, i) = slope(out[c], k);
  }
}

const char* const mises = "sqrt(s11^2 + s22^2 + s33^2 - s11*s22 - s22*s33 - s33*s11 + 3*s12^2)";

void formulas(const Matrix& stress, Matrix& slopes) {
  static const mortier::Formulas law = [] {
    mortier::Formulas made(
        {"s11", "s22", "s12", "s33"},
        {{"mises", {mises, ""}}, {"m", {"(s11 + s22 + s33)/3", ""}}, {"flow", {"0.3*mises^3.5", ""}}});
    for (const char* text : {"flow*(s11 - m)", "flow*(s22 - m)", "flow*s12", "flow*(s33 - m)"})
      made.add({text, ""});
    return made;
  }();
  Matrix rate(4, points);
  std::vector<Differentiated<4>> work;
  mortier::evaluateBlocks<false>(
      [&]<class Number>(const Number* in, Number* out, int count) {
        if constexpr (!std::is_same_v<Number, double>) law.evaluate(in, out, count, work);
      },
      stress, stress, rate, &slopes);
}

}  // namespace

int main() {
  mortier::bench::timeOf = mortier::bench::TimeOf::processor;
  const Matrix stress = Matrix::Random(4, points) * 3;
  Matrix rate(4, points);
  const auto own = mortier::rateLaw(Norton());
  measure("mortier, a type in C++", stress,
          [&](const Matrix& s, Matrix& slopes) { own->evaluate(s, s, rate, &slopes); });
  measure("mortier, expressions", stress, formulas);
  using Eigens = Eigen::AutoDiffScalar<Eigen::Vector4d>;
  measure("Eigen, AutoDiffScalar, bare", stress, [](const Matrix& s, Matrix& slopes) {
    onePointAtATime<Eigens>(
        s, slopes, [](Eigens& x, double value, int k) { x = Eigens(value, 4, k); },
        [](const Eigens& x, int k) { return x.derivatives()[k]; });
  });
#ifdef HAS_CERES
  using Jet = ceres::Jet<double, 4>;
  measure("Ceres, Jet", stress, [](const Matrix& s, Matrix& slopes) {
    onePointAtATime<Jet>(
        s, slopes, [](Jet& x, double value, int k) { x = Jet(value, k); },
        [](const Jet& x, int k) { return x.v[k]; });
  });
#endif
#ifdef HAS_BOOST
  measure("Boost.Math, autodiff (a call a direction)", stress, [](const Matrix& s, Matrix& slopes) {
    using boost::math::differentiation::make_fvar;
    using Variable = decltype(make_fvar<double, 1>(0.0));
    for (int i = 0; i < points; ++i)
      for (int k = 0; k < 4; ++k) {
        Variable in[4];
        Variable out[4];
        for (int c = 0; c < 4; ++c) in[c] = c == k ? make_fvar<double, 1>(s(c, i)) : Variable(s(c, i));
        norton(in, out);
        for (int c = 0; c < 4; ++c) slopes(4 * k + c, i) = out[c].derivative(1);
      }
  });
#endif
#ifdef HAS_ADOLC
  {
    constexpr short tape = 1;
    trace_on(tape);
    adouble in[4];
    adouble out[4];
    for (int k = 0; k < 4; ++k) in[k] <<= stress(k, 0);
    norton(in, out);
    double value = 0;
    for (adouble& each : out) each >>= value;
    trace_off();
    measure("ADOL-C, jacobian of a tape", stress, [&](const Matrix& s, Matrix& slopes) {
      double rows[4][4];
      double* J[] = {rows[0], rows[1], rows[2], rows[3]};
      for (int i = 0; i < points; ++i) {
        double x[] = {s(0, i), s(1, i), s(2, i), s(3, i)};
        jacobian(tape, 4, 4, x, J);
        for (int k = 0; k < 4; ++k)
          for (int c = 0; c < 4; ++c) slopes(4 * k + c, i) = J[c][k];
      }
    });
  }
#endif
}
