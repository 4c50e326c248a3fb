// The factorisations of `mortier-mpi`, which the processes of mpirun share (cpp/mumps). The first process
// runs the program; the others work for its engine alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "linear/condensing_solver.h"

namespace mortier {

class DistributedEngine {
 public:
  virtual ~DistributedEngine() = default;

  /// As multifrontalSolver().
  [[nodiscard]] virtual std::unique_ptr<CondensingSolver> solver(const SparsePattern& pattern,
                                                                 const std::vector<int>& kept) = 0;
  /// Keeps the factors of solvers that are made from now on in files of a folder that all processes see.
  virtual void keepFactorsIn(const std::string& folder) = 0;
  [[nodiscard]] virtual int processes() const = 0;
  [[nodiscard]] virtual std::string version() const = 0;  ///< of MUMPS

  /// That of this program; null in `mortier`.
  [[nodiscard]] static DistributedEngine* ofProgram() { return place(); }
  static void use(DistributedEngine* engine) { place() = engine; }

 private:
  static DistributedEngine*& place();
};

/// To be called first. In `mortier-mpi` it makes the engine and returns in the first process alone: the
/// others serve the engine, and end with it. \throws InputError where mpirun has started `mortier`
void startProcesses(int& argc, char**& argv);
/// To be called last, by the first process.
void endProcesses();

}  // namespace mortier
