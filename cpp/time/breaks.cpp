#include "time/breaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace mortier {
namespace {

constexpr int firstIntervals = 499;   // a prime: no multiple of what people write
constexpr double narrow = 1e-7;       // of the whole
constexpr double nearby = 10;         // times that
constexpr size_t mostBreaks = 10000;  // breaks of one datum
constexpr size_t mostSamples = 500000;

class BreakFinder {
 public:
  BreakFinder(std::function<double(double)> datum, double begin, double end, int fine)
      : begin_(begin), end_(end) {
    course_.value = std::move(datum);
    for (int i = 0; fine > 0 && i <= fine; ++i)
      fine_.push_back(course_.value(begin + (end - begin) * i / fine));
  }

  Course find() {
    const double width = (end_ - begin_) / firstIntervals;
    for (int i = 0; i <= firstIntervals; ++i)
      if (const double f = std::abs(course_.value(begin_ + width * i)); std::isfinite(f))
        size_ = std::max(size_, f);
    for (const double f : fine_)
      if (std::isfinite(f)) size_ = std::max(size_, std::abs(f));
    for (int i = 0; i < firstIntervals; ++i)
      search(begin_ + width * i, std::min(end_, begin_ + width * (i + 1 + overlap)));
    for (const auto& [a, b] : brackets_) locate(a, b);
    course_.resolved = brackets_.size() <= mostBreaks && samples_.size() <= mostSamples;
    std::sort(samples_.begin(), samples_.end());
    samples_.erase(std::unique(samples_.begin(), samples_.end()), samples_.end());
    for (const auto& [t, value] : samples_) {
      course_.times.push_back(t);
      course_.values.push_back(value);
    }
    const auto [least, largest] = std::minmax_element(course_.values.begin(), course_.values.end());
    course_.range = *largest - *least;
    return std::move(course_);
  }

 private:
  /// Intervals overlap: a kink near the end of one is well inside the next.
  static constexpr double overlap = 0.1;

  void search(double a, double b) {
    a = std::max(a, searched_);
    if (b <= a || brackets_.size() > mostBreaks || samples_.size() > mostSamples || smooth(a, b)) return;
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

  /// Whether the cubic through every other of seven points meets those between, and the fine ones. The seven
  /// are samples then, or where no interval is narrower.
  [[nodiscard]] bool smooth(double a, double b) {
    constexpr double close = 1e-4;      // of the variation
    constexpr double between = 0.5;     // a cubic is off by so much more between the points than at them
    constexpr double rounding = 1e-13;  // of the values
    std::array<double, 7> f{};
    std::array<double, 7> t{};
    for (int i = 0; i < 7; ++i) {
      t[i] = a + (b - a) * i / 6;
      f[i] = course_.value(t[i]);
    }
    double error = std::max({std::abs(f[1] - (5 * f[0] + 15 * f[2] - 5 * f[4] + f[6]) / 16),
                             std::abs(f[3] - (-f[0] + 9 * f[2] + 9 * f[4] - f[6]) / 16),
                             std::abs(f[5] - (f[0] - 5 * f[2] + 15 * f[4] + 5 * f[6]) / 16)});
    double least = *std::min_element(f.begin(), f.end());
    double largest = *std::max_element(f.begin(), f.end());
    const double perTime = fine_.empty() ? 0 : (static_cast<double>(fine_.size()) - 1) / (end_ - begin_);
    const double last = (b - begin_) * perTime;
    for (double i = std::ceil((a - begin_) * perTime); perTime > 0 && i <= last; ++i) {
      const double value = fine_[static_cast<size_t>(i)];
      const double x = 6 * (begin_ + i / perTime - a) / (b - a);
      const double cubic = f[0] * (x - 2) * (x - 4) * (x - 6) / -48 + f[2] * x * (x - 4) * (x - 6) / 16 -
                           f[4] * x * (x - 2) * (x - 6) / 16 + f[6] * x * (x - 2) * (x - 4) / 48;
      error = std::max(error, between * std::abs(value - cubic));
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
    const bool isSmooth = !(error > close * (largest - least) && error > rounding * size_);
    if (isSmooth || b - a <= narrow * (end_ - begin_))
      for (int i = 0; i < 7; ++i)
        if (std::isfinite(f[i])) samples_.emplace_back(t[i], f[i]);
    return isSmooth;
  }

  void locate(double a, double b) {
    constexpr double jump = 1e-4;  // of the values; a kink changes by as little as it is narrow
    double fa = course_.value(a);
    double fb = course_.value(b);
    if (!(std::abs(fb - fa) > jump * size_)) {
      add(kinkBetween(a, b));
      return;
    }
    for (double middle = a + (b - a) / 2; middle > a && middle < b; middle = a + (b - a) / 2) {
      const double f = course_.value(middle);
      const bool left = std::abs(f - fa) < std::abs(f - fb);
      (left ? a : b) = middle;
      (left ? fa : fb) = f;
    }
    add(a);
    add(b);
  }

  void add(double time) {
    if (time > begin_ && time < end_) course_.breaks.push_back(time);
  }

  /// Where the parabolas through values on both sides meet, which is known to more digits than the width of
  /// the bracket has; where they do not meet (a break of a higher derivative), somewhere inside.
  [[nodiscard]] double kinkBetween(double a, double b) const {
    constexpr double apart = 50;        // distance of the values, in widths of the bracket
    constexpr double rounding = 1e-12;  // of the whole: what the parabolas are known to
    const double h = apart * (b - a);
    if (a - 2 * h < begin_ || b + 2 * h > end_) return shortestBetween(a, b);
    const auto parabola = [&](double from, double step) {
      const double f0 = course_.value(from);
      const double f1 = course_.value(from + step);
      const double f2 = course_.value(from + 2 * step);
      return [=](double t) {
        const double x = (t - from) / step;
        return f0 + x * (f1 - f0) + x * (x - 1) / 2 * (f2 - 2 * f1 + f0);
      };
    };
    const auto before = parabola(a, -h);
    const auto after = parabola(b, h);
    const auto difference = [&](double t) { return after(t) - before(t); };
    if (!(difference(a) * difference(b) < 0)) return shortestBetween(a, b);
    const bool rises = difference(a) < 0;
    for (double middle = a + (b - a) / 2; middle > a && middle < b; middle = a + (b - a) / 2)
      ((difference(middle) < 0) == rises ? a : b) = middle;
    const double known = rounding * (end_ - begin_);
    return shortestBetween(a - known, a + known);
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

  Course course_;
  double begin_;
  double end_;
  std::vector<double> fine_;     ///< values at equal distances
  double size_ = 0;              ///< of the values
  double searched_ = -INFINITY;  ///< no further search before this time
  std::vector<std::pair<double, double>> brackets_;
  std::vector<std::pair<double, double>> samples_;
};

}  // namespace

Course resolve(std::function<double(double)> datum, double begin, double end, int fine) {
  return BreakFinder(std::move(datum), begin, end, fine).find();
}

Course tableCourse(std::function<double(double)> datum, const std::vector<double>& times, double begin,
                   double end) {
  Course course;
  course.value = std::move(datum);
  for (const double t : times)
    if (t > begin && t < end) course.breaks.push_back(t);
  course.times = course.breaks;
  course.times.insert(course.times.begin(), begin);
  course.times.push_back(end);
  for (const double t : course.times) course.values.push_back(course.value(t));
  const auto [least, largest] = std::minmax_element(course.values.begin(), course.values.end());
  course.range = *largest - *least;
  return course;
}

CoursePeak peakBetween(const Course& course, double t0, double t1) {
  CoursePeak peak;
  const auto first = std::upper_bound(course.times.begin(), course.times.end(), t0);
  if (!(course.range > 0) || first == course.times.end() || !(*first < t1)) return peak;
  const auto [least, largest] = std::minmax({course.value(t0), course.value(t1)});
  for (auto t = first; t != course.times.end() && *t < t1; ++t) {
    const double value = course.values[t - course.times.begin()];
    const double height = std::max(value - largest, least - value) / course.range;
    if (height > peak.height) peak = {*t, height};
  }
  return peak;
}

double unseen(const Course& course, const std::vector<double>& nodes, double t0, double t1) {
  if (!(course.range > 0)) return 0;
  std::vector<double> x{t0};
  for (const double node : nodes) x.push_back(node == 1 ? t1 : t0 + node * (t1 - t0));
  std::vector<double> f;
  for (const double t : x) f.push_back(course.value(t));
  double most = 0;
  const auto first = std::upper_bound(course.times.begin(), course.times.end(), t0);
  for (auto t = first; t != course.times.end() && *t < t1; ++t) {
    double seen = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      double weight = f[i];
      for (size_t j = 0; j < x.size(); ++j)
        if (j != i) weight *= (*t - x[j]) / (x[i] - x[j]);
      seen += weight;
    }
    most = std::max(most, std::abs(course.values[t - course.times.begin()] - seen));
  }
  return most / course.range;
}

}  // namespace mortier
