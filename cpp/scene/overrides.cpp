#include <algorithm>
#include <charconv>

#include "base/error.h"
#include "base/printable.h"
#include "scene/readers.h"

namespace mortier {

namespace {

struct Setting {
  std::string where;
  bool fromCommandLine = true;
  std::vector<std::string> path;
  Node value;
};

/// \param place  in the scene; empty: it comes from the command line
Setting parse(const std::string& text, const std::string& place) {
  constexpr size_t longest = 200;  // it stands in every value of the setting
  const std::string where = place.empty() ? "--set " + printable(text, longest) : printable(place, longest);
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(where + ": expected key=value, e.g. time.steps=20");
  std::vector<std::string> path;
  for (size_t begin = 0; begin <= equals;) {
    const size_t end = std::min(text.find('.', begin), equals);
    path.push_back(text.substr(begin, end - begin));
    if (path.back().empty())
      throw InputError(where + ": the key has an empty component, expected e.g. body.upper.mesh");
    begin = end + 1;
  }
  return {where, place.empty(), path, parseSetting(text.substr(equals + 1), where, place.empty())};
}

/// What an element of an array of tables is called by: its name or its label.
std::string handle(const Node& element) {
  const Node* name = element.find("name");
  if (name != nullptr && name->isString()) return name->text;
  const Node* label = element.find("label");
  if (label != nullptr && label->isString()) return label->text;
  return label != nullptr && label->isNumeric() ? shortest(label->value) : "";
}

void set(Node& table, const Setting& setting, size_t depth, const std::string& schemaPath);

/// The elements of an array of tables that the component names; all of them when it names none and is a key
/// of theirs.
void setInArray(Node& array, const Setting& setting, size_t depth, const std::string& schemaPath) {
  const std::string& word = setting.path[depth];
  Keys handles;
  bool named = false;
  for (Node& element : array.elements) {
    handles.push_back(handle(element));
    if (handles.back() == word && depth + 1 < setting.path.size()) {
      set(element, setting, depth + 1, schemaPath);
      named = true;
    }
  }
  if (named) return;
  size_t index = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), index);
  const bool isIndex = status == std::errc() && end == word.data() + word.size() &&
                       schemaPath != "body.boundary" && schemaPath != "body.region";
  if (isIndex && index < array.elements.size() && depth + 1 < setting.path.size())
    return set(array.elements[index], setting, depth + 1, schemaPath);
  const Keys& keys = keysOf(schemaPath);
  if (!isOneOf(word, keys)) {
    handles.erase(std::remove(handles.begin(), handles.end(), ""), handles.end());
    throw InputError(setting.where + ": no " + word + " in " + schemaPath + ", expected " +
                     (handles.empty() ? "" : "one of " + joined(handles) + ", or ") +
                     "a key: " + joined(keys));
  }
  for (Node& element : array.elements) set(element, setting, depth, schemaPath);
}

void set(Node& table, const Setting& setting, size_t depth, const std::string& schemaPath) {
  const std::string& word = setting.path[depth];
  const Keys& keys = keysOf(schemaPath);
  // By the geometry or the law, not by the schema.
  const bool named = schemaPath == "body.mesh.parameters" || schemaPath == "body.material.parameters" ||
                     schemaPath == "body.region.material.parameters";
  if (!table.isTable() || (!named && !isOneOf(word, keys))) {
    const std::string guess = nearest(word, keys);
    throw InputError(
        setting.where + ": no " + word + " in " + (schemaPath.empty() ? "the scene" : schemaPath) +
        (guess.empty() ? "" : ", did you mean " + guess + "?") +
        (keys.empty()
             ? ", which has no keys"
             : (guess.empty() ? ", expected" : " Expected") + std::string(" one of ") + joined(keys)));
  }
  Node* member = table.find(word);
  if (depth + 1 == setting.path.size() && setting.value.isString() && setting.value.text.empty()) {
    table.members.erase(std::remove_if(table.members.begin(), table.members.end(),
                                       [&](const Node& each) { return each.key == word; }),
                        table.members.end());
    return;
  }
  if (member == nullptr) {
    member = &table.members.emplace_back();
    member->key = word;
    member->where = setting.where;
    member->fromCommandLine = setting.fromCommandLine;
  }
  if (depth + 1 == setting.path.size()) {
    *member = setting.value;
    member->key = word;
    return;
  }
  const std::string path = schemaPath.empty() ? word : schemaPath + "." + word;
  if (member->isArray()) {
    setInArray(*member, setting, depth + 1, path);
  } else {
    set(*member, setting, depth + 1, path);
  }
}

}  // namespace

void applyOverride(Node& document, const std::string& setting, const std::string& place) {
  set(document, parse(setting, place), 0, "");
}

}  // namespace mortier
