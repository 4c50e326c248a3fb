#include "mesh/geometry_constants.h"

#include <cctype>
#include <set>
#include <string>

#include "base/error.h"
#include "base/whole_file.h"

namespace mortier {
namespace {

/// The names before "=" in the brackets of every DefineConstant[...].
std::set<std::string> constantsIn(const std::string& text) {
  constexpr const char* blank = " \t\r\n\v\f";
  const std::string keyword = "DefineConstant";
  std::set<std::string> names;
  for (size_t at = 0; (at = text.find(keyword, at)) != std::string::npos;) {
    const size_t open = text.find_first_not_of(blank, at += keyword.size());
    const size_t close = text.find(']', at);
    if (open == std::string::npos || close == std::string::npos || text[open] != '[') continue;
    for (size_t equals = text.find('=', open); equals < close; equals = text.find('=', equals + 1)) {
      const size_t end = text.find_last_not_of(blank, equals - 1) + 1;
      size_t begin = end;
      while (std::isalnum(static_cast<unsigned char>(text[begin - 1])) != 0 || text[begin - 1] == '_')
        --begin;
      while (begin < end && std::isdigit(static_cast<unsigned char>(text[begin])) != 0) ++begin;
      if (begin < end) names.insert(text.substr(begin, end - begin));
    }
  }
  return names;
}

}  // namespace

void requireConstants(const MeshSource& source) {
  if (source.parameters.empty()) return;
  const std::set<std::string> known = constantsIn(readWhole(source.path, "a geometry"));
  for (const auto& [name, value] : source.parameters)
    if (known.count(name) == 0) {
      std::string list;
      for (const std::string& each : known) list += (list.empty() ? "" : ", ") + each;
      throw InputError(source.path + ": no constant " + name + ", expected " +
                       (list.empty() ? "a geometry with DefineConstant[...]"
                                     : "one that its DefineConstant names: " + list));
    }
}

}  // namespace mortier
