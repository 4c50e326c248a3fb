// A TOML document as plain values, each with the place it came from, so that every message can name file and
// line. toml++ itself is visible in document.cpp only.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"

namespace mortier {

struct Node {
  enum class Kind { boolean, integer, number, string, array, table, other };

  Kind kind = Kind::table;
  std::string key;    ///< its name in the table that holds it
  std::string where;  ///< "scenes/compression.toml:14", or "--set time.steps=20"
  bool fromCommandLine = false;
  bool inSpace = false;        ///< whether expressions may depend on z
  bool truth = false;          ///< of a boolean
  double value = 0;            ///< of an integer or a number
  std::string text;            ///< of a string
  std::vector<Node> elements;  ///< of an array
  std::vector<Node> members;   ///< of a table

  [[nodiscard]] bool isTable() const { return kind == Kind::table; }
  [[nodiscard]] bool isArray() const { return kind == Kind::array; }
  [[nodiscard]] bool isString() const { return kind == Kind::string; }
  [[nodiscard]] bool isNumeric() const { return kind == Kind::integer || kind == Kind::number; }

  /// The member `name` of a table; nullptr where it is missing.
  [[nodiscard]] Node* find(const std::string& name);
  [[nodiscard]] const Node* find(const std::string& name) const;
  /// The value as a message quotes it: 0.6, "text", true, a table, an array.
  [[nodiscard]] std::string quoted() const;
};

/// The text of a scene. \throws InputError when it cannot be read.
std::string readSceneText(const std::string& path);

/// The TOML text of a file. \throws InputError `file:line: ...` when it is not TOML.
Node readDocument(const std::string& path, const std::string& text);

/// A value as given to --set: TOML where it is TOML (6, true, "a", { x = 0 }), otherwise the text as a
/// string.
Node parseSetting(const std::string& text, const std::string& where, bool fromCommandLine = true);

/// A number as a message shows it: the shortest decimal that reads back the same.
std::string shortest(double value);
/// The same of a point: "[0.5, 1]".
std::string shortest(const Point& point);
std::string shortest(const SpacePoint& point);

}  // namespace mortier
