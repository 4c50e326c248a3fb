#include "fem/space_elements.h"

#include <algorithm>
#include <numbers>

#include "base/quadrature_rules.h"
#include "base/two_part_vector.h"
#include "fem/tetrahedron.h"

namespace mortier {
namespace {

constexpr double root2 = std::numbers::sqrt2;

SpacePoint placeOfPoint(const TetrahedronMesh& mesh, int degree, int point) {
  SpacePoint place = SpacePoint::Zero();
  for (int k = 0; k < 4; ++k)
    place += (degree == 1 ? 0.25 : QuadraticTetrahedron::interior[point % 4][k]) *
             mesh.vertices[mesh.tetrahedra[degree == 1 ? point : point / 4][k]];
  return place;
}

}  // namespace

std::vector<SpaceRulePoint> triangleRule() {
  std::vector<SpaceRulePoint> rule;
  for (const auto& [x, ofX] : gaussFour)
    for (const auto& [y, ofY] : gaussFour) rule.push_back({{x, y * (1 - x), 0}, ofX * ofY * (1 - x)});
  return rule;
}

std::vector<SpaceRulePoint> tetrahedronRule() {
  std::vector<SpaceRulePoint> rule;
  for (const auto& [z, ofZ] : gaussFour)
    for (const SpaceRulePoint& each : triangleRule())
      rule.push_back(
          {{each.at.x() * (1 - z), each.at.y() * (1 - z), z}, ofZ * each.weight * (1 - z) * (1 - z)});
  return rule;
}

SpaceElements::SpaceElements(TetrahedronMesh mesh, int degree, bool averaged)
    : mesh_(std::move(mesh)), nodes_(spaceNodes(mesh_, degree)) {
  withSpaceElement(degree, [&](auto element) {
    using Element = decltype(element);
    for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      std::array<SpacePoint, 4> x;
      for (int k = 0; k < 4; ++k) x[k] = mesh_.vertices[mesh_.tetrahedra[t][k]];
      const TetrahedronGeometry geometry(x);
      for (const SpaceBarycentric& at : Element::interior) {
        weights_.push_back(geometry.volume / Element::points);
        const Eigen::Matrix<double, 3, Element::nodes> gradients =
            geometry.gradients * Element::derivatives(at);
        largestGradient_ = std::max(largestGradient_, gradients.template lpNorm<Eigen::Infinity>());
        for (int a = 1; a < Element::nodes; ++a)
          for (int c = 0; c < 3; ++c) gradients_.push_back(gradients(c, a) / root2);
      }
    }
  });
  if (averaged) patches_.emplace(volumePatches(mesh_), nodes_, weights_, gradients_);
}

SpacePoint SpaceElements::placeOf(int point) const {
  return placeOfPoint(mesh_, nodes_.degree, point);
}

std::vector<SpacePoint> placesOfPoints(const TetrahedronMesh& mesh, int degree) {
  const auto points = static_cast<int>(mesh.tetrahedra.size()) * (degree == 1 ? 1 : 4);
  std::vector<SpacePoint> places;
  for (int point = 0; point < points; ++point) places.push_back(placeOfPoint(mesh, degree, point));
  return places;
}

// In twice the working precision, of differences to the first node of each tetrahedron.
void SpaceElements::strain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin,
                           int end) const {
  withSpaceElement(nodes_.degree, [&](auto element) {
    using Element = decltype(element);
    constexpr int others = 3 * (Element::nodes - 1);
    for (int i = begin; i < end; ++i) {
      const int* nodes = nodes_.of(i / Element::points);
      const double* G = &gradients_[static_cast<size_t>(others) * i];
      std::array<DoubleDouble, 9> gradient{};  // of the displacement: component, then direction
      for (int a = 1; a < Element::nodes; ++a, G += 3)
        for (int c = 0; c < 3; ++c) {
          const int dof = 3 * nodes[a] + c;
          const int dof0 = 3 * nodes[0] + c;
          DoubleDouble d = DoubleDouble::sum(u.high[dof], -u.high[dof0]);
          d.low += u.low[dof] - u.low[dof0];
          for (int k = 0; k < 3; ++k) {
            gradient[3 * c + k] += DoubleDouble::product(G[k], d);
          }
        }
      const auto plus = [](DoubleDouble a, const DoubleDouble& b, double times = 1) {
        a += {times * b.high, times * b.low};  // times 1, -1 or -2
        return a;
      };
      const auto store = [&](int row, const DoubleDouble& value, double factor = 1) {
        DoubleDouble product = DoubleDouble::product(factor, value);
        if (shift != nullptr) product += DoubleDouble{-(*shift)(row, i), 0};
        strain(row, i) = product.value();
      };
      const auto& [xx, xy, xz, yx, yy, yz, zx, zy, zz] = gradient;
      store(0, plus(plus(xx, yy), zz, -2), std::numbers::inv_sqrt3);
      store(1, plus(xx, yy, -1));
      store(2, plus(xy, yx));
      store(3, plus(xz, zx));
      store(4, plus(yz, zy));
      store(5, plus(plus(xx, yy), zz), root2 * std::numbers::inv_sqrt3);
      if (strain.rows() > 6) strain(6, i) = shift != nullptr ? -(*shift)(6, i) : 0;
    }
  });
  if (patches_) averageStrain(u, shift, strain, begin, end);
}

void SpaceElements::averageStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin,
                                  int end) const {
  PatchProducts products(patches(), u);
  for (int i = begin; i < end; ++i) {
    DoubleDouble p = DoubleDouble::product(*patches_->basis(i), products(patches_->patchOf()[i])[0]);
    if (shift != nullptr) p += DoubleDouble{-(*shift)(5, i), 0};
    strain(5, i) = p.value();
  }
}

void SpaceElements::addStressOf(const Vector& d, const Linearisation& law, Matrix& stress, int begin,
                                int end) const {
  PatchProducts products(patches(), d);
  withSpaceElement(nodes_.degree, [&](auto element) {
    using Element = decltype(element);
    constexpr int others = 3 * (Element::nodes - 1);
    for (int i = begin; i < end; ++i) {
      const int* nodes = nodes_.of(i / Element::points);
      const double* G = &gradients_[static_cast<size_t>(others) * i];
      const SpacePoint d0 = d.segment<3>(3 * static_cast<Eigen::Index>(nodes[0]));
      Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
      for (int a = 1; a < Element::nodes; ++a, G += 3)
        H += (d.segment<3>(3 * static_cast<Eigen::Index>(nodes[a])) - d0) *
             Eigen::RowVector3d(G[0], G[1], G[2]);
      Eigen::Vector<double, 6> strain = strainOfGradient(H);
      if (patches_) strain[5] = *patches_->basis(i) * products(patches_->patchOf()[i])[0];
      stress.col(i).head<6>() += spaceModuliAt(law.moduli, i) * strain;
      if (stress.rows() > 6) stress(6, i) += law.beyond.col(i).head<6>().dot(strain);
    }
  });
}

}  // namespace mortier
