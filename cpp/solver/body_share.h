// Which part of a body is whose: every triangle is owned by one rank, which evaluates its law, factorises
// what it adds to the tangent and keeps what it adds to the forces.
#pragma once

#include <utility>
#include <vector>

#include "base/ranks.h"
#include "solver/model.h"

namespace mortier {

class BodyShare {
 public:
  /// The bodies one after the other are cut into as many equal shares as there are ranks; a body of several
  /// shares is cut where few of its nodes lie. Collective.
  BodyShare(const Model& model, int body, Ranks& ranks);

  [[nodiscard]] Ranks& ranks() const { return *ranks_; }
  /// Equations of the triangles of this rank, ascending.
  [[nodiscard]] const std::vector<int>& equations() const { return equations_; }
  /// Whether this rank adds what is known everywhere at a node: one of those that own a triangle there.
  [[nodiscard]] bool responsible(int node) const { return responsible_[node] != 0; }

  /// Points [begin, end) of triangles that are owned by one rank and follow each other.
  using Run = std::pair<int, int>;
  /// Those of this rank.
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_[ranks_->rank()]; }
  /// Columns by points, good in the runs of each rank, become good everywhere. Collective.
  void gather(Matrix& columns) const;
  /// Columns by points become 0 in the runs of other ranks.
  void clearOthers(Matrix& columns) const;
  /// The largest |entry| in the runs of this rank.
  [[nodiscard]] double largest(const Matrix& columns) const;

 private:
  Ranks* ranks_;
  std::vector<int> equations_;
  std::vector<char> responsible_;
  std::vector<std::vector<Run>> runs_;  ///< per rank
};

}  // namespace mortier
