#pragma once

#include <set>
#include <string>

#include "material/material.h"

namespace mortier {

/// The laws of a material in a line, each once: "Perzyna (frobenius), elastic".
inline std::string lawsOf(const Material& material) {
  std::set<std::string> names;
  for (const LawDescription& law : material.laws()) names.insert(law.text());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace mortier
