#include "fem/error_estimate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.h"
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

/// Coefficients of a fit that are needed: linear ones are evaluated at their vertices only.
template <class Element>
constexpr int keptTerms = Element::nodes == 3 ? 1 : Element::nodes;

template <class Element>
using Terms = Eigen::Matrix<double, Element::nodes, 1>;

/// The terms of a polynomial at a distance from the vertex of a fit, over its size.
template <class Element>
Terms<Element> termsAt(const Point& x) {
  Terms<Element> result;
  if constexpr (Element::nodes == 3)
    result << 1, x.x(), x.y();
  else
    result << 1, x.x(), x.y(), x.x() * x.x(), x.x() * x.y(), x.y() * x.y();
  return result;
}

/// The radius at a place of a triangle over its mean: by that its weights are to be multiplied.
double radiusOverMean(const Body& body, Eigen::Index triangle, const Barycentric& place) {
  const auto& corners = body.mesh().triangles[triangle];
  double radius = 0;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double corner = body.mesh().vertices[corners[k]].x();
    radius += place[k] * corner;
    sum += corner;
  }
  return 3 * radius / sum;
}

/// Fits: polynomials of the degree of the displacements to the stresses at the points of the element.
template <class Element>
class Fits {
 public:
  /// \param samples  places of the points, triangle by triangle
  Fits(const TriangleMesh& mesh, const Neighbours& neighbours, const std::vector<Point>& samples)
      : mesh_(mesh), neighbours_(neighbours), samples_(samples) {}

  /// The fit to the points of a region around a vertex, by least squares; their mean where they do not
  /// determine the polynomial. Where they lie to one side, those of the next ring count too. Quadratic ones
  /// count a point by the inverse square of its distance from the vertex: on meshes that are graded towards
  /// an unbounded stress, points that are far off would have as much to say as those nearby.
  /// Appends the points, and for each its weights in the coefficients that are needed. \returns the size [m].
  double operator()(int vertex, int region, std::vector<int>& points, std::vector<double>& weights) {
    constexpr int terms = Element::nodes;
    constexpr int kept = keptTerms<Element>;
    constexpr double degenerate = 1e-10;
    region_ = region;
    choosePatch(vertex);
    const Point& centre = mesh_.vertices[vertex];
    double size = 0;
    forEachSample([&](int i) { size = std::max(size, (samples_[i] - centre).squaredNorm()); });
    size = std::sqrt(size);
    basis_.clear();
    Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
    forEachSample([&](int i) {
      basis_.push_back(termsAt<Element>((samples_[i] - centre) / size));
      normal += countOf(i, centre, size) * basis_.back() * basis_.back().transpose();
    });
    const auto n = static_cast<double>(basis_.size());
    const Eigen::LDLT<Eigen::Matrix<double, terms, terms>> factor(normal);
    const bool determined = factor.vectorD().minCoeff() >= degenerate * normal(0, 0);
    Eigen::Matrix<double, terms, kept> rows;
    for (int term = 0; term < kept; ++term) rows.col(term) = factor.solve(Terms<Element>::Unit(term));
    size_t k = 0;
    forEachSample([&](int i) {
      points.push_back(i);
      for (int term = 0; term < kept; ++term)
        weights.push_back(determined  ? countOf(i, centre, size) * rows.col(term).dot(basis_[k])
                          : term == 0 ? 1 / n
                                      : 0);
      ++k;
    });
    return size;
  }

 private:
  void choosePatch(int vertex) {
    patch_.clear();
    addAround(vertex);
    if (closed()) return;
    const std::vector<int> inner = patch_;
    for (const int triangle : inner)
      for (const int other : mesh_.triangles[triangle]) addAround(other);
    std::sort(patch_.begin(), patch_.end());
    patch_.erase(std::unique(patch_.begin(), patch_.end()), patch_.end());
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

  template <class Visit>
  void forEachSample(Visit visit) const {
    for (const int t : patch_)
      for (int i = 0; i < Element::points; ++i) visit(Element::points * t + i);
  }

  [[nodiscard]] double countOf(int sample, const Point& centre, double size) const {
    return Element::points > 1 ? size * size / (samples_[sample] - centre).squaredNorm() : 1;
  }

  const TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  const std::vector<Point>& samples_;
  int region_ = 0;
  std::vector<int> patch_;
  std::vector<int> corners_;
  std::vector<Terms<Element>> basis_;
};

}  // namespace

double ErrorEstimate::relative() const {
  return energy > 0 ? std::sqrt(error.sum() / energy) : 0;
}

ErrorEstimator::ErrorEstimator(const Body& body, Threads& threads) : body_(body) {
  if (body.rigid() || body.space() != nullptr) return;
  withElement(body.degree(), [&](auto element) { recover<decltype(element)>(threads); });
}

template <class Element>
void ErrorEstimator::recover(Threads& threads) {
  constexpr int kept = keptTerms<Element>;
  const TriangleMesh& mesh = body_.mesh();
  const ElementNodes& nodes = body_.elementNodes();
  std::vector<int> regions = mesh.regions;
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  recoveredAt_.resize(nodes.triangles.size());
  // Which fits there are, and which values come of them.
  std::vector<int> vertexOf;
  std::vector<int> regionOf;
  for (const int region : regions) {
    std::vector<int> fitOf(mesh.vertices.size(), -1);
    const auto fitAround = [&](int vertex) {
      if (fitOf[vertex] < 0) {
        fitOf[vertex] = static_cast<int>(vertexOf.size());
        vertexOf.push_back(vertex);
        regionOf.push_back(region);
      }
      return fitOf[vertex];
    };
    const auto valueOf = [&](int vertex, const Point& place) {
      return Value{fitAround(vertex), place - mesh.vertices[vertex]};
    };
    std::vector<int> known(nodes.places.size(), -1);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.regions[t] != region) continue;
      const auto& triangle = mesh.triangles[t];
      for (int a = 0; a < Element::nodes; ++a) {
        const int node = nodes.of(t)[a];
        if (known[node] < 0) {
          const Point& place = nodes.places[node];
          if (kept == 1) {
            known[node] = fitAround(node);
          } else {
            known[node] = static_cast<int>(values_.size());
            values_.push_back(
                {valueOf(triangle[a % 3], place), valueOf(triangle[(a < 3 ? a : a + 1) % 3], place)});
          }
        }
        recoveredAt_[Element::nodes * t + a] = known[node];
      }
    }
  }
  // The fits.
  struct Block {
    std::vector<int> points;
    std::vector<double> weights;
  };
  const Neighbours neighbours(mesh);
  const std::vector<Point> samples = body_.places();
  const auto fits = static_cast<int>(vertexOf.size());
  std::vector<double> sizes(fits);
  std::vector<Block> blocks(blocksOf(fits));
  first_.assign(fits + 1, 0);
  forEachBlock(fits, threads, [&](int begin, int end) {
    Fits<Element> around(mesh, neighbours, samples);
    auto& [points, weights] = blocks[begin / itemsOfBlock];
    for (int fit = begin; fit < end; ++fit) {
      const size_t before = points.size();
      sizes[fit] = around(vertexOf[fit], regionOf[fit], points, weights);
      first_[fit + 1] = points.size() - before;
    }
  });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  points_.resize(first_[fits]);
  weights_.resize(kept * first_[fits]);
  forEachBlock(fits, threads, [&](int begin, int /*end*/) {
    const Block block = std::move(blocks[begin / itemsOfBlock]);
    std::copy(block.points.begin(), block.points.end(), points_.begin() + first_[begin]);
    std::copy(block.weights.begin(), block.weights.end(), weights_.begin() + kept * first_[begin]);
  });
  for (auto& values : values_)
    for (Value& value : values) value.at /= sizes[value.fit];
}

ErrorEstimate ErrorEstimator::operator()(const Matrix& stress, Threads& threads) const {
  if (body_.space() != nullptr) return estimateInSpace(body_, stress, threads);
  if (body_.rigid()) return {Vector::Zero(static_cast<Eigen::Index>(body_.mesh().triangles.size())), 0};
  return withElement(body_.degree(),
                     [&](auto element) { return estimate<decltype(element)>(stress, threads); });
}

template <class Element>
Matrix ErrorEstimator::recoveredStress(const Matrix& stress, Threads& threads) const {
  constexpr int kept = keptTerms<Element>;
  const auto fits = static_cast<int>(first_.size()) - 1;
  Matrix coefficients(stress.rows(), kept * static_cast<Eigen::Index>(fits));
  forEachBlock(fits, threads, [&](int begin, int end) {
    coefficients.middleCols(kept * begin, kept * (end - begin)).setZero();
    for (int fit = begin; fit < end; ++fit)
      for (size_t k = first_[fit]; k < first_[fit + 1]; ++k)
        for (int term = 0; term < kept; ++term)
          coefficients.col(kept * fit + term) += weights_[kept * k + term] * stress.col(points_[k]);
  });
  if constexpr (kept == 1) {
    return coefficients;
  } else {
    const auto values = static_cast<int>(values_.size());
    Matrix recovered(stress.rows(), values);
    forEachBlock(values, threads, [&](int begin, int end) {
      recovered.middleCols(begin, end - begin).setZero();
      for (int i = begin; i < end; ++i)
        for (const Value& value : values_[i])
          recovered.col(i) +=
              coefficients.middleCols<kept>(kept * value.fit) * termsAt<Element>(value.at) / 2;
    });
    return recovered;
  }
}

Matrix ErrorEstimator::recovered(const Matrix& stress, Threads& threads) const {
  if (body_.space() != nullptr) return recoveredInSpace(body_, stress, threads);
  return withElement(body_.degree(), [&](auto element) {
    return Matrix(recoveredStress<decltype(element)>(stress, threads)(Eigen::all, recoveredAt_));
  });
}

template <class Element>
ErrorEstimate ErrorEstimator::estimate(const Matrix& stress, Threads& threads) const {
  constexpr int n = Element::points;
  constexpr auto rule = Element::loadRule();
  const Matrix recovered = recoveredStress<Element>(stress, threads);
  const auto triangles = static_cast<int>(stress.cols() / n);
  ErrorEstimate estimate{Vector(triangles), 0};
  std::vector<double> energies(blocksOf(triangles), 0);
  Matrix there(stress.rows(), stress.cols());
  Matrix strain(stress.rows(), stress.cols());
  forEachBlock(triangles, threads, [&](int firstTriangle, int lastTriangle) {
    const int begin = n * firstTriangle;
    const int end = n * lastTriangle;
    double energy = 0;
    estimate.error.segment(firstTriangle, lastTriangle - firstTriangle).setZero();
    const auto integrate = [&](size_t at, auto add) {
      body_.material().elasticStrain(there, strain, begin, end);
      for (int i = begin; i < end; ++i) {
        const auto& toNode = rule[at + i % n].toNode;
        double area = 0;
        for (int k = 0; k < n; ++k) area += body_.weights()[n * (i / n) + k];
        if (body_.axisymmetric()) area *= radiusOverMean(body_, i / n, rule[at + i % n].at);
        const double weight =
            area * std::accumulate(toNode.begin(), toNode.end(), 0.0) / Element::loadDivisor;
        add(i / n, weight * there.col(i).dot(strain.col(i)));
      }
    };
    // As many points of the rule at once as the element has: so each meets the material of its triangle.
    for (size_t at = 0; at < rule.size(); at += n) {
      for (int i = begin; i < end; ++i) {
        const auto N = Element::shapes(rule[at + i % n].at);
        there.col(i).setZero();
        for (int a = 0; a < Element::nodes; ++a)
          there.col(i) += N[a] * recovered.col(recoveredAt_[Element::nodes * (i / n) + a]);
      }
      integrate(at, [&](int /*triangle*/, double part) { energy += part; });
      for (int i = begin; i < end; ++i) {
        const auto L = Element::stressShapes(rule[at + i % n].at);
        for (int k = 0; k < n; ++k) there.col(i) -= L[k] * stress.col(n * (i / n) + k);
      }
      integrate(at, [&](int triangle, double part) { estimate.error[triangle] += part; });
    }
    energies[firstTriangle / itemsOfBlock] = energy;
  });
  for (const double energy : energies) estimate.energy += energy;
  return estimate;
}

}  // namespace mortier
