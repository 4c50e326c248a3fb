// A viscoplastic rate of one's own, G(sigma, eps) [1/s], at many points, with its derivatives. As a
// small type in C++ it is
//
//   struct Creep {
//     static constexpr bool needsTotalStrain = false;                       whether G depends on eps
//     double rate = 0, stress = 0;
//     template <class Number>
//     Components<Number> rateOf(const Components<Number>& s, const Components<Number>& eps) const;
//   };
//
// whose Number is double, or Eigen's AutoDiffScalar, which counts derivatives along: operators and functions
// (sqrt, exp, log, pow, max ...) are found for both. Name what is kept `const Number`, not auto: an operator
// returns a formula of its operands. scene/registered_laws.h makes the law known to scenes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <type_traits>
#include <unsupported/Eigen/AutoDiff>
#include <vector>

#include "base/types.h"

namespace mortier {

/// A number and its derivatives along n directions. Where a function has none, as sqrt at 0, they are no
/// numbers.
template <int n>
using Differentiated = Eigen::AutoDiffScalar<Eigen::Matrix<double, n, 1>>;

/// Of a stress, a strain (eps12, not 2 eps12) or a rate. In plane stress s33 = 0, and eps33, which is not
/// known there, is NaN.
template <class Number>
struct Components {
  Number c11, c22, c12, c33;
};

class RateLaw {
 public:
  virtual ~RateLaw() = default;
  [[nodiscard]] virtual bool needsTotalStrain() const = 0;
  /// Columns are points; `stress` [Pa], `strain` [-], `rate` [1/s] have 4 rows, as Components. `slopes`, if
  /// any, has the 4 x 4 derivatives by the stress [1/(Pa s)], column major, and, where G depends on the
  /// strain, those by it [1/s] after them; no numbers where there are none. Several threads may call it.
  virtual void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const = 0;
  /// A rate may have no slopes where it is a number: sqrt(s11^2 + s22^2) has none without stress, where a law
  /// has no flow and every run begins. There they become those beside the point.
  /// \param modulus  what a strain of 1 is as a stress [Pa]
  void takeSlopesBeside(const Matrix& stress, const Matrix& strain, double modulus, Matrix& slopes) const;
  /// Rows of `slopes`.
  [[nodiscard]] int slopeRows() const { return needsTotalStrain() ? 32 : 16; }
};

/// How many points are evaluated together.
constexpr int pointsAtOnce = 32;

/// Runs `rateOf(const Number* in, Number* out, int points)` on blocks of points, with double or, for slopes,
/// Differentiated: in[k pointsAtOnce + i] is component k of stress and strain of a point, out of the rate.
template <bool needsTotalStrain, class RateOf>
void evaluateBlocks(const RateOf& rateOf, const Matrix& stress, const Matrix& strain, Matrix& rate,
                    Matrix* slopes) {
  constexpr int directions = needsTotalStrain ? 8 : 4;
  const auto run = [&]<class Number>(std::vector<Number> in) {
    std::vector<Number> out(4 * pointsAtOnce, Number(0));
    for (Eigen::Index begin = 0; begin < stress.cols(); begin += pointsAtOnce) {
      const int points = static_cast<int>(std::min<Eigen::Index>(pointsAtOnce, stress.cols() - begin));
      for (int i = 0; i < points; ++i)
        for (int k = 0; k < 8; ++k) {
          const double value = k < 4 ? stress(k, begin + i) : strain(k - 4, begin + i);
          if constexpr (std::is_same_v<Number, double>)
            in[k * pointsAtOnce + i] = value;
          else
            in[k * pointsAtOnce + i] = k < directions ? Number(value, directions, k) : Number(value);
        }
      rateOf(in.data(), out.data(), points);
      for (int i = 0; i < points; ++i)
        for (int c = 0; c < 4; ++c) {
          const Number& result = out[c * pointsAtOnce + i];
          if constexpr (std::is_same_v<Number, double>) {
            rate(c, begin + i) = result;
          } else {
            rate(c, begin + i) = result.value();
            for (int k = 0; k < directions; ++k) (*slopes)(4 * k + c, begin + i) = result.derivatives()[k];
          }
        }
    }
  };
  if (slopes == nullptr)
    run(std::vector<double>(8 * pointsAtOnce));
  else
    run(std::vector<Differentiated<directions>>(8 * pointsAtOnce, 0.0));
}

/// The rate law of a type as above.
template <class Law>
class TypedRateLaw final : public RateLaw {
 public:
  explicit TypedRateLaw(Law law) : law_(std::move(law)) {}
  [[nodiscard]] bool needsTotalStrain() const override { return Law::needsTotalStrain; }
  void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const override {
    evaluateBlocks<Law::needsTotalStrain>(
        [this]<class Number>(const Number* in, Number* out, int points) {
          const auto at = [&](int k, int i) { return in[k * pointsAtOnce + i]; };
          for (int i = 0; i < points; ++i) {
            const Components<Number> all =
                law_.rateOf(Components<Number>{at(0, i), at(1, i), at(2, i), at(3, i)},
                            Components<Number>{at(4, i), at(5, i), at(6, i), at(7, i)});
            out[i] = all.c11;
            out[pointsAtOnce + i] = all.c22;
            out[2 * pointsAtOnce + i] = all.c12;
            out[3 * pointsAtOnce + i] = all.c33;
          }
        },
        stress, strain, rate, slopes);
  }

 private:
  Law law_;
};

template <class Law>
std::shared_ptr<const RateLaw> rateLaw(Law law) {
  return std::make_shared<TypedRateLaw<Law>>(std::move(law));
}

}  // namespace mortier
