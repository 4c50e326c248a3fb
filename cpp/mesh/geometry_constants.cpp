#include "mesh/geometry_constants.h"

#include <regex>
#include <set>
#include <string>

#include "base/error.h"
#include "base/whole_file.h"

namespace mortier {

void requireConstants(const MeshSource& source) {
  if (source.parameters.empty()) return;
  const std::string text = readWhole(source.path, "a geometry");
  std::set<std::string> known;
  const std::regex block(R"(DefineConstant\s*\[([^\]]*)\])");
  const std::regex constant(R"(([A-Za-z_]\w*)\s*=)");
  for (std::sregex_iterator found(text.begin(), text.end(), block), end; found != end; ++found) {
    const std::string inside = (*found)[1];
    for (std::sregex_iterator name(inside.begin(), inside.end(), constant); name != end; ++name)
      known.insert((*name)[1]);
  }
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
