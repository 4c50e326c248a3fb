#include "fem/error_estimate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace mortier {
namespace {

/// The triangles around each vertex.
class Neighbours {
 public:
  explicit Neighbours(const TriangleMesh& mesh) : first_(mesh.vertices.size() + 1, 0) {
    for (const auto& triangle : mesh.triangles)
      for (const int vertex : triangle) ++first_[vertex + 1];
    for (size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    triangles_.resize(3 * mesh.triangles.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const int vertex : mesh.triangles[t]) triangles_[next[vertex]++] = static_cast<int>(t);
  }
  /// Calls visit(triangle).
  template <class Visit>
  void of(int vertex, Visit visit) const {
    for (int i = first_[vertex]; i < first_[vertex + 1]; ++i) visit(triangles_[i]);
  }

 private:
  std::vector<int> first_;
  std::vector<int> triangles_;
};

Point centre(const TriangleMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
}

/// The fits of one region.
class Fits {
 public:
  Fits(const TriangleMesh& mesh, const Neighbours& neighbours, int region)
      : mesh_(mesh), neighbours_(neighbours), region_(region) {}

  /// Calls visit(triangle, weight) for what makes the stress at a vertex: the value there of the fit to the centres around
  /// it. Where they lie to one side, those of the next ring count too.
  template <class Visit>
  void at(int vertex, Visit visit) {
    patch_.clear();
    addAround(vertex);
    if (!closed()) {
      const std::vector<int> inner = patch_;
      for (const int triangle : inner)
        for (const int other : mesh_.triangles[triangle]) addAround(other);
      std::sort(patch_.begin(), patch_.end());
      patch_.erase(std::unique(patch_.begin(), patch_.end()), patch_.end());
    }
    const std::vector<double>& weights = fit(mesh_.vertices[vertex]);
    for (size_t i = 0; i < patch_.size(); ++i) visit(patch_[i], weights[i]);
  }

 private:
  void addAround(int vertex) {
    neighbours_.of(vertex, [&](int t) {
      if (mesh_.regions[t] == region_) patch_.push_back(t);
    });
  }

  /// Whether the triangles lie all around: then they have as many corners besides as there are triangles.
  bool closed() {
    corners_.clear();
    for (const int t : patch_)
      corners_.insert(corners_.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    std::sort(corners_.begin(), corners_.end());
    const auto end = std::unique(corners_.begin(), corners_.end());
    return end - corners_.begin() == static_cast<std::ptrdiff_t>(patch_.size()) + 1;
  }

  /// Of a in a + b . (x - vertex), by least squares; of the mean where the centres do not determine it.
  const std::vector<double>& fit(const Point& vertex) {
    constexpr double degenerate = 1e-10;
    const auto n = static_cast<double>(patch_.size());
    double size = 0;
    for (const int t : patch_) size = std::max(size, (centre(mesh_, t) - vertex).squaredNorm());
    size = std::sqrt(size);
    basis_.clear();
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    for (const int t : patch_) {
      const Point x = (centre(mesh_, t) - vertex) / size;
      basis_.emplace_back(1, x.x(), x.y());
      normal += basis_.back() * basis_.back().transpose();
    }
    const Eigen::LDLT<Eigen::Matrix3d> factor(normal);
    weights_.assign(patch_.size(), 1 / n);
    if (factor.vectorD().minCoeff() < degenerate * n) return weights_;
    const Eigen::Vector3d value = factor.solve(Eigen::Vector3d::UnitX());
    for (size_t i = 0; i < patch_.size(); ++i) weights_[i] = value.dot(basis_[i]);
    return weights_;
  }

  const TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  int region_;
  std::vector<int> patch_;
  std::vector<int> corners_;
  std::vector<Eigen::Vector3d> basis_;
  std::vector<double> weights_;
};

}  // namespace

double ErrorEstimate::relative() const {
  return energy > 0 ? std::sqrt(error.sum() / energy) : 0;
}

ErrorEstimator::ErrorEstimator(const Body& body) : body_(body), corners_(body.mesh().triangles.size()) {
  const TriangleMesh& mesh = body.mesh();
  const Neighbours neighbours(mesh);
  std::vector<int> regions = mesh.regions;
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  for (const int region : regions) {
    Fits fits(mesh, neighbours, region);
    std::vector<int> known(mesh.vertices.size(), -1);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.regions[t] != region) continue;
      for (int i = 0; i < 3; ++i) {
        int& place = known[mesh.triangles[t][i]];
        if (place < 0) {
          place = static_cast<int>(first_.size()) - 1;
          fits.at(mesh.triangles[t][i], [&](int triangle, double weight) {
            parts_.push_back({triangle, weight});
          });
          first_.push_back(parts_.size());
        }
        corners_[t][i] = place;
      }
    }
  }
}

ErrorEstimate ErrorEstimator::operator()(const Matrix& stress) const {
  Matrix recovered = Matrix::Zero(stress.rows(), static_cast<Eigen::Index>(first_.size()) - 1);
  for (Eigen::Index i = 0; i < recovered.cols(); ++i)
    for (size_t k = first_[i]; k < first_[i + 1]; ++k)
      recovered.col(i) += parts_[k].weight * stress.col(parts_[k].triangle);
  ErrorEstimate estimate{Vector::Zero(stress.cols()), 0};
  Matrix middle(stress.rows(), stress.cols());
  Matrix strain;
  // The midpoints of the edges integrate the square of a linear field exactly.
  for (int i = 0; i < 3; ++i) {
    for (Eigen::Index t = 0; t < stress.cols(); ++t)
      middle.col(t) = 0.5 * (recovered.col(corners_[t][i]) + recovered.col(corners_[t][(i + 1) % 3]));
    body_.material().elasticStrain(middle, strain);
    for (Eigen::Index t = 0; t < stress.cols(); ++t)
      estimate.energy += body_.weights()[t] / 3 * middle.col(t).dot(strain.col(t));
    middle -= stress;
    body_.material().elasticStrain(middle, strain);
    for (Eigen::Index t = 0; t < stress.cols(); ++t)
      estimate.error[t] += body_.weights()[t] / 3 * middle.col(t).dot(strain.col(t));
  }
  return estimate;
}

}  // namespace mortier
