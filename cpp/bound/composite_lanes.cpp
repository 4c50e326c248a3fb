#include "bound/composite_lanes.h"

#include <numbers>

#include "bound/composite_reference.h"

namespace mortier {
namespace {

/// Energies of Airy modes by the six coefficients, one entry of the lower triangle after the other.
using AiryTable = std::array<std::array<double, 6>, 78>;

const AiryTable& airyTable() {
  static const AiryTable only = [] {
    AiryTable table;
    for (int k = 0; k < 6; ++k) {
      size_t at = 0;
      for (int c = 0; c < 12; ++c)
        for (int r = c; r < 12; ++r) table[at++][k] = compositeReference().airyEnergies[k](r, c);
    }
    return table;
  }();
  return only;
}

}  // namespace

CompositeLanes::CompositeLanes(const std::array<Lanes, 6>& corners, const std::array<Lanes, 6>& compliance)
    : x_(corners) {
  const Lanes a = x_[2] - x_[0];
  const Lanes b = x_[4] - x_[0];
  const Lanes c = x_[3] - x_[1];
  const Lanes d = x_[5] - x_[1];
  F_ = {a, b, c, d};
  J_ = a * d - b * c;
  const Lanes over = 1 / J_;
  inverse_ = {d * over, -b * over, -c * over, a * over};
  // The columns of J P.
  const std::array<std::array<Lanes, 3>, 3> P{
      {{a * a, c * c, a * c}, {b * b, d * d, b * d}, {2 * a * b, 2 * c * d, a * d + b * c}}};
  const auto& [s00, s11, s22, s01, s02, s12] = compliance;
  std::array<std::array<Lanes, 3>, 3> SP;
  for (int k = 0; k < 3; ++k) {
    const auto& [p, q, r] = P[k];
    SP[k] = {s00 * p + s01 * q + s02 * r, s01 * p + s11 * q + s12 * r, s02 * p + s12 * q + s22 * r};
  }
  const auto product = [&](int i, int j) {
    return over * (P[i][0] * SP[j][0] + P[i][1] * SP[j][1] + P[i][2] * SP[j][2]);
  };
  reference_ = {product(0, 0), product(1, 1), product(2, 2), product(0, 1), product(0, 2), product(1, 2)};
}

CompositeLanes::Twelve CompositeLanes::momentsOf(const std::array<Lanes, 3>& stress) const {
  Twelve result;
  for (int k = 0; k < 3; ++k) {
    const auto [x, y] = sideOf(k);
    result[4 * k] = (stress[0] * y - stress[2] * x) / 2;
    result[4 * k + 1] = (stress[2] * y - stress[1] * x) / 2;
    result[4 * k + 2] = result[4 * k];
    result[4 * k + 3] = result[4 * k + 1];
  }
  return result;
}

CompositeLanes::Twelve CompositeLanes::airyOf(const Twelve& m) const {
  Twelve modes;
  Lanes value = 0;
  std::array<Lanes, 2> gradient{0, 0};
  for (int k = 0; k < 3; ++k) {
    modes[3 * k] = value;
    modes[3 * k + 1] = gradient[0];
    modes[3 * k + 2] = gradient[1];
    const auto [x, y] = sideOf(k);
    const std::array<Lanes, 2> mean{gradient[0] - m[4 * k + 1], gradient[1] + m[4 * k]};
    modes[9 + k] = (mean[0] * y - mean[1] * x) / sqrt(x * x + y * y);
    gradient = {mean[0] - m[4 * k + 3], mean[1] + m[4 * k + 2]};
    value += mean[0] * x + mean[1] * y;
  }
  return modes;
}

/// As a function of the reference triangle an Airy function has the gradient F' grad, and the stress J S.
void CompositeLanes::airyEnergy(std::array<Lanes, 144>& K) const {
  const Lanes over = 1 / (J_ * J_);
  std::array<Lanes, 6> C;
  for (int k = 0; k < 6; ++k) C[k] = over * reference_[k];
  const std::array<double, 6>* entry = airyTable().data();
  for (int c = 0; c < 12; ++c)
    for (int r = c; r < 12; ++r, ++entry) {
      Lanes sum = (*entry)[0] * C[0];
      for (int k = 1; k < 6; ++k) sum += (*entry)[k] * C[k];
      K[12 * c + r] = sum;
      K[12 * r + c] = sum;
    }
  constexpr double slope = std::numbers::sqrt2 / 2;
  constexpr double normals[3][2] = {{0, -1}, {slope, slope}, {-1, 0}};  // of the reference triangle
  std::array<Lanes, 3> along;   // (Phi(Q) - Phi(P)) in the derivative along the normal of the reference
  std::array<Lanes, 3> normal;  // and the mean normal derivative
  for (int k = 0; k < 3; ++k) {
    const auto [x, y] = sideOf(k);
    const Lanes nx = F_[0] * normals[k][0] + F_[1] * normals[k][1];
    const Lanes ny = F_[2] * normals[k][0] + F_[3] * normals[k][1];
    const Lanes square = x * x + y * y;
    along[k] = (nx * x + ny * y) / square;
    normal[k] = (nx * y - ny * x) / sqrt(square);
  }
  const auto toModes = [&](Lanes* first, int stride) {
    for (int k = 0; k < 3; ++k) {
      Lanes& derivative = first[stride * (9 + k)];
      first[stride * 3 * k] -= along[k] * derivative;
      first[stride * 3 * ((k + 1) % 3)] += along[k] * derivative;
      derivative *= normal[k];
    }
    for (int i = 0; i < 3; ++i) {
      Lanes& x = first[stride * (3 * i + 1)];
      Lanes& y = first[stride * (3 * i + 2)];
      const Lanes before = x;
      x = F_[0] * before + F_[1] * y;
      y = F_[2] * before + F_[3] * y;
    }
  };
  for (int i = 0; i < 12; ++i) toModes(&K[i], 12);
  for (int i = 0; i < 12; ++i) toModes(&K[static_cast<size_t>(12) * i], 1);
}

Lanes CompositeLanes::energyOf(const Twelve& m, const std::array<Lanes, 3>& f) const {
  Twelve moments;
  for (int i = 0; i < 6; ++i) {
    moments[2 * i] = inverse_[0] * m[2 * i] + inverse_[1] * m[2 * i + 1];
    moments[2 * i + 1] = inverse_[2] * m[2 * i] + inverse_[3] * m[2 * i + 1];
  }
  std::array<Lanes, 27> values;
  const auto& stresses = compositeReference().stresses;
  for (int i = 0; i < 27; ++i) {
    values[i] = stresses(i, 0) * moments[0];
    for (int j = 1; j < 12; ++j) values[i] += stresses(i, j) * moments[j];
  }
  if (any_of(f[2] != 0))
    for (int i = 0; i < 27; ++i) values[i] += f[2] / J_ * compositeReference().turn[i];
  if (any_of(f[0] != 0 || f[1] != 0))
    for (int corner = 0; corner < 3; ++corner) {
      // The load diag(-f1 y1, -f2 y2), y from the centroid, as J F^-1 s F^-T.
      const Lanes s = J_ * f[0] * ((x_[0] + x_[2] + x_[4]) / 3 - x_[2 * corner]);
      const Lanes t = J_ * f[1] * ((x_[1] + x_[3] + x_[5]) / 3 - x_[2 * corner + 1]);
      const auto& [a, b, c, d] = inverse_;
      const std::array<Lanes, 3> load{s * a * a + t * b * b, s * c * c + t * d * d, s * a * c + t * b * d};
      for (int component = 0; component < 3; ++component) {
        values[9 * component + 3 * corner] += load[component];
        values[9 * component + 3 * ((corner + 2) % 3) + 1] += load[component];
      }
    }
  const auto product = [&](int i, int j) {
    Lanes sum = 0;
    for (int part = 0; part < 9; part += 3) {
      const Lanes* const v = &values[9 * i + part];
      const Lanes* const w = &values[9 * j + part];
      sum += v[0] * w[0] + v[1] * w[1] + v[2] * w[2] + (v[0] + v[1] + v[2]) * (w[0] + w[1] + w[2]);
    }
    return sum;
  };
  const auto& C = reference_;
  return (C[0] * product(0, 0) + C[1] * product(1, 1) + C[2] * product(2, 2) +
          2 * (C[3] * product(0, 1) + C[4] * product(0, 2) + C[5] * product(1, 2))) /
         72;
}

}  // namespace mortier
