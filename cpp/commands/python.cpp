// Commands that Python programs beside the program do: study/ and views/.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/shipped.h"
#include "commands/command_line.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

/// This process becomes the Python program `folder`/__main__.py that comes with mortier, with these words;
/// MORTIER in its environment is this program. \throws OutputError when Python or the program cannot be found
[[noreturn]] void becomePython(const std::string& folder, const std::vector<std::string>& words) {
  const auto program = shippedFolder(folder, "__main__.py");
  if (!program)
    throw OutputError("the folder " + folder + "/ of mortier (" + folder +
                      "/__main__.py) is found neither above the program nor in share/mortier");
  std::error_code ignored;
  const std::string self = fs::read_symlink("/proc/self/exe", ignored).string();
  if (!self.empty()) setenv("MORTIER", self.c_str(), 1);

  std::string python = pythonProgram();
  std::vector<std::string> all{python, program->string()};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  arguments.reserve(all.size() + 1);
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(python.c_str(), arguments.data());
  throw OutputError(python + ": cannot be run, expected Python 3 (Debian package python3)");
}

/// The options that were given as words for Python. An option and its value are one word, so that a value may
/// begin with a minus; an empty value stands for the default, but for an address, where it is a mistake.
std::vector<std::string> wordsOf(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    const std::string& name = option->get_single_name();
    if (option->get_positional() || option->count() == 0) continue;
    if (option->get_items_expected_max() == 0)
      words.push_back("--" + name);
    else
      for (const std::string& value : option->results())
        if (!value.empty() || name == "scheduler") words.push_back("--" + name + '=' + value);
  }
  return words;
}

/// An option that Python reads.
CLI::Option* addText(CLI::App* command, const char* name, const char* help, const char* type = "TEXT") {
  return command
      ->add_option_function<std::string>(
          name, [](const std::string&) {}, help)
      ->type_name(type);
}

[[noreturn]] void becomeViews(const CLI::App& command, std::vector<std::string> words,
                              const std::vector<std::string>& operands) {
  words.insert(words.begin(), command.get_name());
  words.emplace_back("--");
  words.insert(words.end(), operands.begin(), operands.end());
  becomePython("views", words);
}

/// A command of views/ for the results of runs.
Command addViewOfResults(CLI::App* command, const char* help) {
  const auto results = std::make_shared<std::vector<std::string>>();
  command->add_option("OUT", *results, help)->required();
  return {command, [=]() -> int { becomeViews(*command, wordsOf(*command), *results); }};
}

}  // namespace

Command addStudy(CLI::App& app) {
  CLI::App* command = app.add_subcommand("study", "error against cost over a sweep of runs (docs/study.md)");
  const auto study = std::make_shared<std::string>();
  command->add_option("STUDY", *study, "study, a TOML file")->required();
  addText(command, "--out", "folder of the result (default: out/ and the study's name)");
  command
      ->add_option_function<int>(
          "--jobs", [](int) {}, "runs at once (default: one a processor)")
      ->check(CLI::Range(1, 1024));
  addText(command, "--scheduler", "address of a dask scheduler whose workers make the runs (docs/study.md)",
          "ADDRESS");
  command->add_flag("--quiet")->description("print nothing but errors");
  return {command, [=]() -> int {
            std::vector<std::string> words = wordsOf(*command);
            words.insert(words.end(), {"--", *study});
            becomePython("study", words);
          }};
}

Command addPlot(CLI::App& app) {
  CLI::App* command = app.add_subcommand("plot", "pictures of results, PNG and SVG (docs/pictures.md)");
  Command plot =
      addViewOfResults(command, "folders of results, also OUT.failed; several are drawn side by side");
  addText(command, "--out", "folder of the pictures, or one picture (default: OUT.plots beside the result)");
  addText(command, "--step", "a step that was kept (default: the last one)", "N");
  addText(command, "--field", "von_mises (default), s11, s22, s12, s33, u, ux, uy, error ...", "NAME");
  addText(command, "--scale", "of displacements (default: such that they are seen)", "X");
  addText(command, "--window", "part of the plane, in space of the picture (default: all)",
          "XMIN,XMAX,YMIN,YMAX");
  addText(command, "--view", "in space: from where it is seen, by name or in degrees (default: -60,25)",
          "front|top|contact|AZIMUTH,ELEVATION");
  addText(command, "--only", "one of the pictures (default: all)", "fields|contact|history");
  command->add_flag("--animate")->description("a GIF of all steps that were kept as well");
  command->add_flag("--raw")->description("stresses of the triangles, not recovered at the vertices");
  return plot;
}

Command addReport(CLI::App& app) {
  CLI::App* command = app.add_subcommand("report", "results as one interactive HTML file (docs/pictures.md)");
  Command report = addViewOfResults(command, "folders of results; several stand side by side");
  addText(command, "--out", "the HTML file (default: OUT.html beside the result)");
  return report;
}

Command addCompare(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "compare a scene with FreeFEM or with a stored reference (docs/compare.md); exit code 0 or 1");
  const auto scene = std::make_shared<SceneOptions>();
  scene->addScene(*command);
  scene->addSettings(*command);
  scene->addGoal(*command, "--accuracy", "energy", "E");
  addText(command, "--accept",
          "store the result of the scene as a reference, or its numbers alone as FILE.json", "FOLDER");
  addText(command, "--against",
          "what --accept or mortier run stored, or BODY=FILE.vtu of another code (default: FreeFEM)",
          "FOLDER")
      ->take_all();
  addText(command, "--within",
          "largest relative difference from --against (default: that of rounding, on the same meshes)", "X");
  addText(command, "--picture",
          "PNG or SVG of the difference (default: SCENE.difference.png where they differ)", "FILE");
  return {command, [=]() -> int {
            scene->requireScene();
            std::vector<std::string> words;
            for (const std::string& setting : scene->settings) words.push_back("--set=" + setting);
            for (const std::string& word : wordsOf(*command))
              if (!word.starts_with("--set=") && !word.starts_with("--accuracy=")) words.push_back(word);
            becomeViews(*command, words, {scene->scene});
          }};
}

}  // namespace mortier
