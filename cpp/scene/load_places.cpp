#include "scene/load_places.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "base/dense_templates.h"
#include "mesh/boundary_line.h"

namespace mortier {
namespace {

constexpr size_t mostPlaces = 24;
constexpr size_t mostCandidates = 3000;

/// A part of an edge, or of a rectangle, in a part of the time.
struct Cell {
  Point from, to;
  bool rectangle = false;
  Interval time;
  double beyond = 0;
  [[nodiscard]] Point middle() const { return (from + to) / 2; }
  [[nodiscard]] Box box() const {
    const Point low = from.cwiseMin(to);
    const Point high = from.cwiseMax(to);
    return {{low.x(), high.x()}, {low.y(), high.y()}, time};
  }
  bool operator<(const Cell& other) const { return beyond < other.beyond; }
};

/// Looks for values beyond those that are known.
class Search {
 public:
  Search(const Datum& datum, Interval known, double end) : datum_(datum), known_(known), end_(end) {}

  /// Places and times with values that are far beyond.
  void in(Cell whole, std::vector<Point>& places, std::vector<double>& times) {
    constexpr int budget = 1000;
    const double extent = (whole.to - whole.from).norm();
    whole.beyond = beyond(whole);
    std::priority_queue<Cell> cells;
    cells.push(whole);
    for (int i = 0; i < budget && !cells.empty() && matters(cells.top().beyond); ++i) {
      const Cell cell = cells.top();
      cells.pop();
      const Point place = cell.middle();
      const double t = (cell.time.least + cell.time.largest) / 2;
      const double value = datum_(place.x(), place.y(), t);
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
    const Interval enclosed = datum_.enclosure(cell.box());
    const double result = std::max(enclosed.largest - known_.largest, known_.least - enclosed.least);
    return std::isfinite(result) ? result : 0;
  }
  /// Along what shows most of what is not beyond; where all directions show the same along the longest.
  [[nodiscard]] std::array<Cell, 2> halves(const Cell& cell, double extent) const {
    const Point along = (cell.to - cell.from).cwiseAbs() * end_;
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
    if (!cell.rectangle) {
      parts = {cell, cell};
      parts[0].to = parts[1].from = cell.middle();
      consider(parts, along.norm());
    }
    for (int c = 0; cell.rectangle && c < 2; ++c) {
      parts = {cell, cell};
      parts[0].to[c] = parts[1].from[c] = cell.middle()[c];
      consider(parts, along[c]);
    }
    return best;
  }

  const Datum& datum_;
  Interval known_;
  double end_;
};

/// Uneven, so that no period of what people write hides between them.
std::vector<double> trialTimes(double end) {
  constexpr int count = 48;
  constexpr double uneven = 0.3819660112501051;
  std::vector<double> times{0, end};
  for (int i = 0; i < count; ++i) times.push_back(end * (i + uneven) / count);
  return times;
}

/// Of the candidates those whose courses at some times are independent, the largest first.
std::vector<Point> independent(const Datum& datum, const std::vector<Point>& candidates,
                               const std::vector<double>& times) {
  constexpr double same = 1e-9;
  Matrix courses(times.size(), candidates.size());
  for (size_t j = 0; j < candidates.size(); ++j)
    for (size_t i = 0; i < times.size(); ++i) {
      const double value = datum(candidates[j].x(), candidates[j].y(), times[i]);
      courses(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = std::isfinite(value) ? value : 0;
    }
  Eigen::ColPivHouseholderQR<Matrix> qr(courses);
  qr.setThreshold(same);
  const Eigen::Index rank = std::clamp<Eigen::Index>(qr.rank(), 1, mostPlaces);
  std::vector<Point> places;
  for (Eigen::Index i = 0; i < rank; ++i) places.push_back(candidates[qr.colsPermutation().indices()[i]]);
  return places;
}

LoadPlaces found(const Datum& datum, std::vector<Point> candidates, const std::vector<Cell>& cells,
                 double end) {
  const bool bends = datum.inTime && datum.degreeInTime > 1;
  std::vector<double> times = bends ? trialTimes(end) : std::vector<double>{0, end};
  LoadPlaces result;
  if (datum.enclosure && datum.inTime) {
    Interval known{INFINITY, -INFINITY};
    for (const Point& p : candidates)
      for (const double t : times) {
        const double value = datum(p.x(), p.y(), t);
        known = {std::min(known.least, value), std::max(known.largest, value)};
      }
    Search search(datum, known, end);
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

}  // namespace

LoadPlaces loadPlaces(const Datum& datum, const Point& point, double end) {
  return found(datum, {point}, {{point, point, false, {0, end}}}, end);
}

LoadPlaces loadPlaces(const Datum& datum, const TriangleMesh& mesh, const int* label, double end) {
  std::vector<Point> candidates;
  std::vector<Cell> cells;
  if (label != nullptr) {
    const auto edges = edgesOn(mesh, *label);
    const int inside = edges.size() * 8 > mostCandidates ? 1 : 7;
    for (const auto& [a, b] : edges) {
      const Point& from = mesh.vertices[a];
      const Point along = mesh.vertices[b] - from;
      for (int i = 0; i <= inside + 1; ++i) candidates.emplace_back(from + along * i / (inside + 1));
      cells.push_back({from, mesh.vertices[b], false, {0, end}});
    }
  } else if (!mesh.vertices.empty()) {
    Point low = mesh.vertices[0];
    Point high = low;
    const size_t stride = 1 + 2 * mesh.triangles.size() / mostCandidates;
    for (const Point& p : mesh.vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (size_t t = 0; t < mesh.triangles.size(); t += stride) {
      const auto& [a, b, c] = mesh.triangles[t];
      candidates.push_back(mesh.vertices[a]);
      candidates.emplace_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
    }
    cells.push_back({low, high, true, {0, end}});
  }
  if (candidates.empty()) return {};
  if (datum.degree == 0) return loadPlaces(datum, candidates.front(), end);
  return found(datum, std::move(candidates), cells, end);
}

}  // namespace mortier
