#include "commands/freefem_text.h"

#include <algorithm>

#include "base/error.h"
#include "base/printable.h"

namespace mortier {

std::string freefemString(const std::string& text, const std::string& where) {
  constexpr size_t longest = 250;  // with the quotes of an include
  const auto safe = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  if (text.size() > longest || !std::all_of(text.begin(), text.end(), safe))
    throw InputError(where + " = \"" + printable(text) + "\", expected at most " + std::to_string(longest) +
                     " printable ASCII characters without \" and \\ (all that a FreeFEM string can hold)");
  return '"' + text + '"';
}

std::string freefemComment(const std::string& text) {
  return "// " + printable(text) + '\n';
}

}  // namespace mortier
