// A displacement without penetration next to one that has some: u^ = u_h - w with the gap that is left
//
//   G = g0 - [u^.n] = G_h + (w1 - w2).n >= 0      at every vertex of the matched line, so between them too,
//
// and |w|_E^2 + 2 integral of p^ G as small as a few rows of triangles next to the line allow: |w|_E is the
// energy norm of w. Vertices of the line and of some rings around it are moved one direction at a time, each
// as far as is best and allowed (successive over-relaxation); two that touch also move together. Rings are
// two, and more where one side is much finer than the other: what is lifted reaches as deep as the sides of
// the coarser one are long. Admissible whenever it stops.
#pragma once

#include <string>
#include <vector>

#include "bound/loaded_body.h"

namespace mortier {

/// Two vertices of the matched line that face each other.
struct Facing {
  std::array<int, 2> bodies{};  ///< nonmortar, mortar
  std::array<int, 2> vertices{};
  Point normal{0, 0};  ///< outward of the nonmortar body
  double gap = 0;      ///< G of u^ [m]
  double weight = 0;   ///< derivative of the integral of p^ G by it [N/m]
};

struct Lift {
  std::vector<Vector> displacements;              ///< u^ by bodies
  std::vector<Facing> facing;                     ///< all of the line
  std::vector<std::array<int, 2>> facingOfPiece;  ///< at begin and end
  std::vector<Vector> energies;  ///< |w|_E^2 by bodies and triangles of the matched meshes [J/m]
  double gap = 0;                ///< integral of p^ G [J/m]
  std::string obstacle;          ///< why there is none
};

/// \param pressure  p^ at begin and end of each piece [Pa]
Lift lift(const std::vector<LoadedBody>& bodies, const Model& model, const std::vector<MatchedPiece>& pieces,
          const std::vector<std::array<double, 2>>& pressure);

}  // namespace mortier
