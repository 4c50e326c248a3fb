// The table of keys (key_table.cpp): what a scene may hold, table by table, with unit, default, range and a
// line of help. The reader, the conversion of units, --set, the help of options, the completion of shells and
// docs/scene.md take keys from it.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/units.h"

namespace mortier {

using Keys = std::vector<std::string>;

extern const char* const keyTable;  ///< as text, a row a key

/// The numbers that a key accepts.
struct Range {
  double lower = -INFINITY;  ///< of a closed range also accepted
  double upper = INFINITY;
  bool closed = false;
  bool whole = false;

  /// From "> 0", ">= 0", "integer >= 1" or "between 0 and 1"; of any other text all finite numbers.
  static Range from(const std::string& expected);
  [[nodiscard]] bool holds(double value) const;
  /// "-1 < poisson < 0.5"
  [[nodiscard]] std::string text(const std::string& key) const;
};

struct Key {
  Keys names;
  std::string unit, fallback, expected, help;  ///< as documented
  std::optional<Dimension> dimension;          ///< of its unit
  Range range;
  Keys words;          ///< of which it is one
  std::string beside;  ///< the key that must be one of these words
  Keys besideWords;
};

/// The keys of the table at a dotted path without indices ("" is the scene itself, "body.boundary" one
/// condition); empty where there is no such table.
const Keys& keysOf(const std::string& path);

/// A key of that table; nullptr where there is none.
const Key* findKey(const std::string& path, const std::string& name);
/// \pre there is one
const Key& keyAt(const std::string& path, const std::string& name);

/// What it does, in a line without markup.
std::string helpOf(const Key& key);

/// The table of docs/scene.md.
std::string documentedKeys();
/// A line a key, for people and for completion: its path, a tab, what it is.
std::string listedKeys();

/// The parts of a text between characters, without blanks at their ends.
Keys split(const std::string& text, char at);
/// "a, b, c".
std::string joined(const Keys& keys, const std::string& separator = ", ");

/// Whether it is one of the words.
bool isOneOf(const std::string& word, const Keys& words);

/// The key that `word` is most likely a misspelling of; empty when none is close.
std::string nearest(const std::string& word, const Keys& keys);

}  // namespace mortier
