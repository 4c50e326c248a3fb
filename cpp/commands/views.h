#pragma once

#include <string>
#include <vector>

namespace mortier {

/// `mortier plot`: pictures of results, handed over to the Python program in views/.
struct PlotCommand {
  std::vector<std::string> results;
  std::string out;     ///< a folder, or one picture; empty: <result>.plots
  std::string step;    ///< empty: the last one that was kept
  std::string field;   ///< empty: von_mises
  std::string scale;   ///< of the displacements; empty: such that they are seen
  std::string window;  ///< XMIN,XMAX,YMIN,YMAX; empty: everything
  std::string only;    ///< fields, contact or history; empty: all
  bool animate = false;
};

/// `mortier report`: one HTML file of results, made in views/ as well.
struct ReportCommand {
  std::vector<std::string> results;
  std::string out;  ///< empty: <result>.html
};

/// Do not return unless Python or the program in views/ cannot be found. \throws OutputError
int plot(const PlotCommand& command);
int report(const ReportCommand& command);

}  // namespace mortier
