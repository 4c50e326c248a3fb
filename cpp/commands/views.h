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
  bool raw = false;  ///< stresses of the triangles, not recovered at the vertices
};

/// `mortier report`: one HTML file of results, made in views/ as well.
struct ReportCommand {
  std::vector<std::string> results;
  std::string out;  ///< empty: <result>.html
};

/// `mortier compare`: a scene in both codes, or its run beside a result that was kept; made in views/ as
/// well.
struct CompareCommand {
  std::string scene;
  std::vector<std::string> settings;  ///< key=value
  std::vector<std::string> against;   ///< a result, its numbers, BODY=FILE.vtu; empty: FreeFEM
  std::string accept;                 ///< folder of the result, or FILE.json; empty: compare
  std::string within;                 ///< relative difference that is allowed; empty: that of rounding
  std::string picture;                ///< of the difference; empty: <scene>.difference.png where they differ
};

/// Do not return unless Python or the program in views/ cannot be found. \throws OutputError
int plot(const PlotCommand& command);
int report(const ReportCommand& command);
int compare(const CompareCommand& command);

}  // namespace mortier
