// A run distributed over several ranks: every triangle belongs to one rank, whose model has the part of each
// body made of its triangles (fem/body.h), with local numbering. Nodes shared by several ranks are identified
// by global numbers.
#pragma once

#include <string>
#include <vector>

#include "base/ranks.h"
#include "fem/body.h"

namespace mortier {

/// What a rank knows of its part of a body.
struct BodyPart {
  BodyCut cut;
  int wholePoints = 0;
  int pointsOfTriangle = 1;
  std::vector<char> own;  ///< by nodes, whether a triangle of this rank has it
  std::vector<char>
      owned;  ///< by nodes, whether this rank adds what all know of it: one of those that own it
  /// Nodes that several ranks have, ascending, and the place of each among those of all ranks: those of
  /// triangles of several, the labelled boundary, and supports.
  std::vector<int> shared;
  std::vector<int> places;
  int placesOfAll = 0;
  Matrix motions;  ///< rigid ones of the whole body, by dofs of the part

  // On the first rank alone.

  const Body* whole = nullptr;
  /// By ranks: the triangles, and the nodes that they are owned for; numbers in the whole body.
  std::vector<std::vector<int>> trianglesOf = {};
  std::vector<std::vector<int>> nodesOf = {};
};

/// By bodies, the rank of each triangle: the bodies one after the other are cut into as many equal shares as
/// there are ranks; a body of several shares is cut where few of its nodes lie. Collective.
std::vector<std::vector<int>> ownersOf(const std::vector<Body>& bodies, Ranks& ranks);

/// The part of this rank. \param owner  rank of each triangle
BodyPart partOf(const Body& whole, const std::vector<int>& owner, Ranks& ranks);

/// A nodal sum (dofs) over the triangles of each rank becomes that of all, where several have a node.
/// Collective.
void sumAtNodes(const BodyPart& part, Ranks& ranks, Vector& nodal);
/// A nodal vector (dofs) that is known where this rank owns a node becomes known at all nodes that it has.
/// Collective.
void completeAtNodes(const BodyPart& part, Ranks& ranks, Vector& nodal);
/// Nodal vectors (dofs) and columns by points, of all ranks: of the whole body on the first rank, empty on
/// others. Collective.
Vector gatheredNodes(const BodyPart& part, Ranks& ranks, const Vector& nodal);
Matrix gatheredPoints(const BodyPart& part, Ranks& ranks, const Matrix& columns);
/// The reverse, from what this rank has of the whole.
Vector nodesOfPart(const BodyPart& part, const Vector& nodal);
Matrix pointsOfPart(const BodyPart& part, const Matrix& columns);

}  // namespace mortier
