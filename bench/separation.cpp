// Two elastic problems whose whole process is measured against L: bare CHOLMOD once, reading the meshes and
// analysing.
// "patch": [0,1]x[0.5,1] on [0,1]x[0,0.5], 200 against 283 contact edges, uniform pressure, the stress exact.
// "separation": [0,1]x[0.5,1] on [0,2]x[0,0.5], 230 against 320 edges, pressure on [0,0.4] of the top;
// contact opens.
// Both bodies have rollers on x = 0, the lower one also on y = 0; the upper one is held by contact.
// "growing load": the second one while its load spreads from x = 0.1 to 0.9 in 100 steps.
//   bench_separation [--meshes FOLDER] [--cpu] [--rounds N]
// FOLDER holds {patch,separation}-{upper,lower}.mesh (separation.geo); otherwise they are structured.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "bare_cholmod.h"
#include "clock.h"
#include "material/perzyna.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "mesh/read.h"
#include "solver/complementarity.h"
#include "solver/condensed_body.h"
#include "table.h"
#include "time/march.h"

namespace mortier::bench {
namespace {

constexpr double pressure = 10;  // [Pa]

struct Problem {
  const char* name = "";
  const char* figure = "";
  int loadedLabel = 0;  ///< of the upper body
  Rectangle upper;      ///< structured meshes
  Rectangle lower;
  double target = 0;  ///< whole process over L
};

const Problem patch{"patch",
                    "4  patch test, whole process over L",
                    3,
                    {{0, 0.5}, {1, 1}, 200, 117},
                    {{0, 0}, {1, 0.5}, 283, 164},
                    1.1};
const Problem separation{"separation",
                         "5  separation, whole process over L",
                         5,
                         {{0, 0.5}, {1, 1}, 230, 132},
                         {{0, 0}, {2, 0.5}, 320, 93},
                         1.2};

std::string meshFile(const std::string& folder, const Problem& problem, bool upper) {
  return folder + "/" + problem.name + (upper ? "-upper.mesh" : "-lower.mesh");
}

void writeStructuredMeshes(const std::string& folder, const Problem& problem) {
  TriangleMesh upper = rectangleMesh(problem.upper);
  for (size_t e = 0; e < upper.boundaryEdges.size(); ++e) {
    const auto [a, b] = upper.boundaryEdges[e];
    const double middle = (upper.vertices[a].x() + upper.vertices[b].x()) / 2;
    if (upper.boundaryLabels[e] == 3 && problem.loadedLabel == 5 && middle < 0.4) upper.boundaryLabels[e] = 5;
  }
  writeMedit(upper, meshFile(folder, problem, true));
  writeMedit(rectangleMesh(problem.lower), meshFile(folder, problem, false));
}

/// \param fixed  the upper body's bottom too: nothing else holds it without contact.
Body readBody(const std::string& folder, const Problem& problem, bool upper, bool fixed,
              bool growing = false) {
  const Function zero = [](double, double, double) { return 0.0; };
  Conditions conditions;
  conditions.displacements.push_back({4, 0, zero});
  if (!upper || fixed) conditions.displacements.push_back({1, 1, zero});
  if (upper && growing) {
    const Function load = [](double x, double, double t) { return x < 0.1 + 0.8 * t ? -pressure : 0.0; };
    for (const int label : {3, 5}) conditions.tractions.push_back({label, 1, load});
  } else if (upper) {
    conditions.tractions.push_back(
        {problem.loadedLabel, 1, [](double, double, double) { return -pressure; }});
  }
  return {upper ? "upper" : "lower", readMedit(meshFile(folder, problem, upper)),
          elasticMaterial({3e11, 0.3}), std::move(conditions)};
}

Model readModel(const std::string& folder, const Problem& problem, bool growing = false) {
  Model model;
  for (const bool upper : {true, false})
    model.bodies.push_back(readBody(folder, problem, upper, false, growing));
  model.interfaces.emplace_back(ContactPair{{0, 1}, {1, 3}, CouplingKind::mortar}, model.bodies[0].mesh(),
                                model.bodies[1].mesh());
  return model;
}

struct Solution {
  State state;
  StepReport report;
  RunReport run;
};

Solution solve(const Model& model) {
  Solution solution;
  solution.state = initialState(model);
  solution.run = march(model, solution.state, {}, {},
                       [&](const State&, const StepReport& step) { solution.report = step; });
  return solution;
}

/// The contact problem alone, from all nodes active, after the factorisations that it rests on.
struct Pivots {
  int count = 0;
  double secondsEach = 0;
  double factorisation = 0;  ///< [s]
};

Pivots contactPivots(const Model& model) {
  const std::vector<int> firstRow{0, model.interfaces[0].rows()};
  const int rows = firstRow.back();
  const State state = initialState(model);
  ContactProblem problem;
  problem.W = Matrix::Zero(rows, rows);
  Vector slack = model.interfaces[0].initialDistance();
  std::vector<Matrix> normalMotions;
  std::vector<Vector> rigidForces;
  Pivots result;
  for (const int b : {0, 1}) {
    const Body& body = model.bodies[b];
    CondensedBody system(model, b, firstRow, SolverOptions{}, Threads::none());
    BodyIterate iterate{Vector::Zero(body.dofs()), Vector::Zero(body.dofs()), state.bodies[b].stress,
                        Matrix::Zero(3, body.points())};
    system.linearise(nullptr, iterate, {[&](const BodyIterate& at, Linearisation& law, int begin, int end) {
                       return body.material().linearise({0, state.bodies[b].stress, at.strain}, at.stress,
                                                        law, begin, end);
                     }});
    const ContactDofs& dofs = system.contact();
    result.factorisation += secondsOf([&] { system.factorise(); });
    slack -= dofs.C * system.condense(body.load(1));
    system.addCompliance(problem.W);
    normalMotions.emplace_back(dofs.C * dofs.R);
    rigidForces.push_back(dofs.rigidForce(body.load(1)));
  }
  problem.G.resize(rows, normalMotions[0].cols() + normalMotions[1].cols());
  problem.G << normalMotions[0], normalMotions[1];
  Vector balance(problem.G.cols());
  balance << rigidForces[0], rigidForces[1];
  const double total = secondsOf([&] {
    result.count =
        solveContact(problem, slack, Vector::Zero(rows), balance, std::vector<char>(rows, 1)).pivots;
  });
  result.secondsEach = total / result.count;
  return result;
}

void printPatch(const Model& model, const Solution& solution) {
  double worst = 0;
  for (const BodyState& body : solution.state.bodies)
    for (Eigen::Index i = 0; i < body.stress.cols(); ++i) {
      const Eigen::Vector3d s = toCartesian(body.stress.col(i)) - Eigen::Vector3d(0, -pressure, 0);
      worst = std::max(worst, s.cwiseAbs().maxCoeff() / pressure);
    }
  std::printf("  largest stress error over the pressure %.2g, %d contact nodes\n", worst,
              model.interfaces[0].rows());
}

void printSeparation(const Model& model, const Solution& solution) {
  const ContactInterface& interface = model.interfaces[0];
  const Vector& p = solution.state.contactForce[0];
  const Vector gap =
      interface.gap(solution.state.bodies[0].displacement, solution.state.bodies[1].displacement);
  double last = 0;
  double end = 0;
  double open = 0;
  for (int i = 0; i < interface.rows(); ++i) {
    const double x = model.bodies[0].mesh().vertices[interface.nonmortarNodes()[i]].x();
    if (p[i] > 0) last = std::max(last, x);
    if (x >= end) {
      end = x;
      open = -gap[i];
    }
  }
  std::printf(
      "  peak pressure %.4f (8.780), last node in contact %.4f (0.7130), gap at x = %g %.5g m (6.2666e-12)\n",
      solution.report.maxPressure, last, end, open);
}

void measureGrowingLoad(const std::string& folder) {
  constexpr int steps = 100;
  const Model model = readModel(folder, separation, true);
  State state = initialState(model);
  TimePlan plan;
  plan.steps = steps;
  int changed = 0;
  int smallest = model.interfaces[0].rows();
  int largest = 0;
  const RunReport run = march(model, state, plan, {}, [&](const State&, const StepReport& step) {
    if (step.step == 0) return;
    changed += step.joined + step.left > 0 ? 1 : 0;
    smallest = std::min(smallest, step.active);
    largest = std::max(largest, step.active);
  });
  std::printf("growing load: %d steps, contact changed in %d of them, %d to %d of %d nodes, %s\n", run.steps,
              changed, smallest, largest, model.interfaces[0].rows(), run.reason.c_str());
  const size_t triangles = model.bodies[0].mesh().triangles.size() + model.bodies[1].mesh().triangles.size();
  printRow("6  factorisations in the whole run, two bodies", static_cast<double>(triangles),
           run.factorisations, 2);
}

void measure(const std::string& folder, const Problem& problem, int rounds) {
  const Model model = readModel(folder, problem);
  const Solution solution = solve(model);
  if (solution.run.status != Status::converged) {
    std::printf("%s: failed: %s\n", problem.name, solution.run.reason.c_str());
    return;
  }
  const auto triangles =
      static_cast<double>(model.bodies[0].mesh().triangles.size() + model.bodies[1].mesh().triangles.size());
  std::printf("%s: %.0f triangles, %d factorisations, force balance %.1g\n", problem.name, triangles,
              solution.run.factorisations, solution.run.worst.forceBalance);
  if (problem.loadedLabel == 3)
    printPatch(model, solution);
  else
    printSeparation(model, solution);
  const Pivots pivots = contactPivots(model);
  std::printf("  contact: %d pivots (%d changes of the active set)\n", pivots.count, pivots.count - 1);

  BareCholmod bare;
  for (const bool upper : {true, false}) bare.add(readBody(folder, problem, upper, true));
  std::vector<double> unit;
  std::vector<double> whole;
  std::vector<double> parts[3];
  for (int round = 0; round < rounds; ++round) {
    parts[0].push_back(secondsOf([&] {
      for (const bool upper : {true, false}) readMedit(meshFile(folder, problem, upper));
    }));
    parts[1].push_back(secondsOf([&] { bare.analyse(); }));
    parts[2].push_back(secondsOf([&] { bare.factoriseAndSolve(1); }));
    unit.push_back(parts[0].back() + parts[1].back() + parts[2].back());
    whole.push_back(secondsOf([&] { solve(readModel(folder, problem)); }));
  }
  std::printf("  L = reading %.0f %% + analysing %.0f %% + CHOLMOD %.0f %%\n",
              100 * median(parts[0]) / median(unit), 100 * median(parts[1]) / median(unit),
              100 * median(parts[2]) / median(unit));
  printRow(problem.figure, triangles, median(whole) / median(unit), problem.target);
  printRow("5  change of the active set over a factorisation", triangles,
           pivots.secondsEach / pivots.factorisation, 0.02);
}

}  // namespace
}  // namespace mortier::bench

int main(int argc, char** argv) {
  using namespace mortier::bench;
  std::string folder;
  int rounds = 5;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--meshes") == 0 && i + 1 < argc) {
      folder = argv[++i];
    } else if (std::strcmp(argv[i], "--cpu") == 0) {
      timeOf = TimeOf::processor;
    } else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc && std::atoi(argv[i + 1]) > 0) {
      rounds = std::atoi(argv[++i]);
    } else {
      std::fprintf(stderr, "usage: bench_separation [--meshes FOLDER] [--cpu] [--rounds N]\n");
      return EXIT_FAILURE;
    }
  }
  const bool structured = folder.empty();
  if (structured) {
    std::string name = (std::filesystem::temp_directory_path() / "mortier-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) return EXIT_FAILURE;
    folder = name;
    for (const Problem* problem : {&patch, &separation}) writeStructuredMeshes(folder, *problem);
  }
  for (const Problem* problem : {&patch, &separation}) mortier::bench::measure(folder, *problem, rounds);
  mortier::bench::measureGrowingLoad(folder);
  if (structured) std::filesystem::remove_all(folder);
  return EXIT_SUCCESS;
}
