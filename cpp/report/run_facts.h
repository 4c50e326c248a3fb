// Facts of the scene that reports show and the model does not have, so that reports need not know scenes.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "solver/model.h"
#include "time/quantity.h"

namespace mortier {

/// "a, b, c"; `none` where there is none.
inline std::string joined(const std::set<std::string>& words, const std::string& none = "") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? none : text;
}

/// The laws of a body in a line, each once: "Perzyna (frobenius), elastic".
inline std::string lawsOf(const Body& body) {
  if (body.rigid()) return "rigid";
  std::set<std::string> names;
  for (const LawDescription& law : body.material().laws()) names.insert(law.text());
  return joined(names);
}

/// Of the rounds on ever better meshes by which an accuracy is reached.
struct RoundFacts {
  size_t elements = 0;
  int unknowns = 0;
  int steps = 0;
  double mesh = 0;  ///< estimated errors, relative
  double time = 0;
  double seconds = 0;                   ///< wall time
  std::vector<double> quantities = {};  ///< their values at the end
};

struct RunFacts {
  std::string scene;      ///< path of the scene
  std::string sceneText;  ///< the file as it was read
  std::string title;
  Units units;                        ///< of all numbers
  std::string plane = "stress";       ///< "stress" or "strain"
  std::vector<std::string> settings;  ///< --set, as given
  std::vector<std::string> variants;  ///< per interface: the word of the coupling
  std::vector<std::string>
      choices;             ///< per interface: why its nonmortar side is that; empty where the scene says it
  std::string contact;     ///< all variants, each once; "none" without an interface
  std::string nonmortar;   ///< names of the nonmortar bodies; "none" without an interface
  std::string projection;  ///< all projections, each once; "none" where every body is elastic
  std::string scheme;
  int plannedSteps = 0;
  double tolerance = 0;  ///< of a step; 0: equal steps
  int threads = 1;
  SolverOptions solver;
  double accuracy = 0;               ///< asked for, relative, in the energy norm; 0: none
  std::string aim;                   ///< the quantity of which it is asked for; empty: the stress
  bool reached = false;              ///< that
  std::vector<RoundFacts> rounds;    ///< none where no accuracy is asked for
  size_t best = 0;                   ///< the round of the result, from 0
  std::vector<Quantity> quantities;  ///< that the scene asks for
  std::vector<std::string>
      doubts;           ///< where the estimate of the accuracy is known to be wrong, and by how much
  std::string driving;  ///< what drives the step that failed (plan/loads.h)
  std::vector<std::pair<std::string, std::string>> versions;  ///< of mortier and its libraries
};

}  // namespace mortier
