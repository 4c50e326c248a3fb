// The tangent of a body, K = sum |T| B' H^-1 B: its sparse pattern, and the sum over elements and patches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "fem/element_data.h"
#include "fem/supports.h"
#include "linear/condensing_solver.h"

namespace mortier {

class TangentAssembly {
 public:
  template <int dim>
  TangentAssembly(const ElementData<dim>& elements, const Supports& supports, bool symmetric);

  [[nodiscard]] const SparsePattern& pattern() const { return pattern_; }

  /// As values of the pattern. \param elements, supports  those of the constructor
  template <int dim>
  void assemble(const ElementData<dim>& elements, const Supports& supports, const TangentModuli& moduli,
                std::vector<double>& values, Threads& threads) const;

 private:
  /// Columns that one thread assembles: no entry is written by two.
  struct Part {
    int firstColumn = 0;
    int endColumn = 0;
    std::vector<int> elements;  ///< plain ones with a node there
  };

  template <int dim>
  void buildPattern(const ElementData<dim>& elements, const std::vector<int>& equations);
  template <int dim>
  void cutIntoParts(const std::vector<int>& equations);
  template <int dim>
  void placeBlocks(const ElementData<dim>& elements, const Supports& supports);
  /// Of the block of two nodes in the first column of the second; -1 where there is none.
  template <int dim>
  [[nodiscard]] int place(const std::vector<int>& equations, int node, int of) const;
  /// Adds a matrix of some nodes. \param placeOf  place() by their numbers
  template <int dim, class PlaceOf, class Entries>
  void add(const std::vector<int>& equations, std::span<const int> nodes, const PlaceOf& placeOf,
           const Entries& entries, std::vector<double>& values) const;

  template <int dim, class At>
  void assembleAt(const ElementData<dim>& elements, const Supports& supports, const TangentModuli& moduli,
                  std::vector<double>& values, Threads& threads) const;
  template <int dim, class At>
  void assemblePlain(const ElementData<dim>& elements, const std::vector<int>& equations,
                     const TangentModuli& moduli, std::vector<double>& values, Threads& threads) const;
  template <int dim, class At>
  void addOthers(const ElementData<dim>& elements, const Supports& supports, const TangentModuli& moduli,
                 std::vector<double>& values, Threads& threads) const;
  template <int dim, class At>
  void addPatches(const ElementData<dim>& elements, const Supports& supports, const TangentModuli& moduli,
                  std::vector<double>& values, Threads& threads) const;

  SparsePattern pattern_;
  std::vector<Part> parts_;
  /// Per plain element and pair of its nodes, by columns: place() of the block.
  std::vector<uint16_t> blocks_;
  std::vector<int> others_;           ///< elements with supported nodes
  std::vector<int> placesOfPatches_;  ///< the same of all patches, one after the other
};

}  // namespace mortier
