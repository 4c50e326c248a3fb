// The error estimate on tetrahedra. The stress at a vertex is that of a polynomial of the degree of the
// displacements, fitted to the points of the tetrahedra around it that are of one region; with too few of
// them those around its neighbours count too. Points next to a vertex weigh more where the fit is quadratic.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/dense_templates.h"
#include "fem/error_estimate.h"
#include "fem/tetrahedron.h"

namespace mortier {
namespace {

/// 1, x, y, z and, for degree 2, their products.
Vector monomials(const SpacePoint& x, int degree) {
  Vector values(degree == 1 ? 4 : 10);
  values.head<4>() << 1, x.x(), x.y(), x.z();
  if (degree > 1)
    values.tail<6>() << x.x() * x.x(), x.y() * x.y(), x.z() * x.z(), x.x() * x.y(), x.y() * x.z(),
        x.z() * x.x();
  return values;
}

class Recovery {
 public:
  Recovery(const Body& body, const Matrix& stress)
      : space_(*body.space()), stress_(stress), around_(space_.mesh().vertices.size()) {
    const TetrahedronMesh& mesh = space_.mesh();
    for (size_t e = 0; e < mesh.tetrahedra.size(); ++e)
      for (const int v : mesh.tetrahedra[e]) around_[v].push_back(static_cast<int>(e));
  }

  /// Of an element: 6 x its nodes.
  Matrix at(int element) {
    const SpaceNodes& nodes = space_.nodes();
    const int* own = nodes.of(element);
    const int region = space_.mesh().regions[element];
    Matrix values(6, nodes.perElement());
    for (int k = 0; k < 4; ++k) values.col(k) = fit(own[k], region).valueAt(nodes.places[own[k]]);
    for (int k = 4; k < nodes.perElement(); ++k) {
      const auto& [a, b] = sidesOfTetrahedron[k - 4];
      const SpacePoint& middle = nodes.places[own[k]];
      values.col(k) = (fit(own[a], region).valueAt(middle) + fit(own[b], region).valueAt(middle)) / 2;
    }
    return values;
  }

 private:
  struct Fit {
    SpacePoint centre;
    double size = 1;
    Matrix coefficients;  ///< 6 x monomials
    int degree = 1;
    [[nodiscard]] Vector valueAt(const SpacePoint& x) const {
      return coefficients * monomials((x - centre) / size, degree);
    }
  };

  const Fit& fit(int vertex, int region) {
    const auto [found, isNew] = fits_.try_emplace({vertex, region});
    if (isNew) found->second = made(vertex, region);
    return found->second;
  }

  [[nodiscard]] std::vector<int> patch(int vertex, int region) const {
    const TetrahedronMesh& mesh = space_.mesh();
    std::vector<int> elements;
    const auto add = [&](int of) {
      for (const int e : around_[of])
        if (mesh.regions[e] == region) elements.push_back(e);
    };
    add(vertex);
    const size_t enough = space_.nodes().degree == 1 ? 8 : 6;
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
    const int degree = space_.nodes().degree;
    const int each = space_.pointsOfElement();
    const std::vector<int> elements = patch(vertex, region);
    Fit fit{space_.mesh().vertices[vertex], 0, {}, degree};
    std::vector<int> points;
    for (const int e : elements)
      for (int i = 0; i < each; ++i) points.push_back(each * e + i);
    for (const int p : points) fit.size = std::max(fit.size, (space_.placeOf(p) - fit.centre).norm());
    const auto rows = static_cast<Eigen::Index>(points.size());
    Matrix design(rows, degree == 1 ? 4 : 10);
    Matrix values(rows, 6);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const SpacePoint x = (space_.placeOf(points[i]) - fit.centre) / fit.size;
      const double weight = degree == 1 ? 1 : 1 / x.norm();
      design.row(i) = weight * monomials(x, degree);
      values.row(i) = weight * stress_.col(points[i]).head<6>();
    }
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
    constexpr double dependent = 1e-2;  // what few points hardly tell is left out, a constant is kept
    solver.setThreshold(dependent);
    solver.compute(design);
    fit.coefficients.resize(6, design.cols());
    for (int c = 0; c < 6; ++c) fit.coefficients.row(c) = solver.solve(Vector(values.col(c)));
    return fit;
  }

  const SpaceElements& space_;
  const Matrix& stress_;
  std::vector<std::vector<int>> around_;
  std::map<std::pair<int, int>, Fit> fits_;  ///< by vertex and region
};

/// Barycentric coordinates and parts of the volume; exact for the square of the error.
std::vector<std::pair<SpaceBarycentric, double>> estimateRule(int degree) {
  std::vector<std::pair<SpaceBarycentric, double>> rule;
  if (degree == 1)
    for (const SpaceBarycentric& b : QuadraticTetrahedron::interior) rule.emplace_back(b, 0.25);
  else
    for (const auto& [at, weight] : tetrahedronRule())
      rule.emplace_back(SpaceBarycentric{1 - at.sum(), at.x(), at.y(), at.z()}, 6 * weight);
  return rule;
}

}  // namespace

ErrorEstimate estimateInSpace(const Body& body, const Matrix& stress) {
  const int degree = body.degree();
  const Eigen::Index each = body.space()->pointsOfElement();
  const auto elements = static_cast<Eigen::Index>(body.elements());
  Recovery recovery(body, stress);
  std::vector<Matrix> recovered;
  for (Eigen::Index e = 0; e < elements; ++e) recovered.push_back(recovery.at(static_cast<int>(e)));
  ErrorEstimate result{Vector::Zero(elements), 0};
  const auto rule = estimateRule(degree);
  Matrix off = Matrix::Zero(stress.rows(), body.points());  // what a law remembers is no error
  Matrix all = off;
  Matrix strain;
  // A point of the rule in each element at a time, at the place of a stress point: laws know these alone.
  for (const auto& [at, weight] : rule) {
    withSpaceElement(degree, [&, at = at](auto element) {
      const auto N = decltype(element)::shapes(at);
      const Eigen::Map<const Vector> shapes(N.data(), static_cast<Eigen::Index>(N.size()));
      for (Eigen::Index e = 0; e < elements; ++e) {
        all.col(each * e).head<6>() = recovered[e] * shapes;
        off.col(each * e) = all.col(each * e);
        constexpr double far = QuadraticTetrahedron::far;
        for (Eigen::Index q = 0; q < each; ++q)
          off.col(each * e).head<6>() -=
              (each == 1 ? 1 : (at[q] - far) / (QuadraticTetrahedron::near - far)) *
              stress.col(each * e + q).head<6>();
      }
    });
    const auto energyOf = [&, weight = weight](const Matrix& field, Eigen::Index e) {
      return weight * static_cast<double>(each) * body.weights()[each * e] *
             field.col(each * e).dot(strain.col(each * e));
    };
    body.material().elasticStrain(off, strain);
    for (Eigen::Index e = 0; e < elements; ++e) result.error[e] += energyOf(off, e);
    body.material().elasticStrain(all, strain);
    for (Eigen::Index e = 0; e < elements; ++e) result.energy += energyOf(all, e);
  }
  return result;
}

}  // namespace mortier
