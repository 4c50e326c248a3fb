#include "commands/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <set>

#include "base/error.h"
#include "base/printable.h"
#include "scene/keys.h"

namespace mortier {

void SceneOptions::addScene(CLI::App& command) {
  command.add_option("SCENE", scene, "scene, a TOML file");
}

void SceneOptions::addSettings(CLI::App& command) {
  command
      .add_option("--set", settings,
                  "change a key of the scene, e.g. time.steps=20, contact.variant=interpolation, "
                  "body.upper.mesh=FILE (mortier keys lists them)")
      ->type_name("KEY=VALUE");
}

void SceneOptions::addGoal(CLI::App& command, const char* flag, const char* key, const char* type) {
  const Key& known = keyAt("accuracy", key);
  const bool hasDefault = known.range.holds(std::atof(known.fallback.c_str()));
  command
      .add_option_function<std::string>(
          flag,
          [this, key](const std::string& value) {
            settings.push_back(std::string("accuracy.") + key + "=" + value);
          },
          helpOf(known) + (hasDefault ? " (default " + known.fallback + ")" : ""))
      ->type_name(type);
}

void SceneOptions::requireScene() {
  const auto found = std::find_if(settings.begin(), settings.end(), [](const std::string& each) {
    return each.find('=') == std::string::npos;
  });
  if (scene.empty() && found != settings.end()) {
    scene = *found;
    settings.erase(found);
  }
  if (scene.empty()) throw InputError("no scene given, expected SCENE.toml (see --help)");
}

Command addKeys(CLI::App& app) {
  CLI::App* keys = app.add_subcommand("keys", "all keys of a scene, a line each (docs/scene.md)");
  const CLI::Option* markdown = keys->add_flag("--markdown")->description("as the table of docs/scene.md");
  return {keys, [markdown] {
            std::fputs((markdown->count() > 0 ? documentedKeys() : listedKeys()).c_str(), stdout);
            return exitDone;
          }};
}

void complain(const std::string& text) {
  std::fflush(stdout);
  std::fprintf(stderr, "mortier: %s\n", printable(text).c_str());
}

void warn(const std::string& text) {
  static std::set<std::string> printed;
  if (printed.insert(text).second) complain("warning: " + text);
}

void finishStandardOutput() {
  errno = 0;
  std::cout.flush();
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (failed && errno != EPIPE)
    throw OutputError(std::string("standard output: cannot be written") +
                      (errno == 0 ? "" : std::string(": ") + std::strerror(errno)));
}

}  // namespace mortier
