// mortier: contact of elastic and viscoplastic bodies with incompatible meshes.
#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <new>

#include "base/error.h"
#include "base/ranks.h"
#include "commands/check.h"
#include "commands/complain.h"
#include "commands/exit_code.h"
#include "commands/freefem.h"
#include "commands/law.h"
#include "commands/mesh_options.h"
#include "commands/run.h"
#include "commands/scene_argument.h"
#include "commands/study.h"
#include "commands/version.h"
#include "commands/views.h"
#include "linear/dense_kernels.h"
#include "scene/keys.h"

using namespace mortier;

namespace {

constexpr const char* settingsHelp =
    "change a key of the scene, e.g. time.steps=20, contact.variant=interpolation, body.upper.mesh=FILE "
    "(mortier keys lists them)";

int dispatch(int argc, char** argv) {
  CLI::App app(
      "Contact of elastic and viscoplastic bodies with incompatible meshes.\n"
      "Exit codes: 0 done, 1 a step cannot be solved, output cannot be written or interrupted, 2 wrong "
      "input, "
      "3 nothing holds a body.",
      "mortier");
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return "mortier: " + std::string(error.what()) + " (see mortier --help)\n";
  });
  app.get_formatter()->label("TEXT", "");
  app.get_formatter()->label("REQUIRED", "(required)");
  app.set_version_flag("--version", std::string("mortier ") + version);

  RunCommand runCommand;
  CLI::App* runApp = app.add_subcommand("run", "solve a scene (docs/scene.md) and write its result");
  runApp->add_option("SCENE", runCommand.scene, "scene, a TOML file");
  CLI::Option* out = runApp->add_option("--out", runCommand.out,
                                        "folder of the result (default: out/ and the scene's name)");
  out->type_name("DIR");
  runApp->add_option("--restart", runCommand.restart, "resume the interrupted run that was writing to DIR")
      ->type_name("DIR")
      ->excludes(out);
  runApp
      ->add_option("--checkpoint", runCommand.checkpoint,
                   "wall time between checkpoints [s] (default 30; 0: after every step)")
      ->check([](const std::string& text) {
        const double seconds = std::strtod(text.c_str(), nullptr);
        return std::isfinite(seconds) && seconds >= 0 ? std::string() : text + ", expected a number >= 0";
      })
      ->type_name("SECONDS");
  runApp->add_option("--set", runCommand.settings, settingsHelp)->type_name("KEY=VALUE");
  const auto addGoal = [](CLI::App* to, std::vector<std::string>& settings, const char* flag, const char* key,
                          const char* type) {
    const Key& known = keyAt("accuracy", key);
    to->add_option_function<std::string>(
          flag,
          [&settings, key](const std::string& value) {
            settings.push_back(std::string("accuracy.") + key + "=" + value);
          },
          helpOf(known) + (known.range.holds(std::atof(known.fallback.c_str()))
                               ? " (default " + known.fallback + ")"
                               : ""))
        ->type_name(type);
  };
  addGoal(runApp, runCommand.settings, "--accuracy", "energy", "E");
  addGoal(runApp, runCommand.settings, "--max-unknowns", "max_unknowns", "N");
  addGoal(runApp, runCommand.settings, "--max-seconds", "max_seconds", "SECONDS");
  runApp->add_option("--threads", runCommand.threads, "threads (default 1)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  runApp->add_flag_callback(
      "--list-solutions", [&runCommand] { runCommand.settings.emplace_back("solver.list_solutions=true"); },
      helpOf(keyAt("solver", "list_solutions")));
  runApp->add_flag("--quiet", runCommand.quiet, "no log and no progress bar");

  const std::function<int()> meshCommand = addMeshCommand(app);

  bool documented = false;
  CLI::App* keysApp = app.add_subcommand("keys", "all keys of a scene, a line each (docs/scene.md)");
  keysApp->add_flag("--markdown", documented, "as the table of docs/scene.md");

  CheckCommand checkCommand;
  CLI::App* checkApp = app.add_subcommand(
      "check", "say what a run would model and leave out, and what is wrong or doubtful (docs/check.md)");
  checkApp->add_option("SCENE", checkCommand.scene, "scene, a TOML file");
  checkApp->add_option("--set", checkCommand.settings, settingsHelp)->type_name("KEY=VALUE");
  addGoal(checkApp, checkCommand.settings, "--accuracy", "energy", "E");
  checkApp->add_flag("--json", checkCommand.json, "machine-readable");
  checkApp->add_flag("--list", checkCommand.list, "all faults that it knows, and their remedies; no scene");

  FreefemCommand freefemCommand;
  CLI::App* freefemApp = app.add_subcommand("freefem", "write a scene as a FreeFEM script");
  freefemApp->add_option("SCENE", freefemCommand.scene, "scene, a TOML file");
  freefemApp->add_option("FILE", freefemCommand.file, ".edp file to write (default: standard output)");
  freefemApp->add_option("--set", freefemCommand.settings, settingsHelp)->type_name("KEY=VALUE");
  freefemApp
      ->add_option("--steps-of", freefemCommand.stepsOf,
                   "results of a run of the scene, whose steps it takes")
      ->type_name("FOLDER");

  LawCommand lawCommand;
  CLI::App* lawApp = app.add_subcommand(
      "law", "try the laws of a scene at random stresses (docs/check.md); exit code 0 or 1");
  lawApp->add_option("SCENE", lawCommand.scene, "scene, a TOML file");
  lawApp->add_option("--set", lawCommand.settings, settingsHelp)->type_name("KEY=VALUE");
  lawApp->add_option("--stress", lawCommand.stress, "largest stress (default: that of the scene's data)")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  lawApp->add_option("--strain", lawCommand.strain, "largest strain (default: that stress over young)")
      ->check(CLI::PositiveNumber)
      ->type_name("E");
  lawApp->add_option("--samples", lawCommand.samples, "how many stresses (default 100)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");

  StudyCommand studyCommand;
  CLI::App* studyApp = app.add_subcommand("study", "error against cost over a sweep of runs (docs/study.md)");
  studyApp->add_option("STUDY", studyCommand.study, "study, a TOML file")->required();
  studyApp->add_option("--out", studyCommand.out,
                       "folder of the result (default: out/ and the study's name)");
  studyApp->add_option("--jobs", studyCommand.jobs, "runs at once (default: one a processor)")
      ->check(CLI::Range(1, 1024));
  studyApp
      ->add_option("--scheduler", studyCommand.scheduler,
                   "address of a dask scheduler whose workers make the runs (docs/study.md)")
      ->type_name("ADDRESS");
  studyApp->add_flag("--quiet", studyCommand.quiet, "print nothing but errors");

  PlotCommand plotCommand;
  CLI::App* plotApp = app.add_subcommand("plot", "pictures of results, PNG and SVG (docs/pictures.md)");
  plotApp
      ->add_option("OUT", plotCommand.results,
                   "folders of results, also OUT.failed; several are drawn side by side")
      ->required();
  plotApp->add_option("--out", plotCommand.out,
                      "folder of the pictures, or one picture (default: OUT.plots beside the result)");
  plotApp->add_option("--step", plotCommand.step, "a step that was kept (default: the last one)")
      ->type_name("N");
  plotApp
      ->add_option("--field", plotCommand.field,
                   "von_mises (default), s11, s22, s12, s33, u, ux, uy, error ...")
      ->type_name("NAME");
  plotApp->add_option("--scale", plotCommand.scale, "of displacements (default: such that they are seen)")
      ->type_name("X");
  plotApp->add_option("--window", plotCommand.window, "part of the plane (default: all)")
      ->type_name("XMIN,XMAX,YMIN,YMAX");
  plotApp->add_option("--only", plotCommand.only, "one of the pictures (default: all)")
      ->type_name("fields|contact|history");
  plotApp->add_flag("--animate", plotCommand.animate, "a GIF of all steps that were kept as well");
  plotApp->add_flag("--raw", plotCommand.raw, "stresses of the triangles, not recovered at the vertices");

  ReportCommand reportCommand;
  CLI::App* reportApp =
      app.add_subcommand("report", "results as one interactive HTML file (docs/pictures.md)");
  reportApp->add_option("OUT", reportCommand.results, "folders of results; several stand side by side")
      ->required();
  reportApp->add_option("--out", reportCommand.out, "the HTML file (default: OUT.html beside the result)");

  CompareCommand compareCommand;
  CLI::App* compareApp = app.add_subcommand(
      "compare",
      "compare a scene with FreeFEM or with a stored reference (docs/compare.md); exit code 0 or 1");
  compareApp->add_option("SCENE", compareCommand.scene, "scene, a TOML file");
  compareApp->add_option("--set", compareCommand.settings, settingsHelp)->type_name("KEY=VALUE");
  addGoal(compareApp, compareCommand.settings, "--accuracy", "energy", "E");
  compareApp
      ->add_option("--accept", compareCommand.accept,
                   "store the result of the scene as a reference, or its numbers alone as FILE.json")
      ->type_name("FOLDER");
  compareApp
      ->add_option("--against", compareCommand.against,
                   "what --accept or mortier run stored, or BODY=FILE.vtu of another code (default: FreeFEM)")
      ->type_name("FOLDER")
      ->take_all()
      ->expected(1);
  compareApp
      ->add_option(
          "--within", compareCommand.within,
          "largest relative difference from --against (default: that of rounding, on the same meshes)")
      ->type_name("X");
  compareApp
      ->add_option("--picture", compareCommand.picture,
                   "PNG or SVG of the difference (default: SCENE.difference.png where they differ)")
      ->type_name("FILE");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exitDone : exitWrongInput;
  }
  if (*runApp) {
    if (runCommand.restart.empty() || !runCommand.settings.empty()) {
      takeSceneFromSettings(runCommand.settings, runCommand.scene);
    }
    return run(runCommand);
  }
  if (*checkApp) {
    if (!checkCommand.list) {
      takeSceneFromSettings(checkCommand.settings, checkCommand.scene);
    }
    return check(checkCommand);
  }
  if (*keysApp) {
    std::fputs((documented ? documentedKeys() : listedKeys()).c_str(), stdout);
    return exitDone;
  }
  if (*freefemApp) {
    takeSceneFromSettings(freefemCommand.settings, freefemCommand.scene);
    return writeFreefem(freefemCommand);
  }
  if (*lawApp) {
    takeSceneFromSettings(lawCommand.settings, lawCommand.scene);
    return tryLaws(lawCommand);
  }
  if (*studyApp) {
    return study(studyCommand);
  }
  if (*plotApp) {
    return plot(plotCommand);
  }
  if (*reportApp) {
    return report(reportCommand);
  }
  if (*compareApp) {
    takeSceneFromSettings(compareCommand.settings, compareCommand.scene);
    return compare(compareCommand);
  }
  if (app.got_subcommand("mesh")) {
    return meshCommand();
  }
  std::fputs(app.help().c_str(), stderr);
  return exitWrongInput;
}

int complainOf(const std::string& text, int code) {
  if (Ranks::all().end(code)) complain(text);
  Ranks::all().leave();
  return code;
}
}  // namespace

int main(int argc, char** argv) {
  // A reader that goes away and a file that may not grow are errors of a write, not the end of the program.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  dense::endThreadsOfBlas();
  try {
    startRanks(argc, argv);
    const int code = dispatch(argc, argv);
    finishStandardOutput();
    static_cast<void>(Ranks::all().end(code));  // it has told why
    Ranks::all().leave();
    return code;
  } catch (const InputError& error) {
    return complainOf(error.what(), exitWrongInput);
  } catch (const UnheldBodyError& error) {
    return complainOf(error.what(), exitUnheld);
  } catch (const PeerEnded& error) {
    return complainOf(error.what(), error.code());
  } catch (const std::bad_alloc&) {
    return complainOf("out of memory", exitFailed);
  } catch (const std::exception& error) {
    return complainOf(error.what(), exitFailed);
  }
}
