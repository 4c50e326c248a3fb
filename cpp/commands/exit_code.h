// What the program returns to the shell.
#pragma once

namespace mortier {

enum ExitCode {
  exitDone = 0,
  exitFailed = 1,      ///< a step that cannot be solved, or output that cannot be written
  exitWrongInput = 2,  ///< wrong scene, mesh or usage
  exitUnheld = 3       ///< nothing holds a body
};

}  // namespace mortier
