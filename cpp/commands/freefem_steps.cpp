#include "commands/freefem_steps.h"

#include <charconv>
#include <sstream>

#include "base/error.h"
#include "base/whole_file.h"

namespace mortier {
namespace {

/// The cells of a line without quotes.
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result(1);
  for (const char c : line)
    if (c == ',')
      result.emplace_back();
    else if (c != '\r')
      result.back() += c;
  return result;
}

}  // namespace

std::vector<double> stepsOfRun(const std::string& folder, double end) {
  const std::string path = folder + "/history.csv";
  const auto refuse = [&](int line, const std::string& what, const std::string& expected) {
    throw InputError(path + (line > 0 ? ':' + std::to_string(line) : "") + ": " + what + ", expected " +
                     expected);
  };
  std::istringstream file(readWhole(path, "the history of a run"));
  std::string line;
  if (!std::getline(file, line)) refuse(0, "cannot be read", "the history of a run");
  size_t column = 0;
  const std::vector<std::string> names = cells(line);
  while (column < names.size() && names[column].compare(0, 5, "time[") != 0) ++column;
  if (column == names.size()) refuse(1, "no column time[...]", "the history of a run");
  std::vector<double> times;
  for (int number = 2; std::getline(file, line); ++number) {
    const std::vector<std::string> row = cells(line);
    double time = 0;
    const std::string text = column < row.size() ? row[column] : "";
    const auto [rest, fault] = std::from_chars(text.data(), text.data() + text.size(), time);
    if (number == 2 && text == "0") continue;  // what acts at once is no step
    const double last = times.empty() ? 0 : times.back();
    if (fault != std::errc() || rest != text.data() + text.size() || !(time > last) || !(time <= end))
      refuse(number, "time " + text, "a number above the one before, up to the end of the scene");
    times.push_back(time);
  }
  if (times.empty() || times.back() != end)
    refuse(0, "no step to the end of the scene", "a run that has ended");
  return times;
}

}  // namespace mortier
