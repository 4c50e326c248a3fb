#include "scene/keys.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "scene/document.h"

namespace mortier {

namespace {

/// Tables with the same keys, and the row that documents them.
struct Tables {
  Keys paths;
  Key head;
  std::vector<Key> keys;
};

/// "a", "b" at the beginning of a text.
Keys quoted(const std::string& text) {
  Keys words;
  for (size_t at = 0; at < text.size() && text[at] == '"';) {
    const size_t end = text.find('"', at + 1);
    words.push_back(text.substr(at + 1, end - at - 1));
    at = text.compare(end + 1, 3, ", \"") == 0 ? end + 3 : text.size();
  }
  return words;
}

std::string withoutQuotes(std::string text) {
  std::erase(text, '`');
  return text;
}

Key keyOf(const std::string& row) {
  Keys cells = split(row, '|');
  cells.resize(5);
  Key key{split(cells[0], ','), cells[1], cells[2], cells[3], cells[4], {}, {}, {}, {}, {}};
  if (const auto unit = unitOf(key.unit)) key.dimension = unit->dimension;
  const std::string expected = withoutQuotes(key.expected);
  key.range = Range::from(expected);
  key.words = quoted(expected);
  for (size_t is = expected.find(" = \""); is != std::string::npos; is = expected.find(" = \"", is + 1))
    if (const size_t with = expected.rfind("with ", is); with != std::string::npos && key.beside.empty()) {
      key.beside = expected.substr(with + 5, is - with - 5);
      key.besideWords = quoted(expected.substr(is + 3));
    }
  return key;
}

std::vector<Tables> readTables() {
  Keys rows;
  std::istringstream text(keyTable);
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("  "))
      rows.back() += line.substr(1);
    else if (!line.empty())
      rows.push_back(line);
  }
  std::vector<Tables> all;
  for (const std::string& row : rows) {
    const size_t end = row.find(']');
    if (row.front() == '[')
      all.push_back({split(row.substr(1, end - 1), ' '), keyOf(row.substr(end + 1)), {}});
    else
      all.back().keys.push_back(keyOf(row));
  }
  all.front().paths = {""};
  return all;
}

const std::vector<Tables>& tables() {
  static const std::vector<Tables> all = readTables();
  return all;
}

std::string rowOf(const std::string& name, const Key& key) {
  std::string row = "|";
  for (const std::string& cell : {name, key.unit, key.fallback, key.expected, key.help})
    row += (cell.empty() ? "" : " " + cell) + " |";
  return row + "\n";
}

/// Levenshtein distance.
size_t distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] != b[j - 1] ? 1 : 0);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

Range Range::from(const std::string& expected) {
  Range range;
  const char* text = expected.c_str();
  if (std::sscanf(text, "between %lf and %lf", &range.lower, &range.upper) == 2) return range;
  range.whole = std::sscanf(text, "integer >= %lf", &range.lower) == 1;
  range.closed = range.whole || std::sscanf(text, ">= %lf", &range.lower) == 1;
  if (!range.closed) static_cast<void>(std::sscanf(text, "> %lf", &range.lower));
  return range;
}

bool Range::holds(double value) const {
  return std::isfinite(value) && (closed ? value >= lower : value > lower) && value < upper &&
         (!whole || (value == std::floor(value) && value <= std::numeric_limits<int>::max()));
}

std::string Range::text(const std::string& key) const {
  if (whole) return "an integer >= " + shortest(lower);
  if (std::isfinite(upper)) return shortest(lower) + " < " + key + " < " + shortest(upper);
  return std::isfinite(lower) ? key + (closed ? " >= " : " > ") + shortest(lower) : "a finite number";
}

const Keys& keysOf(const std::string& path) {
  static const std::map<std::string, Keys> names = [] {
    std::map<std::string, Keys> all;
    for (const Tables& each : tables())
      for (const std::string& table : each.paths)
        for (const Key& key : each.keys)
          all[table].insert(all[table].end(), key.names.begin(), key.names.end());
    return all;
  }();
  static const Keys none;
  const auto found = names.find(path);
  return found == names.end() ? none : found->second;
}

const Key* findKey(const std::string& path, const std::string& name) {
  for (const Tables& each : tables())
    if (isOneOf(path, each.paths))
      for (const Key& key : each.keys)
        if (isOneOf(name, key.names)) return &key;
  return nullptr;
}

const Key& keyAt(const std::string& path, const std::string& name) {
  if (const Key* key = findKey(path, name)) return *key;
  throw std::logic_error("no key " + name + " in the table " + path);
}

std::string helpOf(const Key& key) {
  const std::string text = withoutQuotes(key.help);
  return text.substr(0, std::min({text.find(" ("), text.find(';'), text.find(". ")}));
}

std::string documentedKeys() {
  std::string text = "| key | unit | default | expected | meaning |\n|---|---|---|---|---|\n";
  for (const Tables& each : tables()) {
    const std::string& path = each.paths.front();
    const bool titled = path.empty() || !each.head.names.empty();
    if (!path.empty() && titled) text += rowOf("**" + joined(each.head.names) + "**", each.head);
    for (const Key& key : each.keys) {
      if (key.help.empty()) continue;
      Keys names;
      for (const std::string& name : key.names)
        names.push_back("`" + (titled ? "" : path.substr(path.rfind('.') + 1) + ".") + name + "`");
      text += rowOf(joined(names), key);
    }
  }
  return text;
}

std::string listedKeys() {
  std::string text;
  for (const Tables& each : tables())
    for (const Key& key : each.keys)
      for (const std::string& name : key.names) {
        const std::string path = each.paths.front().empty() ? name : each.paths.front() + "." + name;
        if (path.starts_with("datum") || (!keysOf(path).empty() && key.help.empty())) continue;
        const std::string is = helpOf(key) + (key.unit.empty() ? "" : " [" + key.unit + "]");
        const std::string expected = withoutQuotes(key.expected);
        const std::string otherwise = key.fallback.empty() ? "" : " (" + withoutQuotes(key.fallback) + ")";
        text.append(path).append("\t").append(is).append(is.empty() || expected.empty() ? "" : "; ");
        text.append(expected).append(otherwise).append("\n");
      }
  return text;
}

Keys split(const std::string& text, char at) {
  constexpr const char* blanks = " \r";
  Keys parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) {
    const size_t first = part.find_first_not_of(blanks);
    parts.push_back(
        first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(blanks) - first + 1));
  }
  return parts;
}

std::string joined(const Keys& keys, const std::string& separator) {
  std::string text;
  for (const std::string& key : keys) text += (&key == &keys.front() ? "" : separator) + key;
  return text;
}

bool isOneOf(const std::string& word, const Keys& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string nearest(const std::string& word, const Keys& keys) {
  std::string best;
  size_t least = 3 + word.size() / 5;  // beyond that a suggestion misleads
  for (const std::string& key : keys) {
    const size_t d = distance(word, key);
    if (d < least && d < std::max(word.size(), key.size())) {
      least = d;
      best = key;
    }
  }
  return best;
}

}  // namespace mortier
