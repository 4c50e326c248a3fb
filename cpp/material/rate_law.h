// A user-defined viscoplastic rate, G(sigma, eps) [1/s], at many points, with its derivatives. As a
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
#include <utility>
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

/// The same in space. A law whose rateOf takes these supports bodies in space; a template takes both.
template <class Number>
struct SpaceComponents {
  Number c11, c22, c12, c33, c13, c23;
};

class RateLaw {
 public:
  virtual ~RateLaw() = default;
  [[nodiscard]] virtual bool needsTotalStrain() const = 0;
  /// Whether it is the law of tensors of so many components: 4, or 6 in space.
  [[nodiscard]] virtual bool takes(int components) const { return components == 4; }
  /// Columns are points; `stress` [Pa], `strain` [-], `rate` [1/s] have n = 4 rows, as Components, or 6, as
  /// SpaceComponents. `slopes`, if any, has the n x n derivatives by the stress [1/(Pa s)], column major,
  /// and, where G depends on the strain, those by it [1/s] after them; no numbers where there are none.
  /// Several threads may call it.
  virtual void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const = 0;
  /// A rate may have no slopes where it is a number: sqrt(s11^2 + s22^2) has none without stress, where a law
  /// has no flow and every run begins. There they become those beside the point.
  /// \param modulus  what a strain of 1 is as a stress [Pa]
  void takeSlopesBeside(const Matrix& stress, const Matrix& strain, double modulus, Matrix& slopes) const;
  /// Rows of `slopes`.
  [[nodiscard]] Eigen::Index slopeRows(Eigen::Index components) const {
    return (needsTotalStrain() ? 2 : 1) * components * components;
  }
};

/// How many points are evaluated together.
constexpr int pointsAtOnce = 32;

/// Runs `rateOf(const Number* in, Number* out, int points)` on blocks of points, with double or, for slopes,
/// Differentiated: in[k pointsAtOnce + i] is component k of stress and strain of a point, out of the rate.
template <int n, bool needsTotalStrain, class RateOf>
void evaluateBlocks(const RateOf& rateOf, const Matrix& stress, const Matrix& strain, Matrix& rate,
                    Matrix* slopes) {
  constexpr int directions = needsTotalStrain ? 2 * n : n;
  const auto run = [&]<class Number>(std::vector<Number> in) {
    std::vector<Number> out(n * pointsAtOnce, Number(0));
    for (Eigen::Index begin = 0; begin < stress.cols(); begin += pointsAtOnce) {
      const int points = static_cast<int>(std::min<Eigen::Index>(pointsAtOnce, stress.cols() - begin));
      for (int i = 0; i < points; ++i)
        for (int k = 0; k < 2 * n; ++k) {
          const double value = k < n ? stress(k, begin + i) : strain(k - n, begin + i);
          if constexpr (std::is_same_v<Number, double>)
            in[k * pointsAtOnce + i] = value;
          else
            in[k * pointsAtOnce + i] = k < directions ? Number(value, directions, k) : Number(value);
        }
      rateOf(in.data(), out.data(), points);
      for (int i = 0; i < points; ++i)
        for (int c = 0; c < n; ++c) {
          const Number& result = out[c * pointsAtOnce + i];
          if constexpr (std::is_same_v<Number, double>) {
            rate(c, begin + i) = result;
          } else {
            rate(c, begin + i) = result.value();
            for (int k = 0; k < directions; ++k) (*slopes)(n * k + c, begin + i) = result.derivatives()[k];
          }
        }
    }
  };
  if (slopes == nullptr)
    run(std::vector<double>(2 * n * pointsAtOnce));
  else
    run(std::vector<Differentiated<directions>>(2 * n * pointsAtOnce, 0.0));
}

/// The rate law of a type as above.
template <class Law>
class TypedRateLaw final : public RateLaw {
 public:
  explicit TypedRateLaw(Law law) : law_(std::move(law)) {}
  [[nodiscard]] bool needsTotalStrain() const override { return Law::needsTotalStrain; }
  [[nodiscard]] bool takes(int components) const override { return components == 4 ? inPlane : inSpace; }
  void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const override {
    if constexpr (inPlane)
      if (stress.rows() == 4) return evaluateAs<4, Components>(stress, strain, rate, slopes);
    if constexpr (inSpace)
      if (stress.rows() == 6) return evaluateAs<6, SpaceComponents>(stress, strain, rate, slopes);
  }

 private:
  template <class Tensor>
  static constexpr bool isOf = requires(const Law& law, const Tensor& tensor) {
    law.rateOf(tensor, tensor);
  };
  static constexpr bool inPlane = isOf<Components<double>>;
  static constexpr bool inSpace = isOf<SpaceComponents<double>>;

  template <int n, template <class> class Tensor>
  void evaluateAs(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const {
    evaluateBlocks<n, Law::needsTotalStrain>(
        [this]<class Number>(const Number* in, Number* out, int points) {
          eachPoint<Tensor<Number>>(in, out, points);
        },
        stress, strain, rate, slopes);
  }

  template <class Tensor, class Number>
  void eachPoint(const Number* in, Number* out, int points) const {
    constexpr int n = sizeof(Tensor) / sizeof(Number);
    const auto tensorAt = [&]<size_t... k>(const Number* first, std::index_sequence<k...>) {
      return Tensor{first[k * pointsAtOnce]...};
    };
    for (int i = 0; i < points; ++i) {
      const Tensor all = law_.rateOf(tensorAt(in + i, std::make_index_sequence<n>()),
                                     tensorAt(in + n * pointsAtOnce + i, std::make_index_sequence<n>()));
      out[i] = all.c11;
      out[pointsAtOnce + i] = all.c22;
      out[2 * pointsAtOnce + i] = all.c12;
      out[3 * pointsAtOnce + i] = all.c33;
      if constexpr (n == 6) {
        out[4 * pointsAtOnce + i] = all.c13;
        out[5 * pointsAtOnce + i] = all.c23;
      }
    }
  }

  Law law_;
};

template <class Law>
std::shared_ptr<const RateLaw> rateLaw(Law law) {
  return std::make_shared<TypedRateLaw<Law>>(std::move(law));
}

}  // namespace mortier
