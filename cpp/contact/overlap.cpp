#include "contact/overlap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/disjoint_sets.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

constexpr int piecesOfBent = 8;

/// A run of a boundary within the other body, between two cuts of one piece.
struct Run {
  int of = 0;
  int piece = 0;
  Point from, to;
  PointInside middle;
};

/// Where a piece meets the other boundary.
struct Cut {
  double part = 0;  ///< of the piece
  Point at;
};

using Cuts = std::vector<std::vector<Cut>>;

Cuts cutsOf(const MovedOutline& one, const MovedOutline& other, const std::vector<char>& near, Cuts& across,
            double rounding) {
  constexpr double ends = 1e-12;  // of a piece
  Cuts cuts(one.pieces().size());
  for (size_t i = 0; i < cuts.size(); ++i) {
    if (near[i] == 0) continue;
    const Point& p = one.points()[i];
    const Point along = one.points()[i + 1] - p;
    const Point end = one.points()[i + 1];
    other.tree().near(p.cwiseMin(end), p.cwiseMax(end), rounding, [&](int j) {
      if (other.pieces()[j].side < 0) return;
      const Point& q = other.points()[j];
      const Point way = other.points()[j + 1] - q;
      const double sine = cross(along, way);
      if (sine == 0) return;
      const double part = cross(q - p, way) / sine;
      const double partAcross = cross(q - p, along) / sine;
      if (!(part >= -ends && part <= 1 + ends && partAcross >= -ends && partAcross <= 1 + ends)) return;
      const Point at = p + std::clamp(part, 0.0, 1.0) * along;
      cuts[i].push_back({std::clamp(part, 0.0, 1.0), at});
      across[j].push_back({std::clamp(partAcross, 0.0, 1.0), at});
    });
  }
  return cuts;
}

/// Pieces that may be within the other body.
std::vector<char> piecesNear(const MovedOutline& one, const MovedOutline& other, double rounding) {
  std::vector<char> near(one.pieces().size(), 0);
  for (size_t i = 0; i < near.size(); ++i) {
    if (one.pieces()[i].side < 0) continue;
    const Point& a = one.points()[i];
    const Point& b = one.points()[i + 1];
    const bool apart = ((a.cwiseMin(b) - other.high()).array() > rounding).any() ||
                       ((other.low() - a.cwiseMax(b)).array() > rounding).any();
    near[i] = apart ? 0 : 1;
  }
  return near;
}

/// Adds the runs within the other body, and the nodes with which they begin.
void addRuns(const MovedOutline& one, const MovedOutline& other, int of, const std::vector<char>& near,
             Cuts& cuts, double rounding, std::vector<Run>& runs,
             std::vector<std::pair<int, PointInside>>& nodes) {
  for (size_t i = 0; i < cuts.size(); ++i) {
    if (near[i] == 0) continue;
    const MovedOutline::Piece& piece = one.pieces()[i];
    const Point& a = one.points()[i];
    const Point& b = one.points()[i + 1];
    std::vector<Cut> at{{0, a}, {1, b}};
    at.insert(at.end(), cuts[i].begin(), cuts[i].end());
    std::stable_sort(at.begin(), at.end(), [](const Cut& x, const Cut& y) { return x.part < y.part; });
    const auto inside = [&](const Point& x, double part, const MovedOutline::Nearest& nearest) {
      return PointInside{of,
                         piece.side,
                         piece.from + part * (piece.to - piece.from),
                         x,
                         std::max(0.0, -nearest.distance),
                         other.pieces()[nearest.piece].side,
                         nearest.part};
    };
    for (size_t k = 0; k + 1 < at.size(); ++k) {
      if (!(at[k + 1].part > at[k].part)) continue;
      const Point middle = (at[k].at + at[k + 1].at) / 2;
      const MovedOutline::Nearest nearest = other.nearest(middle);
      bool within = nearest.distance < -rounding;
      if (std::abs(nearest.distance) <= rounding) {
        // Both boundaries are there: once that of what both bodies have in common, if they lie on one side.
        const Point way = other.points()[nearest.piece + 1] - other.points()[nearest.piece];
        within = of == 0 && way.dot(b - a) > 0;
      }
      if (!within) continue;
      const double part = (at[k].part + at[k + 1].part) / 2;
      if (at[k].part == 0) {
        const MovedOutline::Nearest there = other.nearest(a);
        if (there.distance < -rounding)
          nodes.emplace_back(static_cast<int>(runs.size()), inside(a, 0, there));
      }
      runs.push_back({of, static_cast<int>(i), at[k].at, at[k + 1].at, inside(middle, part, nearest)});
    }
  }
}

/// Joins runs whose ends meet.
DisjointSets joined(const std::vector<Run>& runs, double rounding) {
  DisjointSets sets(runs.size());
  std::vector<std::pair<Point, int>> ends;
  for (size_t r = 0; r < runs.size(); ++r) {
    ends.emplace_back(runs[r].from, static_cast<int>(r));
    ends.emplace_back(runs[r].to, static_cast<int>(r));
  }
  std::sort(ends.begin(), ends.end(), [](const auto& x, const auto& y) {
    return std::pair(x.first.x(), x.second) < std::pair(y.first.x(), y.second);
  });
  constexpr size_t most = 64;  // ends in a row on one vertical line
  for (size_t i = 0; i < ends.size(); ++i)
    for (size_t j = i + 1; j < std::min(ends.size(), i + most); ++j) {
      if (ends[j].first.x() - ends[i].first.x() > rounding) break;
      if ((ends[j].first - ends[i].first).norm() <= rounding) sets.join(ends[i].second, ends[j].second);
    }
  for (size_t r = 0; r + 1 < runs.size(); ++r)
    if (runs[r].of == runs[r + 1].of && runs[r].to == runs[r + 1].from)
      sets.join(static_cast<int>(r), static_cast<int>(r) + 1);
  return sets;
}

}  // namespace

Point placeOn(const OutlineSide& side, const std::vector<Point>& places, double part) {
  const Point& a = places[side.nodes[0]];
  const Point& b = places[side.nodes[1]];
  if (side.middle < 0) return (1 - part) * a + part * b;
  const auto [atA, atB, atMiddle] = QuadraticEdge::shapes(part);
  return atA * a + atB * b + atMiddle * places[side.middle];
}

BodyOutline outlineOf(const TriangleMesh& mesh, const ElementNodes& nodes) {
  std::map<std::array<int, 2>, int> labels;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    labels[mesh.boundaryEdges[e]] = mesh.boundaryLabels[e];
  std::vector<OutlineSide> found;
  forEachPlace(sortedSides(mesh), [&](const auto& sides) {
    if (sides.size() != 1) return;
    const int t = sides.front().element();
    const int k = sides.front().corner();
    const std::array<int, 2> ends{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]};
    const auto label = labels.find(ends);
    found.push_back(
        {ends, nodes.degree == 1 ? -1 : nodes.of(t)[3 + k], label == labels.end() ? 0 : label->second});
  });
  std::multimap<int, int> from;
  for (size_t i = 0; i < found.size(); ++i) from.emplace(found[i].nodes[0], static_cast<int>(i));
  BodyOutline outline;
  while (!from.empty()) {
    const auto first = static_cast<int>(outline.sides.size());
    for (auto at = from.begin(); at != from.end(); at = from.find(outline.sides.back().nodes[1])) {
      outline.previous.push_back(static_cast<int>(outline.sides.size()) - 1);
      outline.sides.push_back(found[at->second]);
      outline.next.push_back(static_cast<int>(outline.sides.size()));
      from.erase(at);
    }
    outline.previous[first] = static_cast<int>(outline.sides.size()) - 1;
    outline.next.back() = first;
  }
  return outline;
}

MovedOutline::MovedOutline(const BodyOutline& outline, const std::vector<Point>& places) : tree_({}) {
  const std::vector<OutlineSide>& sides = outline.sides;
  low_ = Point::Constant(infinity);
  high_ = -low_;
  int first = 0;  // of the loop
  for (size_t k = 0; k < sides.size(); ++k) {
    const OutlineSide& side = sides[k];
    const Point& a = places[side.nodes[0]];
    const Point& b = places[side.nodes[1]];
    const double bend = side.middle < 0 ? 0 : (places[side.middle] - (a + b) / 2).norm();
    constexpr double straight = 1e-12;
    const int parts = bend > straight * (b - a).norm() ? piecesOfBent : 1;
    if (side.middle >= 0) offCurve_.push_back(parts > 1 ? bend / (parts * parts) : bend);
    for (int part = 0; part < parts; ++part) {
      const auto here = static_cast<int>(pieces_.size());
      points_.push_back(part == 0 ? a : placeOn(side, places, double(part) / parts));
      pieces_.push_back(
          {static_cast<int>(k), double(part) / parts, double(part + 1) / parts, here - 1, here + 1});
    }
    if (outline.next[k] == static_cast<int>(k) + 1) continue;
    pieces_.back().next = first;
    pieces_[first].previous = static_cast<int>(pieces_.size()) - 1;
    points_.push_back(b);
    pieces_.emplace_back();
    first = static_cast<int>(pieces_.size());
  }
  if (!pieces_.empty()) pieces_.pop_back();
  for (const Point& x : points_) {
    low_ = low_.cwiseMin(x);
    high_ = high_.cwiseMax(x);
  }
  tree_ = ElementTree(points_);
}

MovedOutline::Nearest MovedOutline::nearest(const Point& x) const {
  double least = infinity;
  Nearest found;
  double at = 0;
  tree_.near(x, least, [&](int k) {
    if (pieces_[k].side < 0) return;
    const Point along = points_[k + 1] - points_[k];
    const double length2 = along.squaredNorm();
    const double part = length2 > 0 ? std::clamp(along.dot(x - points_[k]) / length2, 0.0, 1.0) : 0;
    const double distance = (points_[k] + part * along - x).norm();
    if (distance > least || (distance == least && found.piece >= 0)) return;
    least = distance;
    found.piece = k;
    at = part;
  });
  if (found.piece < 0) return found;
  const Piece& piece = pieces_[found.piece];
  // At a corner by the sum of both normals, which is right for any turn (Baerentzen and Aanaes 2005).
  const auto along = [&](int k) -> Point { return (points_[k + 1] - points_[k]).normalized(); };
  Point way = along(found.piece);
  if (at == 0) way += along(piece.previous);
  if (at == 1) way += along(piece.next);
  const Point foot = points_[found.piece] + at * (points_[found.piece + 1] - points_[found.piece]);
  const bool inside = cross(way, x - foot) > 0;
  found.distance = inside ? -least : least;
  found.part = piece.from + at * (piece.to - piece.from);
  return found;
}

std::vector<CommonRegion> commonRegions(const MovedOutline& one, const MovedOutline& other, double rounding) {
  const bool apart =
      ((one.low() - other.high()).array() > 0).any() || ((other.low() - one.high()).array() > 0).any();
  if (apart) return {};
  const std::vector<char> near = piecesNear(one, other, rounding);
  const std::vector<char> nearOther = piecesNear(other, one, rounding);
  Cuts cutsOther(other.pieces().size());
  Cuts cuts = cutsOf(one, other, near, cutsOther, rounding);
  std::vector<Run> runs;
  std::vector<std::pair<int, PointInside>> nodes;
  addRuns(one, other, 0, near, cuts, rounding, runs, nodes);
  addRuns(other, one, 1, nearOther, cutsOther, rounding, runs, nodes);
  DisjointSets sets = joined(runs, rounding);
  std::vector<int> numberOf(runs.size(), -1);
  std::vector<CommonRegion> overlaps;
  std::vector<Point> origins;
  const auto take = [](CommonRegion& overlap, const PointInside& point) {
    overlap.points.push_back(point);
    if (!(point.depth > overlap.depth)) return;
    overlap.depth = point.depth;
    overlap.place = point.at;
  };
  for (size_t r = 0; r < runs.size(); ++r) {
    int& number = numberOf[sets.of(static_cast<int>(r))];
    if (number < 0) {
      number = static_cast<int>(overlaps.size());
      overlaps.emplace_back();
      origins.push_back(runs[r].from);
    }
    CommonRegion& overlap = overlaps[number];
    overlap.area += cross(runs[r].from - origins[number], runs[r].to - origins[number]) / 2;
    take(overlap, runs[r].middle);
  }
  for (const auto& [run, point] : nodes) take(overlaps[numberOf[sets.of(run)]], point);
  overlaps.erase(std::remove_if(overlaps.begin(), overlaps.end(),
                                [&](const CommonRegion& overlap) { return !(overlap.depth > rounding); }),
                 overlaps.end());
  return overlaps;
}

}  // namespace mortier
