// Points of a mesh in batches of eight, side by side in vector registers: vectors of GCC and Clang, of which
// the laws compile in a fraction of the time that std::experimental::simd takes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace mortier {

constexpr int laneCount = 8;

/// One truth a lane.
class LaneMask {
 public:
  using Half = long long __attribute__((vector_size(32)));

  LaneMask() = default;
  explicit LaneMask(bool all) : low(Half{} - (all ? 1 : 0)), high(low) {}
  LaneMask(const Half& first, const Half& second) : low(first), high(second) {}

  friend LaneMask operator&&(const LaneMask& a, const LaneMask& b) {
    return {a.low & b.low, a.high & b.high};
  }
  friend LaneMask operator!(const LaneMask& a) { return {~a.low, ~a.high}; }
  friend bool any_of(const LaneMask& a) {
    const Half either = a.low | a.high;
    return (either[0] | either[1] | either[2] | either[3]) != 0;
  }
  friend bool none_of(const LaneMask& a) { return !any_of(a); }

  Half low, high;
};

/// One number a lane.
class Lanes {
 public:
  using Half = double __attribute__((vector_size(32)));

  Lanes() = default;
  Lanes(double all) : low(all - Half{}), high(low) {}  // NOLINT(google-explicit-constructor): as numbers are
  Lanes(const Half& first, const Half& second) : low(first), high(second) {}

  [[nodiscard]] double operator[](int lane) const { return lane < 4 ? low[lane] : high[lane - 4]; }

  friend Lanes operator-(const Lanes& a) { return {-a.low, -a.high}; }
  friend Lanes operator+(const Lanes& a, const Lanes& b) { return {a.low + b.low, a.high + b.high}; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return {a.low - b.low, a.high - b.high}; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return {a.low * b.low, a.high * b.high}; }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return {a.low / b.low, a.high / b.high}; }
  Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
  Lanes& operator*=(const Lanes& b) { return *this = *this * b; }
  Lanes& operator/=(const Lanes& b) { return *this = *this / b; }

  friend LaneMask operator<(const Lanes& a, const Lanes& b) { return {a.low < b.low, a.high < b.high}; }
  friend LaneMask operator>(const Lanes& a, const Lanes& b) { return {a.low > b.low, a.high > b.high}; }
  friend LaneMask operator>=(const Lanes& a, const Lanes& b) { return {a.low >= b.low, a.high >= b.high}; }

  /// Where the mask holds the first, elsewhere the second.
  friend Lanes select(const LaneMask& mask, const Lanes& yes, const Lanes& no) {
    return {mask.low ? yes.low : no.low, mask.high ? yes.high : no.high};
  }
  // As std::max and std::min take NaN.
  friend Lanes max(const Lanes& a, const Lanes& b) { return select(a < b, b, a); }
  friend Lanes min(const Lanes& a, const Lanes& b) { return select(b < a, b, a); }
  friend Lanes abs(const Lanes& a) {
    constexpr long long all = std::numeric_limits<long long>::max();  // of a number all bits but the sign
    return {(Half)((LaneMask::Half)a.low & all), (Half)((LaneMask::Half)a.high & all)};
  }
  template <class Function>
  friend Lanes mapped(const Lanes& a, const Function& f) {
    return {Half{f(a.low[0]), f(a.low[1]), f(a.low[2]), f(a.low[3])},
            Half{f(a.high[0]), f(a.high[1]), f(a.high[2]), f(a.high[3])}};
  }
  friend Lanes sqrt(const Lanes& a) {
    return mapped(a, [](double x) { return std::sqrt(x); });
  }
  friend Lanes exp(const Lanes& a) {
    return mapped(a, [](double x) { return std::exp(x); });
  }
  friend Lanes log(const Lanes& a) {
    return mapped(a, [](double x) { return std::log(x); });
  }

  Half low, high;
};

/// The points [first, first + count) of a matrix with `rows` rows, column major, `data` at its first point;
/// lanes beyond `count` repeat the last point.
struct Batch {
  int first = 0;
  int count = laneCount;

  Batch(int begin, int end) : first(begin), count(std::min(laneCount, end - begin)) {}

  template <size_t rows>
  [[nodiscard]] std::array<Lanes, rows> load(const double* data) const {
    alignas(64) double buffer[rows][laneCount];
    for (int lane = 0; lane < laneCount; ++lane) {
      const double* point = data + rows * (first + std::min(lane, count - 1));
      for (size_t row = 0; row < rows; ++row) buffer[row][lane] = point[row];
    }
    std::array<Lanes, rows> result;
    std::memcpy(result.data(), buffer, sizeof buffer);
    return result;
  }

  template <size_t rows>
  void store(const std::array<Lanes, rows>& values, double* data) const {
    alignas(64) double buffer[rows][laneCount];
    std::memcpy(buffer, values.data(), sizeof buffer);
    for (int lane = 0; lane < count; ++lane)
      for (size_t row = 0; row < rows; ++row) data[rows * (first + lane) + row] = buffer[row][lane];
  }
};

}  // namespace mortier
