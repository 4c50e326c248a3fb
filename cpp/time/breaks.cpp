#include "time/breaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace mortier {
namespace {

constexpr int firstIntervals = 97;  // no multiple of what people write
constexpr double narrow = 1e-7;     // of the whole
constexpr double nearby = 10;       // times that
constexpr size_t most = 10000;      // breaks of one datum

class BreakFinder {
 public:
  BreakFinder(const std::function<double(double)>& datum, double begin, double end)
      : datum_(datum), begin_(begin), end_(end) {}

  std::vector<double> find() {
    const double width = (end_ - begin_) / firstIntervals;
    for (int i = 0; i <= firstIntervals; ++i)
      if (const double f = std::abs(datum_(begin_ + width * i)); std::isfinite(f)) size_ = std::max(size_, f);
    for (int i = 0; i < firstIntervals; ++i)
      search(begin_ + width * i, std::min(end_, begin_ + width * (i + 1 + overlap)));
    for (const auto& [a, b] : brackets_) locate(a, b);
    return std::move(found_);
  }

 private:
  /// Intervals overlap: a kink near the end of one is well inside the next.
  static constexpr double overlap = 0.1;

  void search(double a, double b) {
    a = std::max(a, searched_);
    if (b <= a || brackets_.size() > most || smooth(a, b)) return;
    if (b - a <= narrow * (end_ - begin_)) {
      // What is rough close to a break is the rounding of the same break.
      if (brackets_.empty() || a > brackets_.back().second + nearby * narrow * (end_ - begin_))
        brackets_.emplace_back(a, b);
      brackets_.back().second = b;
      searched_ = b;
      return;
    }
    search(a, a + (0.5 + overlap) * (b - a));
    search(a + (0.5 - overlap) * (b - a), b);
  }

  /// Whether the cubic through every other of seven points meets those between.
  [[nodiscard]] bool smooth(double a, double b) const {
    constexpr double close = 1e-4;      // of the variation
    constexpr double rounding = 1e-13;  // of the values
    std::array<double, 7> f{};
    for (int i = 0; i < 7; ++i) f[i] = datum_(a + (b - a) * i / 6);
    const double error = std::max({std::abs(f[1] - (5 * f[0] + 15 * f[2] - 5 * f[4] + f[6]) / 16),
                                   std::abs(f[3] - (-f[0] + 9 * f[2] + 9 * f[4] - f[6]) / 16),
                                   std::abs(f[5] - (f[0] - 5 * f[2] + 15 * f[4] + 5 * f[6]) / 16)});
    const auto [least, largest] = std::minmax_element(f.begin(), f.end());
    return !(error > close * (*largest - *least) && error > rounding * size_);
  }

  void locate(double a, double b) {
    constexpr double jump = 1e-4;  // of the values; a kink changes by as little as it is narrow
    double fa = datum_(a);
    double fb = datum_(b);
    if (!(std::abs(fb - fa) > jump * size_)) {
      add(shortestBetween(a, b));
      return;
    }
    for (double middle = a + (b - a) / 2; middle > a && middle < b; middle = a + (b - a) / 2) {
      const double f = datum_(middle);
      const bool left = std::abs(f - fa) < std::abs(f - fb);
      (left ? a : b) = middle;
      (left ? fa : fb) = f;
    }
    add(a);
    add(b);
  }

  void add(double time) {
    if (time > begin_ && time < end_) found_.push_back(time);
  }

  /// The number with the fewest digits: what the data say is rarely 0.99999999987.
  static double shortestBetween(double a, double b) {
    for (int digits = 1; digits < 17; ++digits) {
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), "%.*g", digits, a + (b - a) / 2);
      const double value = std::strtod(text.data(), nullptr);
      if (value >= a && value <= b) return value;
    }
    return a + (b - a) / 2;
  }

  const std::function<double(double)>& datum_;
  double begin_;
  double end_;
  double size_ = 0;              ///< of the values
  double searched_ = -INFINITY;  ///< no further search before this time
  std::vector<std::pair<double, double>> brackets_;
  std::vector<double> found_;
};

}  // namespace

std::vector<double> findBreaks(const std::vector<std::function<double(double)>>& data, double begin,
                               double end) {
  std::vector<double> breaks;
  for (const auto& datum : data) {
    const std::vector<double> found = BreakFinder(datum, begin, end).find();
    breaks.insert(breaks.end(), found.begin(), found.end());
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

}  // namespace mortier
