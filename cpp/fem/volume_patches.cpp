#include "fem/volume_patches.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fem/element.h"

namespace mortier {

/// What patches need to know of their elements.
struct VolumePatches::Elements {
  int dimension = 2;
  int nodesOfElement = 3;
  int points = 1;                        ///< of an element
  int terms = 1;                         ///< of the polynomials
  const std::vector<int>& nodes;         ///< element by element
  const std::vector<double>& weights;    ///< of the points
  const std::vector<double>& gradients;  ///< of all shape functions of an element but the first, over sqrt2
  const std::vector<double>& hoops;      ///< as in Body
  const std::vector<Point>& places;      ///< of the points; none where polynomials are constants
};

void VolumePatches::findPatches(const std::vector<int>& nodes) {
  const int patches = patchOf_.empty() ? 0 : *std::max_element(patchOf_.begin(), patchOf_.end()) + 1;
  elementsFrom_.assign(patches + 1, 0);
  for (const int patch : patchOf_) ++elementsFrom_[patch + 1];
  std::partial_sum(elementsFrom_.begin(), elementsFrom_.end(), elementsFrom_.begin());
  elements_.resize(patchOf_.size());
  std::vector<int> next(elementsFrom_.begin(), elementsFrom_.end() - 1);
  for (size_t e = 0; e < patchOf_.size(); ++e) elements_[next[patchOf_[e]]++] = static_cast<int>(e);
  const auto of = [&](size_t element) {
    return nodes.begin() + static_cast<std::ptrdiff_t>(ofElement_ * element);
  };
  nodesFrom_.assign(1, 0);
  for (int patch = 0; patch < patches; ++patch) {
    const auto first = static_cast<std::ptrdiff_t>(nodes_.size());
    for (const int e : elements(patch)) nodes_.insert(nodes_.end(), of(e), of(e) + ofElement_);
    std::sort(nodes_.begin() + first, nodes_.end());
    nodes_.erase(std::unique(nodes_.begin() + first, nodes_.end()), nodes_.end());
    nodesFrom_.push_back(static_cast<int>(nodes_.size()));
  }
  local_.reserve(nodes.size());
  for (size_t e = 0; e < patchOf_.size(); ++e) {
    const std::span<const int> own = this->nodes(patchOf_[e]);
    for (int a = 0; a < ofElement_; ++a)
      local_.push_back(static_cast<int>(std::lower_bound(own.begin(), own.end(), of(e)[a]) - own.begin()));
  }
}

VolumePatches::VolumePatches(const std::vector<int>& patchOf, const ElementNodes& nodes,
                             const std::vector<Point>& places, const std::vector<double>& weights,
                             const std::vector<double>& gradients, const std::vector<double>& hoops)
    : VolumePatches(patchOf, {2, nodes.perElement(), nodes.degree == 1 ? 1 : 3, nodes.degree == 1 ? 1 : 3,
                              nodes.elements, weights, gradients, hoops, places}) {}

VolumePatches::VolumePatches(const std::vector<int>& patchOf, const SpaceNodes& nodes,
                             const std::vector<double>& weights, const std::vector<double>& gradients)
    : VolumePatches(patchOf, {3, 4, 1, 1, nodes.elements, weights, gradients, {}, {}}) {}

VolumePatches::VolumePatches(const std::vector<int>& patchOf, const Elements& elements)
    : patchOf_(patchOf),
      dimension_(elements.dimension),
      ofElement_(elements.nodesOfElement),
      points_(elements.points),
      terms_(elements.terms) {
  findPatches(elements.nodes);
  const auto& [dimension, n, each, terms, nodes, weights, gradients, hoops, places] = elements;
  const double overRoot = std::sqrt(2.0 / dimension);  // of gradients over sqrt2
  basis_.resize(terms * weights.size());
  rows_.assign(dimension * static_cast<size_t>(terms) * nodes_.size(), 0);
  if (!hoops.empty()) uniform_.assign(static_cast<size_t>(terms) * count(), 0);
  Matrix F;  // the polynomials at the points
  std::vector<int> points;
  for (int patch = 0; patch < count(); ++patch) {
    points.clear();
    for (const int e : this->elements(patch))
      for (int i = 0; i < each; ++i) points.push_back(each * e + i);
    const auto m = static_cast<Eigen::Index>(points.size());
    F.setOnes(terms, m);
    if (terms == 3) {
      Point centre = Point::Zero();
      for (const int i : points) centre += places[i] / static_cast<double>(m);
      double size = 0;
      for (const int i : points) size = std::max(size, (places[i] - centre).lpNorm<Eigen::Infinity>());
      for (Eigen::Index k = 0; k < m; ++k) F.col(k).tail<2>() = (places[points[k]] - centre) / size;
    }
    Eigen::Matrix3d gram = Eigen::Matrix3d::Identity();
    gram.topLeftCorner(terms, terms).setZero();
    for (Eigen::Index k = 0; k < m; ++k)
      gram.topLeftCorner(terms, terms) += weights[points[k]] * F.col(k) * F.col(k).transpose();
    const Eigen::Matrix3d L = gram.llt().matrixL();
    L.topLeftCorner(terms, terms).triangularView<Eigen::Lower>().solveInPlace(F);
    for (Eigen::Index k = 0; k < m; ++k) {
      const int i = points[k];
      const int* at = local(i / each);
      for (int term = 0; term < terms; ++term) {
        basis_[static_cast<size_t>(terms) * i + term] = F(term, k);
        const double factor = weights[i] * F(term, k);
        double* row = const_cast<double*>(this->row(patch, term));
        const double* gradient = &gradients[dimension * static_cast<size_t>(n - 1) * i];
        for (int a = 1; a < n; ++a)
          for (int c = 0; c < dimension; ++c) {
            const double part = factor * overRoot * gradient[dimension * (a - 1) + c];
            row[dimension * at[a] + c] += part;
            row[dimension * at[0] + c] -= part;  // gradients sum to zero
          }
        for (int a = 0; a < n && !hoops.empty(); ++a) {
          const double part = factor * overRoot2 * hoops[static_cast<size_t>(n) * i + a];
          row[2 * at[a]] += part;
          uniform_[static_cast<size_t>(terms) * patch + term] += part;
        }
      }
    }
  }
}

template <class Value, class At, class Difference, class Times>
std::array<Value, 3> VolumePatches::productsOf(int patch, At at, Difference difference, Times times) const {
  const auto nodes = this->nodes(patch);
  const int first = dimension_ * nodes[0];
  std::array<Value, 3> sums{};
  for (int k = 0; k < terms_; ++k) sums[k] = times(uniform(patch, k), at(first));
  for (size_t a = 1; a < nodes.size(); ++a)
    for (int c = 0; c < dimension_; ++c) {
      const Value change = difference(dimension_ * nodes[a] + c, first + c);
      for (int k = 0; k < terms_; ++k) sums[k] += times(row(patch, k)[dimension_ * a + c], change);
    }
  return sums;
}

std::array<DoubleDouble, 3> VolumePatches::products(int patch, const TwoPartVector& u) const {
  return productsOf<DoubleDouble>(
      patch,
      [&](int dof) {
        return DoubleDouble{u.high[dof], u.low[dof]};
      },
      [&](int dof, int first) {
        DoubleDouble change = DoubleDouble::sum(u.high[dof], -u.high[first]);
        change.low += u.low[dof] - u.low[first];
        return change;
      },
      [](double a, const DoubleDouble& b) { return DoubleDouble::product(a, b); });
}

std::array<double, 3> VolumePatches::products(int patch, const Vector& d) const {
  return productsOf<double>(
      patch, [&](int dof) { return d[dof]; }, [&](int dof, int first) { return d[dof] - d[first]; },
      [](double a, double b) { return a * b; });
}

void VolumePatches::addForces(const std::vector<double>& sums, Vector& f) const {
  for (int patch = 0; patch < count(); ++patch)
    for (int k = 0; k < terms_; ++k) {
      const double* row = this->row(patch, k);
      for (const int node : nodes(patch))
        for (int c = 0; c < dimension_; ++c)
          f[dimension_ * node + c] += sums[static_cast<size_t>(terms_) * patch + k] * *row++;
    }
}

Vector VolumePatches::averaged(const Vector& theta, const std::vector<double>& weights) const {
  Vector result(theta.size());
  for (int patch = 0; patch < count(); ++patch) {
    Eigen::Vector3d moments = Eigen::Vector3d::Zero();
    const auto forEachPoint = [&](auto visit) {
      for (const int t : elements(patch))
        for (int i = points_ * t; i < points_ * (t + 1); ++i)
          for (int term = 0; term < terms_; ++term) visit(i, term, basis_[terms_ * i + term]);
    };
    forEachPoint([&](int i, int term, double value) { moments[term] += weights[i] * value * theta[i]; });
    forEachPoint([&](int i, int term, double value) {
      result[i] = (term == 0 ? 0 : result[i]) + value * moments[term];
    });
  }
  return result;
}

void PatchTangent::start(const VolumePatches& patches, int patch) {
  std::copy_n(patches.row(patch, 0), terms_ * size_, m_);
  std::fill_n(m_ + terms_ * size_, 2 * terms_ * size_, 0.0);
}

void PatchTangent::addInner(const Eigen::Matrix3d& inner) {
  for (int k = 0; k < terms_; ++k)
    for (int l = 0; l < terms_; ++l)
      for (size_t i = 0; i < size_; ++i)
        first(k)[i] += inner(std::max(k, l), std::min(k, l)) * m_[l * size_ + i];
}

}  // namespace mortier
