// Two elastic problems whose whole process is measured against L: CHOLMOD alone (supernodal, METIS, OpenBLAS)
// once, reading the meshes and analysing.
// "patch": [0,1]x[0.5,1] on [0,1]x[0,0.5], 200 against 283 contact edges, uniform pressure, the stress exact.
// "separation": [0,1]x[0.5,1] on [0,2]x[0,0.5], 230 against 320 edges, pressure on [0,0.4] of the top;
// contact opens.
// Both bodies have rollers on x = 0, the lower one also on y = 0; the upper one is held by contact.
// "growing load": the second one while its load spreads from x = 0.1 to 0.9 in 100 steps.
//   separation [--cpu] [--rounds N]        --cpu: processor time, on a machine that others use
#include <cblas.h>
#include <cholmod.h>
#include <omp.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "material/perzyna.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "mesh/read.h"
#include "time/march.h"

namespace mortier::bench {
namespace {

constexpr double pressure = 10;  // [Pa]

clockid_t timeOf = CLOCK_MONOTONIC;

template <class Work>
double secondsOf(const Work& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(timeOf, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double begin = now();
  work();
  return now() - begin;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void printRow(const char* name, double triangles, double value, double target) {
  std::printf("%-58s %9.3g %9.3f   <= %6.3g   %s\n", name, triangles, value, target,
              value <= target ? "met" : "NOT met");
}

/// CHOLMOD on the elastic stiffness of one body. OpenMP has one thread: Debian's CHOLMOD starts a team in
/// every supernode.
class BareCholmod {
 public:
  /// Keeps a copy of the body's stiffness, not the body. \pre its supports hold it.
  explicit BareCholmod(const Body& body) {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    Linearisation law;
    law.predictor.resize(3, body.points());
    law.moduli.resize(9, body.points());
    const Matrix zero = Matrix::Zero(3, body.points());
    body.material().linearise({0, zero, zero}, zero, law, 0, body.points());
    std::vector<double> values;
    body.tangent(law.moduli, values);
    const SparsePattern& pattern = body.pattern();
    K_ = cholmod_allocate_sparse(pattern.size, pattern.size, pattern.entries(), 1, 1, -1, CHOLMOD_REAL,
                                 &common_);
    right_ = cholmod_ones(pattern.size, 1, CHOLMOD_REAL, &common_);
    std::copy(pattern.columnStart.begin(), pattern.columnStart.end(), static_cast<int*>(K_->p));
    std::copy(pattern.rows.begin(), pattern.rows.end(), static_cast<int*>(K_->i));
    std::copy(values.begin(), values.end(), static_cast<double*>(K_->x));
  }
  BareCholmod(const BareCholmod&) = delete;
  BareCholmod& operator=(const BareCholmod&) = delete;
  ~BareCholmod() {
    cholmod_free_sparse(&K_, &common_);
    cholmod_free_dense(&right_, &common_);
    cholmod_free_factor(&L_, &common_);
    cholmod_finish(&common_);
  }

  void analyse() {
    cholmod_free_factor(&L_, &common_);
    L_ = cholmod_analyze(K_, &common_);
    if (L_ == nullptr) throw std::runtime_error("CHOLMOD: the analysis failed");
  }
  void factoriseAndSolve() {
    cholmod_factorize(K_, L_, &common_);
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, L_, right_, &common_);
    if (common_.status != CHOLMOD_OK) throw std::runtime_error("CHOLMOD: the stiffness is singular");
    cholmod_free_dense(&solution, &common_);
  }

 private:
  cholmod_common common_{};
  cholmod_sparse* K_ = nullptr;
  cholmod_dense* right_ = nullptr;
  cholmod_factor* L_ = nullptr;
};

struct Problem {
  const char* name = "";
  const char* figure = "";
  int loadedLabel = 0;  ///< of the upper body
  Rectangle upper;      ///< structured meshes
  Rectangle lower;
  double target = 0;  ///< whole process over L
};

const Problem patch{"patch",
                    "patch test, whole process over L",
                    3,
                    {{0, 0.5}, {1, 1}, 200, 117},
                    {{0, 0}, {1, 0.5}, 283, 164},
                    1.1};
const Problem separation{"separation",
                         "separation, whole process over L",
                         5,
                         {{0, 0.5}, {1, 1}, 230, 132},
                         {{0, 0}, {2, 0.5}, 320, 93},
                         1.2};

std::string meshFile(const std::string& folder, const Problem& problem, bool upper) {
  return folder + "/" + problem.name + (upper ? "-upper.mesh" : "-lower.mesh");
}

void writeMeshes(const std::string& folder, const Problem& problem) {
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
  printRow("factorisations in the whole run, two bodies", static_cast<double>(triangles), run.factorisations,
           2);
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

  BareCholmod bare[]{BareCholmod(readBody(folder, problem, true, true)),
                     BareCholmod(readBody(folder, problem, false, true))};
  omp_set_num_threads(1);
  openblas_set_num_threads(1);
  std::vector<double> unit;
  std::vector<double> whole;
  std::vector<double> parts[3];
  for (int round = 0; round < rounds; ++round) {
    parts[0].push_back(secondsOf([&] {
      for (const bool upper : {true, false}) readMedit(meshFile(folder, problem, upper));
    }));
    parts[1].push_back(secondsOf([&] {
      for (BareCholmod& body : bare) body.analyse();
    }));
    parts[2].push_back(secondsOf([&] {
      for (BareCholmod& body : bare) body.factoriseAndSolve();
    }));
    unit.push_back(parts[0].back() + parts[1].back() + parts[2].back());
    whole.push_back(secondsOf([&] { solve(readModel(folder, problem)); }));
  }
  std::printf("  L = reading %.0f %% + analysing %.0f %% + CHOLMOD %.0f %%\n",
              100 * median(parts[0]) / median(unit), 100 * median(parts[1]) / median(unit),
              100 * median(parts[2]) / median(unit));
  printRow(problem.figure, triangles, median(whole) / median(unit), problem.target);
}

}  // namespace
}  // namespace mortier::bench

int main(int argc, char** argv) {
  using namespace mortier::bench;
  int rounds = 5;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--cpu") == 0) {
      timeOf = CLOCK_PROCESS_CPUTIME_ID;
    } else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc && std::atoi(argv[i + 1]) > 0) {
      rounds = std::atoi(argv[++i]);
    } else {
      std::fprintf(stderr, "usage: separation [--cpu] [--rounds N]\n");
      return EXIT_FAILURE;
    }
  }
  std::string folder = (std::filesystem::temp_directory_path() / "mortier-bench-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return EXIT_FAILURE;
  for (const Problem* problem : {&patch, &separation}) {
    writeMeshes(folder, *problem);
    measure(folder, *problem, rounds);
  }
  measureGrowingLoad(folder);
  std::filesystem::remove_all(folder);
  return EXIT_SUCCESS;
}
