// Where the matrices of the triangles go: the sparse pattern of the tangent, and the places of its 2 x 2
// blocks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "linear/sparse_pattern.h"

namespace mortier {

constexpr int triangleDofs = 6;

/// The triangles of a body as the assembly sees them.
struct TriangleData {
  const std::vector<std::array<int, 3>>& nodes;
  const std::vector<int>& equations;     ///< of dof 2 node + component, ascending; -1 where there is none
  const std::vector<double>& weights;    ///< areas [m^2]
  const std::vector<double>& gradients;  ///< of the second and third shape function, over sqrt2 [1/m]

  /// Of all three. They sum to zero.
  [[nodiscard]] std::array<double, 6> gradientsOf(int t) const {
    const double* G = &gradients[static_cast<size_t>(4) * t];
    return {-(G[0] + G[2]), -(G[1] + G[3]), G[0], G[1], G[2], G[3]};
  }
};

class TangentAssembly {
 public:
  TangentAssembly() = default;
  /// \param frameOf  of each node, -1 where its equations are along the axes; may be empty
  TangentAssembly(const TriangleData& triangles, const std::vector<int>& frameOf, bool symmetric);

  [[nodiscard]] const SparsePattern& pattern() const { return pattern_; }

  /// values = sum |T| B' D B over the plain triangles: those whose nodes all have two equations along the
  /// axes.
  void assemblePlain(const TriangleData& triangles, const Matrix& moduli, std::vector<double>& values,
                     Threads& threads) const;

  /// Entries of the pattern for the 6 x 6 matrix of a triangle, column major, -1 for none.
  using Entries = std::array<int, triangleDofs * triangleDofs>;
  struct SupportedTriangle {
    int triangle = 0;
    Entries entries;
  };
  /// The others.
  [[nodiscard]] const std::vector<SupportedTriangle>& supported() const { return supported_; }

 private:
  /// Columns that one thread assembles: no entry is written by two.
  struct Part {
    int firstColumn = 0;
    int endColumn = 0;
    std::vector<int> triangles;  ///< plain ones with a node there
  };

  void buildPattern(const TriangleData& triangles);
  void cutIntoParts(const std::vector<int>& equations);
  void placeBlocks(const TriangleData& triangles, const std::vector<int>& frameOf);
  [[nodiscard]] Entries entriesOf(const TriangleData& triangles, size_t t) const;
  [[nodiscard]] int entry(int row, int column) const;

  SparsePattern pattern_;
  std::vector<Part> parts_;
  /// Per triangle and pair of nodes 3 column + row: place of the block in its column.
  std::vector<std::array<uint16_t, 9>> blocks_;
  std::vector<SupportedTriangle> supported_;
};

}  // namespace mortier
