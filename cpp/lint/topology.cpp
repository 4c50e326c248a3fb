#include "lint/topology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "mesh/boundary_line.h"

namespace mortier {
namespace {

std::uint64_t keyOf(int a, int b) {
  const auto [near, far] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(near) << 32) | static_cast<std::uint32_t>(far);
}

}  // namespace

Topology topologyOf(const TriangleMesh& mesh) {
  struct Side {
    std::uint64_t key;
    int triangle;
    int corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k)
      sides.push_back({keyOf(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]), t, k});
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  std::unordered_map<std::uint64_t, int> labels;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    labels[keyOf(mesh.boundaryEdges[e][0], mesh.boundaryEdges[e][1])] = mesh.boundaryLabels[e];

  Topology topology;
  for (size_t i = 0; i < sides.size(); ++i) {
    if (i + 1 < sides.size() && sides[i].key == sides[i + 1].key) {
      topology.neighbours.push_back({sides[i].triangle, sides[i + 1].triangle});
      ++i;
      continue;
    }
    const auto& corners = mesh.triangles[sides[i].triangle];
    const auto label = labels.find(sides[i].key);
    topology.boundary.push_back({corners[sides[i].corner], corners[(sides[i].corner + 1) % 3],
                                 sides[i].triangle, label == labels.end() ? noLabel : label->second});
  }
  return topology;
}

SegmentGrid::SegmentGrid(std::vector<std::array<Point, 2>> segments) : segments_(std::move(segments)) {
  Point upper = segments_.empty() ? Point(1, 1) : segments_[0][0];
  lower_ = segments_.empty() ? Point(0, 0) : segments_[0][0];
  for (const auto& segment : segments_)
    for (const Point& p : segment) {
      lower_ = lower_.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
  const double largest = (upper - lower_).maxCoeff();
  const double aim = largest / std::max(1.0, std::sqrt(static_cast<double>(segments_.size())));
  columns_ = 1 + static_cast<int>((upper - lower_).x() / aim);
  rows_ = 1 + static_cast<int>((upper - lower_).y() / aim);
  size_ = {aim, aim};
  cells_.resize(static_cast<size_t>(columns_) * rows_);
  for (int i = 0; i < static_cast<int>(segments_.size()); ++i) {
    const auto [x0, y0] = cell(segments_[i][0].cwiseMin(segments_[i][1]));
    const auto [x1, y1] = cell(segments_[i][0].cwiseMax(segments_[i][1]));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) cells_[static_cast<size_t>(y) * columns_ + x].push_back(i);
  }
}

std::array<int, 2> SegmentGrid::cell(const Point& p) const {
  const auto index = [](double x, int count) {
    return static_cast<int>(std::clamp(std::floor(x), 0.0, count - 1.0));
  };
  const Point at = (p - lower_).cwiseQuotient(size_);
  return {index(at.x(), columns_), index(at.y(), rows_)};
}

SegmentGrid boundaryGrid(const TriangleMesh& mesh, const Topology& topology) {
  std::vector<std::array<Point, 2>> segments;
  for (const BoundaryEdge& edge : topology.boundary)
    segments.push_back({mesh.vertices[edge.from], mesh.vertices[edge.to]});
  return SegmentGrid(std::move(segments));
}

double distanceToSegment(const Point& p, const std::array<Point, 2>& segment) {
  const Point along = segment[1] - segment[0];
  const double square = along.squaredNorm();
  const double s = square > 0 ? std::clamp((p - segment[0]).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - segment[0] - s * along).norm();
}

double edgeRatioWhereFine(const TriangleMesh& mesh, int label, const TriangleMesh& other, int otherLabel) {
  struct Edge {
    Point middle;
    double length;
  };
  std::array<std::vector<Edge>, 2> lines;
  for (const int k : {0, 1})
    for (const auto& [a, b] : edgesOn(k == 0 ? mesh : other, k == 0 ? label : otherLabel)) {
      const Point& x = (k == 0 ? mesh : other).vertices[a];
      const Point& y = (k == 0 ? mesh : other).vertices[b];
      lines[k].push_back({(x + y) / 2, (y - x).norm()});
    }
  std::pair<double, double> finest{INFINITY, 1};  // product and ratio of the lengths
  for (const std::vector<Edge>& line : lines) {
    const auto shorter = [](const Edge& a, const Edge& b) { return a.length < b.length; };
    const Point place = std::min_element(line.begin(), line.end(), shorter)->middle;
    const auto nearer = [&](const Edge& a, const Edge& b) {
      return (a.middle - place).squaredNorm() < (b.middle - place).squaredNorm();
    };
    const double h1 = std::min_element(lines[0].begin(), lines[0].end(), nearer)->length;
    const double h2 = std::min_element(lines[1].begin(), lines[1].end(), nearer)->length;
    finest = std::min(finest, {h1 * h2, h2 / h1});
  }
  return finest.second;
}

std::array<Point, 2> boundingBox(const TriangleMesh& mesh) {
  std::array<Point, 2> box{mesh.vertices[0], mesh.vertices[0]};
  for (const Point& p : mesh.vertices) {
    box[0] = box[0].cwiseMin(p);
    box[1] = box[1].cwiseMax(p);
  }
  return box;
}

}  // namespace mortier
