#include "scene/table_reader.h"

#include <cmath>
#include <limits>

#include "base/counted.h"
#include "base/error.h"

namespace mortier {

Range anyNumber() {
  return {[](double) { return true; }, [](const std::string&) { return std::string("a finite number"); }};
}

Range above(double lower) {
  return {[=](double v) { return v > lower; },
          [=](const std::string& key) { return key + " > " + shortest(lower); }};
}

Range atLeast(double least) {
  return {[=](double v) { return v >= least; },
          [=](const std::string& key) { return key + " >= " + shortest(least); }};
}

Range between(double lower, double upper) {
  return {[=](double v) { return v > lower && v < upper; },
          [=](const std::string& key) { return shortest(lower) + " < " + key + " < " + shortest(upper); }};
}

TableReader::TableReader(const Node& table, std::string path, std::string subject)
    : table_(table), path_(std::move(path)), subject_(std::move(subject)) {
  const Keys& keys = keysOf(path_);
  if (!table.isTable()) {
    throw InputError(message(table.where, table.quoted() + ", expected a table with " + joined(keys)));
  }
  for (const Node& value : table.members) {
    const std::string& key = value.key;
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      const std::string guess = nearest(key, keys);
      throw InputError(message(
          value.where, "unknown key " + key + (guess.empty() ? "" : ", did you mean " + guess + "?") +
                           (guess.empty() ? ", expected " : " Expected ") + "one of " + joined(keys)));
    }
  }
}

std::string TableReader::message(const std::string& where, const std::string& text) const {
  return where + ": " + (subject_.empty() ? "" : subject_ + ": ") + text;
}

void TableReader::reject(const std::string& key, const std::string& expected) const {
  const Node* node = find(key);
  if (node == nullptr) {
    throw InputError(message(table_.where, key + " is missing, expected " + expected));
  }
  throw InputError(message(node->where, key + " = " + node->quoted() + ", expected " + expected));
}

const Node& TableReader::require(const std::string& key, const std::string& expected) const {
  const Node* node = find(key);
  if (node == nullptr) {
    reject(key, expected);
  }
  return *node;
}

double TableReader::number(const std::string& key, const Range& range, std::optional<double> fallback) const {
  const Node* node = find(key);
  if (node == nullptr && fallback) {
    return *fallback;
  }
  if (node == nullptr || !node->isNumeric() || !std::isfinite(node->value) || !range.holds(node->value)) {
    reject(key, range.text(key));
  }
  return node->value;
}

int TableReader::integer(const std::string& key, int least, std::optional<int> fallback) const {
  const Node* node = find(key);
  if (node == nullptr && fallback) {
    return *fallback;
  }
  const double most = std::numeric_limits<int>::max();
  if (node == nullptr || !node->isNumeric() || !(node->value >= least && node->value <= most) ||
      node->value != std::floor(node->value)) {
    reject(key, "an integer >= " + std::to_string(least));
  }
  return static_cast<int>(node->value);
}

bool TableReader::boolean(const std::string& key, bool fallback) const {
  const Node* node = find(key);
  if (node == nullptr) {
    return fallback;
  }
  if (node->kind != Node::Kind::boolean) {
    reject(key, "true or false");
  }
  return node->truth;
}

std::string TableReader::string(const std::string& key, std::optional<std::string> fallback) const {
  const Node* node = find(key);
  if (node == nullptr && fallback) {
    return *fallback;
  }
  if (node == nullptr || !node->isString()) {
    reject(key, "a string");
  }
  return node->text;
}

std::vector<std::string> TableReader::strings(const std::string& key) const {
  const Node* node = find(key);
  std::vector<std::string> result;
  if (node == nullptr) {
    return result;
  }
  if (!node->isArray()) {
    reject(key, "a list of strings");
  }
  for (const Node& each : node->elements) {
    if (!each.isString()) {
      reject(key, "a list of strings");
    }
    result.push_back(each.text);
  }
  return result;
}

int TableReader::oneOf(const std::string& key, const Keys& words, std::optional<int> fallback) const {
  const Node* node = find(key);
  if (node == nullptr && fallback) {
    return *fallback;
  }
  const auto found =
      node == nullptr || !node->isString() ? words.end() : std::find(words.begin(), words.end(), node->text);
  if (found == words.end()) {
    reject(key, "one of " + joined(words));
  }
  return static_cast<int>(found - words.begin());
}

TableReader::Label TableReader::label(const std::string& key) const {
  const Node* node = find(key);
  if (node != nullptr && node->isString() && !node->text.empty()) {
    return {-1, node->text};
  }
  if (node != nullptr && !node->isNumeric()) {
    reject(key, "an integer >= 0, or a name in the mesh");
  }
  return {integer(key, 0), ""};
}

std::vector<std::string> TableReader::labels(const std::string& key) const {
  std::vector<std::string> result;
  const Node* node = find(key);
  if (node == nullptr) return result;
  const bool isList = node->isArray();
  for (size_t i = 0; i < (isList ? node->elements.size() : 1); ++i) {
    const Node& each = isList ? node->elements[i] : *node;
    const bool isName = each.isString() && !each.text.empty();
    const bool isNumber = each.isNumeric() && each.value == std::floor(each.value) && each.value >= 0 &&
                          each.value <= std::numeric_limits<int>::max();
    if (!isName && !isNumber) reject(key, "an integer >= 0, a name in the mesh, or a list of them");
    result.push_back(isName ? each.text : std::to_string(static_cast<int>(each.value)));
  }
  if (result.empty()) reject(key, "one label or more");
  return result;
}

std::vector<double> TableReader::numbers(const std::string& key) const {
  const Node* node = find(key);
  if (node == nullptr || !node->isArray()) {
    reject(key, "an array of numbers");
  }
  std::vector<double> values;
  for (const Node& element : node->elements) {
    if (!element.isNumeric() || !std::isfinite(element.value)) {
      throw InputError(message(element.where, key + "[" + std::to_string(values.size()) +
                                                  "] = " + element.quoted() + ", expected a finite number"));
    }
    values.push_back(element.value);
  }
  return values;
}

Point TableReader::point(const std::string& key) const {
  const std::vector<double> values = numbers(key);
  if (values.size() != 2) reject(key, "two numbers, [x, y]");
  return {values[0], values[1]};
}

Expression TableReader::expression(const std::string& key) const {
  const Node& node = require(key, "a number or an expression in x, y, t");
  if (node.isTable()) {
    return timeTable(key, node);
  }
  if (node.isNumeric() && std::isfinite(node.value)) {
    return constantExpression(node.value, message(node.where, key + " = " + node.quoted()));
  }
  if (!node.isString()) {
    reject(key, "a finite number, an expression in x, y, t, or a table { time = [...], value = [...] }");
  }
  return parseExpression(node.text, message(node.where, key + " = " + node.quoted()));
}

Expression TableReader::timeTable(const std::string& key, const Node& node) const {
  const TableReader table(node, "datum", subject_.empty() ? key : subject_ + ": " + key);
  const std::vector<double> times = table.numbers("time");
  const std::vector<double> values = table.numbers("value");
  if (times.size() < 2) {
    table.reject("time", "two times or more");
  }
  if (values.size() != times.size()) {
    throw InputError(table.message(table.find("value")->where,
                                   "value has " + counted(values.size(), "number") + ", expected " +
                                       std::to_string(times.size()) + " as time has"));
  }
  for (size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1])) {
      throw InputError(table.message(table.find("time")->elements[i].where,
                                     "time[" + std::to_string(i) + "] = " + shortest(times[i]) +
                                         ", expected times that ascend, more than " +
                                         shortest(times[i - 1])));
    }
  }
  return tableExpression(times, values, message(node.where, key + " = " + node.quoted()));
}

std::vector<const Node*> TableReader::tables(const std::string& key) const {
  std::vector<const Node*> result;
  const Node* node = find(key);
  if (node != nullptr && node->isArray()) {
    for (const Node& element : node->elements) {
      result.push_back(&element);
    }
  } else if (node != nullptr) {
    result.push_back(node);
  }
  return result;
}

}  // namespace mortier
