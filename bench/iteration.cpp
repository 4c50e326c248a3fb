// One viscoplastic Newton iteration, everything included, against bare CHOLMOD on the elastic stiffness of
// the same meshes: time, threads, coupling, memory and growth, each beside its target (docs/benchmarks.md).
//   bench_iteration [--million] [--cpu] [--rounds N]
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "bare_cholmod.h"
#include "clock.h"
#include "squares.h"
#include "table.h"
#include "time/march.h"

namespace mortier::bench {
namespace {

/// Slope of log y over log x by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]);
    const double v = std::log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

struct Variant {
  const char* name = "";
  Projection projection = Projection::frobenius;
  CouplingKind coupling = CouplingKind::mortar;
  int threads = 1;
};

constexpr Variant variants[] = {
    {"frobenius", Projection::frobenius, CouplingKind::mortar, 1},
    {"frobenius, 2 threads", Projection::frobenius, CouplingKind::mortar, 2},
    {"frobenius, interpolation", Projection::frobenius, CouplingKind::interpolation, 1},
    {"elasticity", Projection::elasticity, CouplingKind::mortar, 1},
    {"elasticity, 2 threads", Projection::elasticity, CouplingKind::mortar, 2},
    {"elasticity, interpolation", Projection::elasticity, CouplingKind::interpolation, 1},
};
enum : size_t {
  frobenius,
  frobeniusThreads,
  frobeniusInterpolation,
  elastic,
  elasticThreads,
  elasticInterpolation
};

/// A march in time that stops after every step until it is told to go on.
class SteppedMarch {
 public:
  SteppedMarch(const Cells& cells, const Variant& variant)
      : model_(twoSquares(cells, variant.projection, variant.coupling)) {
    thread_ = std::thread([this, threads = variant.threads] {
      State state = flowing(model_);
      SolverOptions options;
      options.threads = threads;
      const TimePlan plan{flowingTime + timeStep * plannedSteps, plannedSteps, Scheme::backwardEuler};
      const Observer pause = [this](const State&, const StepReport& step) {
        seconds_ = now() - begin_;
        iterations_ = step.iterations;
        done_.release();
        go_.acquire();
        if (stop_) throw Stopped{};
        begin_ = now();
      };
      try {
        const RunReport report = march(model_, state, plan, options, pause);
        std::fprintf(stderr, "bench_iteration: %s\n", report.reason.c_str());
        std::_Exit(EXIT_FAILURE);
      } catch (const Stopped&) {
      }
    });
    done_.acquire();
  }
  SteppedMarch(const SteppedMarch&) = delete;
  SteppedMarch& operator=(const SteppedMarch&) = delete;
  ~SteppedMarch() {
    stop_ = true;
    go_.release();
    thread_.join();
  }

  void step() {
    go_.release();
    done_.acquire();
  }
  /// Of the last step.
  [[nodiscard]] double stepSeconds() const { return seconds_; }
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  struct Stopped {};
  static constexpr int plannedSteps = 100000;

  Model model_;
  std::binary_semaphore go_{0};
  std::binary_semaphore done_{0};
  bool stop_ = false;
  double begin_ = 0;
  double seconds_ = 0;
  int iterations_ = 0;
  std::thread thread_;
};

BareCholmod bareCholmod(const Cells& cells) {
  BareCholmod bare;
  for (const bool upper : {true, false})
    bare.add(squareBody(upper, cells, elasticMaterial(elasticity), true));
  bare.analyse();
  return bare;
}

/// Peak of a process that does `work` only [MiB].
double peakMemory(const std::function<void()>& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    work();
    std::_Exit(EXIT_SUCCESS);
  }
  rusage usage{};
  int status = 0;
  if (child < 0 || wait4(child, &status, 0, &usage) != child || status != 0) {
    std::fprintf(stderr, "bench_iteration: a measurement of memory failed\n");
    std::exit(EXIT_FAILURE);
  }
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

struct Sample {
  std::vector<double> seconds;  ///< per iteration, one a round
  int steps = 0;
  int iterations = 0;
};

struct Figures {
  double triangles = 0;
  double unit = 0;      ///< [s]
  int unitThreads = 1;  ///< of BLAS, the faster setting
  std::vector<Sample> variants;
  double memoryUnit = 0;      ///< above an empty process [MiB]
  double memory[2] = {0, 0};  ///< frobenius, elasticity
  [[nodiscard]] double time(size_t variant) const { return median(variants[variant].seconds); }
};

void measureMemory(const Cells& cells, Figures& figures) {
  const double empty = peakMemory([] {});
  figures.memoryUnit = peakMemory([&] { bareCholmod(cells).factoriseAndSolve(1); }) - empty;
  for (const int i : {0, 1}) {
    const Variant& variant = variants[i == 0 ? frobenius : elastic];
    figures.memory[i] = peakMemory([&] {
                          SteppedMarch run(cells, variant);
                          for (int n = 0; n < 3; ++n) run.step();
                          std::_Exit(EXIT_SUCCESS);
                        }) -
                        empty;
  }
}

void measureTime(const Cells& cells, int rounds, Figures& figures) {
  constexpr int warmUp = 4;  // the first step has no increments to begin with
  constexpr double secondsPerSample = 0.05;
  BareCholmod bare = bareCholmod(cells);
  std::vector<std::unique_ptr<SteppedMarch>> runs;
  for (const Variant& variant : variants) runs.push_back(std::make_unique<SteppedMarch>(cells, variant));
  for (auto& run : runs)
    for (int n = 0; n < warmUp; ++n) run->step();

  figures.variants.resize(std::size(variants));
  const auto unitSeconds = [&](int blasThreads) {
    return secondsOf([&] { bare.factoriseAndSolve(blasThreads); });
  };
  unitSeconds(2);
  const int repetitions = std::max(1, static_cast<int>(secondsPerSample / unitSeconds(1)));
  std::vector<double> unit[2];
  for (int round = 0; round < rounds; ++round) {
    double total[2] = {0, 0};
    std::vector<double> totals(runs.size(), 0.0);
    std::vector<int> iterations(runs.size(), 0);
    // OpenBLAS's second thread goes on spinning for a while; nothing else is timed meanwhile.
    for (int n = 0; n < repetitions; ++n) total[1] += unitSeconds(2);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    for (int n = 0; n < repetitions; ++n) {
      total[0] += unitSeconds(1);
      for (size_t v = 0; v < runs.size(); ++v) {
        runs[v]->step();
        totals[v] += runs[v]->stepSeconds();
        iterations[v] += runs[v]->iterations();
      }
    }
    for (const int i : {0, 1}) unit[i].push_back(total[i] / repetitions);
    for (size_t v = 0; v < runs.size(); ++v) {
      Sample& sample = figures.variants[v];
      sample.seconds.push_back(totals[v] / iterations[v]);
      sample.steps += repetitions;
      sample.iterations += iterations[v];
    }
  }
  figures.unitThreads = median(unit[1]) < median(unit[0]) ? 2 : 1;
  figures.unit = median(unit[figures.unitThreads - 1]);
}

void printTable(const std::vector<Figures>& all) {
  constexpr double frobeniusTargets[] = {0.6, 0.7, 0.85, 0.9};
  constexpr double elasticTargets[] = {0.7, 0.85, 1.2, 1.3};
  std::printf("\n%-58s %9s %9s %11s\n", "figure", "triangles", "measured", "target");
  for (size_t i = 0; i < all.size(); ++i) {
    const Figures& f = all[i];
    const double n = f.triangles;
    printRow("2  iteration over the unit, frobenius", n, f.time(frobenius) / f.unit, frobeniusTargets[i]);
    printRow("2  iteration over the unit, elasticity", n, f.time(elastic) / f.unit, elasticTargets[i]);
  }
  for (const Figures& f : all) {
    const double n = f.triangles;
    for (size_t v = 0; v < std::size(variants); ++v) {
      const std::string name = std::string("2  iterations a step, ") + variants[v].name;
      const bool mortar = variants[v].coupling == CouplingKind::mortar;
      if (variants[v].threads == 1)
        printRow(name.c_str(), n, static_cast<double>(f.variants[v].iterations) / f.variants[v].steps,
                 mortar ? 1.1 : 1.5);
    }
  }
  if (timeOf == TimeOf::wall)
    std::printf("(below 3e4 triangles both take one thread: what differs is noise)\n");
  for (const Figures& f : all) {
    if (timeOf == TimeOf::processor) break;
    const double target = f.triangles > 5e4 ? 1.4 : 1.0;
    printRow("3  one thread over two, frobenius", f.triangles, f.time(frobenius) / f.time(frobeniusThreads),
             target, false);
    printRow("3  one thread over two, elasticity", f.triangles, f.time(elastic) / f.time(elasticThreads),
             target, false);
  }
  for (const Figures& f : all) {
    printRow("7  peak memory over the unit, frobenius (1e6)", f.triangles, f.memory[0] / f.memoryUnit, 1.4);
    printRow("7  peak memory over the unit, elasticity (1e6)", f.triangles, f.memory[1] / f.memoryUnit, 2.2);
  }
  std::vector<double> triangles;
  std::vector<double> values[4];
  for (const Figures& f : all) {
    if (f.triangles < 5e3) continue;
    triangles.push_back(f.triangles);
    values[0].push_back(f.time(frobenius));
    values[1].push_back(f.time(elastic));
    values[2].push_back(f.memory[0]);
    values[3].push_back(f.memory[1]);
  }
  const double largest = triangles.back();
  printRow("8  exponent of time from 1e4, frobenius", largest, exponent(triangles, values[0]), 1.3);
  printRow("8  exponent of time from 1e4, elasticity", largest, exponent(triangles, values[1]), 1.3);
  printRow("8  exponent of memory from 1e4, frobenius", largest, exponent(triangles, values[2]), 1.12);
  printRow("8  exponent of memory from 1e4, elasticity", largest, exponent(triangles, values[3]), 1.12);
  for (const Figures& f : all) {
    if (f.triangles < 5e4) continue;
    printRow("9  mortar over interpolation, frobenius", f.triangles,
             f.time(frobenius) / f.time(frobeniusInterpolation), 1.02);
    printRow("9  mortar over interpolation, elasticity", f.triangles,
             f.time(elastic) / f.time(elasticInterpolation), 1.02);
  }
}

int run(bool million, int rounds) {
  std::vector<double> sizes{1.2e3, 1e4, 1e5};
  if (million) sizes.push_back(1e6);
  std::vector<Figures> all(sizes.size());
  // Memory first: a child begins with the peak of its parent.
  for (size_t i = 0; i < sizes.size(); ++i) {
    measureMemory(cellsFor(sizes[i]), all[i]);
    std::printf("%g triangles: MiB above an empty process: unit %.4g, frobenius %.4g, elasticity %.4g\n",
                sizes[i], all[i].memoryUnit, all[i].memory[0], all[i].memory[1]);
  }
  // Memory that is freed stays with the process: no page is zeroed twice, on either side.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  for (size_t i = 0; i < sizes.size(); ++i) {
    const Cells cells = cellsFor(sizes[i]);
    all[i].triangles = cells.triangles();
    measureTime(cells, rounds, all[i]);
    std::printf("%d triangles: unit %.4g ms (%d BLAS threads)\n", cells.triangles(), 1e3 * all[i].unit,
                all[i].unitThreads);
    for (size_t v = 0; v < std::size(variants); ++v)
      std::printf("  %-28s %.4g ms an iteration\n", variants[v].name, 1e3 * all[i].time(v));
    std::fflush(stdout);
  }
  printTable(all);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace mortier::bench

int main(int argc, char** argv) {
  bool million = false;
  int rounds = 5;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--million") == 0) {
      million = true;
    } else if (std::strcmp(argv[i], "--cpu") == 0) {
      mortier::bench::timeOf = mortier::bench::TimeOf::processor;
    } else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc && std::atoi(argv[i + 1]) > 0) {
      rounds = std::atoi(argv[++i]);
    } else {
      std::fprintf(stderr, "usage: bench_iteration [--million] [--cpu] [--rounds N]\n");
      return EXIT_FAILURE;
    }
  }
  mallopt(M_ARENA_MAX, 1);  // the marches are threads here; in a program they run on the main one
  return mortier::bench::run(million, rounds);
}
