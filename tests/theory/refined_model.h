// A model on finer meshes, for reference solutions.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "mesh/refine.h"
#include "solver/model.h"

namespace mortier::scenes {

struct Refined {
  Model model;
  std::vector<std::vector<int>> parents;  ///< by bodies and triangles
};

/// Every triangle cut into 4^times.
inline Refined refined(const Model& model, int times) {
  Refined result;
  for (const Body& body : model.bodies) {
    TriangleMesh mesh = body.mesh();
    std::vector<int> parents(mesh.triangles.size());
    for (size_t t = 0; t < parents.size(); ++t) parents[t] = static_cast<int>(t);
    for (int i = 0; i < 2 * times; ++i) {
      RefinedMesh finer = bisect(mesh, {}, std::vector<char>(mesh.triangles.size(), 1));
      for (int& parent : finer.parents) parent = parents[parent];
      mesh = std::move(finer.mesh);
      parents = std::move(finer.parents);
    }
    result.model.bodies.emplace_back(
        body.name(), mesh, std::shared_ptr<const Material>(std::shared_ptr<void>(), &body.material()),
        body.conditions());
    result.parents.push_back(std::move(parents));
  }
  for (const ContactInterface& interface : model.interfaces) addInterface(result.model, interface.pair());
  return result;
}

}  // namespace mortier::scenes
