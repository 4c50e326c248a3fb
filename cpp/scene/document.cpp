#include "scene/document.h"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "base/error.h"
#include "base/whole_file.h"

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace mortier {

namespace {

/// Names the line of a value; those of a setting all share one place.
struct Places {
  std::string place;
  bool byLine = true;
  bool fromCommandLine = false;

  [[nodiscard]] std::string at(const toml::source_region& source) const {
    return byLine ? place + ":" + std::to_string(source.begin.line) : place;
  }
};

Node convert(const toml::node& source, const Places& places) {
  Node node;
  node.where = places.at(source.source());
  node.fromCommandLine = places.fromCommandLine;
  switch (source.type()) {
    case toml::node_type::table:
      for (const auto& [key, value] : *source.as_table()) {
        node.members.push_back(convert(value, places));
        node.members.back().key = key.str();
      }
      break;
    case toml::node_type::array:
      node.kind = Node::Kind::array;
      for (const toml::node& value : *source.as_array()) node.elements.push_back(convert(value, places));
      break;
    case toml::node_type::string:
      node.kind = Node::Kind::string;
      node.text = source.as_string()->get();
      break;
    case toml::node_type::integer:
      node.kind = Node::Kind::integer;
      node.value = static_cast<double>(source.as_integer()->get());
      break;
    case toml::node_type::floating_point:
      node.kind = Node::Kind::number;
      node.value = source.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      node.kind = Node::Kind::boolean;
      node.truth = source.as_boolean()->get();
      break;
    default:
      node.kind = Node::Kind::other;
  }
  return node;
}

/// toml++ quotes its input; a message stays on one line.
std::string oneLine(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return line;
}

/// Names of a key may be joined by dots without end, and every table of them stands on the stack when it is
/// taken away.
/// \throws InputError for more names than a scene could need.
void requireShortKeys(const std::string& text, const std::string& place) {
  constexpr int longest = 32;
  int names = 1;
  int line = 1;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '"' || c == '\'') {
      const bool several =
          text.compare(i, 3, std::string(3, c)) == 0;  // three quotes: a string of several lines
      const std::string quotes(several ? 3 : 1, c);
      for (i += quotes.size(); i < text.size() && text.compare(i, quotes.size(), quotes) != 0; ++i) {
        line += text[i] == '\n' ? 1 : 0;
        if (c == '"' && text[i] == '\\') ++i;
      }
      i += quotes.size() - 1;
    } else if (c == '.') {
      if (++names > longest)
        throw InputError(place + ":" + std::to_string(line) + ": a key of more than " +
                         std::to_string(longest) + " names, expected a key of a scene");
    } else if (c == '\n' || std::strchr("=,[]{}", c) != nullptr) {
      names = 1;
      line += c == '\n' ? 1 : 0;
    }
  }
}

}  // namespace

Node* Node::find(const std::string& name) {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const Node& m) { return m.key == name; });
  return found == members.end() ? nullptr : &*found;
}

const Node* Node::find(const std::string& name) const {
  return const_cast<Node*>(this)->find(name);
}

std::string Node::quoted() const {
  switch (kind) {
    case Kind::boolean:
      return truth ? "true" : "false";
    case Kind::integer:
    case Kind::number:
      return shortest(value);
    case Kind::string:
      return "\"" + oneLine(text) + "\"";
    case Kind::array:
      return "an array";
    case Kind::table:
      return "a table";
    default:
      return "a date";
  }
}

std::string readSceneText(const std::string& path) {
  constexpr uint64_t most = uint64_t{1} << 28;
  return readWhole(path, "a scene (TOML file)", most, true);
}

Node readDocument(const std::string& path, const std::string& text) {
  try {
    requireShortKeys(text, path);
    const toml::table table = toml::parse(text, path);
    return convert(table, {path});
  } catch (const toml::parse_error& error) {
    throw InputError(path + ":" + std::to_string(error.source().begin.line) +
                     ": not TOML: " + oneLine(error.description()));
  }
}

Node parseSetting(const std::string& text, const std::string& where, bool fromCommandLine) {
  try {
    requireShortKeys(text, where);
    const toml::table table = toml::parse("value = " + text);
    if (table.size() == 1) return convert(*table.get("value"), {where, false, fromCommandLine});
  } catch (const toml::parse_error&) {  // a path or an expression: a plain string
  }
  Node node;
  node.kind = Node::Kind::string;
  node.where = where;
  node.fromCommandLine = fromCommandLine;
  node.text = text;
  return node;
}

std::string shortest(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string shortest(const Point& point) {
  return "[" + shortest(point.x()) + ", " + shortest(point.y()) + "]";
}

std::string shortest(const SpacePoint& point) {
  return "[" + shortest(point.x()) + ", " + shortest(point.y()) + ", " + shortest(point.z()) + "]";
}

}  // namespace mortier
