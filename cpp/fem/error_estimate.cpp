#include "fem/error_estimate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/dense_templates.h"
#include "base/parallel.h"
#include "fem/element.h"
#include "fem/tetrahedron.h"
#include "mesh/simplices.h"

namespace mortier {

class ErrorEstimator::Recovery {
 public:
  virtual ~Recovery() = default;
  [[nodiscard]] virtual ErrorEstimate estimate(const Matrix& stress, Threads& threads) const = 0;
  [[nodiscard]] virtual Matrix recovered(const Matrix& stress, Threads& threads) const = 0;
};

namespace {

/// Of a field that is f_a at the nodes of an element: its square, integrated, is the measure of the element
/// times the sum of those of its modes sum_a f_a N_am.
template <class Element>
using Modes = Eigen::Matrix<double, Element::nodes, Element::nodes>;

/// Modes are values at the points of a rule in the plane, where these are at different radii, and those of
/// the mass matrix N N' in space.
template <class Element>
Modes<Element> modesOf() {
  Modes<Element> modes = Modes<Element>::Zero();
  const auto shapesAt = [](const auto& b) {
    return Eigen::Vector<double, Element::nodes>(Element::shapes(b).data());
  };
  if constexpr (Element::interior[0].size() == 3) {
    constexpr auto rule = Element::loadRule();
    for (size_t m = 0; m < rule.size(); ++m) {
      const auto& [at, toNode] = rule[m];
      const double weight = std::accumulate(toNode.begin(), toNode.end(), 0.0) / Element::loadDivisor;
      modes.col(static_cast<Eigen::Index>(m)) = std::sqrt(weight) * shapesAt(at);
    }
  } else {
    Matrix mass = Matrix::Zero(Element::nodes, Element::nodes);
    for (const auto& [at, weight] : tetrahedronRule()) {
      const auto N = shapesAt(SpaceBarycentric{1 - at.sum(), at.x(), at.y(), at.z()});
      mass += 6 * weight * N * N.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(mass);
    modes = eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().asDiagonal();
  }
  return modes;
}

/// The stress at a vertex is that of a polynomial of the degree of the displacements, fitted by least squares
/// to the points of the elements of one region around it; at the middle of a side it is the mean of what both
/// ends say. Quadratic fits count a point by the inverse square of its distance from the vertex: on meshes
/// that are graded towards an unbounded stress, points that are far off would have as much to say as those
/// nearby.
template <class Element>
class Fitted final : public ErrorEstimator::Recovery {
 public:
  static constexpr int corners = static_cast<int>(Element::interior[0].size());
  static constexpr int dimension = corners - 1;
  static constexpr int nodes = Element::nodes;
  static constexpr int each = Element::points;
  using Place = Eigen::Vector<double, dimension>;
  /// The first components: what a law in space remembers is no error.
  using Stress = Eigen::Vector<double, 6>;
  using Stresses = Eigen::Matrix<double, 6, nodes>;

  explicit Fitted(const Body& body) : body_(body), samples_(dimension, body.points()) {
    if (body.rigid()) return;
    for (int i = 0; i < body.points(); ++i) samples_.col(i) = body.placeOfPoint(i).head<dimension>();
    findPlaces();
    findPatches();
  }

  [[nodiscard]] Matrix recovered(const Matrix& stress, Threads& threads) const override {
    return recover(stress, threads)(Eigen::seqN(0, used(stress)), placeOf_);
  }

  /// Laws take stress points alone: modes take their place, some at a time.
  [[nodiscard]] ErrorEstimate estimate(const Matrix& stress, Threads& threads) const override {
    if (body_.rigid()) return {Vector::Zero(static_cast<Eigen::Index>(body_.elements())), 0};
    const Eigen::Matrix<double, 6, Eigen::Dynamic> recovered = recover(stress, threads);
    const Eigen::Index own = used(stress);
    const Modes<Element> N = modesOf<Element>();
    const Eigen::Matrix<double, each, nodes> ofPoints = pointsToNodes().lazyProduct(N);
    const auto count = static_cast<int>(body_.elements());
    ErrorEstimate result{Vector::Zero(count), 0};
    Vector energies = Vector::Zero(count);
    Matrix field = Matrix::Zero(stress.rows(), stress.cols());
    Matrix strain(stress.rows(), stress.cols());
    forEachBlock(count, threads, [&](int begin, int end) {
      std::vector<Stresses> modes(end - begin);
      const auto addEnergies = [&](Vector& sums) {
        for (int first = 0; first < nodes; first += each) {
          const int some = std::min(each, nodes - first);
          for (int e = begin; e < end; ++e)
            for (int m = 0; m < some; ++m)
              field.col(each * e + m).head(own) = modes[e - begin].col(first + m).head(own);
          body_.material().elasticStrain(field, strain, each * begin, each * end);
          for (int e = begin; e < end; ++e)
            for (int m = 0; m < some; ++m)
              sums[e] += measureAt(e, first + m) * field.col(each * e + m).dot(strain.col(each * e + m));
        }
      };
      for (int e = begin; e < end; ++e) {
        Stresses atNodes;
        for (int a = 0; a < nodes; ++a) atNodes.col(a) = recovered.col(placeOf_[nodes * e + a]);
        modes[e - begin] = atNodes.lazyProduct(N);
      }
      addEnergies(energies);
      for (int e = begin; e < end; ++e)
        modes[e - begin].topRows(own) -= stress.middleCols<each>(each * e).topRows(own).lazyProduct(ofPoints);
      addEnergies(result.error);
    });
    result.energy = std::accumulate(energies.begin(), energies.end(), 0.0);
    return result;
  }

 private:
  struct Fit {
    Place centre;
    double size = 0;
    Stresses coefficients;
    [[nodiscard]] Stress valueAt(const Place& x) const { return coefficients * termsAt((x - centre) / size); }
  };

  /// What a fit has beside the stress.
  struct Patch {
    Place centre;
    double size = 0;
    Modes<Element> inverse;  ///< of its normal matrix
    bool determined = false;
  };
  /// Nearly dependent terms are left out, in the plane all but a constant.
  static constexpr double dependent = dimension == 3 ? 1e-2 : 1e-5;

  static Eigen::Index used(const Matrix& stress) { return std::min<Eigen::Index>(6, stress.rows()); }

  /// 1, the coordinates and, for degree 2, their squares and products.
  static Eigen::Vector<double, nodes> termsAt(const Place& x) {
    Eigen::Vector<double, nodes> terms;
    terms[0] = 1;
    terms.template segment<dimension>(1) = x;
    if constexpr (each > 1) {
      terms.template segment<dimension>(corners) = x.cwiseAbs2();
      for (int k = corners + dimension, i = 0; k < nodes; ++k, ++i) terms[k] = x[i] * x[(i + 1) % dimension];
    }
    return terms;
  }

  /// Columns: the shape functions of the stress of an element at its nodes.
  static Eigen::Matrix<double, each, nodes> pointsToNodes() {
    Eigen::Matrix<double, each, nodes> at = Eigen::Matrix<double, each, nodes>::Ones();
    if constexpr (each > 1) {
      constexpr double far = Element::interior[0][1];
      at.setZero();
      at.template leftCols<corners>().setIdentity();
      for (int k = corners; k < nodes; ++k)
        for (const int end : sidesOfTetrahedron[k - corners]) at(end, k) = 0.5;
      at = ((at.array() - far) / (Element::interior[0][0] - far)).matrix().eval();
    }
    return at;
  }

  [[nodiscard]] const auto& mesh() const {
    if constexpr (dimension == 3)
      return body_.space()->mesh();
    else
      return body_.mesh();
  }
  [[nodiscard]] Place placeOf(int node) const { return body_.placeOfNode(node).head<dimension>(); }

  /// Of an element; what a mode of a ring has of it goes with the radius.
  [[nodiscard]] double measureAt(int element, int mode) const {
    double measure = 0;
    for (int i = 0; i < each; ++i) measure += body_.weights()[each * element + i];
    if constexpr (dimension == 2)
      if (body_.axisymmetric()) {
        const auto at = Element::loadRule()[mode].at;
        double radius = 0;
        double sum = 0;
        for (int k = 0; k < corners; ++k) {
          const double corner = mesh().vertices[mesh().triangles[element][k]].x();
          radius += at[k] * corner;
          sum += corner;
        }
        measure *= corners * radius / sum;
      }
    return measure;
  }

  /// Numbers the nodes once for each region they are in: vertices, then middles.
  void findPlaces() {
    const std::vector<int>& regions = mesh().regions;
    std::vector<int> order(body_.elements());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return regions[a] < regions[b]; });
    placeOf_.resize(nodes * order.size());
    std::vector<int> last(body_.nodes(), -1);  // place of a node in the region it was met in last
    for (const bool middles : {false, true}) {
      for (const int e : order)
        for (int k = middles ? corners : 0; k < (middles ? nodes : corners); ++k) {
          int* own = &placeOf_[static_cast<size_t>(nodes) * e];
          const int node = body_.nodesOf(e)[k];
          if (last[node] < 0 || regionOf_[last[node]] != regions[e]) {
            last[node] = static_cast<int>(nodeOf_.size());
            nodeOf_.push_back(node);
            regionOf_.push_back(regions[e]);
            if (middles)
              ends_.push_back(
                  {own[sidesOfTetrahedron[k - corners][0]], own[sidesOfTetrahedron[k - corners][1]]});
          }
          own[k] = last[node];
        }
    }
  }

  /// By places.
  [[nodiscard]] Eigen::Matrix<double, 6, Eigen::Dynamic> recover(const Matrix& stress,
                                                                 Threads& threads) const {
    const auto middles = static_cast<int>(ends_.size());
    const int vertices = static_cast<int>(nodeOf_.size()) - middles;
    Eigen::Matrix<double, 6, Eigen::Dynamic> result(6, vertices + middles);
    std::vector<Fit> fits(vertices);
    forEachBlock(vertices, threads, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        fits[i] = fitted(i, stress);
        result.col(i) = fits[i].coefficients.col(0);
      }
    });
    forEachBlock(middles, threads, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Place middle = placeOf(nodeOf_[vertices + i]);
        result.col(vertices + i) =
            (fits[ends_[i][0]].valueAt(middle) + fits[ends_[i][1]].valueAt(middle)) / 2;
      }
    });
    return result;
  }

  /// The elements of a region around a vertex and, where they are too few or lie to one side, around those
  /// beside it.
  void findPatches() {
    const auto& all = elementsOf(mesh());
    std::vector<int> start(mesh().vertices.size() + 1, 0);
    for (const auto& element : all)
      for (const int v : element) ++start[v + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<int> around(start.back());
    std::vector<int> next(start.begin(), start.end() - 1);
    for (size_t e = 0; e < all.size(); ++e)
      for (const int v : all[e]) around[next[v]++] = static_cast<int>(e);
    std::vector<int> elements;
    for (size_t i = 0; i < nodeOf_.size() - ends_.size(); ++i) {
      const auto add = [&](int vertex) {
        for (int k = start[vertex]; k < start[vertex + 1]; ++k)
          if (mesh().regions[around[k]] == regionOf_[i]) elements.push_back(around[k]);
      };
      elements.clear();
      add(nodeOf_[i]);
      for (int rings = 1; rings < dimension && !suffice(elements); ++rings) {
        const std::vector<int> inner = elements;
        for (const int e : inner)
          for (const int v : all[e]) add(v);
        std::sort(elements.begin(), elements.end());
        elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
      }
      patches_.insert(patches_.end(), elements.begin(), elements.end());
      patchStart_.push_back(patches_.size());
      of_.push_back(patchAround(static_cast<int>(i)));
    }
  }

  [[nodiscard]] bool suffice(const std::vector<int>& elements) const {
    if constexpr (dimension == 3) {
      return elements.size() >= (each == 1 ? 8 : 6);
    } else {  // all around: they have as many corners besides as there are triangles
      std::vector<int> all;
      for (const int t : elements)
        all.insert(all.end(), mesh().triangles[t].begin(), mesh().triangles[t].end());
      std::sort(all.begin(), all.end());
      return std::unique(all.begin(), all.end()) - all.begin() ==
             static_cast<std::ptrdiff_t>(elements.size()) + 1;
    }
  }

  /// Calls visit(weight, terms, point) for the points that a fit is made to.
  template <class Visit>
  void forEachPoint(int place, const Patch& patch, Visit visit) const {
    for (size_t k = patchStart_[place]; k < patchStart_[place + 1]; ++k)
      for (int i = each * patches_[k]; i < each * (patches_[k] + 1); ++i) {
        const Place x = (samples_.col(i) - patch.centre) / patch.size;
        visit(each == 1 ? 1 : 1 / x.squaredNorm(), termsAt(x), i);
      }
  }

  [[nodiscard]] Patch patchAround(int place) const {
    Patch patch{placeOf(nodeOf_[place]), 1, Modes<Element>::Zero()};
    double square = 0;
    forEachPoint(place, patch, [&](double, const auto& terms, int) {
      square = std::max(square, terms.template segment<dimension>(1).squaredNorm());
    });
    patch.size = std::sqrt(square);
    Modes<Element> normal = Modes<Element>::Zero();
    forEachPoint(place, patch, [&](double weight, const auto& terms, int) {
      normal += weight * terms * terms.transpose();
    });
    const Eigen::LDLT<Modes<Element>> factor(normal);
    patch.determined = factor.vectorD().minCoeff() >= dependent * dependent * factor.vectorD().maxCoeff();
    if (patch.determined) patch.inverse = factor.solve(Modes<Element>::Identity());
    return patch;
  }

  [[nodiscard]] Fit fitted(int place, const Matrix& stress) const {
    const Patch& patch = of_[place];
    Fit fit{patch.centre, patch.size, Stresses::Zero()};
    const Eigen::Index own = used(stress);
    const auto count = each * static_cast<Eigen::Index>(patchStart_[place + 1] - patchStart_[place]);
    Stress mean = Stress::Zero();
    for (size_t k = patchStart_[place]; k < patchStart_[place + 1]; ++k)
      for (int i = 0; i < each; ++i) mean.head(own) += stress.col(each * patches_[k] + i).head(own);
    mean /= static_cast<double>(count);
    // Of the difference from a mean: where terms are left out a stress that is the same everywhere stays so.
    Stress off = Stress::Zero();
    if (patch.determined) {
      Stresses right = Stresses::Zero();
      forEachPoint(place, patch, [&](double weight, const auto& terms, int i) {
        off.head(own) = stress.col(i).head(own) - mean.head(own);
        right += off * (weight * terms).transpose();
      });
      fit.coefficients = right * patch.inverse;
    } else if constexpr (dimension == 3) {
      Matrix design(count, nodes);
      Matrix values(count, 6);
      Eigen::Index row = 0;
      forEachPoint(place, patch, [&](double weight, const auto& terms, int i) {
        off.head(own) = stress.col(i).head(own) - mean.head(own);
        design.row(row) = std::sqrt(weight) * terms;
        values.row(row++) = std::sqrt(weight) * off;
      });
      Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
      solver.setThreshold(dependent);
      solver.compute(design);
      fit.coefficients = solver.solve(values).transpose();
    }
    fit.coefficients.col(0) += mean;
    return fit;
  }

  const Body& body_;
  Matrix samples_;                        ///< places of the points
  std::vector<int> placeOf_;              ///< of each node of each element
  std::vector<int> nodeOf_, regionOf_;    ///< of each place
  std::vector<std::array<int, 2>> ends_;  ///< of the last places, which are of middles
  std::vector<size_t> patchStart_{0};     ///< by the other places
  std::vector<int> patches_;
  std::vector<Patch> of_;
};

}  // namespace

double ErrorEstimate::relative() const {
  return energy > 0 ? std::sqrt(error.sum() / energy) : 0;
}

ErrorEstimator::ErrorEstimator(const Body& body) {
  const auto make = [&](auto element) { recovery_ = std::make_shared<Fitted<decltype(element)>>(body); };
  if (body.dimension() == 3)
    withSpaceElement(body.degree(), make);
  else
    withElement(body.degree(), make);
}

ErrorEstimate ErrorEstimator::operator()(const Matrix& stress, Threads& threads) const {
  return recovery_->estimate(stress, threads);
}

Matrix ErrorEstimator::recovered(const Matrix& stress, Threads& threads) const {
  return recovery_->recovered(stress, threads);
}

}  // namespace mortier
