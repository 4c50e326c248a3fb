// Which side should be nonmortar? Measured: 500 random pairs of meshes and materials on the contact with an
// exact solution (tests/theory/half_open_contact.h), each solved with either side nonmortar, the energy
// errors compared, and rules judged by how often they choose a side that is at most 10 % worse than the
// better one.
//
//   bench_nonmortar_side [pairs] [seed]
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>

#include "theory/half_open_contact.h"

namespace {

using namespace mortier;
using namespace mortier::scenes;

struct MeshPair {
  int cells[2];  // of the upper and the lower body
  double young[2];
  double poisson[2];
  double error[2];  // with the upper, the lower body nonmortar
};

double energyError(const MeshPair& pair, CouplingKind coupling, int nonmortar) {
  const HalfOpenContact upper({pair.young[0], pair.poisson[0]}, false);
  const HalfOpenContact lower({pair.young[1], pair.poisson[1]}, true);
  const Model model = contactModel(upper.body(pair.cells[0]), lower.body(pair.cells[1]), coupling, nonmortar);
  const auto [state, report] = run(model, 1, 1);
  if (report.status != Status::converged) return INFINITY;
  double error = 0;
  double norm = 0;
  upper.addEnergies(model.bodies[0], state.bodies[0].stress, error, norm);
  lower.addEnergies(model.bodies[1], state.bodies[1].stress, error, norm);
  return std::sqrt(error / norm);
}

struct Rule {
  const char* text;
  std::function<int(const MeshPair&)> side;
};

}  // namespace

int main(int count, char** arguments) {
  const int pairs = count > 1 ? std::atoi(arguments[1]) : 500;
  std::mt19937 random(count > 2 ? static_cast<unsigned>(std::atoi(arguments[2])) : 1);
  std::uniform_real_distribution<double> unit(0, 1);
  const Rule rules[] = {
      {"upper", [](const MeshPair&) { return 0; }},
      {"finer mesh", [](const MeshPair& p) { return p.cells[0] >= p.cells[1] ? 0 : 1; }},
      {"coarser mesh", [](const MeshPair& p) { return p.cells[0] >= p.cells[1] ? 1 : 0; }},
      {"softer body", [](const MeshPair& p) { return p.young[0] <= p.young[1] ? 0 : 1; }},
      {"stiffer body", [](const MeshPair& p) { return p.young[0] <= p.young[1] ? 1 : 0; }},
      {"softer or finer",
       [](const MeshPair& p) {
         constexpr double clearly = 100;  // as scene/sides.cpp
         if (p.young[0] > clearly * p.young[1] || p.young[1] > clearly * p.young[0])
           return p.young[0] <= p.young[1] ? 0 : 1;
         return p.cells[0] >= p.cells[1] ? 0 : 1;
       }},
      {"larger E h",
       [](const MeshPair& p) { return p.young[0] / p.cells[0] >= p.young[1] / p.cells[1] ? 0 : 1; }},
      {"smaller E h",
       [](const MeshPair& p) { return p.young[0] / p.cells[0] >= p.young[1] / p.cells[1] ? 1 : 0; }},
      {"larger E / h",
       [](const MeshPair& p) { return p.young[0] * p.cells[0] >= p.young[1] * p.cells[1] ? 0 : 1; }},
      {"smaller E / h",
       [](const MeshPair& p) { return p.young[0] * p.cells[0] >= p.young[1] * p.cells[1] ? 1 : 0; }},
  };
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation}) {
    std::vector<MeshPair> all;
    for (int i = 0; i < pairs; ++i) {
      MeshPair pair{};
      for (const int b : {0, 1}) {
        pair.cells[b] = static_cast<int>(std::lround(4 * std::pow(10, unit(random))));
        pair.young[b] = std::pow(10, 3 * unit(random));
        pair.poisson[b] = 0.45 * unit(random);
      }
      for (const int b : {0, 1}) pair.error[b] = energyError(pair, coupling, b);
      all.push_back(pair);
      if (std::getenv("PAIRS") != nullptr)
        std::printf("%3d %3d  %9.3e  %9.3e  %9.3e\n", pair.cells[0], pair.cells[1],
                    pair.young[0] / pair.young[1], pair.error[0], pair.error[1]);
    }
    std::printf("%s, %d pairs: nonmortar is the side of the ...\n",
                coupling == CouplingKind::mortar ? "mortar" : "interpolation", pairs);
    for (const Rule& rule : rules) {
      int good = 0;
      double worst = 1;
      for (const MeshPair& pair : all) {
        const double ratio = pair.error[rule.side(pair)] / std::min(pair.error[0], pair.error[1]);
        good += ratio <= 1.1 ? 1 : 0;
        worst = std::max(worst, ratio);
      }
      std::printf(
          "  %-14s at most 10 %% worse than the better side in %5.1f %% of the pairs, worst %.2f times\n",
          rule.text, 100.0 * good / pairs, worst);
    }
  }
}
