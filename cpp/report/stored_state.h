// The last state of a run as a file of its result, with which another run may begin: on the same meshes, with
// other supports, loads, contacts or materials.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/units.h"
#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

struct StoredState {
  struct StoredBody {
    std::string name;
    uint64_t mesh = 0;              ///< hash
    std::vector<std::string> laws;  ///< names
  };
  /// A contact or a tie, by the sides, and the nodes of its rows.
  struct StoredPair {
    std::array<std::string, 2> bodies;
    std::array<int, 2> labels{};
    std::vector<int> nodes;
  };

  std::array<std::string, 5> kind;  ///< units of length, force, stress and time, and the plane
  std::vector<StoredBody> bodies;
  std::vector<StoredPair> contacts, ties;
  State state;
};

constexpr const char* stateName = "state";

/// The bytes of the file.
/// \param plane  "stress", "strain", "axisymmetric" or "space"
std::string stateText(const Model& model, const State& state, const Units& units, const std::string& plane);

/// \throws InputError
StoredState readState(const std::string& path);

/// The state in which a run of the model begins: bodies of the other run, by name, are where they were then,
/// with their stress, others as drawn, at rest. A contact of the same rows keeps its forces and slip, another
/// one has none; distances are those at which the bodies are. \throws InputError where a body has another
/// mesh, or other stresses
State beginningWith(const StoredState& stored, const Model& model, const Units& units,
                    const std::string& plane);

}  // namespace mortier
