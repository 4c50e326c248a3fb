// Linear elastic bodies whose contact lines are glued in part: displacements z by matched meshes with
//
//   (E eps z, eps v) + sum of l_i [v.n]_i = f(v),     [z.n]_i = jump_i   at the glued vertices i,
//
// for all v that vanish where supports act; l_i are the forces of the glue, 0 where it is not. Bodies are
// condensed to the motions along which vertices of the line are glued, once for all solutions.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bound/lift.h"
#include "bound/loaded_body.h"
#include "linear/condensing_solver.h"

namespace mortier {

class GluedBodies {
 public:
  /// What it is given must outlive it.
  GluedBodies(const std::vector<LoadedBody>& bodies, const std::vector<Facing>& facing);

  struct Given {
    std::vector<Vector> held;   ///< by bodies (dofs), what supports prescribe; 0 beside
    std::vector<Vector> loads;  ///< by bodies (dofs) [N/m]
    std::vector<char> glued;    ///< by facing vertices
    Vector jumps;               ///< [z.n] where glued
  };
  struct Solution {
    std::vector<Vector> displacements;  ///< z by bodies (dofs)
    Vector forces;                      ///< l by facing vertices [N/m]
  };
  /// None where supports and glue leave a body free to move, or supports contradict the glue.
  [[nodiscard]] std::optional<Solution> solve(const Given& given) const;
  /// [v.n] at a facing vertex.
  [[nodiscard]] double jump(const std::vector<Vector>& v, size_t facing) const;

 private:
  struct Entry {
    int place;  ///< of all kept motions
    double value;
  };
  const std::vector<LoadedBody>& bodies_;
  const std::vector<Facing>& facing_;
  std::vector<std::unique_ptr<CondensingSolver>> solvers_;  ///< null where the body cannot be factorised
  std::vector<std::vector<int>> kept_;                      ///< equations by bodies
  std::vector<std::vector<Entry>> rows_;                    ///< [z.n] by facing vertices
  int size_ = 0;                                            ///< kept motions of all bodies
};

}  // namespace mortier
