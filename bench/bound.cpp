// What a guaranteed bound costs: the construction over one factorisation and one solution by CHOLMOD alone on
// the elastic stiffness of the same meshes, on contact with a known end, where the true error is known too.
//   bench_bound [--cpu] [--rounds N] [cells of the upper body]...
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "bare_cholmod.h"
#include "bound/energy_bound.h"
#include "clock.h"
#include "theory/half_open_contact.h"

namespace {

using namespace mortier;
using namespace mortier::bench;
using namespace mortier::scenes;

void row(int cells, CouplingKind coupling, int rounds) {
  const std::array<HalfOpenContact, 2> exact{{{{1, 0.3}, false}, {{1, 0.3}, true}}};
  const Model model =
      contactModel(exact[0].body(cells), exact[1].body(3 * cells / 2 + 1), coupling, upperBody);
  const State state = run(model, 1, 1).state;
  BareCholmod bare;
  double error = 0;
  double norm = 0;
  size_t triangles = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    bare.add(model.bodies[b]);
    exact[b].addEnergies(model.bodies[b], state.bodies[b].stress, error, norm);
    triangles += model.bodies[b].mesh().triangles.size();
  }
  bare.analyse();
  std::vector<double> unit;
  std::vector<double> cost;
  EnergyBound bound;
  for (int i = 0; i < rounds; ++i) {
    unit.push_back(secondsOf([&] { bare.factoriseAndSolve(1); }));
    cost.push_back(secondsOf([&] { bound = energyBound(model, state); }));
  }
  std::printf("%9zu %-14s %8.0f %8.0f %6.2f %8.3f %9.1e   %s\n", triangles, nameOf(coupling),
              1e9 * median(unit) / static_cast<double>(triangles),
              1e9 * median(cost) / static_cast<double>(triangles), median(cost) / median(unit),
              bound.bound / std::sqrt(error), bound.imbalance, bound.obstacle.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> cells;
  int rounds = 3;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--cpu") == 0)
      timeOf = TimeOf::processor;
    else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc)
      rounds = std::atoi(argv[++i]);
    else
      cells.push_back(std::atoi(argv[i]));
  }
  if (cells.empty()) cells = {39, 78, 157};
  std::printf("%9s %-14s %8s %8s %6s %8s\n", "triangles", "", "unit/ns", "bound/ns", "over", "sharp");
  for (const int each : cells)
    for (const CouplingKind coupling : couplings) row(each, coupling, rounds);
  return 0;
}
