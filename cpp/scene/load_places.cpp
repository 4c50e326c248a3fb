#include "scene/load_courses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>

#include "base/dense_templates.h"
#include "mesh/boundary_line.h"
#include "mesh/box_of.h"

namespace mortier {
namespace {

constexpr size_t mostPlaces = 24;
constexpr size_t mostCandidates = 3000;

/// A part of an edge, of a triangle or of a box, in a part of the time.
struct Cell {
  std::vector<SpacePoint> corners;  ///< of a box two
  bool isBox = false;
  Interval time;
  double beyond = 0;
  [[nodiscard]] SpacePoint middle() const {
    SpacePoint sum = corners[0];
    for (size_t i = 1; i < corners.size(); ++i) sum += corners[i];
    return sum / static_cast<double>(corners.size());
  }
  [[nodiscard]] Box box() const {
    const auto box = boxOf(corners);
    const SpacePoint low = box.min();
    const SpacePoint high = box.max();
    return {{low.x(), high.x()}, {low.y(), high.y()}, time, {low.z(), high.z()}};
  }
  /// The two corners of the longest side.
  [[nodiscard]] std::array<size_t, 2> longest() const {
    std::array<size_t, 2> ends{0, 1};
    for (size_t i = 0; i < corners.size(); ++i)
      for (size_t j = i + 1; j < corners.size(); ++j)
        if ((corners[j] - corners[i]).squaredNorm() > (corners[ends[1]] - corners[ends[0]]).squaredNorm())
          ends = {i, j};
    return ends;
  }
  bool operator<(const Cell& other) const { return beyond < other.beyond; }
};

/// Looks for values beyond those that are known.
class Search {
 public:
  Search(const Expression& datum, Interval known, double duration)
      : datum_(datum), known_(known), duration_(duration) {}

  /// Places and times with values that are far beyond.
  void in(Cell whole, std::vector<SpacePoint>& places, std::vector<double>& times) {
    constexpr int budget = 1000;
    const auto [first, last] = whole.longest();
    const double extent = (whole.corners[last] - whole.corners[first]).norm();
    whole.beyond = beyond(whole);
    std::priority_queue<Cell> cells;
    cells.push(whole);
    for (int i = 0; i < budget && !cells.empty() && matters(cells.top().beyond); ++i) {
      const Cell cell = cells.top();
      cells.pop();
      const SpacePoint place = cell.middle();
      const double t = (cell.time.least + cell.time.largest) / 2;
      const double value = datum_.value(place, t);
      const double over = std::max(value - known_.largest, known_.least - value);
      if (std::isfinite(over) && matters(over) && over > cell.beyond / 2) {
        places.push_back(place);
        times.push_back(t);
        known_ = {std::min(known_.least, value), std::max(known_.largest, value)};
      }
      for (const Cell& half : halves(cell, extent))
        if (matters(half.beyond)) cells.push(half);
    }
  }

 private:
  [[nodiscard]] bool matters(double beyond) const {
    constexpr double part = 0.1;
    return beyond > part * (known_.largest - known_.least) && beyond > 0;
  }
  [[nodiscard]] double beyond(const Cell& cell) const {
    const Interval enclosed = datum_.value.enclosure(cell.box());
    const double result = std::max(enclosed.largest - known_.largest, known_.least - enclosed.least);
    return std::isfinite(result) ? result : 0;
  }
  /// Along what shows most of what is not beyond; where all directions show the same along the longest.
  [[nodiscard]] std::array<Cell, 2> halves(const Cell& cell, double extent) const {
    const auto [i, j] = cell.longest();
    const SpacePoint along = (cell.corners[j] - cell.corners[i]).cwiseAbs() * duration_;
    const double inTime = (cell.time.largest - cell.time.least) * extent;
    std::array<Cell, 2> best;
    double least = INFINITY;
    double longest = 0;
    const auto consider = [&](std::array<Cell, 2> parts, double length) {
      for (Cell& part : parts) part.beyond = std::max(0.0, beyond(part));
      const double left = parts[0].beyond + parts[1].beyond;
      if (left > least || (left == least && length <= longest)) return;
      best = parts;
      least = left;
      longest = length;
    };
    std::array<Cell, 2> parts{cell, cell};
    parts[0].time.largest = parts[1].time.least = (cell.time.least + cell.time.largest) / 2;
    consider(parts, inTime);
    const SpacePoint middle = (cell.corners[i] + cell.corners[j]) / 2;
    if (!cell.isBox) {
      parts = {cell, cell};
      parts[0].corners[j] = parts[1].corners[i] = middle;
      consider(parts, along.norm());
    }
    for (int c = 0; cell.isBox && c < 3; ++c) {
      if (!(along[c] > 0)) continue;
      parts = {cell, cell};
      parts[0].corners[1][c] = parts[1].corners[0][c] = middle[c];
      consider(parts, along[c]);
    }
    return best;
  }

  const Expression& datum_;
  Interval known_;
  double duration_;  ///< of the run [s]
};

std::vector<double> trialTimes(const TimePlan& time) {
  constexpr int count = 48;
  std::vector<double> times{time.begin, time.end};
  for (int i = 0; i < count; ++i) times.push_back(time.begin + time.duration() * (i + unevenPart) / count);
  return times;
}

/// Of the candidates those whose courses at some times are independent, the largest first.
std::vector<SpacePoint> independent(const Expression& datum, const std::vector<SpacePoint>& candidates,
                                    const std::vector<double>& times) {
  constexpr double same = 1e-9;
  Matrix courses(times.size(), candidates.size());
  for (size_t j = 0; j < candidates.size(); ++j)
    for (size_t i = 0; i < times.size(); ++i) {
      const double value = datum.value(candidates[j], times[i]);
      courses(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = std::isfinite(value) ? value : 0;
    }
  Eigen::ColPivHouseholderQR<Matrix> qr(courses);
  qr.setThreshold(same);
  const Eigen::Index rank = std::clamp<Eigen::Index>(qr.rank(), 1, mostPlaces);
  std::vector<SpacePoint> places;
  for (Eigen::Index i = 0; i < rank; ++i) places.push_back(candidates[qr.colsPermutation().indices()[i]]);
  return places;
}

LoadPlaces found(const Expression& datum, std::vector<SpacePoint> candidates, const std::vector<Cell>& cells,
                 const TimePlan& time) {
  const bool bends = datum.inTime && datum.value.degreeInTime > 1;
  std::vector<double> times = bends ? trialTimes(time) : std::vector<double>{time.begin, time.end};
  LoadPlaces result;
  if (datum.value.enclosure && datum.inTime) {
    Interval known{INFINITY, -INFINITY};
    for (const SpacePoint& p : candidates)
      for (const double t : times) {
        const double value = datum.value(p, t);
        known = {std::min(known.least, value), std::max(known.largest, value)};
      }
    Search search(datum, known, time.duration());
    // What is linear in time has no peaks: it is looked for only where the candidates show none of it.
    const bool hidden = known.least == 0 && known.largest == 0;
    for (const Cell& cell : cells)
      if (bends || hidden) search.in(cell, candidates, result.times);
    std::sort(result.times.begin(), result.times.end());
    times.insert(times.end(), result.times.begin(), result.times.end());
  }
  result.points = independent(datum, candidates, times);
  return result;
}

/// A mesh as lists.
struct Parts {
  std::vector<SpacePoint> vertices;
  std::vector<std::vector<int>> sides;     ///< where the datum acts, if it acts on sides
  std::vector<std::vector<int>> elements;  ///< otherwise
};

template <class Lists>
std::vector<std::vector<int>> listsOf(const Lists& all) {
  std::vector<std::vector<int>> lists;
  for (const auto& each : all) lists.emplace_back(each.begin(), each.end());
  return lists;
}

/// Of an edge the parts of equal length; of a triangle its corners, the middles of its sides and its own.
void addPlacesOf(const std::vector<SpacePoint>& corners, int inside, std::vector<SpacePoint>& places) {
  if (corners.size() == 2) {
    const SpacePoint along = corners[1] - corners[0];
    for (int i = 0; i <= inside + 1; ++i) places.emplace_back(corners[0] + along * i / (inside + 1));
    return;
  }
  const SpacePoint middle = (corners[0] + corners[1] + corners[2]) / 3;
  places.push_back(middle);
  for (int i = 0; i < 3; ++i) {
    const SpacePoint& corner = corners[static_cast<size_t>(i)];
    places.push_back(corner);
    if (inside > 1) places.emplace_back((corner + corners[static_cast<size_t>((i + 1) % 3)]) / 2);
    if (inside > 1) places.emplace_back((corner + middle) / 2);
  }
}

LoadPlaces placesIn(const Parts& parts, const Expression& datum, const int* label, const TimePlan& time) {
  std::vector<SpacePoint> candidates;
  std::vector<Cell> cells;
  if (label != nullptr) {
    const int inside = parts.sides.size() * 8 > mostCandidates ? 1 : 7;
    for (const std::vector<int>& side : parts.sides) {
      std::vector<SpacePoint> corners;
      for (const int v : side) corners.push_back(parts.vertices[v]);
      addPlacesOf(corners, inside, candidates);
      cells.push_back({std::move(corners), false, {time.begin, time.end}});
    }
  } else if (!parts.vertices.empty()) {
    const auto box = boxOf(parts.vertices);
    const size_t stride = 1 + 2 * parts.elements.size() / mostCandidates;
    for (size_t e = 0; e < parts.elements.size(); e += stride) {
      const std::vector<int>& element = parts.elements[e];
      SpacePoint sum = SpacePoint::Zero();
      for (const int v : element) sum += parts.vertices[v];
      candidates.push_back(parts.vertices[element[0]]);
      candidates.emplace_back(sum / static_cast<double>(element.size()));
    }
    cells.push_back({{box.min(), box.max()}, true, {time.begin, time.end}});
  }
  if (candidates.empty()) return {};
  if (datum.value.degree == 0) return loadPlaces(datum, candidates.front(), time);
  return found(datum, std::move(candidates), cells, time);
}

}  // namespace

LoadPlaces loadPlaces(const Expression& datum, const SpacePoint& point, const TimePlan& time) {
  return found(datum, {point}, {{{point, point}, false, {time.begin, time.end}}}, time);
}

template <class Mesh>
LoadPlaces loadPlaces(const Expression& datum, const Mesh& mesh, const int* label, const TimePlan& time) {
  Parts parts;
  for (const auto& p : mesh.vertices) parts.vertices.push_back(asSpacePoint(p));
  if (label != nullptr)
    parts.sides = listsOf(sidesWith(mesh, *label));
  else
    parts.elements = listsOf(elementsOf(mesh));
  return placesIn(parts, datum, label, time);
}

template LoadPlaces loadPlaces(const Expression&, const TriangleMesh&, const int*, const TimePlan&);
template LoadPlaces loadPlaces(const Expression&, const TetrahedronMesh&, const int*, const TimePlan&);

}  // namespace mortier
