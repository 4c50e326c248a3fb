#ifdef MORTIER_GMSH
#include "mesh/gmsh_library.h"

#include <dlfcn.h>
#include <gmshc.h>

#include <algorithm>
#include <charconv>
#include <type_traits>

#include "base/error.h"

namespace mortier {
namespace {

std::string decimal(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace

Gmsh::Gmsh(const MeshSource& source) : path_(source.path) {
  library_ = dlopen(MORTIER_GMSH, RTLD_NOW);
  if (library_ == nullptr) throw InputError(path_ + ": Gmsh cannot be loaded: " + dlerror());
  // Later versions ask as well whether to run as a program.
  std::vector<std::string> words{"gmsh"};
  for (const auto& [name, value] : source.parameters)
    words.insert(words.end(), {"-setnumber", name, decimal(value)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  const int count = static_cast<int>(arguments.size());
  if constexpr (std::is_invocable_v<decltype(gmshInitialize), int, char**, int, int*>)
    call<decltype(gmshInitialize)>("gmshInitialize", count, arguments.data(), 0);
  else
    call<decltype(gmshInitialize)>("gmshInitialize", count, arguments.data(), 0, 0);
  call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", "General.Terminal", 0.0);
  if (source.size > 0)
    call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", "Mesh.MeshSizeMax", source.size);
}

Gmsh::~Gmsh() {
  int ignored = 0;
  reinterpret_cast<decltype(gmshFinalize)*>(address("gmshFinalize"))(&ignored);
}

void* Gmsh::address(const char* name) const {
  void* const found = dlsym(library_, name);
  if (found == nullptr) throw InputError(path_ + ": Gmsh lacks " + name);
  return found;
}

void Gmsh::free(void* data) const {
  reinterpret_cast<decltype(gmshFree)*>(address("gmshFree"))(data);
}

void Gmsh::fail() const {
  char* text = nullptr;
  int error = 0;
  reinterpret_cast<decltype(gmshLoggerGetLastError)*>(address("gmshLoggerGetLastError"))(&text, &error);
  std::string said = text == nullptr || *text == 0 ? "cannot read it" : text;
  std::replace(said.begin(), said.end(), '\n', ' ');
  if (text != nullptr) free(text);
  throw InputError(path_ + ": Gmsh: " + said);
}

}  // namespace mortier

#endif
