// Numbers in messages.
#pragma once

#include <cstdio>
#include <string>

namespace mortier {

/// With so many significant digits: "0.012" of two.
inline std::string digits(double value, int count = 2) {
  char text[32];
  return {text, static_cast<size_t>(std::snprintf(text, sizeof text, "%.*g", count, value))};
}

// Numbers of things in messages: "1 step", "2 steps", "3 vertices", "4 tetrahedra".

/// \param what  one of them; its last word is a noun
inline std::string counted(size_t n, const std::string& what) {
  if (n == 1) return "1 " + what;
  const std::string stem = what.size() < 2 ? "" : what.substr(0, what.size() - 2);
  const std::string number = std::to_string(n) + " ";
  if (what.ends_with("vertex")) return number + stem + "ices";
  if (what.ends_with("hedron")) return number + stem + "a";
  return number + what + "s";
}

}  // namespace mortier
