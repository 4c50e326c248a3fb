#include "scene/read_time.h"

#include <algorithm>

#include "base/error.h"
#include "scene/table_reader.h"
#include "scene/words.h"

namespace mortier {

namespace {

std::vector<double> readBreaks(const TableReader& time, double end) {
  std::vector<double> breaks;
  const Node* node = time.find("breaks");
  if (node == nullptr) {
    return breaks;
  }
  const std::string expected = "an array of times between 0 and end = " + shortest(end);
  if (!node->isArray()) {
    time.reject("breaks", expected);
  }
  for (const Node& element : node->elements) {
    if (!element.isNumeric() || !(element.value > 0 && element.value < end)) {
      throw InputError(
          time.message(element.where, "breaks has " + element.quoted() + ", expected " + expected));
    }
    breaks.push_back(element.value);
  }
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

}  // namespace

TimePlan readTime(const Node& node) {
  const TableReader time(node, "time", "time");
  TimePlan plan;
  plan.end = time.number("end", above(0));
  plan.scheme = static_cast<Scheme>(time.oneOf("scheme", schemeWords, 0));
  if (time.find("tolerance") == nullptr) {
    plan.steps = time.integer("steps", 1);
    for (const char* key : {"max_steps", "breaks"}) {
      if (time.find(key) != nullptr) {
        time.reject(key, "it only beside tolerance: without, steps are equal");
      }
    }
    return plan;
  }
  plan.tolerance = time.number("tolerance", between(0, 1));
  plan.steps = time.integer("steps", 1, 0);
  plan.maxSteps = time.integer("max_steps", 1, plan.maxSteps);
  plan.breaks = readBreaks(time, plan.end);
  if (plan.scheme == Scheme::crankNicolson) {
    time.reject("scheme", "sdirk2 or backward-euler beside tolerance: crank-nicolson has no error estimate");
  }
  return plan;
}

}  // namespace mortier
