#include "contact/smooth_part.h"

#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

/// A part whose nodes lie on its chord up to this part of its length is straight: coordinates may be rounded.
constexpr double straightness = 1e-6;

/// Perpendicular to a direction, away from the body on its left.
Point outward(const Point& t) {
  return {t.y(), -t.x()};
}

/// Angle by which the line turns at its nodes, and that angle over the mean length of the elements there.
/// None at the ends of an open line.
struct Bends {
  std::vector<double> turn;
  std::vector<double> curvature;
};

Bends bendsOf(const BoundaryLine& line) {
  const std::vector<Point>& x = line.points;
  const size_t n = x.size();
  Bends bends{std::vector<double>(n, 0), std::vector<double>(n, 0)};
  for (size_t i = line.closed ? 0 : 1; i + 1 < n; ++i) {
    const Point before = x[i] - x[i == 0 ? n - 2 : i - 1];
    const Point after = x[i + 1] - x[i];
    bends.turn[i] = std::abs(std::atan2(cross(before, after), before.dot(after)));
    bends.curvature[i] = 2 * bends.turn[i] / (before.norm() + after.norm());
  }
  if (line.closed) {
    bends.turn.back() = bends.turn.front();
    bends.curvature.back() = bends.curvature.front();
  }
  return bends;
}

/// Whether an element is known to be straight.
bool isStraight(const BoundaryLine& line, int e) {
  return !line.middles.empty() && line.middles[e] == (line.points[e] + line.points[e + 1]) / 2;
}

std::vector<int> cornersOf(const BoundaryLine& line, Kinks kinks) {
  constexpr double degree = M_PI / 180;
  constexpr double least = degree;
  constexpr double ratio = 4;
  constexpr double rounding = 1e-6;  // rad
  const Bends bends = bendsOf(line);
  const auto last = static_cast<int>(line.points.size()) - 1;
  std::vector<int> corners;
  for (int i = line.closed ? 0 : 1; i < last; ++i) {
    const int before = i == 0 ? last - 1 : i - 1;
    const double neighbours = std::max(bends.curvature[before], bends.curvature[i + 1]);
    const bool kink = kinks == Kinks::ofStraightElements && bends.turn[i] > rounding &&
                      isStraight(line, before) && isStraight(line, i);
    if (kink || bends.turn[i] > sharpTurn ||
        (bends.turn[i] > least && bends.curvature[i] > ratio * neighbours))
      corners.push_back(i);
  }
  return corners;
}

bool isStraight(const std::vector<Point>& points) {
  const Point chord = points.back() - points.front();
  const double length = chord.norm();
  double previous = -1;
  for (const Point& point : points) {
    const Point x = point - points.front();
    const double along = x.dot(chord) / length;
    if (!(std::abs(cross(x, chord)) <= straightness * length * length) || !(along > previous)) return false;
    previous = along;
  }
  return true;
}

void setCurvedNormals(SmoothPart& part) {
  const int n = part.elements();
  const auto tangent = [&](int before, int after) {
    const double h1 = part.s[before + 1] - part.s[before];
    const double h2 = part.s[after + 1] - part.s[after];
    return Point((h2 * part.direction(before) + h1 * part.direction(after)).normalized());
  };
  part.normals.resize(n + 1);
  for (int i = 1; i < n; ++i) part.normals[i] = outward(tangent(i - 1, i));
  if (part.closed) {
    part.normals.front() = part.normals.back() = outward(tangent(n - 1, 0));
    return;
  }
  if (n == 1) {  // a bent element between two corners
    for (const int end : {0, 1}) part.normals[end] = outward(part.tangentAt(0, end).normalized());
    return;
  }
  const auto reflected = [&](const Point& normal, int element) {
    const Point e = outward(part.direction(element));
    return Point((2 * e.dot(normal) * e - normal).normalized());
  };
  part.normals.front() = reflected(part.normals[1], 0);
  part.normals.back() = reflected(part.normals[n - 1], n - 1);
}

/// Of a list by elements; empty where there is none.
template <class Value>
std::vector<Value> stretchOf(const std::vector<Value>& list, int begin, int end) {
  return list.empty() ? list : std::vector<Value>(list.begin() + begin, list.begin() + end);
}

void setArcLengths(SmoothPart& part) {
  part.s.assign(1, 0);
  for (size_t i = 1; i < part.points.size(); ++i)
    part.s.push_back(part.s.back() + (part.points[i] - part.points[i - 1]).norm());
}

SmoothPart partOf(const BoundaryLine& line, int begin, int end, bool closed) {
  SmoothPart part;
  part.nodes.assign(line.nodes.begin() + begin, line.nodes.begin() + end + 1);
  part.points.assign(line.points.begin() + begin, line.points.begin() + end + 1);
  part.closed = closed;
  if (!line.middleNodes.empty()) {
    part.middles.assign(line.middleNodes.begin() + begin, line.middleNodes.begin() + end);
    part.middlePoints.assign(line.middlePoints.begin() + begin, line.middlePoints.begin() + end);
  }
  const std::vector<EdgeCurve> curves = stretchOf(line.curves, begin, end);
  part.straight = !part.closed && isStraight(part.points) &&
                  std::none_of(curves.begin(), curves.end(), [](const EdgeCurve& c) { return c.known(); });
  for (int e = 0; e < part.elements(); ++e) part.straight = part.straight && !part.bent(e);
  if (part.straight) {
    const Point t = (part.points.back() - part.points.front()).normalized();
    for (const Point& point : part.points) part.s.push_back((point - part.points.front()).dot(t));
    part.normals.assign(part.points.size(), outward(t));
    part.curvatures.assign(part.points.size(), 0);
    part.arcs.assign(part.points.size() - 1, {0, true});
  } else {
    setArcLengths(part);
    setCurvedNormals(part);
    part.curvatures = nodalCurvatures(part.points, part.closed);
    part.arcs = arcsOf(part.points, part.closed, stretchOf(line.middles, begin, end));
    for (size_t e = 0; e < curves.size(); ++e)
      if (curves[e].known()) part.arcs[e] = {part.arcs[e].curvature, true, curves[e]};
    for (double& curvature : part.curvatures) curvature = std::abs(curvature);
  }
  return part;
}

}  // namespace

Point SmoothPart::direction(int element) const {
  return (points[element + 1] - points[element]).normalized();
}

SmoothPart moved(const std::shared_ptr<const SmoothPart>& drawn, const Vector& u) {
  SmoothPart part = *drawn;
  for (size_t i = 0; i < part.nodes.size(); ++i) part.points[i] += u.segment<2>(2 * part.nodes[i]);
  for (size_t e = 0; e < part.middles.size(); ++e) part.middlePoints[e] += u.segment<2>(2 * part.middles[e]);
  part.straight = false;
  part.drawn = drawn;
  setArcLengths(part);
  setCurvedNormals(part);
  return part;
}

BoundaryLine begunAt(const BoundaryLine& line, int first) {
  BoundaryLine result = line;
  const auto begin = [first](auto& list) { std::rotate(list.begin(), list.begin() + first, list.end()); };
  const auto beginClosed = [&](auto& list) {
    list.pop_back();
    begin(list);
    list.push_back(list.front());
  };
  beginClosed(result.nodes);
  beginClosed(result.points);
  if (!result.middles.empty()) begin(result.middles);
  if (!result.curves.empty()) begin(result.curves);
  if (!result.middleNodes.empty()) {
    begin(result.middleNodes);
    begin(result.middlePoints);
  }
  return result;
}

std::vector<SmoothPart> smoothParts(const BoundaryLine& line, Kinks kinks) {
  std::vector<int> corners = cornersOf(line, kinks);
  if (line.closed && !corners.empty() && corners.front() != 0)
    return smoothParts(begunAt(line, corners.front()), kinks);
  const bool closed = line.closed && corners.empty();
  if (corners.empty() || corners.front() != 0) corners.insert(corners.begin(), 0);
  corners.push_back(static_cast<int>(line.points.size()) - 1);
  std::vector<SmoothPart> parts;
  const bool round = line.closed && !closed;
  for (size_t i = 1; i < corners.size(); ++i) {
    parts.push_back(partOf(line, corners[i - 1], corners[i], closed));
    parts.back().corners = {i > 1 || round, i + 1 < corners.size() || round};
  }
  return parts;
}

}  // namespace mortier
