#pragma once

#include <optional>
#include <string>

namespace mortier {

/// `mortier study`: handed over to the Python program in study/, which runs this program again and again.
struct StudyCommand {
  std::string study;
  std::string out;                       ///< empty: out/<study>
  int jobs = 0;                          ///< runs at once; 0: one a processor
  std::optional<std::string> scheduler;  ///< address of a dask scheduler whose workers make the runs
  bool quiet = false;
};

/// Does not return unless Python or the program in study/ cannot be found. \throws OutputError
int study(const StudyCommand& command);

}  // namespace mortier
