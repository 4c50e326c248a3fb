#include "mesh/axis.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace mortier {

TriangleMesh meshAboutAxis(TriangleMesh mesh, const char* beside) {
  constexpr double rounding = 1e-12;  // of the largest radius
  double largest = 0;
  for (const Point& vertex : mesh.vertices) largest = std::max(largest, std::abs(vertex.x()));
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    double& radius = mesh.vertices[v].x();
    if (std::abs(radius) <= rounding * largest) radius = 0;
    if (radius >= 0) continue;
    std::ostringstream message;
    message << mesh.name << ": vertex " << v + 1 << " at x = " << radius << ", expected x >= 0 beside "
            << beside << ": x is the distance from the axis";
    throw InputError(message.str());
  }
  for (Point& middle : mesh.edgeMiddles)
    if (std::abs(middle.x()) <= rounding * largest) middle.x() = 0;
  return mesh;
}

}  // namespace mortier
