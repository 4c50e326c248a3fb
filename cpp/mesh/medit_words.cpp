#include "mesh/medit_words.h"

#include <algorithm>

#include "base/error.h"

namespace mortier {
namespace {

// Text of the file as it may stand in a message of one line.
std::string quote(std::string_view word) {
  constexpr size_t longest = 40;
  std::string out(word.substr(0, longest));
  for (char& c : out) {
    if (c < ' ' || c > '~') c = '?';
  }
  return word.size() > longest ? out + "..." : out;
}

}  // namespace

std::string_view MeditWords::next() {
  skipBlanks();
  const size_t begin = at_;
  while (at_ < text_.size() && !isBlank(text_[at_])) ++at_;
  if (at_ > begin) lastEnd_ = at_;
  return text_.substr(begin, at_ - begin);
}

std::optional<MeditWords::Name> MeditWords::nextName() {
  while (at_ < text_.size()) {
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    for (const std::string_view of : {"label", "region"}) {
      const std::string head = "# " + std::string(of) + " ";
      if (line.substr(0, head.size()) != head) continue;
      Name name{of, 0, {}};
      const char* const last = line.data() + line.size();
      const auto [after, error] = std::from_chars(line.data() + head.size(), last, name.number);
      name.name = line.substr(static_cast<size_t>(after - line.data()));
      constexpr std::string_view equals = " = ";
      if (error != std::errc() || name.name.substr(0, equals.size()) != equals) continue;
      name.name.remove_prefix(equals.size());
      if (!name.name.empty()) return name;
    }
  }
  return std::nullopt;
}

void MeditWords::skipString() {
  skipBlanks();
  if (at_ == text_.size() || text_[at_] != '"') failAt(next(), "a string in double quotes");
  const size_t close = text_.find('"', at_ + 1);
  if (close == std::string_view::npos) fail(at_, "string without end, expected closing double quotes");
  at_ = lastEnd_ = close + 1;
}

size_t MeditWords::offset(size_t begin, size_t words) const {
  MeditWords again(path_, text_);
  again.at_ = begin;
  for (size_t i = 0; i < words; ++i) again.next();
  again.skipBlanks();
  return again.at_;
}

std::string MeditWords::place(size_t at) const {
  const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n');
  return path_ + ":" + std::to_string(line);
}

void MeditWords::fail(size_t at, const std::string& what) const {
  throw InputError(place(at) + ": " + what);
}

void MeditWords::failAt(std::string_view found, const std::string& expected) const {
  if (found.empty()) fail(lastEnd_, "end of file, expected " + expected);
  fail(lastEnd_ - found.size(), "'" + quote(found) + "', expected " + expected);
}

void MeditWords::skipBlanks() {
  while (at_ < text_.size()) {
    if (text_[at_] == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (isBlank(text_[at_])) {
      ++at_;
    } else {
      return;
    }
  }
}

}  // namespace mortier
