#include "mesh/regions.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "mesh/element_sides.h"
#include "mesh/simplices.h"

namespace mortier {
namespace {

template <class Mesh>
std::string regionsOf(const Mesh& mesh) {
  std::string text;
  for (const int region : knownNumbers(mesh.regions, mesh.sharedRegions)) {
    text += (text.empty() ? "" : ", ") + std::to_string(region);
    for (const auto& [name, number] : mesh.regionNames)
      if (number == region) text += " (" + name + ")";
  }
  return text;
}

template <class Mesh>
int numberOf(const std::string& region, const Mesh& mesh) {
  const auto named = mesh.regionNames.find(region);
  int number = 0;
  const char* const end = region.data() + region.size();
  const bool isNumber = std::from_chars(region.data(), end, number).ptr == end;
  if (named != mesh.regionNames.end()) number = named->second;
  if ((named != mesh.regionNames.end() || isNumber) &&
      knownNumbers(mesh.regions, mesh.sharedRegions).contains(number))
    return number;
  throw InputError(mesh.name + ": no region " + region + ", expected one of " + regionsOf(mesh));
}

/// Leaves out the items that are not to be kept, and what other lists have of them; empty ones stay empty.
template <class Keep, class Items, class... Others>
void keepItems(const Keep& keep, Items& items, Others&... others) {
  size_t kept = 0;
  const auto take = [&](auto& list, size_t from) {
    if (!list.empty()) list[kept] = list[from];
  };
  for (size_t i = 0; i < items.size(); ++i) {
    if (!keep(items[i])) continue;
    (take(others, i), ...);
    items[kept++] = items[i];
  }
  const auto end = [&](auto& list) { list.resize(std::min(list.size(), kept)); };
  (end(items), (end(others), ...));
}

/// Calls use with the labelled sides of a mesh, their labels, and what else goes with them.
template <class Mesh, class Use>
void withSides(Mesh& mesh, const Use& use) {
  if constexpr (ofTetrahedra<Mesh>)
    use(mesh.boundaryTriangles, mesh.boundaryLabels, mesh.boundaryNormals);
  else
    use(mesh.boundaryEdges, mesh.boundaryLabels, mesh.edgeMiddles, mesh.edgeCurves);
}

/// Keeps the sides that belong to so many elements. \param good  of that number
template <class Mesh, class Good>
void keepSides(Mesh& mesh, const Good& good) {
  const auto sides = sortedSides(mesh);
  const auto keep = [&](const auto& side) { return good(sidesOn(sides, side).size()); };
  withSides(mesh, [&](auto&... lists) { keepItems(keep, lists...); });
  if constexpr (ofTetrahedra<Mesh>) keepItems(keep, mesh.geometry.triangles, mesh.geometry.numbers);
}

template <class Mesh>
void keepElements(Mesh& mesh, const std::vector<std::string>& regions) {
  std::set<int> wanted;
  for (const std::string& region : regions) wanted.insert(numberOf(region, mesh));
  const auto isWanted = [&](int region) { return wanted.contains(region); };
  const auto isKept = [&](int region) {
    const auto groups = mesh.sharedRegions.find(region);
    return isWanted(region) || (groups != mesh.sharedRegions.end() &&
                                std::any_of(groups->second.begin(), groups->second.end(), isWanted));
  };
  keepItems(isKept, mesh.regions, elementsOf(mesh));
}

/// Leaves out vertices that none of the elements has, and numbers the others by their order in them.
template <class Mesh>
void renumberVertices(Mesh& mesh) {
  std::vector<int> numbers(mesh.vertices.size(), -1);
  auto vertices = std::exchange(mesh.vertices, {});
  const auto renumber = [&](auto& items) {
    for (auto& item : items)
      for (int& v : item) {
        if (numbers[v] < 0) {
          numbers[v] = static_cast<int>(mesh.vertices.size());
          mesh.vertices.push_back(vertices[v]);
        }
        v = numbers[v];
      }
  };
  renumber(elementsOf(mesh));
  renumber(labelledSides(mesh));
  if constexpr (ofTetrahedra<Mesh>) renumber(mesh.geometry.triangles);
}

using Names = std::map<std::string, int>;

/// "top" in quotes, or its number.
std::string nameOf(int number, const Names& names) {
  for (const auto& [name, named] : names)
    if (named == number) return name;
  return std::to_string(number);
}

/// A number for sides or elements that are in several groups, with the names of these joined by a plus sign.
class SharedNumbers {
 public:
  SharedNumbers(const std::vector<int>& numbers, Names& names, std::map<int, std::vector<int>>& shared)
      : names_(names), shared_(shared) {
    for (const int number : numbers) largest_ = std::max(largest_, number);
    for (const auto& [name, number] : names) largest_ = std::max(largest_, number);
  }
  int operator()(const std::vector<int>& groups) {
    const auto [found, isNew] = known_.try_emplace(groups, largest_ + 1);
    if (isNew) {
      ++largest_;
      shared_[largest_] = groups;
      std::string name = nameOf(groups.front(), names_);
      for (size_t i = 1; i < groups.size(); ++i) name += "+" + nameOf(groups[i], names_);
      names_.try_emplace(name, largest_);
    }
    return found->second;
  }

 private:
  Names& names_;
  std::map<int, std::vector<int>>& shared_;
  std::map<std::vector<int>, int> known_;
  int largest_ = 0;
};

/// Items with the same vertices become the first of them. \param others  lists that go with the items
template <class Items, class... Others>
void joinGroups(Items& items, std::vector<int>& numbers, Names& names,
                std::map<int, std::vector<int>>& shared, Others&... others) {
  std::vector<std::pair<typename Items::value_type, size_t>> sorted;
  sorted.reserve(items.size());
  for (size_t i = 0; i < items.size(); ++i) {
    sorted.emplace_back(items[i], i);
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::map<size_t, std::vector<int>> several;  // by the first of the items
  std::vector<char> isFirst(items.size(), 0);
  for (size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    const size_t first = sorted[begin].second;
    std::set<int> groups;
    for (; end < sorted.size() && sorted[end].first == sorted[begin].first; ++end)
      groups.insert(numbers[sorted[end].second]);
    isFirst[first] = 1;
    if (groups.size() > 1) several[first].assign(groups.begin(), groups.end());
  }
  SharedNumbers numberOf(numbers, names, shared);
  for (const auto& [first, groups] : several) numbers[first] = numberOf(groups);
  size_t at = 0;
  keepItems([&](const auto& /*item*/) { return isFirst[at++] != 0; }, items, numbers, others...);
}

/// \param items  sides or elements, of which numbers[i] is that of the i-th  \param place  of an item, as
/// text
template <class Items, class Place>
void choose(const std::string& mesh, const std::string& what, const Items& items, std::vector<int>& numbers,
            const Names& names, std::map<int, std::vector<int>>& shared, const std::set<int>& used,
            const Place& place) {
  for (size_t i = 0; i < items.size() && !shared.empty(); ++i) {
    const auto groups = shared.find(numbers[i]);
    if (groups == shared.end()) continue;
    std::vector<int> chosen;
    if (used.contains(numbers[i])) chosen.push_back(numbers[i]);
    for (const int group : groups->second)
      if (used.contains(group)) chosen.push_back(group);
    if (chosen.size() > 1)
      throw InputError(mesh + ": a " + what + " at " + place(items[i]) + " is in the groups " +
                           nameOf(chosen[0], names) + " and " + nameOf(chosen[1], names) +
                           ", and the scene names both, expected groups that share none",
                       "label-twice");
    if (!chosen.empty()) numbers[i] = chosen.front();
  }
  shared.clear();
}

/// The mean of the vertices.
template <class Mesh, class Item>
std::string placeOf(const Mesh& mesh, const Item& item) {
  auto sum = mesh.vertices[item[0]];
  for (size_t k = 1; k < item.size(); ++k) sum += mesh.vertices[item[k]];
  sum /= static_cast<double>(item.size());
  if constexpr (ofTetrahedra<Mesh>)
    return placeText(sum, 3);
  else
    return placeText(sum);
}

}  // namespace

std::set<int> knownNumbers(const std::vector<int>& present, const std::map<int, std::vector<int>>& shared) {
  std::set<int> known(present.begin(), present.end());
  for (const auto& [number, groups] : shared)
    if (known.contains(number)) known.insert(groups.begin(), groups.end());
  return known;
}

template <class Mesh>
void keepRegions(Mesh& mesh, const std::vector<std::string>& regions) {
  keepElements(mesh, regions);
  keepSides(mesh, [](auto elements) { return elements == 1; });
  renumberVertices(mesh);
}

template <class Mesh>
void dropInnerSides(Mesh& mesh) {
  keepSides(mesh, [](auto elements) { return elements < 2; });
}

template <class Mesh>
void takeGroups(Mesh& mesh, const std::vector<std::string>& regions) {
  joinGroups(elementsOf(mesh), mesh.regions, mesh.regionNames, mesh.sharedRegions);
  withSides(mesh, [&](auto& sides, auto& labels, auto&... others) {
    joinGroups(sides, labels, mesh.labelNames, mesh.sharedLabels, others...);
  });
  if (regions.empty())
    dropInnerSides(mesh);
  else
    keepRegions(mesh, regions);
  validate(mesh);
}

template <class Mesh>
void chooseGroups(Mesh& mesh, const std::set<int>& labels, const std::set<int>& regions) {
  const auto place = [&](const auto& item) { return placeOf(mesh, item); };
  choose(mesh.name, "side", labelledSides(mesh), mesh.boundaryLabels, mesh.labelNames, mesh.sharedLabels,
         labels, place);
  choose(mesh.name, elementWord<Mesh>, elementsOf(mesh), mesh.regions, mesh.regionNames, mesh.sharedRegions,
         regions, place);
}

template void keepRegions(TriangleMesh&, const std::vector<std::string>&);
template void keepRegions(TetrahedronMesh&, const std::vector<std::string>&);
template void dropInnerSides(TetrahedronMesh&);
template void takeGroups(TriangleMesh&, const std::vector<std::string>&);
template void takeGroups(TetrahedronMesh&, const std::vector<std::string>&);
template void chooseGroups(TriangleMesh&, const std::set<int>&, const std::set<int>&);
template void chooseGroups(TetrahedronMesh&, const std::set<int>&, const std::set<int>&);

}  // namespace mortier
