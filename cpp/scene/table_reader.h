// Typed access to one table of a scene, by the table of keys. Whatever is wrong becomes one line:
//   scenes/compression.toml:14: body upper: poisson = 0.6, expected -1 < poisson < 0.5
#pragma once

#include <optional>
#include <string>

#include "scene/document.h"
#include "scene/expression.h"
#include "scene/keys.h"

namespace mortier {

class TableReader {
 public:
  /// `table` is at the `path` of the table of keys; `subject` names it in messages ("body upper", may be
  /// empty). \throws InputError when it is no table or has a key that is not known.
  TableReader(const Node& table, std::string path, std::string subject);

  [[nodiscard]] const Node& table() const { return table_; }
  [[nodiscard]] const Node* find(const std::string& key) const { return table_.find(key); }
  [[nodiscard]] bool has(const std::string& key) const { return find(key) != nullptr; }
  /// \throws InputError when `key` is missing; `expected` says what it should hold.
  [[nodiscard]] const Node& require(const std::string& key, const std::string& expected) const;
  /// \throws InputError where a key stands that belongs to other words of the key `governing`.
  void requireBeside(const std::string& governing, const std::string& word,
                     const std::string& except = "") const;

  // In the range of the table of keys. A missing key gives the fallback, else the default of that table; it
  // is an error where there is neither.
  /// \param range  in place of that of the table
  [[nodiscard]] double number(const std::string& key, std::optional<double> fallback = {},
                              const std::string& range = "") const;
  [[nodiscard]] int integer(const std::string& key, std::optional<int> fallback = {}) const {
    return static_cast<int>(number(key, fallback));
  }
  [[nodiscard]] bool boolean(const std::string& key) const;
  [[nodiscard]] std::string string(const std::string& key, std::optional<std::string> fallback = {}) const;
  /// The strings of a list; none where the key is missing.
  [[nodiscard]] std::vector<std::string> strings(const std::string& key) const;
  /// The one of its words, which are in the order of the enumeration.
  template <class Choice>
  [[nodiscard]] Choice choice(const std::string& key, std::optional<Choice> fallback = {}) const {
    const int otherwise = fallback ? static_cast<int>(*fallback) : -1;
    return static_cast<Choice>(oneOf(key, keyAt(path_, key).words, otherwise));
  }
  /// The index of the value among `words`; of the default where `otherwise` is negative.
  [[nodiscard]] int oneOf(const std::string& key, const Keys& words, int otherwise = -1) const;
  /// A label: a number >= 0, or a name that the mesh knows.
  struct Label {
    int number = 0;
    std::string name;
    [[nodiscard]] std::string text() const { return name.empty() ? std::to_string(number) : name; }
  };
  [[nodiscard]] Label label(const std::string& key) const;
  /// One label or a list of them, as text; none where the key is missing.
  [[nodiscard]] std::vector<std::string> labels(const std::string& key) const;
  /// An array of finite numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& key) const;
  /// [x, y]
  [[nodiscard]] Point point(const std::string& key, std::optional<Point> fallback = {}) const;
  /// [x, y, z]
  [[nodiscard]] SpacePoint spacePoint(const std::string& key, std::optional<SpacePoint> fallback = {}) const;
  /// A number, an expression in x, y, in space z, and t, or a table in time; none where the key is missing.
  [[nodiscard]] std::optional<Expression> datum(const std::string& key) const;
  /// The table or tables under `key` (an array of tables or a single one), none where it is missing.
  [[nodiscard]] std::vector<const Node*> tables(const std::string& key) const;

  /// `where: subject: message`
  [[nodiscard]] std::string message(const std::string& where, const std::string& text) const;
  /// \throws InputError `where: subject: message`
  [[noreturn]] void refuse(const Node& at, const std::string& text) const;
  /// \throws InputError `where: subject: key = value, expected ...`
  [[noreturn]] void reject(const std::string& key, const std::string& expected) const;
  /// The same if the key is there, as it is not to be.
  void rejectIfGiven(const Keys& keys, const std::string& expected) const;

 private:
  [[nodiscard]] Expression timeTable(const std::string& key, const Node& node) const;

  const Node& table_;
  std::string path_;
  std::string subject_;
};

}  // namespace mortier
