#include "report/checkpoint.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>

#include "base/error.h"
#include "base/whole_file.h"
#include "report/checkpoint_files.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

/// Names the layout below; it changes with any member.
constexpr std::string_view magic = "mortier checkpoint 3\n";

uint64_t fnv1a(std::string_view bytes, uint64_t hash = 14695981039346656037U) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211U;
  return hash;
}

template <class T>
uint64_t fnv1a(const std::vector<T>& values, uint64_t hash) {
  return fnv1a({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}, hash);
}

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Puts values into a string of bytes.
class Writer {
 public:
  std::string bytes;

  template <class... T>
  void operator()(T&... values) {
    (put(values), ...);
  }

 private:
  void raw(const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }
  void size(uint64_t n) { raw(&n, sizeof n); }
  template <Plain T>
  void put(T& value) {
    raw(&value, sizeof value);
  }
  void put(std::string& text) {
    size(text.size());
    raw(text.data(), text.size());
  }
  template <int Columns>
  void put(Eigen::Matrix<double, Eigen::Dynamic, Columns>& m) {
    size(m.rows());
    size(m.cols());
    raw(m.data(), m.size() * sizeof(double));
  }
  void put(std::map<std::string, int>& counts) {
    size(counts.size());
    for (auto& [key, count] : counts) {
      std::string name = key;
      (*this)(name, count);
    }
  }
  template <class T>
  void put(std::vector<T>& values) {
    size(values.size());
    for (T& value : values) put(value);
  }
  template <class T>
  void put(T& value) {
    visitMembers(*this, value);
  }
};

/// Takes them out again. \throws InputError where they do not fit.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  [[nodiscard]] bool atEnd() const { return bytes_.empty(); }

 private:
  void raw(void* data, size_t size) {
    if (size > bytes_.size()) throw InputError("too short");
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  uint64_t size() {
    uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > bytes_.size()) throw InputError("too short");
    return n;
  }
  template <Plain T>
  void get(T& value) {
    raw(&value, sizeof value);
  }
  void get(std::string& text) {
    text.resize(size());
    raw(text.data(), text.size());
  }
  template <int Columns>
  void get(Eigen::Matrix<double, Eigen::Dynamic, Columns>& m) {
    uint64_t shape[2];
    raw(shape, sizeof shape);
    if (shape[0] != 0 && shape[1] > bytes_.size() / sizeof(double) / shape[0]) throw InputError("too short");
    m.resize(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
    raw(m.data(), m.size() * sizeof(double));
  }
  void get(std::map<std::string, int>& counts) {
    for (uint64_t n = size(); n > 0; --n) {
      std::string key;
      (*this)(key);
      (*this)(counts[key]);
    }
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(size());
    for (T& value : values) get(value);
  }
  template <class T>
  void get(T& value) {
    visitMembers(*this, value);
  }

  std::string_view bytes_;
};

// Every member by name: one that is added and forgotten here does not compile.
template <class Archive>
void visitMembers(Archive& archive, RunIdentity& identity) {
  auto& [workingFolder, scene, text, settings, meshes, meshHashes] = identity;
  archive(workingFolder, scene, text, settings, meshes, meshHashes);
}
template <class Archive>
void visitMembers(Archive& archive, KeptFields& fields) {
  auto& [step, time] = fields;
  archive(step, time);
}
template <class Archive>
void visitMembers(Archive& archive, FilesSoFar& files) {
  auto& [history, contact, fields] = files;
  archive(history, contact, fields);
}
template <class Archive>
void visitMembers(Archive& archive, Certificate& certificate) {
  auto& [forceBalance, materialResidual, gapOnActive, sign, complementarity] = certificate;
  archive(forceBalance, materialResidual, gapOnActive, sign, complementarity);
}
template <class Archive>
void visitMembers(Archive& archive, StepReport& report) {
  auto& [step, time, timeStep, status, reason, rung, guarded, rejections, estimate, iterations,
         factorisations, active, joined, left, penetration, maxPressure, contactForce, viscoplasticFraction,
         certificate] = report;
  archive(step, time, timeStep, status, reason, rung, guarded, rejections, estimate, iterations,
          factorisations, active, joined, left, penetration, maxPressure, contactForce, viscoplasticFraction,
          certificate);
}
template <class Archive>
void visitMembers(Archive& archive, RunReport& report) {
  auto& [status, reason, steps, iterations, maxIterationsInAStep, factorisations, pilotIterations, rejected,
         guarded, solveSeconds, worst, rungs] = report;
  archive(status, reason, steps, iterations, maxIterationsInAStep, factorisations, pilotIterations, rejected,
          guarded, solveSeconds, worst, rungs);
}
template <class Archive>
void visitMembers(Archive& archive, BodyState& body) {
  auto& [displacement, stress, viscoplasticStrain] = body;
  archive(displacement, stress, viscoplasticStrain);
}
template <class Archive>
void visitMembers(Archive& archive, State& state) {
  auto& [time, bodies, contactForce] = state;
  archive(time, bodies, contactForce);
}
template <class Archive>
void visitMembers(Archive& archive, BodyIncrement& increment) {
  auto& [displacement, small, stress] = increment;
  archive(displacement, small, stress);
}
template <class Archive>
void visitMembers(Archive& archive, ControllerMemory& controller) {
  auto& [timeStep, stress, displacement] = controller;
  archive(timeStep, stress, displacement);
}
template <class Archive>
void visitMembers(Archive& archive, SolverMemory& solver) {
  auto& [libraries, elasticFactors] = solver;
  archive(libraries, elasticFactors);
}
template <class Archive>
void visitMembers(Archive& archive, MarchMemory& memory) {
  auto& [begin, run, increments, timeStep, solver, controller] = memory;
  archive(begin, run, increments, timeStep, solver, controller);
}
template <class Archive>
void visitMembers(Archive& archive, Checkpoint& checkpoint) {
  auto& [identity, files, last, state, memory] = checkpoint;
  archive(identity, files, last, state, memory);
}

Checkpoint decode(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InputError("cannot be read");
  uint64_t sum = 0;
  if (bytes.size() < magic.size() + sizeof sum) throw InputError("too short");
  if (bytes.compare(0, magic.size(), magic) != 0) throw InputError("not of this version of mortier");
  const std::string_view content(bytes.data(), bytes.size() - sizeof sum);
  std::memcpy(&sum, bytes.data() + content.size(), sizeof sum);
  if (sum != fnv1a(content)) throw InputError("damaged");
  Reader reader(content.substr(magic.size()));
  Checkpoint checkpoint;
  reader(checkpoint);
  if (!reader.atEnd()) throw InputError("damaged");
  return checkpoint;
}

void requireFile(const std::string& path, uint64_t size) {
  std::error_code error;
  const uint64_t is = fs::file_size(path, error);
  if (error || is < size)
    throw InputError("its " + fs::path(path).filename().string() + " is shorter than it was");
}

}  // namespace

uint64_t hashOf(const TriangleMesh& mesh) {
  uint64_t hash = fnv1a("");
  for (const Point& p : mesh.vertices)
    hash = fnv1a({reinterpret_cast<const char*>(p.data()), 2 * sizeof(double)}, hash);
  hash = fnv1a(mesh.triangles, hash);
  hash = fnv1a(mesh.regions, hash);
  hash = fnv1a(mesh.boundaryEdges, hash);
  return fnv1a(mesh.boundaryLabels, hash);
}

void writeCheckpoint(const std::string& folder, const Checkpoint& checkpoint) {
  static_assert(std::endian::native == std::endian::little);
  Writer writer;
  writer.bytes = magic;
  writer(const_cast<Checkpoint&>(checkpoint));  // one list of members serves reading and writing
  const uint64_t sum = fnv1a(writer.bytes);
  writer.bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  const std::string path = folder + "/" + checkpointName;
  std::error_code none;
  fs::rename(path, folder + "/" + previousCheckpointName, none);
  writeWhole(path, writer.bytes, true);
}

Checkpoint readCheckpoint(const std::string& folder) {
  std::string fault;
  for (const char* name : {checkpointName, previousCheckpointName}) {
    const std::string path = folder + "/" + name;
    if (!fs::exists(path)) continue;
    try {
      Checkpoint checkpoint = decode(path);
      requireFile(folder + "/history.csv", checkpoint.files.history);
      requireFile(folder + "/contact.csv", checkpoint.files.contact);
      return checkpoint;
    } catch (const InputError& error) {
      fault += (fault.empty() ? "" : "; ") + path + ": " + error.what();
    }
  }
  throw InputError((fault.empty() ? folder + ": no checkpoint" : fault) +
                   ", expected a checkpoint that this program wrote");
}

void requireSame(const RunIdentity& stored, const RunIdentity& given, const std::string& folder) {
  const auto reject = [&](const std::string& what) {
    throw InputError(given.scene + ": " + what + ", expected what the checkpoint in " + folder +
                     " was made with");
  };
  const auto listed = [](const std::vector<std::string>& settings) {
    std::string text;
    for (const std::string& each : settings) text += " " + each;
    return text.empty() ? " nothing" : text;
  };
  if (stored.text != given.text) {
    const auto [a, b] =
        std::mismatch(given.text.begin(), given.text.end(), stored.text.begin(), stored.text.end());
    reject("line " + std::to_string(1 + std::count(given.text.begin(), a, '\n')) + " has changed");
  }
  if (stored.settings != given.settings)
    reject("--set" + listed(given.settings) + " (was" + listed(stored.settings) + ")");
  for (size_t b = 0; b < given.meshHashes.size(); ++b)
    if (b >= stored.meshHashes.size() || stored.meshHashes[b] != given.meshHashes[b])
      reject("the mesh " + given.meshes[b] + " has changed");
}

}  // namespace mortier
