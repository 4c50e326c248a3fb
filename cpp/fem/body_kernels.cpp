// What a body does in every iteration, triangle by triangle.
#include "base/double_double.h"
#include "base/lanes.h"
#include "fem/body.h"
#include "fem/element.h"

namespace mortier {

// With G = gradient / sqrt2, a nodal displacement (ux, uy) strains p, q, r by
//   B = [Gx Gy; Gx -Gy; Gy Gx],
// and, where the body turns about the axis, the circumference by [N/r 0], N the shape function at the point.
// The gradients of one triangle sum to zero: differences to its first node keep rigid motions exact.

Vector Body::internalForce(const Matrix& stress) const {
  const TriangleData triangles = triangleData();
  Vector f = Vector::Zero(dofs());
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    for (size_t i = 0; i < weights_.size(); ++i) {
      const int* triangle = &nodes_.triangles[Element::nodes * (i / Element::points)];
      const auto column = static_cast<Eigen::Index>(i);
      double p = weights_[i] * stress(0, column);
      const double q = weights_[i] * stress(1, column);
      const double r = weights_[i] * stress(2, column);
      const auto G = triangles.gradientsOf<Element>(i);
      if (patches_) {
        const double* row = patches_->row(static_cast<int>(i));
        for (const int node : patches_->nodes(patches_->patchOf()[i / Element::points]))
          for (const int c : {0, 1}) f[2 * node + c] += p * *row++;
        p = 0;
      }
      for (int a = 0; a < Element::nodes; ++a) {
        f[2 * triangle[a]] += (p + q) * G[2 * a] + r * G[2 * a + 1];
        f[2 * triangle[a] + 1] += (p - q) * G[2 * a + 1] + r * G[2 * a];
      }
      if (!axisymmetric_) continue;
      const double hoop = weights_[i] * stress(3, column);
      for (int a = 0; a < Element::nodes; ++a) f[2 * triangle[a]] += hoop * hoops_[Element::nodes * i + a];
    }
  });
  return f;
}

double Body::largestForce(const Matrix& stress) const {
  const TriangleData triangles = triangleData();
  double largest = 0;
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    for (size_t i = 0; i < weights_.size(); ++i) {
      const auto s = stress.col(static_cast<Eigen::Index>(i)).head<3>().cwiseAbs();
      for (const double gradient : triangles.gradientsOf<Element>(i))
        largest = std::max(largest, weights_[i] * std::abs(gradient) * s.maxCoeff());
      for (size_t a = Element::nodes * i; axisymmetric_ && a < Element::nodes * (i + 1); ++a)
        largest =
            std::max(largest, weights_[i] * std::abs(hoops_[a] * stress(3, static_cast<Eigen::Index>(i))));
    }
  });
  return largest;
}

void Body::strain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const {
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
  const int ofTriangle = pointsOfTriangle();
  for (int i = begin; i < end; ++i) {
    const auto nodes = patches_->nodes(patches_->patchOf()[i / ofTriangle]);
    const double* row = patches_->row(i) + 2;
    const int first = 2 * *nodes.begin();
    const auto add = [&](DoubleDouble& sum, double factor, DoubleDouble value) {
      DoubleDouble product = DoubleDouble::product(factor, value.high);
      product.low += factor * value.low;
      sum += product;
    };
    DoubleDouble p{0, 0};
    for (const int* node = nodes.begin() + 1; node != nodes.end(); ++node)
      for (const int c : {0, 1}) {
        DoubleDouble change = DoubleDouble::sum(u.high[2 * *node + c], -u.high[first + c]);
        change.low += u.low[2 * *node + c] - u.low[first + c];
        add(p, *row++, change);
      }
    if (axisymmetric_) add(p, patches_->uniform(i), {u.high[first], u.low[first]});
    if (shift != nullptr) p += DoubleDouble{-(*shift)(0, i), 0};
    strain(0, i) = p.value();
  }
}

void Body::hoopStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const {
  const int n = nodes_.perTriangle();
  const int ofTriangle = pointsOfTriangle();
  for (int i = begin; i < end; ++i) {
    const int* triangle = nodes_.of(i / ofTriangle);
    DoubleDouble sum{0, 0};
    for (int a = 0; a < n; ++a) {
      const double overRadius = hoops_[static_cast<size_t>(n) * i + a];
      DoubleDouble product = DoubleDouble::product(overRadius, u.high[2 * triangle[a]]);
      product.low += overRadius * u.low[2 * triangle[a]];
      sum += product;
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
      const int* triangle = &nodes_.triangles[static_cast<size_t>(Element::nodes) * (i / Element::points)];
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
      const auto times = [&](int g, int k) {
        DoubleDouble product = DoubleDouble::product(G[g][lane], d[k].high);
        product.low += G[g][lane] * d[k].low;
        return product;
      };
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
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    constexpr int others = 2 * (Element::nodes - 1);
    const auto strainOf = [&](int i) {
      const int* triangle = &nodes_.triangles[static_cast<size_t>(Element::nodes) * (i / Element::points)];
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
        const auto nodes = patches_->nodes(patches_->patchOf()[i / Element::points]);
        const double* row = patches_->row(i) + 2;
        const int first = 2 * *nodes.begin();
        p = patches_->uniform(i) * d[first];
        for (const int* node = nodes.begin() + 1; node != nodes.end(); ++node)
          for (const int c : {0, 1}) p += *row++ * (d[2 * *node + c] - d[first + c]);
      }
      return std::array<double, 3>{p, xx - yy, xy};
    };
    for (int i = begin; i < end; ++i) {
      const auto [p, q, r] = strainOf(i);
      const std::array<double, 9> D = moduliAt(law.moduli, i);
      for (int c = 0; c < 3; ++c) stress(c, i) += D[c] * p + D[3 + c] * q + D[6 + c] * r;
    }
    for (int i = begin; i < end && axisymmetric_; ++i) {
      const int* triangle = &nodes_.triangles[static_cast<size_t>(Element::nodes) * (i / Element::points)];
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

void Body::tangent(const TangentModuli& moduli, std::vector<double>& values, Threads& threads) const {
  if (patches_)
    values.assign(pattern().entries(), 0.0);
  else
    assembly().assemblePlain(triangleData(), moduli, values, threads);
  addGroups(moduli, values, threads);
}

void Body::addGroups(const TangentModuli& moduli, std::vector<double>& values, Threads& threads) const {
  // The matrices of some at once, then their sums in the order of the groups.
  constexpr size_t atOnce = 1024;
  constexpr size_t ofABlock = 32;
  const std::vector<TangentAssembly::Group>& groups = assembly().groups();
  std::vector<Matrix> matrices(std::min(atOnce, groups.size()));
  for (size_t first = 0; first < groups.size(); first += atOnce) {
    const size_t count = std::min(atOnce, groups.size() - first);
    threads.forEach(static_cast<int>((count + ofABlock - 1) / ofABlock), [&](int block) {
      Matrix B;
      Matrix DB;
      for (size_t k = ofABlock * block; k < std::min(count, ofABlock * (block + 1)); ++k)
        groupTangent(groups[first + k], moduli, B, DB, matrices[k]);
    });
    for (size_t k = 0; k < count; ++k) {
      const std::vector<int>& entries = groups[first + k].entries;
      for (size_t i = 0; i < entries.size(); ++i)
        if (entries[i] >= 0) values[entries[i]] += matrices[k].data()[i];
    }
  }
}

// Columns of B and DB, transposed: p, q, r and where the body turns about the axis the circumference, point
// by point.
void Body::groupTangent(const TangentAssembly::Group& group, const TangentModuli& moduli, Matrix& B,
                        Matrix& DB, Matrix& K) const {
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    const auto dofs = static_cast<Eigen::Index>(2 * group.nodes.size());
    const Eigen::Index rows = axisymmetric_ ? 4 : 3;
    const auto points = static_cast<Eigen::Index>(Element::points * group.triangles.size());
    B.setZero(dofs, rows * points);
    DB.resize(dofs, rows * points);
    Eigen::Index at = 0;
    for (const int t : group.triangles) {
      std::array<Eigen::Index, Element::nodes> dof;
      for (int a = 0; a < Element::nodes; ++a)
        dof[a] =
            2 * (std::find(group.nodes.begin(), group.nodes.end(), nodes_.of(t)[a]) - group.nodes.begin());
      for (int i = Element::points * t; i < Element::points * (t + 1); ++i, at += rows) {
        const auto G = triangleData().template gradientsOf<Element>(i);
        for (int a = 0; a < Element::nodes; ++a) {
          const double gx = G[2 * a];
          const double gy = G[2 * a + 1];
          B.template block<2, 3>(dof[a], at) = Eigen::Matrix<double, 2, 3>{{gx, gx, gy}, {gy, -gy, gx}};
          if (axisymmetric_) B(dof[a], at + 3) = hoops_[static_cast<size_t>(Element::nodes) * i + a];
        }
        if (patches_) B.col(at) = Eigen::Map<const Vector>(patches_->row(i), dofs);
        const std::array<double, 9> D = moduliAt(moduli.plane, i);
        const double w = weights_[i];
        for (int r = 0; r < 3; ++r)
          DB.col(at + r) =
              (w * D[r]) * B.col(at) + (w * D[3 + r]) * B.col(at + 1) + (w * D[6 + r]) * B.col(at + 2);
        if (!axisymmetric_) continue;
        const BeyondModuli beyond = beyondAt(*moduli.beyond, i);
        for (int r = 0; r < 3; ++r) DB.col(at + r) += (w * beyond.column[r]) * B.col(at + 3);
        DB.col(at + 3) = (w * beyond.row[0]) * B.col(at) + (w * beyond.row[1]) * B.col(at + 1) +
                         (w * beyond.row[2]) * B.col(at + 2) + (w * beyond.corner) * B.col(at + 3);
      }
    }
    K.noalias() = B * DB.transpose();
    // Motions along the frames of the nodes.
    for (size_t a = 0; a < group.nodes.size() && !frameOf_.empty(); ++a)
      if (const int frame = frameOf_[group.nodes[a]]; frame >= 0) {
        const auto first = static_cast<Eigen::Index>(2 * a);
        K.middleRows<2>(first) = (frames_[frame] * K.middleRows<2>(first)).eval();
        K.middleCols<2>(first) = (K.middleCols<2>(first) * frames_[frame].transpose()).eval();
      }
  });
}

}  // namespace mortier
