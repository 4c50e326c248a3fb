// The error estimate on tetrahedra. The stress at a vertex is that of a polynomial of the degree of the
// displacements, fitted to the points of the tetrahedra around it that are of one region; with too few of
// them those around its neighbours count too. Points next to a vertex weigh more where the fit is quadratic.
#include <algorithm>
#include <numeric>

#include "base/dense_templates.h"
#include "base/parallel.h"
#include "fem/error_estimate.h"
#include "fem/tetrahedron.h"

namespace mortier {
namespace {

/// 1, x, y, z and, for degree 2, their products.
template <int monomials>
Eigen::Vector<double, monomials> monomialsAt(const SpacePoint& x) {
  Eigen::Vector<double, monomials> values;
  values.template head<4>() << 1, x.x(), x.y(), x.z();
  if constexpr (monomials > 4)
    values.template tail<6>() << x.x() * x.x(), x.y() * x.y(), x.z() * x.z(), x.x() * x.y(), x.y() * x.z(),
        x.z() * x.x();
  return values;
}

template <class Element>
class SpaceRecovery {
 public:
  static constexpr int monomials = Element::nodes;
  using Stresses = Eigen::Matrix<double, 6, Element::nodes>;

  SpaceRecovery(const Body& body, const Matrix& stress, Threads& threads)
      : space_(*body.space()), stress_(stress) {
    findPlaces();
    findElementsAround();
    forEachBlock(static_cast<int>(fits_.size()), threads, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) fits_[i] = made(nodeOf_[i], regionOf_[i]);
    });
    findMiddles(threads);
  }

  /// At the nodes of an element.
  [[nodiscard]] Stresses at(int element) const {
    Stresses result;
    const int* own = &placeOf_[static_cast<size_t>(Element::nodes) * element];
    for (int k = 0; k < Element::nodes; ++k) {
      if (k < 4)
        result.col(k) = fits_[own[k]].coefficients.col(0);
      else
        result.col(k) = middles_.col(own[k] - static_cast<int>(fits_.size()));
    }
    return result;
  }

 private:
  struct Fit {
    SpacePoint centre;
    double size = 0;
    Eigen::Matrix<double, 6, monomials> coefficients;
    [[nodiscard]] Eigen::Vector<double, 6> valueAt(const SpacePoint& x) const {
      return coefficients * monomialsAt<monomials>((x - centre) / size);
    }
  };

  /// Numbers the nodes once for each region they are in: vertices, then middles.
  void findPlaces() {
    const SpaceNodes& nodes = space_.nodes();
    const std::vector<int>& regions = space_.mesh().regions;
    std::vector<int> order(space_.mesh().tetrahedra.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return regions[a] < regions[b]; });
    placeOf_.resize(static_cast<size_t>(Element::nodes) * order.size());
    std::vector<int> last(nodes.count(), -1);  // place of a node in the region it was met in last
    for (const bool middles : {false, true}) {
      for (const int e : order)
        for (int k = middles ? 4 : 0; k < (middles ? Element::nodes : 4); ++k) {
          const int node = nodes.of(e)[k];
          if (last[node] < 0 || regionOf_[last[node]] != regions[e]) {
            last[node] = static_cast<int>(nodeOf_.size());
            nodeOf_.push_back(node);
            regionOf_.push_back(regions[e]);
          }
          placeOf_[static_cast<size_t>(Element::nodes) * e + k] = last[node];
        }
      if (!middles) fits_.resize(nodeOf_.size());
    }
  }

  void findElementsAround() {
    const TetrahedronMesh& mesh = space_.mesh();
    aroundStart_.assign(mesh.vertices.size() + 1, 0);
    for (const auto& tetrahedron : mesh.tetrahedra)
      for (const int v : tetrahedron) ++aroundStart_[v + 1];
    std::partial_sum(aroundStart_.begin(), aroundStart_.end(), aroundStart_.begin());
    around_.resize(aroundStart_.back());
    std::vector<int> next(aroundStart_.begin(), aroundStart_.end() - 1);
    for (size_t e = 0; e < mesh.tetrahedra.size(); ++e)
      for (const int v : mesh.tetrahedra[e]) around_[next[v]++] = static_cast<int>(e);
  }

  /// The mean of what both ends say.
  void findMiddles(Threads& threads) {
    const auto vertices = static_cast<int>(fits_.size());
    const auto all = static_cast<int>(nodeOf_.size());
    std::vector<std::array<int, 2>> ends(all - vertices);
    for (size_t e = 0; 4 < Element::nodes && e < space_.mesh().tetrahedra.size(); ++e)
      for (int k = 4; k < Element::nodes; ++k) {
        const int* own = &placeOf_[Element::nodes * e];
        ends[own[k] - vertices] = {own[sidesOfTetrahedron[k - 4][0]], own[sidesOfTetrahedron[k - 4][1]]};
      }
    middles_.resize(6, all - vertices);
    forEachBlock(all - vertices, threads, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const SpacePoint& middle = space_.nodes().places[nodeOf_[vertices + i]];
        middles_.col(i) = (fits_[ends[i][0]].valueAt(middle) + fits_[ends[i][1]].valueAt(middle)) / 2;
      }
    });
  }

  [[nodiscard]] std::vector<int> patch(int vertex, int region) const {
    const TetrahedronMesh& mesh = space_.mesh();
    std::vector<int> elements;
    const auto add = [&](int of) {
      for (int i = aroundStart_[of]; i < aroundStart_[of + 1]; ++i)
        if (mesh.regions[around_[i]] == region) elements.push_back(around_[i]);
    };
    add(vertex);
    constexpr size_t enough = Element::nodes == 4 ? 8 : 6;
    for (int rings = 0; rings < 2 && elements.size() < enough; ++rings) {
      const std::vector<int> inner = elements;
      for (const int e : inner)
        for (const int v : mesh.tetrahedra[e]) add(v);
      std::sort(elements.begin(), elements.end());
      elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    }
    return elements;
  }

  [[nodiscard]] Fit made(int vertex, int region) const {
    constexpr int each = Element::points;
    const std::vector<int> elements = patch(vertex, region);
    Fit fit{space_.mesh().vertices[vertex], 0, {}};
    std::vector<SpacePoint> offsets;
    for (const int e : elements)
      for (int i = 0; i < each; ++i) offsets.push_back(space_.placeOf(each * e + i) - fit.centre);
    for (const SpacePoint& offset : offsets) fit.size = std::max(fit.size, offset.norm());
    const auto rows = static_cast<Eigen::Index>(offsets.size());
    Matrix design(rows, monomials);
    Matrix values(rows, 6);
    // Of the difference from a mean: where terms are left out a stress that is the same everywhere stays so.
    Eigen::Vector<double, 6> mean = Eigen::Vector<double, 6>::Zero();
    for (const int e : elements)
      mean += stress_.template block<6, each>(0, each * e).rowwise().sum() / static_cast<double>(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const SpacePoint x = offsets[i] / fit.size;
      const double weight = each == 1 ? 1 : 1 / x.norm();
      design.row(i) = weight * monomialsAt<monomials>(x);
      values.row(i) = weight * (stress_.col(each * elements[i / each] + i % each).template head<6>() - mean);
    }
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
    constexpr double dependent = 1e-2;  // nearly dependent terms are left out, a constant is kept
    solver.setThreshold(dependent);
    solver.compute(design);
    fit.coefficients = solver.solve(values).transpose();
    fit.coefficients.col(0) += mean;
    return fit;
  }

  const SpaceElements& space_;
  const Matrix& stress_;
  std::vector<int> aroundStart_, around_;  ///< elements around each vertex
  std::vector<int> placeOf_;               ///< of each node of each element
  std::vector<int> nodeOf_, regionOf_;     ///< of each place
  std::vector<Fit> fits_;                  ///< of the first places, which are of vertices
  Matrix middles_;                         ///< of the others
};

/// Integral of N_a N_b over the volume of an element, N its shape functions, as L L'.
template <class Element>
Eigen::Matrix<double, Element::nodes, Element::nodes> factorOfMass() {
  Matrix mass = Matrix::Zero(Element::nodes, Element::nodes);
  for (const auto& [at, weight] : tetrahedronRule()) {
    const auto N = Element::shapes({1 - at.sum(), at.x(), at.y(), at.z()});
    const Eigen::Map<const Eigen::Vector<double, Element::nodes>> shapes(N.data());
    mass += 6 * weight * shapes * shapes.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(mass);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().asDiagonal();
}

/// Columns: the shape functions of the stress of an element at its nodes.
template <class Element>
Eigen::Matrix<double, Element::points, Element::nodes> stressAtNodes() {
  Eigen::Matrix<double, Element::points, Element::nodes> result;
  result.setOnes();
  if constexpr (Element::points == 4) {
    constexpr double far = QuadraticTetrahedron::far;
    Eigen::Matrix<double, 4, Element::nodes> at;
    at.setZero();
    at.template leftCols<4>().setIdentity();
    for (int k = 4; k < Element::nodes; ++k)
      for (const int end : sidesOfTetrahedron[k - 4]) at(end, k) = 0.5;
    result = ((at.array() - far) / (QuadraticTetrahedron::near - far)).matrix();
  }
  return result;
}

/// The energy of a field that is f_a at the nodes is the volume times the sum of those of its modes
/// sum_a f_a L_am, with the mass L L'. Laws take stress points alone: modes take their place, some at a time.
template <class Element>
ErrorEstimate estimateOn(const Body& body, const Matrix& stress, Threads& threads) {
  constexpr int each = Element::points;
  constexpr int nodes = Element::nodes;
  const SpaceRecovery<Element> recovery(body, stress, threads);
  const auto L = factorOfMass<Element>();
  const auto E = stressAtNodes<Element>().lazyProduct(L).eval();
  const auto elements = static_cast<int>(body.elements());
  ErrorEstimate result{Vector::Zero(elements), 0};
  Vector energies = Vector::Zero(elements);
  Matrix field = Matrix::Zero(stress.rows(), body.points());  // what a law remembers is no error
  Matrix strain(stress.rows(), body.points());
  forEachBlock(elements, threads, [&](int begin, int end) {
    std::vector<typename SpaceRecovery<Element>::Stresses> modes(end - begin);
    for (int e = begin; e < end; ++e) modes[e - begin] = recovery.at(e).lazyProduct(L);
    const auto addEnergies = [&](Vector& sums) {
      for (int first = 0; first < nodes; first += each) {
        const int count = std::min(each, nodes - first);
        for (int e = begin; e < end; ++e)
          for (int m = 0; m < count; ++m)
            field.col(each * e + m).template head<6>() = modes[e - begin].col(first + m);
        body.material().elasticStrain(field, strain, each * begin, each * end);
        for (int e = begin; e < end; ++e)
          for (int m = 0; m < count; ++m)
            sums[e] +=
                each * body.weights()[each * e] * field.col(each * e + m).dot(strain.col(each * e + m));
      }
    };
    addEnergies(energies);
    for (int e = begin; e < end; ++e)
      modes[e - begin] -= stress.template block<6, each>(0, each * e).lazyProduct(E);
    addEnergies(result.error);
  });
  result.energy = std::accumulate(energies.begin(), energies.end(), 0.0);
  return result;
}

}  // namespace

ErrorEstimate estimateInSpace(const Body& body, const Matrix& stress, Threads& threads) {
  return withSpaceElement(body.degree(),
                          [&](auto element) { return estimateOn<decltype(element)>(body, stress, threads); });
}

Matrix recoveredInSpace(const Body& body, const Matrix& stress, Threads& threads) {
  return withSpaceElement(body.degree(), [&](auto element) {
    constexpr int nodes = decltype(element)::nodes;
    const SpaceRecovery<decltype(element)> recovery(body, stress, threads);
    const auto elements = static_cast<int>(body.elements());
    Matrix recovered(6, Eigen::Index{nodes} * elements);
    for (int e = 0; e < elements; ++e) recovered.middleCols<nodes>(Eigen::Index{nodes} * e) = recovery.at(e);
    return recovered;
  });
}

}  // namespace mortier
