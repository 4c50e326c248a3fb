// A viscoplastic rate of one's own, G(sigma, eps) [1/s], at many points at once, with its derivatives. As a
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

/// Runs `rateOf(Dual<n> in[8], Dual<n> out[4])`, which is generic in n, over all points: in are the
/// components of stress and strain.
template <bool ofStrain, class RateOf>
void evaluateInLanes(const RateOf& rateOf, const Matrix& stress, const Matrix& strain, Matrix& rate,
                     Matrix* slopes) {
  constexpr int directions = ofStrain ? 8 : 4;
  const int points = static_cast<int>(stress.cols());
  const auto run = [&]<int n>(std::array<Dual<n>, 8> in, const Batch& batch) {
    std::array<Dual<n>, 4> out;
    rateOf(in.data(), out.data());
    batch.store(std::array<Lanes, 4>{out[0].value, out[1].value, out[2].value, out[3].value}, rate.data());
    if constexpr (n > 0) {
      std::array<Lanes, 4 * n> all;
      for (int k = 0; k < n; ++k)
        for (int c = 0; c < 4; ++c) all[4 * k + c] = out[c].slope[k];
      batch.store(all, slopes->data());
    }
  };
  for (int i = 0; i < points; i += laneCount) {
    const Batch batch(i, points);
    const std::array<Lanes, 4> s = batch.load<4>(stress.data());
    const std::array<Lanes, 4> e = batch.load<4>(strain.data());
    const auto start = [&]<int n>() {
      std::array<Dual<n>, 8> in;
      for (int k = 0; k < 4; ++k) {
        in[k] = s[k];
        in[4 + k] = e[k];
      }
      for (int k = 0; k < n; ++k) in[k].slope[k] = 1;
      return in;
    };
    if (slopes == nullptr)
      run.template operator()<0>(start.template operator()<0>(), batch);
    else
      run.template operator()<directions>(start.template operator()<directions>(), batch);
  }
}

/// The rate law of a type as above.
template <class Law>
class TypedRateLaw final : public RateLaw {
 public:
  explicit TypedRateLaw(Law law) : law_(std::move(law)) {}
  [[nodiscard]] bool ofStrain() const override { return Law::ofStrain; }
  [[gnu::flatten]] void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate,
                                 Matrix* slopes) const override {
    evaluateInLanes<Law::ofStrain>(
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
