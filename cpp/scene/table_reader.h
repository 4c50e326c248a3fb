// Typed access to one table of a scene. Whatever is wrong becomes one line:
//   scenes/compression.toml:14: body upper: poisson = 0.6, expected -1 < poisson < 0.5
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/document.h"
#include "scene/expression.h"
#include "scene/schema.h"

namespace mortier {

/// The numbers that a key accepts, with the words that say so ("poisson" -> "-1 < poisson < 0.5").
struct Range {
  std::function<bool(double)> holds;
  std::function<std::string(const std::string& key)> text;
};

Range anyNumber();
Range above(double lower);
Range atLeast(double least);
Range between(double lower, double upper);  ///< open on both ends

class TableReader {
 public:
  /// `table` is at the schema's `path`; `subject` names it in messages ("body upper", may be empty).
  /// \throws InputError when it is no table or has a key that the schema does not know.
  TableReader(const Node& table, std::string path, std::string subject);

  [[nodiscard]] const Node& table() const { return table_; }
  [[nodiscard]] const Node* find(const std::string& key) const { return table_.find(key); }
  /// \throws InputError when `key` is missing; `expected` says what it should hold.
  [[nodiscard]] const Node& require(const std::string& key, const std::string& expected) const;

  /// Finite numbers in range; a missing key gives the fallback, or is an error where there is none.
  [[nodiscard]] double number(const std::string& key, const Range& range,
                              std::optional<double> fallback = std::nullopt) const;
  [[nodiscard]] int integer(const std::string& key, int least,
                            std::optional<int> fallback = std::nullopt) const;
  [[nodiscard]] bool boolean(const std::string& key, bool fallback) const;
  [[nodiscard]] std::string string(const std::string& key,
                                   std::optional<std::string> fallback = std::nullopt) const;
  /// The strings of a list; none where the key is missing.
  [[nodiscard]] std::vector<std::string> strings(const std::string& key) const;
  /// The index of the value among `words`.
  [[nodiscard]] int oneOf(const std::string& key, const Keys& words,
                          std::optional<int> fallback = std::nullopt) const;
  /// A label: a number >= 0, or a name that the mesh knows.
  struct Label {
    int number = 0;
    std::string name;
  };
  [[nodiscard]] Label label(const std::string& key) const;
  /// One label or a list of them, as text; none where the key is missing.
  [[nodiscard]] std::vector<std::string> labels(const std::string& key) const;
  /// An array of finite numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& key) const;
  /// [x, y]
  [[nodiscard]] Point point(const std::string& key) const;
  /// A number, an expression in x, y, t, or a table in time.
  [[nodiscard]] Expression expression(const std::string& key) const;
  /// The table or tables under `key` (an array of tables or a single one), none where it is missing.
  [[nodiscard]] std::vector<const Node*> tables(const std::string& key) const;

  /// `where: subject: message`
  [[nodiscard]] std::string message(const std::string& where, const std::string& text) const;
  /// \throws InputError `where: subject: key = value, expected ...`
  [[noreturn]] void reject(const std::string& key, const std::string& expected) const;

 private:
  [[nodiscard]] Expression timeTable(const std::string& key, const Node& node) const;

  const Node& table_;
  std::string path_;
  std::string subject_;
};

}  // namespace mortier
