// mortier: contact of elastic and viscoplastic bodies with incompatible meshes.
#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "base/error.h"
#include "base/heap.h"
#include "commands/command_line.h"
#include "linear/blas.h"
#include "linear/distributed_engine.h"

using namespace mortier;

namespace {

/// In the order of --help.
constexpr std::array addCommand{addRun, addMesh,  addKeys, addCheck,  addFreefem,
                                addLaw, addStudy, addPlot, addReport, addCompare};

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
  std::array<Command, addCommand.size()> commands;
  for (size_t i = 0; i < commands.size(); ++i) commands[i] = addCommand[i](app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exitDone : exitWrongInput;
  }
  for (const Command& command : commands)
    if (command.options->parsed()) return command.work();
  std::fputs(app.help().c_str(), stderr);
  return exitWrongInput;
}

int complainOf(const std::string& text, int code) {
  complain(text);
  endProcesses();
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  // A reader that goes away and a file that may not grow are errors of a write, not the end of the program.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  keepHeap();
  dense::endThreadsOfBlas();
  try {
    startProcesses(argc, argv);
    const int code = dispatch(argc, argv);
    finishStandardOutput();
    endProcesses();
    return code;
  } catch (const InputError& error) {
    return complainOf(error.what(), exitWrongInput);
  } catch (const UnheldBodyError& error) {
    return complainOf(error.what(), exitUnheld);
  } catch (const std::bad_alloc&) {
    return complainOf("out of memory", exitFailed);
  } catch (const std::exception& error) {
    return complainOf(error.what(), exitFailed);
  }
}
