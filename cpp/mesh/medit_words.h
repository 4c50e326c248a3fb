// The text of a Medit file word by word, and the place of each for messages.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace mortier {

class MeditWords {
 public:
  /// Both must outlive the object. Comments, from # to the end of the line, are blanks.
  MeditWords(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  /// The next word; empty at the end of the file.
  std::string_view next();

  /// The next word as a number. \throws InputError where it is none; `what` says what was expected.
  template <class Number>
  Number number(const char* what) {
    skipBlanks();
    const size_t begin = at_;
    if (at_ < text_.size() && text_[at_] == '+') ++at_;  // which from_chars does not take
    Number value{};
    const char* const last = text_.data() + text_.size();
    const auto [end, error] = std::from_chars(text_.data() + at_, last, value);
    if (error == std::errc() && (end == last || isBlank(*end))) {
      at_ = lastEnd_ = size_t(end - text_.data());
      return value;
    }
    at_ = begin;
    failAt(next(), what);
  }

  /// The next line `# label 3 = top` or `# region 1 = punch`, from where this is to the end of the text.
  struct Name {
    std::string_view of;
    int number = 0;
    std::string_view name;
  };
  std::optional<Name> nextName();
  /// What comes next is again what follows the last word, comments included.
  void rewind() { at_ = lastEnd_; }

  /// Passes a string in double quotes, which FreeFEM's savemesh writes into the head of its files.
  void skipString();

  /// Offsets into the text: of what comes next, of the end of the last word, of the word that comes `words`
  /// after `begin`.
  [[nodiscard]] size_t at() const { return at_; }
  [[nodiscard]] size_t lastEnd() const { return lastEnd_; }
  [[nodiscard]] size_t offset(size_t begin, size_t words) const;
  [[nodiscard]] size_t remaining() const { return text_.size() - at_; }

  /// `file:line` of an offset. Lines are counted only here.
  [[nodiscard]] std::string place(size_t at) const;

  /// \throws InputError `file:line: what`.
  [[noreturn]] void fail(size_t at, const std::string& what) const;
  /// Complains about the word just read.
  [[noreturn]] void failAt(std::string_view found, const std::string& expected) const;

 private:
  static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  void skipBlanks();

  const std::string& path_;
  std::string_view text_;
  size_t at_ = 0;
  size_t lastEnd_ = 0;
};

}  // namespace mortier
