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

// Numbers of things in messages: "1 step", "2 steps", "3 vertices".

/// \param what  one of them; its last word is a noun
inline std::string counted(size_t n, const std::string& what) {
  if (n == 1) return "1 " + what;
  const std::string vertex = "vertex";
  const bool isVertex =
      what.size() >= vertex.size() && what.compare(what.size() - vertex.size(), vertex.size(), vertex) == 0;
  return std::to_string(n) + " " + (isVertex ? what.substr(0, what.size() - 2) + "ices" : what + "s");
}

}  // namespace mortier
