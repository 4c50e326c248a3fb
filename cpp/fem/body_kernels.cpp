// What a body does in every iteration, triangle by triangle.

#include "base/lanes.h"
#include "base/two_part_vector.h"
#include "fem/body.h"
#include "fem/element_data.h"
#include "fem/tangent_assembly.h"

namespace mortier {
// With G = gradient / sqrt2, a nodal displacement (ux, uy) strains p, q, r by
//   B = [Gx Gy; Gx -Gy; Gy Gx],
// and, where the body turns about the axis, the circumference by [N/r 0], N the shape function at the point.
// The gradients of one triangle sum to zero: differences to its first node keep rigid motions exact.
//
// Where the volumetric strain is averaged, p is the sum of the polynomials of the patch less the
// circumference over sqrt2 (fem/volume_patches.h).

template <class Work>
auto Body::withElements(const Work& work) const {
  if (!space_) return work(ElementData<2>{nodes_, weights_, gradients_, hoops_, patches()});
  return work(ElementData<3>{space_->nodes(), weights_, gradients_, hoops_, patches()});
}

Vector Body::internalForce(const Matrix& stress) const {
  Vector f = Vector::Zero(dofs());
  const int terms = patches() != nullptr ? patches()->terms() : 0;
  std::vector<double> ofPatches(patches() != nullptr ? static_cast<size_t>(terms) * patches()->count() : 0);
  withElements([&]<int dim>(const ElementData<dim>& elements) {
    withPointsOf(elements, [&](auto point) {
      using At = typename decltype(point)::type;
      using Element = typename At::Element;
      for (int i = 0; i < points(); ++i) {
        const int* nodes = elements.nodes.of(static_cast<size_t>(i) / Element::points);
        const At at(elements, i);
        const auto force = at.force(stress, i);
        for (int a = 0; a < Element::nodes; ++a)
          f.segment<dim>(static_cast<Eigen::Index>(dim) * nodes[a]) += at.rows(force, a);
        if (elements.patches == nullptr) continue;
        const double* basis = elements.patches->basis(i);
        const int patch = elements.patches->patchOf()[i / Element::points];
        for (int k = 0; k < terms; ++k)
          ofPatches[static_cast<size_t>(terms) * patch + k] += at.volumeForce(stress, i) * basis[k];
      }
    });
  });
  if (patches() != nullptr) patches()->addForces(ofPatches, f);
  return f;
}

double Body::largestForce(const Matrix& stress) const {
  return withElements([&]<int dim>(const ElementData<dim>& elements) {
    return withElementIn<dim>(elements.nodes.degree, [&](auto element) {
      using Element = decltype(element);
      double largest = 0;
      for (size_t i = 0; i < weights_.size(); ++i) {
        const auto column = stress.col(static_cast<Eigen::Index>(i));
        double steepest = 0;
        for (const double gradient : elements.template gradientsOf<Element>(i))
          steepest = std::max(steepest, std::abs(gradient));
        const double most = column.template head<3 * dim - 3>().cwiseAbs().maxCoeff();
        largest = std::max(largest, weights_[i] * steepest * most);
        for (size_t a = Element::nodes * i; axisymmetric_ && a < Element::nodes * (i + 1); ++a)
          largest = std::max(largest, weights_[i] * std::abs(hoops_[a] * column[3]));
      }
      return largest;
    });
  });
}

const SparsePattern& Body::pattern() const {
  if (!assembly_)
    withElements([&](const auto& elements) {
      assembly_ = std::make_shared<const TangentAssembly>(elements, supports_, material_->symmetricTangent());
    });
  return assembly_->pattern();
}

void Body::tangent(const Matrix& moduli, std::vector<double>& values, Threads& threads) const {
  static_cast<void>(pattern());
  withElements(
      [&](const auto& elements) { assembly_->assemble(elements, supports_, {moduli}, values, threads); });
}

void Body::tangent(const Linearisation& law, std::vector<double>& values, Threads& threads) const {
  static_cast<void>(pattern());
  withElements([&](const auto& elements) {
    assembly_->assemble(elements, supports_, {law.moduli, &law.beyond}, values, threads);
  });
}

void Body::strain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const {
  if (space_) {
    strainInSpace(u, shift, strain, begin, end);
    if (patches_) averageStrain(u, shift, strain, begin, end);
    return;
  }
  if (strain.rows() > 3 && shift == nullptr)
    strain.bottomRows(strain.rows() - 3).middleCols(begin, end - begin).setZero();
  if (strain.rows() > 3 && shift != nullptr)
    strain.bottomRows(strain.rows() - 3).middleCols(begin, end - begin) =
        -shift->bottomRows(strain.rows() - 3).middleCols(begin, end - begin);
  withElement(degree(), [&](auto element) { strainOf<decltype(element)>(u, shift, strain, begin, end); });
  if (axisymmetric_) hoopStrain(u, shift, strain, begin, end);
  if (patches_) averageStrain(u, shift, strain, begin, end);
}

void Body::averageStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin,
                         int end) const {
  const int n = nodes_.perElement();
  const int ofElement = pointsOfTriangle();
  const int terms = patches_->terms();
  const int row = space_ ? 5 : 0;
  PatchProducts products(patches(), u);
  for (int i = begin; i < end; ++i) {
    const std::array<DoubleDouble, 3>& sums = products(patches_->patchOf()[i / ofElement]);
    const double* basis = patches_->basis(i);
    DoubleDouble p = DoubleDouble::product(basis[0], sums[0]);
    for (int k = 1; k < terms; ++k) p += DoubleDouble::product(basis[k], sums[k]);
    const int* triangle = axisymmetric_ ? nodes_.of(i / ofElement) : nullptr;
    for (int a = 0; a < n && axisymmetric_; ++a)
      p += DoubleDouble::product(-overRoot2 * hoops_[static_cast<size_t>(n) * i + a],
                                 {u.high[2 * triangle[a]], u.low[2 * triangle[a]]});
    if (shift != nullptr) p += DoubleDouble{-(*shift)(row, i), 0};
    strain(row, i) = p.value();
  }
}

void Body::hoopStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const {
  const int n = nodes_.perElement();
  const int ofTriangle = pointsOfTriangle();
  for (int i = begin; i < end; ++i) {
    const int* triangle = nodes_.of(i / ofTriangle);
    DoubleDouble sum{0, 0};
    for (int a = 0; a < n; ++a) {
      const double overRadius = hoops_[static_cast<size_t>(n) * i + a];
      sum += DoubleDouble::product(overRadius, {u.high[2 * triangle[a]], u.low[2 * triangle[a]]});
    }
    if (shift != nullptr) sum += DoubleDouble{-(*shift)(3, i), 0};
    strain(3, i) = sum.value();
  }
}

template <class Element>
void Body::strainOf(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const {
  constexpr int others = 2 * (Element::nodes - 1);  // dofs of the nodes but the first
  const double* high = u.high.data();
  const double* low = u.low.data();
  for (int first = begin; first < end; first += laneCount) {
    // The other nodes, x and y, and the first, by lanes.
    double u1[others][laneCount];
    double u0[others][laneCount];
    double smallChange[others][laneCount];
    double G[others][laneCount];
    double taken[3][laneCount] =
        {};  // the shift; no branch in the loop over lanes, or it is not made of vectors
    const int count = std::min(laneCount, end - first);
    for (int lane = 0; lane < laneCount; ++lane) {
      const int i = first + std::min(lane, count - 1);
      const int* triangle = &nodes_.elements[static_cast<size_t>(Element::nodes) * (i / Element::points)];
      for (int k = 0; k < others; ++k) {
        const int dof = 2 * triangle[1 + k / 2] + k % 2;
        const int dof0 = 2 * triangle[0] + k % 2;
        u1[k][lane] = high[dof];
        u0[k][lane] = high[dof0];
        smallChange[k][lane] = low[dof] - low[dof0];
        G[k][lane] = gradients_[static_cast<size_t>(others) * i + k];
      }
      for (int c = 0; c < 3 && shift != nullptr; ++c) taken[c][lane] = (*shift)(c, i);
    }
    double result[3][laneCount];
    for (int lane = 0; lane < laneCount; ++lane) {
      DoubleDouble d[others];
      for (int k = 0; k < others; ++k) {
        d[k] = DoubleDouble::sum(u1[k][lane], -u0[k][lane]);
        d[k].low += smallChange[k][lane];
      }
      const auto times = [&](int g, int k) { return DoubleDouble::product(G[g][lane], d[k]); };
      DoubleDouble xx = times(0, 0);
      DoubleDouble yy = times(1, 1);
      DoubleDouble xy = times(1, 0);
      for (int k = 2; k < others; k += 2) {
        xx += times(k, k);
        yy += times(k + 1, k + 1);
      }
      xy += times(0, 1);
      for (int k = 2; k < others; k += 2) {
        xy += times(k + 1, k);
        xy += times(k, k + 1);
      }
      DoubleDouble p = xx;
      DoubleDouble q = xx;
      p += yy;
      q += DoubleDouble{-yy.high, -yy.low};
      p += DoubleDouble{-taken[0][lane], 0};
      q += DoubleDouble{-taken[1][lane], 0};
      xy += DoubleDouble{-taken[2][lane], 0};
      result[0][lane] = p.value();
      result[1][lane] = q.value();
      result[2][lane] = xy.value();
    }
    for (int lane = 0; lane < count; ++lane)
      for (int c = 0; c < 3; ++c) strain(c, first + lane) = result[c][lane];
  }
}

void Body::addStressOf(const Vector& d, const Linearisation& law, Matrix& stress, int begin, int end) const {
  if (space_) return addStressInSpace(d, law, stress, begin, end);
  PatchProducts products(patches(), d);
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    constexpr int others = 2 * (Element::nodes - 1);
    const auto strainOf = [&](int i) {
      const int* triangle = &nodes_.elements[static_cast<size_t>(Element::nodes) * (i / Element::points)];
      const double* G = &gradients_[static_cast<size_t>(others) * i];
      double xx = 0;
      double yy = 0;
      double xy = 0;
      const double x0 = d[2 * triangle[0]];
      const double y0 = d[2 * triangle[0] + 1];
      for (int a = 1; a < Element::nodes; ++a) {
        const double dx = d[2 * triangle[a]] - x0;
        const double dy = d[2 * triangle[a] + 1] - y0;
        const double gx = G[2 * a - 2];
        const double gy = G[2 * a - 1];
        xx += gx * dx;
        yy += gy * dy;
        xy += gy * dx + gx * dy;
      }
      double p = xx + yy;
      if (patches_) {
        const std::array<double, 3>& sums = products(patches_->patchOf()[i / Element::points]);
        p = 0;
        for (int k = 0; k < patches_->terms(); ++k) p += patches_->basis(i)[k] * sums[k];
        for (int a = 0; a < Element::nodes && axisymmetric_; ++a)
          p -= overRoot2 * hoops_[static_cast<size_t>(Element::nodes) * i + a] * d[2 * triangle[a]];
      }
      return std::array<double, 3>{p, xx - yy, xy};
    };
    for (int i = begin; i < end; ++i) {
      const auto [p, q, r] = strainOf(i);
      const std::array<double, 9> D = moduliAt(law.moduli, i);
      for (int c = 0; c < 3; ++c) stress(c, i) += D[c] * p + D[3 + c] * q + D[6 + c] * r;
    }
    for (int i = begin; i < end && axisymmetric_; ++i) {
      const int* triangle = &nodes_.elements[static_cast<size_t>(Element::nodes) * (i / Element::points)];
      double hoop = 0;
      for (int a = 0; a < Element::nodes; ++a)
        hoop += hoops_[static_cast<size_t>(Element::nodes) * i + a] * d[2 * triangle[a]];
      const BeyondModuli beyond = beyondAt(law.beyond, i);
      for (int c = 0; c < 3; ++c) stress(c, i) += beyond.column[c] * hoop;
      stress(3, i) += beyond.corner * hoop;
      if (stress.rows() > 4) stress(4, i) += law.beyond(8, i) * hoop;
    }
    if (stress.rows() == 3) return;
    for (int i = begin; i < end; ++i) {
      const auto [p, q, r] = strainOf(i);
      for (Eigen::Index row = 3; row < stress.rows(); ++row) {
        const Eigen::Index first = 4 * (row - 3);
        stress(row, i) +=
            law.beyond(first, i) * p + law.beyond(first + 1, i) * q + law.beyond(first + 2, i) * r;
      }
    }
  });
}

// In twice the working precision, of differences to the first node of each tetrahedron.
void Body::strainInSpace(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin,
                         int end) const {
  withSpaceElement(degree(), [&](auto element) {
    using Element = decltype(element);
    constexpr int others = 3 * (Element::nodes - 1);
    for (int i = begin; i < end; ++i) {
      const int* nodes = space_->nodes().of(i / Element::points);
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
      store(5, plus(plus(xx, yy), zz), std::numbers::sqrt2 * std::numbers::inv_sqrt3);
      if (strain.rows() > 6) strain(6, i) = shift != nullptr ? -(*shift)(6, i) : 0;
    }
  });
}

void Body::addStressInSpace(const Vector& d, const Linearisation& law, Matrix& stress, int begin,
                            int end) const {
  PatchProducts products(patches(), d);
  withSpaceElement(degree(), [&](auto element) {
    using Element = decltype(element);
    constexpr int others = 3 * (Element::nodes - 1);
    for (int i = begin; i < end; ++i) {
      const int* nodes = space_->nodes().of(i / Element::points);
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
