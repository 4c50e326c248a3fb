#include "contact/vertex_functions.h"

namespace mortier {

VertexTable verticesOf(const ContactSurface& surface) {
  VertexTable vertices;
  for (size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int part = surface.parts[t];
      VertexFacts& vertex = vertices[{surface.triangles[t][k], part}];
      vertex.place = surface.places[t][k];
      vertex.normal = surface.vertexNormals[t][k];
      vertex.curvature = surface.curvatures[t][k];
      for (const int other : {(k + 1) % 3, (k + 2) % 3})
        vertex.neighbours.insert({surface.triangles[t][other], part});
    }
  return vertices;
}

void shareFunctions(VertexTable& vertices) {
  std::vector<PartVertex> open;
  for (const auto& [key, vertex] : vertices)
    if (vertex.rows.empty()) open.push_back(key);
  while (!open.empty()) {
    std::vector<std::pair<PartVertex, std::vector<std::pair<int, double>>>> found;
    std::vector<PartVertex> still;
    for (const PartVertex& key : open) {
      std::map<int, double> parts;
      int givers = 0;
      for (const PartVertex& neighbour : vertices[key].neighbours) {
        const auto& rows = vertices[neighbour].rows;
        givers += rows.empty() ? 0 : 1;
        for (const auto& [row, part] : rows) parts[row] += part;
      }
      if (givers == 0) {
        still.push_back(key);
        continue;
      }
      std::vector<std::pair<int, double>> rows;
      for (const auto& [row, part] : parts) rows.emplace_back(row, part / givers);
      found.emplace_back(key, std::move(rows));
    }
    if (found.empty()) return;  // parts of the surface that see nothing
    for (auto& [key, rows] : found) vertices[key].rows = std::move(rows);
    open = std::move(still);
  }
}

}  // namespace mortier
