// The elements of a body as kernels take them, and what a displacement strains at one of their points: of the
// plane, about an axis, and in space.
#pragma once

#include <array>
#include <numbers>
#include <type_traits>
#include <vector>

#include "fem/element.h"
#include "fem/tetrahedron.h"
#include "fem/volume_patches.h"
#include "material/material.h"

namespace mortier {

/// Triangles or tetrahedra.
template <int dim>
struct ElementData {
  static constexpr int dimension = dim;
  const std::conditional_t<dim == 2, ElementNodes, SpaceNodes>& nodes;
  const std::vector<double>& weights;      ///< of the quadrature points, one element after the other
  const std::vector<double>& gradients;    ///< of all but the first shape function, over sqrt2 [1/m]
  const std::vector<double>& hoops;        ///< all shape functions over the radius [1/m]; about an axis
  const VolumePatches* patches = nullptr;  ///< where the volumetric strain is averaged

  /// At a point; the components of a node one after the other. They sum to zero.
  template <class Element>
  [[nodiscard]] std::array<double, dim * Element::nodes> gradientsOf(size_t point) const {
    constexpr int others = dim * (Element::nodes - 1);
    const double* G = &gradients[others * point];
    std::array<double, dim * Element::nodes> all;
    std::array<double, dim> sum{};
    for (int k = 0; k < others; k += dim)
      for (int c = 0; c < dim; ++c) {
        all[dim + k + c] = G[k + c];
        sum[c] += G[k + c];
      }
    for (int c = 0; c < dim; ++c) all[c] = -sum[c];
    return all;
  }
};

/// Of the places of nodes.
template <class Nodes>
inline constexpr int dimensionOf =
    std::remove_cvref_t<decltype(std::declval<Nodes>().places.front())>::SizeAtCompileTime;

/// Calls work(Element{}) with the element of a degree.
template <int dim, class Work>
decltype(auto) withElementIn(int degree, Work work) {
  if constexpr (dim == 2)
    return withElement(degree, work);
  else
    return withSpaceElement(degree, work);
}

/// H^-1 at the quadrature points: of the strains of the plane or of space, and where bodies turn about an
/// axis of that around it (Linearisation).
struct TangentModuli {
  const Matrix& own;
  const Matrix* beyond = nullptr;
};

// With G = gradient / sqrt2, a nodal displacement (ux, uy) strains p, q, r by
//   B = [Gx Gy; Gx -Gy; Gy Gx],
// and of a body that turns about the axis the fourth component by the row [N/r 0], N the shape function. In
// space: strainOfNode. A point has columns of weight D B for a node, B' times such a column, or times weight
// times a stress, for another, and, where the volumetric strain is averaged, what D takes to it and from it.
// B is then without its part of that strain, of which about an axis only minus the circumference over sqrt2
// is left to the element.

template <class ElementOf, bool aboutAxis, bool averaged>
class PlanePoint {
 public:
  using Element = ElementOf;

  struct Column {
    double sum;         ///< of the rows p and q of D B
    double difference;  ///< of these
    double r;
    double hoop = 0;
  };

  PlanePoint(const ElementData<2>& elements, int i)
      : weight_(elements.weights[i]), G_(elements.gradientsOf<Element>(i)) {
    if constexpr (aboutAxis) overRadius_ = &elements.hoops[static_cast<size_t>(Element::nodes) * i];
  }
  PlanePoint(const ElementData<2>& elements, const TangentModuli& moduli, int i) : PlanePoint(elements, i) {
    D_ = moduliAt(moduli.own, i);
    if constexpr (aboutAxis) beyond_ = beyondAt(*moduli.beyond, i);
  }

  [[nodiscard]] std::array<Column, 2> columns(int b) const {
    const double gx = weight_ * G_[2 * b];
    const double gy = weight_ * G_[2 * b + 1];
    double px = gx;
    double py = gy;
    if constexpr (averaged) px = py = 0;
    if constexpr (averaged && aboutAxis) px = -weight_ * overRadius_[b] / std::numbers::sqrt2;
    if constexpr (aboutAxis)
      return {column(px, gx, gy, weight_ * overRadius_[b]), column(py, -gy, gx, 0)};
    else
      return {column(px, gx, gy), column(py, -gy, gx)};
  }
  [[nodiscard]] Column force(const Matrix& stress, int i) const {
    double p = weight_ * stress(0, i);
    const double q = weight_ * stress(1, i);
    double hoop = aboutAxis ? weight_ * stress(3, i) : 0;
    if constexpr (averaged) {
      hoop -= overRoot2 * p;
      p = 0;
    }
    return {p + q, p - q, weight_ * stress(2, i), hoop};
  }
  [[nodiscard]] double volumeForce(const Matrix& stress, int i) const { return weight_ * stress(0, i); }
  [[nodiscard]] Eigen::Vector2d rows(const Column& column, int a) const {
    const double gx = G_[2 * a];
    const double gy = G_[2 * a + 1];
    const Eigen::Vector2d rows(column.sum * gx + column.r * gy, column.difference * gy + column.r * gx);
    if constexpr (aboutAxis) return rows + Eigen::Vector2d(column.hoop * overRadius_[a], 0);
    return rows;
  }

  [[nodiscard]] double weight() const { return weight_; }
  [[nodiscard]] double volume() const { return D_[0]; }
  [[nodiscard]] Column volumeColumn() const { return ofVolume(D_[1], D_[2], aboutAxis ? beyond_.row[0] : 0); }
  [[nodiscard]] Column volumeRow() const { return ofVolume(D_[3], D_[6], aboutAxis ? beyond_.column[0] : 0); }

 private:
  /// D times the strains p, q, r and that around the axis.
  [[nodiscard]] Column column(double p, double q, double r, double strain = 0) const {
    const double dp = D_[0] * p + D_[3] * q + D_[6] * r;
    const double dq = D_[1] * p + D_[4] * q + D_[7] * r;
    Column result{dp + dq, dp - dq, D_[2] * p + D_[5] * q + D_[8] * r};
    if constexpr (aboutAxis) {
      result.sum += (beyond_.column[0] + beyond_.column[1]) * strain;
      result.difference += (beyond_.column[0] - beyond_.column[1]) * strain;
      result.r += beyond_.column[2] * strain;
      result.hoop = beyond_.row[0] * p + beyond_.row[1] * q + beyond_.row[2] * r + beyond_.corner * strain;
    }
    if constexpr (averaged) {
      result.hoop -= (result.sum + result.difference) / (2 * std::numbers::sqrt2);
      result.sum = (result.sum - result.difference) / 2;
      result.difference = -result.sum;
    }
    return result;
  }
  [[nodiscard]] Column ofVolume(double q, double r, double hoop) const {
    return {q, -q, r, hoop - overRoot2 * D_[0]};
  }

  double weight_;
  std::array<double, 2 * Element::nodes> G_;
  std::array<double, 9> D_;
  BeyondModuli beyond_;
  const double* overRadius_ = nullptr;
};

template <class ElementOf, bool averaged>
class SolidPoint {
 public:
  using Element = ElementOf;
  using Column = Eigen::Matrix3d;  ///< tensorOfStress

  SolidPoint(const ElementData<3>& elements, int i)
      : weight_(elements.weights[i]), G_(elements.gradientsOf<Element>(i)) {}
  SolidPoint(const ElementData<3>& elements, const TangentModuli& moduli, int i) : SolidPoint(elements, i) {
    D_ = spaceModuliAt(moduli.own, i);
  }

  [[nodiscard]] std::array<Column, 3> columns(int b) const {
    NodeStrain B = strainOfNode(weight_ * G_[3 * b], weight_ * G_[3 * b + 1], weight_ * G_[3 * b + 2]);
    if constexpr (averaged) B.row(5).setZero();
    const NodeStrain DB = D_ * B;
    return {own(DB.col(0)), own(DB.col(1)), own(DB.col(2))};
  }
  /// The sum of all columns and rows of a point.
  template <class Stiffness>
  void addTo(Stiffness& K) const {
    Eigen::Matrix<double, 6, 3 * Element::nodes> B;
    for (int b = 0; b < Element::nodes; ++b)
      B.template middleCols<3>(3 * b) = strainOfNode(G_[3 * b], G_[3 * b + 1], G_[3 * b + 2]);
    if constexpr (averaged) B.row(5).setZero();
    const Eigen::Matrix<double, 6, 3 * Element::nodes> DB = (weight_ * D_) * B;
    K.noalias() += B.transpose() * DB;
  }
  [[nodiscard]] Column force(const Matrix& stress, int i) const {
    return own(weight_ * stress.col(i).head<6>());
  }
  [[nodiscard]] double volumeForce(const Matrix& stress, int i) const { return weight_ * stress(5, i); }
  [[nodiscard]] Eigen::Vector3d rows(const Column& T, int a) const {
    return T * Eigen::Vector3d(G_[3 * a], G_[3 * a + 1], G_[3 * a + 2]);
  }

  [[nodiscard]] double weight() const { return weight_; }
  [[nodiscard]] double volume() const { return D_(5, 5); }
  [[nodiscard]] Column volumeColumn() const { return own(D_.col(5)); }
  [[nodiscard]] Column volumeRow() const { return own(D_.row(5).transpose()); }

 private:
  [[nodiscard]] static Column own(Eigen::Vector<double, 6> stress) {
    if constexpr (averaged) stress[5] = 0;
    return tensorOfStress(stress);
  }

  double weight_;
  std::array<double, 3 * Element::nodes> G_;
  Eigen::Matrix<double, 6, 6> D_;
};

/// Calls work(std::type_identity<Point>()) with the class of the points of a body.
template <int dim, class Work>
void withPointsOf(const ElementData<dim>& elements, const Work& work) {
  withElementIn<dim>(elements.nodes.degree, [&](auto element) {
    using Element = decltype(element);
    const auto with = [&](auto averaged) {
      if constexpr (dim == 3)
        work(std::type_identity<SolidPoint<Element, averaged.value>>());
      else if (!elements.hoops.empty())
        work(std::type_identity<PlanePoint<Element, true, averaged.value>>());
      else
        work(std::type_identity<PlanePoint<Element, false, averaged.value>>());
    };
    if (elements.patches != nullptr)
      with(std::true_type());
    else
      with(std::false_type());
  });
}

}  // namespace mortier
