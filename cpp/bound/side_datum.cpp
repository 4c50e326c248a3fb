#include "bound/side_datum.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "base/quadrature_rules.h"

namespace mortier {
namespace {

/// Differences that are roundingOfValues, over the values.
constexpr double roundingOfValues = 1e-12;
constexpr int budget = 3000;             ///< pieces of a side
constexpr double narrowest = 1e-14;      ///< piece
constexpr double negligibleRest = 1e-2;  ///< of the square of what is off

struct Piece {
  double begin = 0, end = 1;
  std::array<double, 2> values{};
  double off = 0;    ///< |f - linear on the piece| at most
  double slope = 0;  ///< the same of the derivatives
  std::array<double, 2> moments{};
  double momentError = 0;
  [[nodiscard]] double width() const { return end - begin; }
};

/// Gauss with four points: the error is at most this times width^9 |f^(8)|/8!.
constexpr double gaussError = 2.3e-5;

class Resolving {
 public:
  Resolving(const Datum& datum, const Point& first, const Point& last, double t)
      : datum_(datum),
        along_(datum.along ? datum.along() : Datum::Along()),
        first_(first),
        by_(last - first),
        t_(t) {}

  [[nodiscard]] double at(double s) const {
    return datum_(first_.x() + s * by_.x(), first_.y() + s * by_.y(), t_);
  }

  [[nodiscard]] Piece piece(double begin, double end) const {
    Piece result{begin, end, {at(begin), at(end)}};
    if (!along_) return sampled(result);
    const Interval part{begin, end};
    const Taylor f = along_(Taylor::linear(first_.x(), by_.x(), part),
                            Taylor::linear(first_.y(), by_.y(), part), Taylor::constant({t_, t_}));
    const double w = result.width();
    const auto [low, high] = std::minmax(result.values[0], result.values[1]);
    const double second = 2 * f.c[2].magnitude();
    const double byValues = std::max(f.c[0].largest - low, high - f.c[0].least);
    const double bySecond = second == 0 ? 0 : w * w / 8 * second;
    result.off = std::min(byValues, bySecond);
    const double chord = (result.values[1] - result.values[0]) / w;
    result.slope =
        std::min(second == 0 ? 0 : w / 2 * second, std::max(f.c[1].largest - chord, chord - f.c[1].least));
    if (std::isnan(result.off)) result.off = infinity;
    if (std::isnan(result.slope)) result.slope = infinity;
    const double seventh = f.c[7].magnitude();
    const double eighth = f.c[8].magnitude();
    result.momentError =
        gaussError * std::pow(w, 9) * (eighth == 0 && seventh == 0 ? 0 : 2 * eighth + seventh);
    if (std::isnan(result.momentError)) result.momentError = infinity;
    if (result.momentError <= 2 * w * result.off || !std::isfinite(result.off)) {
      integrate(result);
    } else {  // trapezoid of what is linear
      const double a = result.values[0];
      const double b = result.values[1];
      const double first = w / 6 * (a * (2 * begin + end) + b * (begin + 2 * end));
      result.moments = {w * (a + b) / 2 - first, first};
      result.momentError = w * result.off;
    }
    return result;
  }

 private:
  void integrate(Piece& piece) const {
    for (const auto& [place, weight] : gaussFour) {
      const double s = piece.begin + place * piece.width();
      const double part = weight * piece.width() * at(s);
      piece.moments[0] += (1 - s) * part;
      piece.moments[1] += s * part;
    }
  }
  /// Of a function without a formula some values are known.
  [[nodiscard]] Piece sampled(Piece piece) const {
    constexpr int samples = 8;
    double last = piece.values[0];
    const double chord = piece.values[1] - piece.values[0];
    for (int i = 1; i <= samples; ++i) {
      const double s = static_cast<double>(i) / samples;
      const double value = i < samples ? at(piece.begin + s * piece.width()) : piece.values[1];
      piece.off = std::max(piece.off, std::abs(value - piece.values[0] - s * chord));
      piece.slope = std::max(piece.slope, std::abs((value - last) * samples - chord) / piece.width());
      last = value;
    }
    integrate(piece);
    return piece;
  }

  const Datum& datum_;
  Datum::Along along_;
  Point first_, by_;
  double t_;
};

/// Halves the pieces that weigh most until the weights of all sum to no more than `enough()`.
template <class Weight, class Enough>
void refine(const Resolving& function, std::vector<Piece>& pieces, Weight weight, Enough enough) {
  std::priority_queue<std::pair<double, size_t>> worst;
  for (size_t i = 0; i < pieces.size(); ++i) worst.push({weight(pieces[i]), i});
  const auto sum = [&] {
    double all = 0;
    for (const Piece& piece : pieces) all += weight(piece);
    return all;
  };
  for (int round = 0; !worst.empty() && pieces.size() < budget; ++round) {
    constexpr int often = 8;
    if (round % often == 0 && sum() <= enough()) return;
    const size_t i = worst.top().second;
    worst.pop();
    if (pieces[i].width() < narrowest) continue;
    const double middle = (pieces[i].begin + pieces[i].end) / 2;
    pieces.push_back(function.piece(middle, pieces[i].end));
    pieces[i] = function.piece(pieces[i].begin, middle);
    worst.push({weight(pieces[i]), i});
    worst.push({weight(pieces.back()), pieces.size() - 1});
  }
}

}  // namespace

bool SideDatum::linear() const {
  return off <= roundingOfValues * size;
}

SideDatum SideDatum::times(double part) const {
  SideDatum result = *this;
  for (double* each :
       {&result.ends[0], &result.ends[1], &result.moments[0], &result.moments[1], &result.momentError,
        &result.size, &result.off, &result.slope, &result.least, &result.largest})
    *each *= part;
  for (double& each : result.slopeMoments) each *= part * part;
  return result;
}

SideDatum onSide(const Datum& datum, const Point& first, const Point& last, double t) {
  if (datum.constant()) {
    const double value = datum(first.x(), first.y(), t);
    SideDatum result;
    result.ends = {value, value};
    result.moments = {value / 2, value / 2};
    result.size = std::abs(value);
    return result;
  }
  const Resolving function(datum, first, last, t);
  SideDatum result;
  result.ends = {function.at(0), function.at(1)};
  const double slope = result.ends[1] - result.ends[0];
  const auto linearAt = [&](double s) { return result.ends[0] + s * slope; };
  std::vector<Piece> pieces{function.piece(0, 1)};
  double largest = 0;  // |f - linear| at ends of pieces
  const auto offAt = [&](const Piece& piece) {
    return std::array{piece.values[0] - linearAt(piece.begin), piece.values[1] - linearAt(piece.end)};
  };
  const auto squareOf = [&](const Piece& piece) {
    const auto [a, b] = offAt(piece);
    largest = std::max({largest, std::abs(a), std::abs(b)});
    result.size = std::max({result.size, std::abs(piece.values[0]), std::abs(piece.values[1])});
    return piece.off * piece.off * piece.width();
  };
  refine(function, pieces, squareOf, [&] {
    return std::max(negligibleRest * negligibleRest * largest * largest,
                    std::pow(0.1 * roundingOfValues * result.size, 2));
  });
  refine(
      function, pieces, [](const Piece& piece) { return piece.momentError; },
      [&] { return 0.1 * roundingOfValues * result.size; });
  double squares = 0;
  double slopes = 0;
  for (const Piece& piece : pieces) {
    const auto [a, b] = offAt(piece);
    const double w = piece.width();
    squares += std::pow(std::sqrt(w * (a * a + a * b + b * b) / 3) + piece.off * std::sqrt(w), 2);
    const double steep = w * std::pow(std::abs((b - a) / w) + piece.slope, 2);
    slopes += steep;
    result.slopeMoments[0] += (1 - piece.begin) * steep;
    result.slopeMoments[1] += piece.end * steep;
    result.least = std::min(result.least, std::min(a, b) - piece.off);
    result.largest = std::max(result.largest, std::max(a, b) + piece.off);
    for (int i = 0; i < 2; ++i) result.moments[i] += piece.moments[i];
    result.momentError += piece.momentError;
    if (w < 1e-6 && std::abs(piece.values[1] - piece.values[0]) > 0.05 * (largest + piece.off))
      result.jumps.push_back(piece.begin + w / 2);
  }
  result.off = std::sqrt(squares);
  result.slope = std::sqrt(slopes);
  if (result.linear()) result.slope = std::min(result.slope, 4 * result.off);
  result.known = std::isfinite(result.off);
  std::sort(result.jumps.begin(), result.jumps.end());
  return result;
}

}  // namespace mortier
