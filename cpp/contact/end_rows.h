// Where the end of a stretch of contact is pressed, not somewhere beside it.
//
// The force of a row acts at the mean place of its row function, for `weighted` rows a third of an element
// inside of the end of a line, for others where contact ends within an element. What rests on such rows would
// tip too early. With x_k the places of the rows and c the end, the last row of a stretch becomes
//
//   (1 + a) row_k - a row_(k-1),   a = (c - x_k)/(x_k - x_(k-1)),
//
// which acts at c: gaps are extrapolated linearly. The forces of a uniform pressure stay positive. Rows at an
// end on an axis of symmetry, or beside a merged vertex, are not changed.
#pragma once

#include <vector>

#include "base/sparse.h"
#include "contact/common_refinement.h"

namespace mortier {

/// T, rows x rows: rows with those at ends replaced are T times the others. Identity where none is.
/// \param nodes  of the rows, along the part; with those of the middles of its elements none is replaced
/// \param places  abscissae at which the forces of the rows act [m]
/// \param goesOn  by vertices of the part: whether it lies on an axis of symmetry or is merged
Eigen::SparseMatrix<double> endRows(const CommonRefinement& refinement, const std::vector<int>& nodes,
                                    const Vector& places, const std::vector<char>& goesOn);

/// T^-T f: the forces of rows that have become T times the others, as those were f.
Vector forcesAtEnds(const Eigen::SparseMatrix<double>& T, const Vector& f);

}  // namespace mortier
