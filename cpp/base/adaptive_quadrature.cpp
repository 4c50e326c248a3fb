#include "base/adaptive_quadrature.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense_templates.h"

namespace mortier {
namespace {

/// A polynomial meets the function on a part where it is off by less than this part of the largest value.
constexpr double smoothOnEdge = 1e-6;
constexpr double smoothOnTriangle = 1e-4;
/// A part is not cut again where what it may be off by, times its share of the whole, is below this part of
/// the largest value.
constexpr double shareOfEdge = 1e-10;
constexpr double shareOfTriangle = 2e-4;
/// The same for values that an enclosure allows and no sample has.
constexpr double shareHidden = 1e-3;
constexpr size_t mostParts = 1500;

// Gauss and Kronrod on [-1, 1]: 15 points, every other one of the 7.
constexpr int points = 15;
constexpr std::array<double, 8> kronrod{
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693,    0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0};
constexpr std::array<double, 8> kronrodWeights{
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};

struct EdgeRule {
  std::array<double, points> at{}, weight{};        ///< on [0, 1]
  std::array<std::array<double, 7>, 8> toOthers{};  ///< the polynomial through Gauss's points at the others
  EdgeRule() {
    for (int i = 0; i < points; ++i) {
      const int k = i < 8 ? i : 14 - i;
      at[i] = 0.5 + (i < 8 ? -0.5 : 0.5) * kronrod[k];
      weight[i] = kronrodWeights[k] / 2;
    }
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 7; ++j) {
        toOthers[i][j] = 1;
        for (int k = 0; k < 7; ++k)
          if (k != j) toOthers[i][j] *= (at[2 * i] - at[2 * k + 1]) / (at[2 * j + 1] - at[2 * k + 1]);
      }
  }
  /// How far the values are from the polynomial.
  [[nodiscard]] double off(const std::array<double, points>& f) const {
    double most = 0;
    for (int i = 0; i < 8; ++i) {
      double value = 0;
      for (int j = 0; j < 7; ++j) value += toOthers[i][j] * f[2 * j + 1];
      most = std::max(most, std::abs(f[2 * i] - value));
    }
    return most;
  }
};

// Dunavant (1985), degree 6; and points next to the corners and the sides, which it does not reach.
using Barycentric = std::array<double, 3>;
using Corners = std::array<Barycentric, 3>;
constexpr int dunavantPoints = 12;
constexpr int trianglePoints = dunavantPoints + 6;

struct TriangleRule {
  std::array<Barycentric, trianglePoints> at{};
  std::array<double, trianglePoints> weight{};
  Eigen::Matrix<double, trianglePoints, trianglePoints> residual;  ///< of the quadratic that fits best
  TriangleRule() {
    int n = 0;
    const auto add = [&](Barycentric b, double w) {
      at[n] = b;
      weight[n++] = w;
    };
    for (const auto& [a, w] :
         {std::pair(0.063089014491502, 0.050844906370207), std::pair(0.249286745170910, 0.116786275726379)})
      for (int k = 0; k < 3; ++k) {
        Barycentric b{a, a, a};
        b[k] = 1 - 2 * a;
        add(b, w);
      }
    Barycentric b{0.053145049844817, 0.310352451033784, 1 - 0.053145049844817 - 0.310352451033784};
    do add(b, (1 - 3 * (0.050844906370207 + 0.116786275726379)) / 6);
    while (std::next_permutation(b.begin(), b.end()));
    constexpr double inside = 0.005;
    for (int k = 0; k < 3; ++k) {
      Barycentric corner{inside, inside, inside};
      corner[k] = 1 - 2 * inside;
      add(corner, 0);
      Barycentric side{(1 - inside) / 2, (1 - inside) / 2, (1 - inside) / 2};
      side[k] = inside;
      add(side, 0);
    }
    Eigen::Matrix<double, trianglePoints, 6> terms;
    for (int i = 0; i < trianglePoints; ++i) {
      const auto& [c, d, e] = at[i];
      terms.row(i) << c * c, d * d, e * e, c * d, d * e, e * c;
    }
    const auto fitted = terms.topRows<dunavantPoints>();
    const Eigen::Matrix<double, 6, 6> normal = fitted.transpose() * fitted;
    residual.setIdentity();
    residual.leftCols<dunavantPoints>() -= terms * normal.inverse() * fitted.transpose();
  }
  [[nodiscard]] double off(const std::array<double, trianglePoints>& f) const {
    return (residual * Eigen::Map<const Eigen::Matrix<double, trianglePoints, 1>>(f.data()))
        .lpNorm<Eigen::Infinity>();
  }
};

/// What a part of the whole is cut into, where its points are, and what is enclosed there.
struct EdgePart {
  static constexpr int count = points;
  static constexpr double smooth = smoothOnEdge;
  static constexpr double share = shareOfEdge;
  double begin = 0;
  double end = 1;
  static const EdgeRule& rule() {
    static const EdgeRule rule;
    return rule;
  }
  [[nodiscard]] double part() const { return end - begin; }
  [[nodiscard]] double middle() const { return begin + (end - begin) / 2; }
  [[nodiscard]] double place(double at) const { return begin + (end - begin) * at; }
  [[nodiscard]] bool divisible() const { return middle() > begin && middle() < end; }
  [[nodiscard]] std::array<EdgePart, 2> halves() const { return {{{begin, middle()}, {middle(), end}}}; }
  [[nodiscard]] Interval enclosed(const std::function<Interval(double, double)>& enclosure) const {
    return enclosure(begin, end);
  }
};

struct TrianglePart {
  static constexpr int count = trianglePoints;
  static constexpr double smooth = smoothOnTriangle;
  static constexpr double share = shareOfTriangle;
  Corners corners{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  double area = 1;
  static const TriangleRule& rule() {
    static const TriangleRule rule;
    return rule;
  }
  [[nodiscard]] double part() const { return area; }
  [[nodiscard]] Barycentric place(const Barycentric& at) const {
    Barycentric place{};
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) place[c] += at[k] * corners[k][c];
    return place;
  }
  [[nodiscard]] Barycentric middle() const { return place({1.0 / 3, 1.0 / 3, 1.0 / 3}); }
  [[nodiscard]] bool divisible() const { return area > 1e-24; }
  [[nodiscard]] std::array<TrianglePart, 4> halves() const {
    const Barycentric ab = place({0.5, 0.5, 0});
    const Barycentric bc = place({0, 0.5, 0.5});
    const Barycentric ca = place({0.5, 0, 0.5});
    const auto& [a, b, c] = corners;
    return {{{{a, ab, ca}, area / 4},
             {{ab, b, bc}, area / 4},
             {{ca, bc, c}, area / 4},
             {{ab, bc, ca}, area / 4}}};
  }
  [[nodiscard]] Interval enclosed(const std::function<Interval(const Corners&)>& enclosure) const {
    return enclosure(corners);
  }
};

/// By how much values that are enclosed are beyond those at the points, more than these vary.
double hidden(const Interval& enclosed, const Interval& seen) {
  if (!std::isfinite(enclosed.least) || !std::isfinite(enclosed.largest)) return 0;
  const double beyond = std::max(enclosed.largest - seen.largest, seen.least - enclosed.least);
  return std::max(0.0, beyond - 2 * (seen.largest - seen.least));
}

/// All parts of a level before those of the next, so that the budget is not used up in one place.
template <class Part, class Place, class Value, class Enclosure>
Resolved<Place> resolved(const Value& value, const Enclosure& enclosure, std::vector<Part> level) {
  Resolved<Place> result;
  const auto& rule = Part::rule();
  double most = 0;
  size_t done = 0;
  for (std::vector<Part> next; !level.empty(); level = std::move(next), next.clear()) {
    std::vector<std::array<double, Part::count>> values(level.size());
    for (size_t i = 0; i < level.size(); ++i)
      for (int k = 0; k < Part::count; ++k) {
        values[i][k] = value(level[i].place(rule.at[k]));
        result.size = std::max(result.size, std::abs(values[i][k]));
      }
    done += level.size();
    for (size_t i = 0; i < level.size(); ++i) {
      const Part& part = level[i];
      const auto [least, largest] = std::minmax_element(values[i].begin(), values[i].end());
      const double off = rule.off(values[i]);
      const double beyond = enclosure ? hidden(part.enclosed(enclosure), {*least, *largest}) : 0;
      const bool smooth = off <= Part::smooth * result.size || off * part.part() <= Part::share * result.size;
      const bool seen = beyond * part.part() <= shareHidden * result.size;
      if (!(smooth && seen) && done + next.size() < mostParts && part.divisible()) {
        for (const Part& half : part.halves()) next.push_back(half);
        continue;
      }
      for (int k = 0; k < Part::count; ++k)
        if (rule.weight[k] > 0)
          result.samples.push_back({part.place(rule.at[k]), rule.weight[k] * part.part(), values[i][k]});
      const bool met = off <= Part::smooth * result.size;
      const double missed = ((met ? 0 : off) + (seen ? 0 : beyond)) * part.part();
      result.uncertain = std::hypot(result.uncertain, missed);  // parts are off to either side
      if (missed > most) {
        most = missed;
        result.worst = part.middle();
      }
    }
  }
  return result;
}

}  // namespace

ResolvedEdge resolveOnEdge(const std::function<double(double)>& value,
                           const std::function<Interval(double, double)>& enclosure) {
  constexpr double uneven = 0.4384;  // no period of what people write
  ResolvedEdge edge =
      resolved<EdgePart, double>(value, enclosure, std::vector<EdgePart>{{0, uneven}, {uneven, 1}});
  std::sort(edge.samples.begin(), edge.samples.end(),
            [](const auto& a, const auto& b) { return a.at < b.at; });
  return edge;
}

ResolvedTriangle resolveOnTriangle(const std::function<double(const Barycentric&)>& value,
                                   const std::function<Interval(const Corners&)>& enclosure) {
  return resolved<TrianglePart, Barycentric>(value, enclosure, std::vector<TrianglePart>{{}});
}

}  // namespace mortier
