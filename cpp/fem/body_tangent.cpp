// The tangent of a body: triangles whose nodes are free (fem/tangent_assembly.cpp), the others, and patches.

#include "fem/body.h"
#include "fem/element.h"

namespace mortier {

template <class Element>
Eigen::Matrix<double, 2 * Element::nodes, 2 * Element::nodes> Body::triangleTangent(
    int triangle, const TangentModuli& moduli) const {
  constexpr int n = 2 * Element::nodes;
  constexpr int most = 4 * Element::points;
  // Columns of B and DB, transposed: p, q, r and where the body turns about the axis the circumference.
  using Strains = Eigen::Matrix<double, n, Eigen::Dynamic, Eigen::ColMajor, n, most>;
  const int rows = axisymmetric_ ? 4 : 3;
  Strains B = Strains::Zero(n, rows * Element::points);
  Strains DB(n, rows * Element::points);
  for (int k = 0; k < Element::points; ++k) {
    const int i = Element::points * triangle + k;
    const int at = rows * k;
    const auto G = triangleData().template gradientsOf<Element>(i);
    for (int a = 0; a < Element::nodes; ++a) {
      const double gx = G[2 * a];
      const double gy = G[2 * a + 1];
      B.template block<2, 3>(2 * a, at) = Eigen::Matrix<double, 2, 3>{{gx, gx, gy}, {gy, -gy, gx}};
      if (axisymmetric_) B(2 * a, at + 3) = hoops_[static_cast<size_t>(Element::nodes) * i + a];
    }
    if (patches_) B.col(at).setZero();
    if (patches_ && axisymmetric_) B.col(at) = -overRoot2 * B.col(at + 3);
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
  Eigen::Matrix<double, n, n> K = B.lazyProduct(DB.transpose());
  // Motions along the frames of the nodes.
  for (int a = 0; a < Element::nodes && !frameOf_.empty(); ++a)
    if (const int frame = frameOf_[nodes_.of(triangle)[a]]; frame >= 0) {
      K.template middleRows<2>(2 * a) = (frames_[frame] * K.template middleRows<2>(2 * a)).eval();
      K.template middleCols<2>(2 * a) = (K.template middleCols<2>(2 * a) * frames_[frame].transpose()).eval();
    }
  return K;
}

template <class Element>
void Body::addOthers(const TangentModuli& moduli, std::vector<double>& values, Threads& threads) const {
  // The matrices of some at once, then their sums in the order of the triangles.
  constexpr size_t atOnce = 1024;
  constexpr size_t ofABlock = 32;
  const std::vector<TangentAssembly::Other>& others = assembly().others();
  std::vector<Eigen::Matrix<double, 2 * Element::nodes, 2 * Element::nodes>> matrices(
      std::min(atOnce, others.size()));
  for (size_t first = 0; first < others.size(); first += atOnce) {
    const size_t count = std::min(atOnce, others.size() - first);
    threads.forEach(static_cast<int>((count + ofABlock - 1) / ofABlock), [&](int block) {
      for (size_t k = ofABlock * block; k < std::min(count, ofABlock * (block + 1)); ++k)
        matrices[k] = triangleTangent<Element>(others[first + k].triangle, moduli);
    });
    for (size_t k = 0; k < count; ++k) {
      const std::vector<int>& entries = others[first + k].entries;
      for (size_t i = 0; i < entries.size(); ++i)
        if (entries[i] >= 0) values[entries[i]] += matrices[k].data()[i];
    }
  }
}

template <class Element>
void Body::addPatches(const TangentModuli& moduli, std::vector<double>& values, Threads& threads) const {
  constexpr int terms = Element::points == 1 ? 1 : 3;
  const bool symmetric = pattern().symmetric;
  constexpr int ofABlock = 256;
  std::vector<double> work;
  const int* entry = assembly().entriesOfPatches().data();
  const auto setPatch = [&](int patch, double* memory) {
    const auto nodes = patches_->nodes(patch);
    PatchTangent tangent(*patches_, patch, 2, memory);
    tangent.start(*patches_, patch);
    Eigen::Matrix3d inner = Eigen::Matrix3d::Zero();
    for (const int t : patches_->elements(patch)) {
      const int* local = patches_->local(t);
      for (int i = Element::points * t; i < Element::points * (t + 1); ++i) {
        const auto G = triangleData().template gradientsOf<Element>(i);
        const std::array<double, 9> D = moduliAt(moduli.plane, i);
        const double* basis = patches_->basis(i);
        double hoopRow = 0;
        double hoopColumn = 0;
        if (axisymmetric_) {
          const BeyondModuli beyond = beyondAt(*moduli.beyond, i);
          hoopRow = beyond.row[0] - overRoot2 * D[0];
          hoopColumn = beyond.column[0] - overRoot2 * D[0];
        }
        for (int k = 0; k < terms; ++k) {
          const double w = weights_[i] * basis[k];
          double* R = tangent.first(k);
          double* C = tangent.second(k);
          for (int l = 0; l <= k; ++l) inner(k, l) += w * basis[l] * D[0];
          for (int a = 0; a < Element::nodes; ++a) {
            const int at = 2 * local[a];
            const double gx = w * G[2 * a];
            const double gy = w * G[2 * a + 1];
            R[at] += D[1] * gx + D[2] * gy;
            R[at + 1] += D[2] * gx - D[1] * gy;
            C[at] += D[3] * gx + D[6] * gy;
            C[at + 1] += D[6] * gx - D[3] * gy;
            if (!axisymmetric_) continue;
            const double hoop = w * hoops_[static_cast<size_t>(Element::nodes) * i + a];
            R[at] += hoopRow * hoop;
            C[at] += hoopColumn * hoop;
          }
        }
      }
    }
    tangent.addInner(inner);
    for (size_t a = 0; a < nodes.size() && !frameOf_.empty(); ++a)
      if (const int frame = frameOf_[nodes[a]]; frame >= 0)
        tangent.turnNode(2 * a, [&](double* at) {
          Eigen::Map<Point> vector(at);
          vector = (frames_[frame] * vector).eval();
        });
  };
  const auto addPatch = [&](int patch, double* memory) {
    const PatchTangent tangent(*patches_, patch, 2, memory);
    for (size_t j = 0; j < tangent.size(); ++j)
      for (size_t i = symmetric ? j : 0; i < tangent.size(); ++i, ++entry)
        if (*entry >= 0) values[*entry] += tangent(i, j);
  };
  constexpr int atOnce = 64 * ofABlock;
  for (int first = 0; first < patches_->count(); first += atOnce) {
    const int end = std::min(first + atOnce, patches_->count());
    std::vector<size_t> from(1, 0);
    for (int patch = first; patch < end; ++patch)
      from.push_back(from.back() + PatchTangent::need(*patches_, patch, 2));
    work.resize(from.back());
    threads.forEach((end - first + ofABlock - 1) / ofABlock, [&](int block) {
      for (int patch = first + ofABlock * block; patch < std::min(end, first + ofABlock * (block + 1));
           ++patch)
        setPatch(patch, work.data() + from[patch - first]);
    });
    for (int patch = first; patch < end; ++patch) addPatch(patch, work.data() + from[patch - first]);
  }
}

void Body::tangent(const TangentModuli& moduli, std::vector<double>& values, Threads& threads) const {
  assembly().assemblePlain(triangleData(), moduli, values, threads);
  withElement(degree(), [&](auto element) {
    using Element = decltype(element);
    addOthers<Element>(moduli, values, threads);
    if (patches_) addPatches<Element>(moduli, values, threads);
  });
}

}  // namespace mortier
