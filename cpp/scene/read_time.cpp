#include <algorithm>

#include "base/error.h"
#include "scene/readers.h"

namespace mortier {

namespace {

std::vector<double> readBreaks(const TableReader& time, double end) {
  std::vector<double> breaks;
  if (!time.has("breaks")) return breaks;
  const Node& node = *time.find("breaks");
  const std::string expected = "an array of times between 0 and end = " + shortest(end);
  if (!node.isArray()) time.reject("breaks", expected);
  for (const Node& element : node.elements) {
    if (!element.isNumeric() || !(element.value > 0 && element.value < end))
      time.refuse(element, "breaks has " + element.quoted() + ", expected " + expected);
    breaks.push_back(element.value);
  }
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

}  // namespace

TimePlan readTime(const Node& node) {
  const TableReader time(node, "time", "time");
  TimePlan plan;
  plan.end = time.number("end");
  plan.scheme = time.choice<Scheme>("scheme");
  if (!time.has("tolerance")) {
    plan.steps = time.integer("steps");
    time.rejectIfGiven({"max_steps", "breaks"}, "it only beside tolerance: without, steps are equal");
    return plan;
  }
  plan.tolerance = time.number("tolerance");
  plan.steps = time.integer("steps", 0);
  plan.maxSteps = time.integer("max_steps");
  plan.breaks = readBreaks(time, plan.end);
  if (plan.scheme == Scheme::crankNicolson)
    time.reject("scheme", "sdirk2 or backward-euler beside tolerance: crank-nicolson has no error estimate");
  return plan;
}

}  // namespace mortier
