#include "fem/error_estimate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "fem/element.h"

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

/// The fits of one region: polynomials of the degree of the displacements to the stresses at the points of
/// the element.
template <class Element>
class Fits {
 public:
  /// \param samples  places of the points, triangle by triangle
  Fits(const TriangleMesh& mesh, const Neighbours& neighbours, const std::vector<Point>& samples, int region)
      : mesh_(mesh), neighbours_(neighbours), samples_(samples), region_(region) {}

  /// Calls visit(point, weight) for what makes the stress at a place: the value there of the fit to the
  /// points around a vertex. Where these lie to one side, those of the next ring count too.
  template <class Visit>
  void at(int vertex, const Point& place, Visit visit) {
    patch_.clear();
    addAround(vertex);
    if (!closed()) {
      const std::vector<int> inner = patch_;
      for (const int triangle : inner)
        for (const int other : mesh_.triangles[triangle]) addAround(other);
      std::sort(patch_.begin(), patch_.end());
      patch_.erase(std::unique(patch_.begin(), patch_.end()), patch_.end());
    }
    const std::vector<double>& weights = fit(mesh_.vertices[vertex], place);
    for (size_t i = 0; i < weights.size(); ++i)
      visit(Element::points * patch_[i / Element::points] + static_cast<int>(i % Element::points),
            weights[i]);
  }

 private:
  static constexpr int terms = Element::nodes;  // of a polynomial of that degree
  using Terms = Eigen::Matrix<double, terms, 1>;

  static Terms termsAt(const Point& x) {
    Terms result;
    if constexpr (terms == 3)
      result << 1, x.x(), x.y();
    else
      result << 1, x.x(), x.y(), x.x() * x.x(), x.x() * x.y(), x.y() * x.y();
    return result;
  }

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

  /// Of the value at a place, by least squares; of the mean where the points do not determine the polynomial.
  /// Quadratic ones count a point by the inverse square of its distance from the vertex: on meshes that are
  /// graded towards an unbounded stress, points that are far off would have as much to say as those nearby.
  const std::vector<double>& fit(const Point& vertex, const Point& place) {
    constexpr double degenerate = 1e-10;
    double size = 0;
    const auto forEachSample = [&](auto visit) {
      for (const int t : patch_)
        for (int i = 0; i < Element::points; ++i) visit(samples_[Element::points * t + i]);
    };
    forEachSample([&](const Point& sample) { size = std::max(size, (sample - vertex).squaredNorm()); });
    size = std::sqrt(size);
    basis_.clear();
    counts_.clear();
    Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
    forEachSample([&](const Point& sample) {
      counts_.push_back(Element::points > 1 ? size * size / (sample - vertex).squaredNorm() : 1);
      basis_.push_back(termsAt((sample - vertex) / size));
      normal += counts_.back() * basis_.back() * basis_.back().transpose();
    });
    const auto n = static_cast<double>(basis_.size());
    const Eigen::LDLT<Eigen::Matrix<double, terms, terms>> factor(normal);
    weights_.assign(basis_.size(), 1 / n);
    if (factor.vectorD().minCoeff() < degenerate * normal(0, 0)) return weights_;
    const Terms value = factor.solve(termsAt((place - vertex) / size));
    for (size_t i = 0; i < basis_.size(); ++i) weights_[i] = counts_[i] * value.dot(basis_[i]);
    return weights_;
  }

  const TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  const std::vector<Point>& samples_;
  int region_;
  std::vector<int> patch_;
  std::vector<int> corners_;
  std::vector<Terms> basis_;
  std::vector<double> counts_;
  std::vector<double> weights_;
};

}  // namespace

double ErrorEstimate::relative() const {
  return energy > 0 ? std::sqrt(error.sum() / energy) : 0;
}

ErrorEstimator::ErrorEstimator(const Body& body) : body_(body) {
  withElement(body.degree(), [&](auto element) { recover<decltype(element)>(); });
}

template <class Element>
void ErrorEstimator::recover() {
  const TriangleMesh& mesh = body_.mesh();
  const ElementNodes& nodes = body_.elementNodes();
  const Neighbours neighbours(mesh);
  const std::vector<Point> samples = body_.places();
  std::vector<int> regions = mesh.regions;
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  recoveredAt_.resize(nodes.triangles.size());
  for (const int region : regions) {
    Fits<Element> fits(mesh, neighbours, samples, region);
    std::vector<int> known(nodes.places.size(), -1);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.regions[t] != region) continue;
      for (int a = 0; a < Element::nodes; ++a) {
        const int node = nodes.of(t)[a];
        if (known[node] < 0) {
          known[node] = static_cast<int>(first_.size()) - 1;
          // At a middle the mean of what the vertices beside it say.
          const int fitsHere = a < 3 ? 1 : 2;
          for (int k = 0; k < fitsHere; ++k)
            fits.at(mesh.triangles[t][(a + k) % 3], nodes.places[node], [&](int point, double weight) {
              parts_.push_back({point, weight / fitsHere});
            });
          first_.push_back(parts_.size());
        }
        recoveredAt_[Element::nodes * t + a] = known[node];
      }
    }
  }
}

ErrorEstimate ErrorEstimator::operator()(const Matrix& stress) const {
  return withElement(body_.degree(), [&](auto element) { return estimate<decltype(element)>(stress); });
}

template <class Element>
ErrorEstimate ErrorEstimator::estimate(const Matrix& stress) const {
  constexpr int n = Element::points;
  constexpr auto rule = Element::loadRule();
  Matrix recovered = Matrix::Zero(stress.rows(), static_cast<Eigen::Index>(first_.size()) - 1);
  for (Eigen::Index i = 0; i < recovered.cols(); ++i)
    for (size_t k = first_[i]; k < first_[i + 1]; ++k)
      recovered.col(i) += parts_[k].weight * stress.col(parts_[k].point);
  const Eigen::Index triangles = stress.cols() / n;
  ErrorEstimate estimate{Vector::Zero(triangles), 0};
  Matrix there(stress.rows(), stress.cols());
  Matrix own(stress.rows(), stress.cols());
  Matrix strain;
  const auto integrate = [&](size_t at, auto add) {
    body_.material().elasticStrain(there, strain);
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      const auto& toNode = rule[at + i % n].toNode;
      double area = 0;
      for (int k = 0; k < n; ++k) area += body_.weights()[n * (i / n) + k];
      const double weight = area * std::accumulate(toNode.begin(), toNode.end(), 0.0) / Element::loadDivisor;
      add(i / n, weight * there.col(i).dot(strain.col(i)));
    }
  };
  // As many points of the rule at once as the element has: so each meets the material of its triangle.
  for (size_t at = 0; at < rule.size(); at += n) {
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      const Barycentric& place = rule[at + i % n].at;
      const auto N = Element::shapes(place);
      const auto L = Element::stressShapes(place);
      there.col(i).setZero();
      own.col(i).setZero();
      for (int a = 0; a < Element::nodes; ++a)
        there.col(i) += N[a] * recovered.col(recoveredAt_[Element::nodes * (i / n) + a]);
      for (int k = 0; k < n; ++k) own.col(i) += L[k] * stress.col(n * (i / n) + k);
    }
    integrate(at, [&](Eigen::Index, double part) { estimate.energy += part; });
    there -= own;
    integrate(at, [&](Eigen::Index triangle, double part) { estimate.error[triangle] += part; });
  }
  return estimate;
}

}  // namespace mortier
