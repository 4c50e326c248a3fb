// Which trace nodes of the nonmortar line have a row, and the functions chi of the rows (coupling.h).
#pragma once

#include <vector>

#include "base/quadrature_rules.h"
#include "contact/coupling.h"

namespace mortier {

/// A vertex at which a corner contact has more than this weight has a row, whatever else it faces.
constexpr double atCorner = 0.5;

/// Rows and row functions of a part. The last vertex of a closed part has the row of the first.
class RowFunctions {
 public:
  /// Arguments as in couple(); the refinement must outlive it.
  RowFunctions(CouplingKind kind, const CommonRefinement& refinement, const std::vector<char>& merged,
               const std::vector<char>& only = {});

  /// Trace nodes with a row, along the line.
  [[nodiscard]] const std::vector<int>& nodes() const { return nodes_; }
  [[nodiscard]] int count() const { return static_cast<int>(nodes_.size()); }
  /// Rows of the nodes of an element that carry row functions, the vertices first; -1: none.
  [[nodiscard]] EdgeNodes at(int element) const;
  /// Values of these functions at an abscissa of the element.
  [[nodiscard]] EdgeValues functions(int element, const EdgeNodes& rows, double s) const;

 private:
  const SmoothPart& part_;
  int degree_;
  std::vector<int> ofNode_;  ///< row of a trace node; -1: none
  std::vector<int> nodes_;
};

/// Lobatto's rule of seven points on every segment: distances of circles are roots, no polynomials, and the
/// least distance of straight sides is at the ends of pieces, however these are cut. Calls
/// at(segment, rows, s, values of the row functions, weight).
template <class At>
void atLobattoPoints(const CommonRefinement& refinement, const RowFunctions& rows, At at) {
  for (const Segment& segment : refinement.segments()) {
    const EdgeNodes row = rows.at(segment.nonmortar);
    if (row.maxCoeff() < 0) continue;
    const double length = segment.end - segment.begin;
    for (const auto& [place, weight] : lobattoSeven) {
      const double s = place < 1 ? segment.begin + place * length : segment.end;
      at(segment, row, s, rows.functions(segment.nonmortar, row, s), weight * length);
    }
  }
}

/// The projection of a distance is below a convex one by h^2/12 times its second derivative, and bodies that
/// touch would press each other. It is moved up, by the same number at all rows, until none is below the
/// least distance on its elements; but by no more than twice the way to the distance at the node, so that
/// kinks and steps move the rows beside them alone.
Vector lifted(const Vector& projected, const Vector& atNodes, const Vector& least);

}  // namespace mortier
