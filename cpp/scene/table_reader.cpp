#include "scene/readers.h"

#include <algorithm>
#include <cstdlib>

#include "base/digits.h"
#include "base/error.h"

namespace mortier {

TableReader::TableReader(const Node& table, std::string path, std::string subject)
    : table_(table), path_(std::move(path)), subject_(std::move(subject)) {
  const Keys& keys = keysOf(path_);
  if (!table.isTable()) refuse(table, table.quoted() + ", expected a table with " + joined(keys));
  for (const Node& value : table.members) {
    if (isOneOf(value.key, keys)) continue;
    const std::string guess = nearest(value.key, keys);
    refuse(value, "unknown key " + value.key + (guess.empty() ? "" : ", did you mean " + guess + "?") +
                      (guess.empty() ? ", expected " : " Expected ") + "one of " + joined(keys));
  }
}

std::string TableReader::message(const std::string& where, const std::string& text) const {
  return where + ": " + (subject_.empty() ? "" : subject_ + ": ") + text;
}

void TableReader::refuse(const Node& at, const std::string& text) const {
  throw InputError(message(at.where, text));
}

void TableReader::reject(const std::string& key, const std::string& expected) const {
  const Node* node = find(key);
  if (node == nullptr) refuse(table_, key + " is missing, expected " + expected);
  refuse(*node, key + " = " + node->quoted() + ", expected " + expected);
}

void TableReader::rejectIfGiven(const Keys& keys, const std::string& expected) const {
  for (const std::string& key : keys)
    if (has(key)) reject(key, expected);
}

const Node& TableReader::require(const std::string& key, const std::string& expected) const {
  const Node* node = find(key);
  if (node == nullptr) reject(key, expected);
  return *node;
}

void TableReader::requireBeside(const std::string& governing, const std::string& word,
                                const std::string& except) const {
  for (const std::string& name : keysOf(path_)) {
    const Key& key = keyAt(path_, name);
    if (has(name) && name != except && key.beside == governing && !isOneOf(word, key.besideWords))
      reject(name, "it beside " + governing + " = \"" + joined(key.besideWords, "\" or \"") + "\" only");
  }
}

double TableReader::number(const std::string& key, std::optional<double> fallback,
                           const std::string& range) const {
  const Node* node = find(key);
  if (node == nullptr && fallback) return *fallback;
  const Key& known = keyAt(path_, key);
  if (node == nullptr) {
    char* end = nullptr;
    const double value = std::strtod(known.fallback.c_str(), &end);
    if (end != known.fallback.c_str() && *end == '\0') return value;
  }
  const Range& accepted = range.empty() ? known.range : Range::from(range);
  if (node == nullptr || !node->isNumeric() || !accepted.holds(node->value)) reject(key, accepted.text(key));
  return node->value;
}

bool TableReader::boolean(const std::string& key) const {
  const Node* node = find(key);
  if (node == nullptr) return keyAt(path_, key).fallback == "true";
  if (node->kind != Node::Kind::boolean) reject(key, "true or false");
  return node->truth;
}

std::string TableReader::string(const std::string& key, std::optional<std::string> fallback) const {
  const Node* node = find(key);
  if (node == nullptr && fallback) return *fallback;
  if (node == nullptr || !node->isString()) reject(key, "a string");
  return node->text;
}

std::vector<std::string> TableReader::strings(const std::string& key) const {
  std::vector<std::string> result;
  const Node* node = find(key);
  if (node == nullptr) return result;
  for (const Node& each : node->elements) {
    if (!each.isString()) reject(key, "a list of strings");
    result.push_back(each.text);
  }
  if (!node->isArray()) reject(key, "a list of strings");
  return result;
}

int TableReader::oneOf(const std::string& key, const Keys& words, int otherwise) const {
  const Node* node = find(key);
  if (node == nullptr && otherwise >= 0) return otherwise;
  std::string word = node == nullptr ? keyAt(path_, key).fallback : node->isString() ? node->text : "";
  if (node == nullptr) std::erase_if(word, [](char c) { return c == '"' || c == '`'; });
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) reject(key, "one of " + joined(words));
  return static_cast<int>(found - words.begin());
}

TableReader::Label TableReader::label(const std::string& key) const {
  const Node* node = find(key);
  if (node != nullptr && node->isString() && !node->text.empty()) return {-1, node->text};
  if (node != nullptr && !node->isNumeric()) reject(key, "an integer >= 0, or a name in the mesh");
  return {static_cast<int>(number(key, {}, "integer >= 0")), ""};
}

std::vector<std::string> TableReader::labels(const std::string& key) const {
  std::vector<std::string> result;
  const Node* node = find(key);
  if (node == nullptr) return result;
  const bool isList = node->isArray();
  for (size_t i = 0; i < (isList ? node->elements.size() : 1); ++i) {
    const Node& each = isList ? node->elements[i] : *node;
    const bool isName = each.isString() && !each.text.empty();
    if (!isName && !(each.isNumeric() && Range::from("integer >= 0").holds(each.value)))
      reject(key, "an integer >= 0, a name in the mesh, or a list of them");
    result.push_back(isName ? each.text : std::to_string(static_cast<int>(each.value)));
  }
  if (result.empty()) reject(key, "one label or more");
  return result;
}

std::vector<double> TableReader::numbers(const std::string& key) const {
  const Node* node = find(key);
  if (node == nullptr || !node->isArray()) reject(key, "an array of numbers");
  std::vector<double> values;
  for (const Node& element : node->elements) {
    if (!element.isNumeric() || !std::isfinite(element.value))
      refuse(element, key + "[" + std::to_string(values.size()) + "] = " + element.quoted() +
                          ", expected a finite number");
    values.push_back(element.value);
  }
  return values;
}

Point TableReader::point(const std::string& key, std::optional<Point> fallback) const {
  if (!has(key) && fallback) return *fallback;
  const std::vector<double> values = numbers(key);
  if (values.size() != 2) reject(key, "two numbers, [x, y]");
  return {values[0], values[1]};
}

SpacePoint TableReader::spacePoint(const std::string& key, std::optional<SpacePoint> fallback) const {
  if (!has(key) && fallback) return *fallback;
  const std::vector<double> values = numbers(key);
  if (values.size() != 3) reject(key, "three numbers, [x, y, z]");
  return {values[0], values[1], values[2]};
}

std::optional<Expression> TableReader::datum(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const Node& node = *find(key);
  if (node.isTable()) return timeTable(key, node);
  const std::string where = message(node.where, key + " = " + node.quoted());
  if (node.isNumeric() && std::isfinite(node.value)) return constantExpression(node.value, where);
  if (!node.isString())
    reject(key, std::string("a finite number, an expression in x, y, ") + (node.inSpace ? "z, " : "") +
                    "t, or a table { time = [...], value = [...] }");
  return parseExpression(node.text, where, node.inSpace);
}

bool TableReader::isHeld(const std::string& key) const {
  const Node* node = find(key);
  return node != nullptr && node->isString() && node->text == "held";
}

std::optional<Expression> TableReader::displacement(const std::string& key) const {
  if (!isHeld(key)) return datum(key);
  return constantExpression(0, message(find(key)->where, key + " = \"held\""));
}

Expression TableReader::timeTable(const std::string& key, const Node& node) const {
  const TableReader table(node, "datum", subject_.empty() ? key : subject_ + ": " + key);
  const std::vector<double> times = table.numbers("time");
  const std::vector<double> values = table.numbers("value");
  if (times.size() < 2) table.reject("time", "two times or more");
  if (values.size() != times.size())
    table.refuse(*table.find("value"), "value has " + counted(values.size(), "number") + ", expected " +
                                           std::to_string(times.size()) + " as time has");
  for (size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      table.refuse(table.find("time")->elements[i],
                   "time[" + std::to_string(i) + "] = " + shortest(times[i]) +
                       ", expected times that ascend, more than " + shortest(times[i - 1]));
  return tableExpression(times, values, message(node.where, key + " = " + node.quoted()));
}

std::vector<const Node*> TableReader::tables(const std::string& key) const {
  std::vector<const Node*> result;
  const Node* node = find(key);
  if (node != nullptr && node->isArray())
    for (const Node& element : node->elements) result.push_back(&element);
  else if (node != nullptr)
    result.push_back(node);
  return result;
}

}  // namespace mortier
