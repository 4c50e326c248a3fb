#include "scene/memory_need.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/formatted.h"
#include "mesh/boundary_line.h"

namespace mortier {
namespace {

struct SideSize {
  double nodes = 0;
  double dofs = 0;  ///< of the nodes, that take part: one each where the line is parallel to an axis
};

SideSize sizeOf(const TriangleMesh& mesh, int label, int degree, bool rough) {
  constexpr double parallel = 1e-9;
  const auto edges = sidesWith(mesh, label);
  bool alongX = true;
  bool alongY = true;
  for (const auto& [a, b] : edges) {
    const Point d = (mesh.vertices[b] - mesh.vertices[a]).cwiseAbs();
    alongX = alongX && d.y() <= parallel * d.x();
    alongY = alongY && d.x() <= parallel * d.y();
  }
  const auto nodes = static_cast<double>(degree * edges.size() + 1);
  return {nodes, ((alongX || alongY) && !rough ? 1 : 2) * nodes};
}

/// Of a body with so many nodes, in 8 bytes.
double needOf(size_t nodes) {
  const auto n = static_cast<double>(nodes);
  return n * (16 * std::log2(n + 1) + 150);
}

}  // namespace

MemoryNeed memoryNeed(const std::vector<const TriangleMesh*>& meshes, const std::vector<ContactPair>& pairs,
                      int degree, const std::vector<bool>& rough, const SolverOptions& options) {
  constexpr double ofALongLine = 400;
  constexpr double program = 12 << 17;  // in 8 bytes: code and libraries, 12 MiB
  double need = program;
  double equations = 0;
  // By Euler's formula a mesh has about as many edges as vertices and triangles together.
  for (const TriangleMesh* mesh : meshes) {
    const size_t nodes =
        mesh->vertices.size() * (degree == 1 ? 1 : 2) + (degree == 1 ? 0 : mesh->triangles.size());
    need += needOf(nodes);
    equations += 2 * static_cast<double>(nodes);
  }
  std::vector<double> dofs(meshes.size(), 0);
  double conditions = 0;
  for (size_t k = 0; k < pairs.size(); ++k) {
    const ContactPair& pair = pairs[k];
    const bool along = k < rough.size() && rough[k];
    const SideSize nonmortar = sizeOf(*meshes[pair.nonmortar.body], pair.nonmortar.label, degree, along);
    const SideSize mortar = sizeOf(*meshes[pair.mortar.body], pair.mortar.label, degree, along);
    conditions += (along ? 2 : 1) * nonmortar.nodes;
    dofs[pair.nonmortar.body] += nonmortar.dofs;
    dofs[pair.mortar.body] += mortar.dofs;
  }
  const bool friction = std::find(rough.begin(), rough.end(), true) != rough.end();
  if (solvesSparse(conditions, equations, friction, options))
    return {sizeof(double) * (need + ofALongLine * conditions), 0};
  double solving = conditions * conditions;
  double largest = 0;
  for (const double m : dofs) {
    solving += m * m;
    largest = std::max(largest, m * m);
  }
  solving += std::max(conditions * conditions, largest);
  return {sizeof(double) * (need + solving), sizeof(double) * solving};
}

namespace {

/// In space, by what solids of six tetrahedra a cell need: 2e7 numbers of a factor of 26,000 equations and of
/// what its fronts pass on, growing with the power 1.4.
MemoryNeed needInSpace(const Model& model, const SolverOptions& options) {
  constexpr double program = 12 << 20;
  double bytes = program;
  double conditions = 0;
  for (const Body& body : model.bodies) {
    constexpr double ofAnEquation = 2500;
    const bool single = engineOf(model, body, options) == LinearEngine::single;
    bytes += (single ? sizeof(float) : sizeof(double)) * 2e7 * std::pow(body.freeDofs() / 26e3, 1.4) +
             ofAnEquation * body.dofs();
  }
  for (const ContactInterface& interface : model.interfaces)
    conditions += interface.rows() + interface.slipRows();
  for (const Tie& tie : model.ties) conditions += tie.rows();
  const double copies = anyFriction(model) ? 7 : 4;
  const double dense = copies * sizeof(double) * conditions * conditions;
  return {bytes + dense, dense};
}

}  // namespace

MemoryNeed memoryNeed(const Model& model, const SolverOptions& options) {
  if (model.bodies.front().dimension() == 3) return needInSpace(model, options);
  std::vector<const TriangleMesh*> meshes;
  for (const Body& body : model.bodies) meshes.push_back(&body.mesh());
  std::vector<ContactPair> pairs;
  std::vector<bool> rough;
  for (const ContactInterface& interface : model.interfaces) {
    pairs.push_back(interface.pair());
    rough.push_back(interface.hasFriction());
  }
  for (const Tie& tie : model.ties) {
    pairs.push_back(tie.pair());
    rough.push_back(true);
  }
  return memoryNeed(meshes, pairs, model.bodies.front().degree(), rough, options);
}

std::string forFriction(const MemoryNeed& need) {
  constexpr double worthTelling = 0.5;
  if (need.dense < worthTelling * need.all) return "";
  return aboutMemory(need.dense) + " of it for the dense matrices that friction needs";
}

double availableMemory() {
  double available = std::numeric_limits<double>::infinity();
  std::ifstream file("/proc/meminfo");
  for (std::string word; file >> word;)
    if (double kibibytes = 0; word == "MemAvailable:" && file >> kibibytes) available = 1024 * kibibytes;
  std::ifstream group("/sys/fs/cgroup/memory.max");
  if (double bytes = 0; group >> bytes) available = std::min(available, bytes);
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      available = std::min(available, static_cast<double>(limit.rlim_cur));
  }
  return available;
}

std::string aboutMemory(double bytes) {
  const double mebibytes = bytes / (1024 * 1024);
  return mebibytes < 1024 ? formatted("about %.0f MiB", mebibytes)
                          : formatted("about %.3g GiB", mebibytes / 1024);
}

void requireMemory(const std::vector<const TriangleMesh*>& meshes, const std::vector<ContactPair>& pairs,
                   int degree, const std::vector<bool>& rough, const SolverOptions& options) {
  requireMemory(memoryNeed(meshes, pairs, degree, rough, options),
                std::find(rough.begin(), rough.end(), true) != rough.end());
}

void requireMemory(const MemoryNeed& need, bool friction) {
  const double available = availableMemory();
  if (need.all <= available) return;
  const std::string part = friction ? forFriction(need) : "";
  throw InputError("the run needs " + aboutMemory(need.all) + " of memory, expected at most the " +
                       aboutMemory(available).substr(6) + " that are available" +
                       (part.empty() ? "" : "; " + part),
                   "memory");
}

}  // namespace mortier
