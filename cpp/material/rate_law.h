// A viscoplastic rate of one's own, G(sigma, eps) [1/s], at many points, with its derivatives. As a
// small type in C++ it is
//
//   struct Creep {
//     static constexpr bool ofStrain = false;                       whether G depends on eps
//     double rate = 0, stress = 0;
//     template <class Number>
//     Components<Number> rateOf(const Components<Number>& s, const Components<Number>& eps) const;
//   };
//
// whose Number counts derivatives along (dual.h): with operators and functions of it nothing else is needed.
// scene/registered_laws.h makes it known to scenes.
#pragma once

#include <memory>

#include "base/types.h"
#include "material/dual.h"

namespace mortier {

/// Of a stress, a strain (eps12, not 2 eps12) or a rate. In plane stress s33 = 0, and eps33, which is not
/// known there, is NaN.
template <class Number>
struct Components {
  Number c11, c22, c12, c33;
};

class RateLaw {
 public:
  virtual ~RateLaw() = default;
  [[nodiscard]] virtual bool ofStrain() const = 0;
  /// Columns are points; `stress` [Pa], `strain` [-], `rate` [1/s] have 4 rows, as Components. `slopes`, if
  /// any, has the 4 x 4 derivatives by the stress [1/(Pa s)], column major, and, where G depends on the
  /// strain, those by it [1/s] after them. Several threads may call it.
  virtual void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const = 0;
  /// Rows of `slopes`.
  [[nodiscard]] int slopeRows() const { return ofStrain() ? 32 : 16; }
};

/// Runs `rateOf(Dual<n> in[8], Dual<n> out[4])`, which is generic in n, at each point: in are the components
/// of stress and strain.
template <bool ofStrain, class RateOf>
void evaluateEach(const RateOf& rateOf, const Matrix& stress, const Matrix& strain, Matrix& rate,
                  Matrix* slopes) {
  const auto run = [&]<int n>(std::array<Dual<n>, 8> in) {
    std::array<Dual<n>, 4> out;
    for (int k = 0; k < n; ++k) in[k].slope[k] = 1;
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      for (int k = 0; k < 4; ++k) {
        in[k].value = stress(k, i);
        in[4 + k].value = strain(k, i);
      }
      rateOf(in.data(), out.data());
      for (int c = 0; c < 4; ++c) {
        rate(c, i) = out[c].value;
        for (int k = 0; k < n; ++k) (*slopes)(4 * k + c, i) = out[c].slope[k];
      }
    }
  };
  if (slopes == nullptr)
    run(std::array<Dual<0>, 8>{});
  else
    run(std::array<Dual<ofStrain ? 8 : 4>, 8>{});
}

/// The rate law of a type as above.
template <class Law>
class TypedRateLaw final : public RateLaw {
 public:
  explicit TypedRateLaw(Law law) : law_(std::move(law)) {}
  [[nodiscard]] bool ofStrain() const override { return Law::ofStrain; }
  void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const override {
    evaluateEach<Law::ofStrain>(
        [this]<int n>(const Dual<n>* in, Dual<n>* out) {
          const Components<Dual<n>> all = law_.rateOf(Components<Dual<n>>{in[0], in[1], in[2], in[3]},
                                                      Components<Dual<n>>{in[4], in[5], in[6], in[7]});
          out[0] = all.c11;
          out[1] = all.c22;
          out[2] = all.c12;
          out[3] = all.c33;
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
