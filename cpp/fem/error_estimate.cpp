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
class Recovery {
 public:
  Recovery(const TriangleMesh& mesh, const Neighbours& neighbours, int region, const Matrix& stress)
      : mesh_(mesh), neighbours_(neighbours), region_(region), stress_(stress) {}

  /// The stress at a vertex: that of the fit to the centres around it. Where they lie to one side, those of the next
  /// ring count too.
  Vector at(int vertex) {
    patch_.clear();
    addAround(vertex);
    if (!closed()) {
      const std::vector<int> inner = patch_;
      for (const int triangle : inner)
        for (const int other : mesh_.triangles[triangle]) addAround(other);
      std::sort(patch_.begin(), patch_.end());
      patch_.erase(std::unique(patch_.begin(), patch_.end()), patch_.end());
    }
    return fit(mesh_.vertices[vertex]);
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

  /// a of a + b . (x - vertex), by least squares; the mean where the centres do not determine it.
  [[nodiscard]] Vector fit(const Point& vertex) const {
    constexpr double degenerate = 1e-10;
    double size = 0;
    for (const int t : patch_) size = std::max(size, (centre(mesh_, t) - vertex).squaredNorm());
    size = std::sqrt(size);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, Eigen::Dynamic> values = Eigen::MatrixXd::Zero(3, stress_.rows());
    for (const int t : patch_) {
      Eigen::Vector3d basis;
      basis << 1, (centre(mesh_, t) - vertex) / size;
      normal += basis * basis.transpose();
      values += basis * stress_.col(t).transpose();
    }
    const Eigen::LDLT<Eigen::Matrix3d> factor(normal);
    const auto n = static_cast<double>(patch_.size());
    if (factor.vectorD().minCoeff() < degenerate * n) return values.row(0).transpose() / n;
    return factor.solve(values).row(0).transpose();
  }

  const TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  int region_;
  const Matrix& stress_;
  std::vector<int> patch_;
  std::vector<int> corners_;
};

/// The recovered stress at the three corners of every triangle.
std::array<Matrix, 3> recover(const TriangleMesh& mesh, const Matrix& stress) {
  const Neighbours neighbours(mesh);
  std::array<Matrix, 3> corners;
  for (Matrix& corner : corners) corner.resizeLike(stress);
  std::vector<int> regions = mesh.regions;
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  Matrix values(stress.rows(), static_cast<Eigen::Index>(mesh.vertices.size()));
  for (const int region : regions) {
    Recovery recovery(mesh, neighbours, region, stress);
    std::vector<char> known(mesh.vertices.size(), 0);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.regions[t] != region) continue;
      for (int i = 0; i < 3; ++i) {
        const int vertex = mesh.triangles[t][i];
        if (known[vertex] == 0) values.col(vertex) = recovery.at(vertex);
        known[vertex] = 1;
        corners[i].col(static_cast<Eigen::Index>(t)) = values.col(vertex);
      }
    }
  }
  return corners;
}

}  // namespace

double ErrorEstimate::relative() const {
  return energy > 0 ? std::sqrt(error.sum() / energy) : 0;
}

ErrorEstimate estimateError(const Body& body, const Matrix& stress) {
  const std::array<Matrix, 3> corners = recover(body.mesh(), stress);
  ErrorEstimate estimate{Vector::Zero(stress.cols()), 0};
  // The midpoints of the edges integrate the square of a linear field exactly.
  for (int i = 0; i < 3; ++i) {
    const Matrix recovered = 0.5 * (corners[i] + corners[(i + 1) % 3]);
    const Matrix error = recovered - stress;
    Matrix strain;
    Matrix errorStrain;
    body.material().elasticStrain(recovered, strain);
    body.material().elasticStrain(error, errorStrain);
    for (Eigen::Index t = 0; t < stress.cols(); ++t) {
      const double weight = body.weights()[t] / 3;
      estimate.energy += weight * recovered.col(t).dot(strain.col(t));
      estimate.error[t] += weight * error.col(t).dot(errorStrain.col(t));
    }
  }
  return estimate;
}

}  // namespace mortier
