// The commands of the program: each function adds one, with its options, to the command line.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace mortier {

constexpr const char* version = MORTIER_VERSION;

enum ExitCode {
  exitDone = 0,
  exitFailed = 1,      ///< a step that cannot be solved, or output that cannot be written
  exitWrongInput = 2,  ///< wrong scene, mesh or usage
  exitUnheld = 3       ///< nothing holds a body
};

struct Command {
  CLI::App* options = nullptr;
  std::function<int()> work;  ///< once the options are parsed; \returns the exit code
};

Command addRun(CLI::App& app);
Command addMesh(CLI::App& app);
Command addKeys(CLI::App& app);
Command addCheck(CLI::App& app);
Command addFreefem(CLI::App& app);
Command addLaw(CLI::App& app);
// Handed over to the Python programs in study/ and views/.
Command addStudy(CLI::App& app);
Command addPlot(CLI::App& app);
Command addReport(CLI::App& app);
Command addCompare(CLI::App& app);

/// The scene of a command, and the settings that change it.
struct SceneOptions {
  std::string scene;
  std::vector<std::string> settings;  ///< key=value

  void addScene(CLI::App& command);
  void addSettings(CLI::App& command);
  /// An option of its own for a key of [accuracy].
  void addGoal(CLI::App& command, const char* flag, const char* key, const char* type);
  /// --set takes any number of values and so takes the scene, too, where that follows it: finds it there.
  /// \throws InputError when there is no scene.
  void requireScene();
};

// Standard error: one printable line of bounded length each, whatever a scene or a file name holds.

/// `mortier: text`
void complain(const std::string& text);
/// `mortier: warning: text`, once each
void warn(const std::string& text);
/// Writes out the rest of standard output. A reader that is gone (`mortier run ... | head`) is no error.
/// \throws OutputError when it cannot be written.
void finishStandardOutput();

}  // namespace mortier
