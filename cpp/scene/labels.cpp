#include "scene/labels.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "mesh/boundary_line.h"
#include "scene/schema.h"

namespace mortier {

namespace {

int numberOf(const std::map<std::string, int>& names, const std::string& name, const std::string& what,
             const TriangleMesh& mesh, const std::string& place) {
  if (const auto found = names.find(name); found != names.end()) {
    return found->second;
  }
  Keys words;
  for (const auto& [known, number] : names) {
    words.push_back(known);
  }
  throw InputError(place + ": label = \"" + name + "\", " +
                   (words.empty()
                        ? "the mesh " + mesh.name + " has no names of " + what
                        : "expected one of " + joined(words) + " (" + what + " of " + mesh.name + ")"));
}

template <class Labels>
Keys wordsFor(const Labels& labels) {
  Keys words;
  for (const int label : labels) {
    words.push_back(std::to_string(label));
  }
  return words;
}

}  // namespace

int boundaryLabel(const TriangleMesh& mesh, int label, const std::string& name, const std::string& place) {
  if (!name.empty()) {
    label = numberOf(mesh.labelNames, name, "boundaries", mesh, place);
  }
  const std::vector<int> labels = boundaryLabels(mesh);
  if (std::binary_search(labels.begin(), labels.end(), label)) {
    return label;
  }
  throw InputError(place + ": label = " + std::to_string(label) +
                   (labels.empty() ? ", the mesh " + mesh.name + " has no labelled boundary"
                                   : ", expected one of " + joined(wordsFor(labels)) +
                                         " (boundary labels of " + mesh.name + ")"));
}

int regionLabel(const TriangleMesh& mesh, int label, const std::string& name, const std::string& place) {
  if (!name.empty()) {
    label = numberOf(mesh.regionNames, name, "regions", mesh, place);
  }
  const std::set<int> labels(mesh.regions.begin(), mesh.regions.end());
  if (labels.count(label) > 0) {
    return label;
  }
  throw InputError(place + ": region label = " + std::to_string(label) + ", expected one of " +
                   joined(wordsFor(labels)) + " (regions of " + mesh.name + ")");
}

}  // namespace mortier
