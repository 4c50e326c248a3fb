// Points of a mesh in batches of eight, side by side in vector registers.
#pragma once

#include <algorithm>
#include <array>
#include <experimental/simd>

namespace mortier {

constexpr int laneCount = 8;
using Lanes = std::experimental::fixed_size_simd<double, laneCount>;
using LaneMask = Lanes::mask_type;

/// Where the mask holds the first, elsewhere the second.
inline Lanes select(const LaneMask& mask, const Lanes& yes, const Lanes& no) {
  Lanes result = no;
  where(mask, result) = yes;
  return result;
}

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
    for (size_t row = 0; row < rows; ++row)
      result[row].copy_from(buffer[row], std::experimental::vector_aligned);
    return result;
  }

  template <size_t rows>
  void store(const std::array<Lanes, rows>& values, double* data) const {
    alignas(64) double buffer[rows][laneCount];
    for (size_t row = 0; row < rows; ++row)
      values[row].copy_to(buffer[row], std::experimental::vector_aligned);
    for (int lane = 0; lane < count; ++lane)
      for (size_t row = 0; row < rows; ++row) data[rows * (first + lane) + row] = buffer[row][lane];
  }
};

}  // namespace mortier
