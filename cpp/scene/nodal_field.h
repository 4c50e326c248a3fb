// A field by its values at the vertices of a mesh, one number a line in the order of the mesh, linear on its
// triangles; beyond the mesh that of the nearest triangle goes on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace mortier {

class NodalField {
 public:
  /// \param where  what messages begin with
  /// \throws InputError unless the file has one finite number a vertex.
  NodalField(const TriangleMesh& mesh, const std::string& file, const std::string& where);

  double operator()(const Point& x) const;

 private:
  struct Cells;
  std::shared_ptr<const Cells> cells_;  ///< triangles by the squares of a grid that they meet
};

}  // namespace mortier
