// Where the matrices of the triangles go: the sparse pattern of the tangent, and the places of its 2 x 2
// blocks.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "fem/volume_patches.h"
#include "linear/condensing_solver.h"
#include "mesh/element_nodes.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// The triangles of a body as kernels take them.
struct TriangleData {
  const ElementNodes& nodes;
  const std::vector<int>& equations;       ///< of dof 2 node + component, ascending; -1 where there is none
  const std::vector<double>& weights;      ///< of the quadrature points, triangle by triangle [m^2] or [m^3]
  const std::vector<double>& gradients;    ///< of all but the first shape function, over sqrt2 [1/m]
  const std::vector<double>& hoops;        ///< all shape functions over the radius [1/m]; empty in the plane
  const VolumePatches* patches = nullptr;  ///< where the volumetric strain is averaged

  [[nodiscard]] size_t count() const { return nodes.triangles.size() / nodes.perTriangle(); }
  /// At a point; the first x and y of a node come one after the other. They sum to zero.
  template <class Element>
  [[nodiscard]] std::array<double, 2 * Element::nodes> gradientsOf(size_t point) const {
    constexpr int others = 2 * (Element::nodes - 1);
    const double* G = &gradients[others * point];
    std::array<double, 2 * Element::nodes> all;
    double x = G[0];
    double y = G[1];
    for (int k = 0; k < others; ++k) all[2 + k] = G[k];
    for (int k = 2; k < others; k += 2) {
      x += G[k];
      y += G[k + 1];
    }
    all[0] = -x;
    all[1] = -y;
    return all;
  }
};

/// H^-1 at the quadrature points: of the strains of the plane, and where bodies turn about an axis of that
/// around it (Linearisation).
struct TangentModuli {
  const Matrix& plane;
  const Matrix* beyond = nullptr;
};

class TangentAssembly {
 public:
  TangentAssembly() = default;
  /// \param frameOf  of each node, -1 where its equations are along the axes; may be empty
  /// \param size  equations of the nodes of the triangles, which come before all others
  TangentAssembly(const TriangleData& triangles, const std::vector<int>& frameOf, int size, bool symmetric);

  [[nodiscard]] const SparsePattern& pattern() const { return pattern_; }

  /// values = sum |T| B' D B over the plain triangles: those whose nodes all have two equations along the
  /// axes. Where the volumetric strain is averaged this is the part of B that is of the triangle alone.
  void assemblePlain(const TriangleData& triangles, const TangentModuli& moduli, std::vector<double>& values,
                     Threads& threads) const;

  struct Other {
    int triangle = 0;
    std::vector<int> entries;  ///< of the pattern for its matrix, column major, -1 for none
  };
  /// Those with supported nodes.
  [[nodiscard]] const std::vector<Other>& others() const { return others_; }
  /// The same of the matrices of all patches, one after the other; where symmetric their lower triangles.
  [[nodiscard]] const std::vector<int>& entriesOfPatches() const { return entriesOfPatches_; }

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
  /// Appends the entries of the matrix of some nodes, ascending where only its `lower` triangle is asked for.
  void addEntries(const TriangleData& triangles, std::span<const int> nodes, bool lower,
                  std::vector<int>& entries) const;
  template <class Element, bool aboutAxis, bool averaged>
  void assemblePlain(const TriangleData& triangles, const TangentModuli& moduli, std::vector<double>& values,
                     Threads& threads) const;
  [[nodiscard]] int entry(int row, int column) const;

  SparsePattern pattern_;
  std::vector<Part> parts_;
  /// Per triangle and pair of its nodes, by columns: place of the block in its column.
  std::vector<uint16_t> blocks_;
  std::vector<Other> others_;
  std::vector<int> entriesOfPatches_;
};

}  // namespace mortier
