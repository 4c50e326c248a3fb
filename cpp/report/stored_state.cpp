#include "report/stored_state.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/archive.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/sealed_file.h"
#include "report/checkpoint_members.h"
#include "time/march.h"

namespace mortier {
namespace {

std::array<std::string, 5> kindOf(const Units& units, const std::string& plane) {
  return {units.length, units.force, units.stress, units.time, plane};
}

std::vector<std::string> lawsOf(const Material& material) {
  std::vector<std::string> names;
  for (const LawDescription& law : material.laws()) names.push_back(law.text());
  return names;
}

std::string firstLine(double time) {
  return stateKind + formatted("%.17g", time);
}

StoredState::StoredPair storedPair(const Model& model, const ContactPair& pair,
                                   const std::vector<int>& nodes) {
  return {{model.bodies[pair.nonmortar.body].name(), model.bodies[pair.mortar.body].name()},
          {pair.nonmortar.label, pair.mortar.label},
          nodes};
}

/// The number of the pair among those that are stored; their count where it is none of them.
size_t indexOf(const StoredState::StoredPair& pair, const std::vector<StoredState::StoredPair>& stored) {
  return std::ranges::find_if(stored,
                              [&](const StoredState::StoredPair& each) {
                                return each.bodies == pair.bodies && each.labels == pair.labels &&
                                       each.nodes == pair.nodes;
                              }) -
         stored.begin();
}

uint64_t meshOf(const Body& body) {
  return body.withMesh([](const auto& mesh, const auto&) { return hashOf(mesh); });
}

/// \throws InputError where it is not one of the body
void requireFits(const BodyState& stored, const BodyState& own, const std::string& body) {
  const auto isLike = [](const auto& given, const auto& expected) {
    return given.rows() == expected.rows() && given.cols() == expected.cols() && given.allFinite();
  };
  if (!isLike(stored.displacement, own.displacement))
    throw InputError("body " + body + " has another degree, expected that of the scene that it goes on from");
  const Matrix& thermal = stored.thermalStrain;
  if (!isLike(stored.stress, own.stress) || !isLike(stored.viscoplasticStrain, own.viscoplasticStrain) ||
      !(thermal.size() == 0 || isLike(thermal, own.stress)))
    throw InputError("body " + body + " has stresses of " + std::to_string(own.stress.rows()) +
                     " components, expected " + std::to_string(stored.stress.rows()) +
                     " as in the scene that it goes on from");
}

/// What a pair has, where it has as many numbers.
template <class Values>
void keep(const std::vector<Values>& stored, size_t from, Values& own) {
  if (from < stored.size() && stored[from].size() == own.size()) own = stored[from];
}

}  // namespace

std::string stateText(const Model& model, const State& state, const Units& units, const std::string& plane) {
  StoredState stored{kindOf(units, plane), {}, {}, {}, state};
  for (const Body& body : model.bodies)
    stored.bodies.push_back({body.name(), meshOf(body), lawsOf(body.material())});
  for (const ContactInterface& each : model.interfaces)
    stored.contacts.push_back(storedPair(model, each.pair(), each.nonmortarNodes()));
  for (const Tie& each : model.ties)
    stored.ties.push_back(storedPair(model, each.pair(), each.nonmortarNodes()));
  ArchiveWriter writer;
  writer(stored);
  return sealed(firstLine(state.time), writer.bytes);
}

StoredState readState(const std::string& path) {
  try {
    const std::string content = readSealed(path, stateKind);
    ArchiveReader reader(content);
    StoredState stored;
    reader(stored);
    const State& state = stored.state;
    const bool fits = reader.bytes.empty() && state.bodies.size() == stored.bodies.size() &&
                      state.contactForce.size() == stored.contacts.size() && std::isfinite(state.time);
    if (!fits) throw InputError("damaged");
    return stored;
  } catch (const std::exception& error) {
    throw InputError(path + ": " + error.what() + ", expected a state that this program wrote");
  }
}

State beginningWith(const StoredState& stored, const Model& model, const Units& units,
                    const std::string& plane) {
  if (stored.kind != kindOf(units, plane))
    throw InputError("other units or another plane, expected those of the scene that it is of");
  State state = initialState(model);
  const State& from = stored.state;
  state.time = from.time;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const auto at = std::ranges::find(stored.bodies, body.name(), &StoredState::StoredBody::name);
    if (at == stored.bodies.end()) continue;
    if (at->mesh != meshOf(body))
      throw InputError("body " + body.name() +
                       " has another mesh, expected that of the scene it goes on from");
    const BodyState& last = from.bodies[at - stored.bodies.begin()];
    BodyState& own = state.bodies[b];
    requireFits(last, own, body.name());
    // What a law remembers beside the stress is known to that law alone.
    if (body.material().components() > body.material().tensorComponents() &&
        at->laws != lawsOf(body.material()))
      throw InputError("body " + body.name() +
                       " has another law, expected that of the scene it goes on from");
    const Matrix cold = own.thermalStrain;
    own = last;
    if (!body.heated()) own.thermalStrain.resize(0, 0);
    if (body.heated() && last.thermalStrain.size() == 0) own.thermalStrain = cold;
  }
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const ContactPair& pair = interface.pair();
    state.gap[k] = interface.gap(state.bodies[pair.nonmortar.body].displacement,
                                 state.bodies[pair.mortar.body].displacement, state.time);
    const size_t same = indexOf(storedPair(model, pair, interface.nonmortarNodes()), stored.contacts);
    if (same == stored.contacts.size()) continue;
    keep(from.contactForce, same, state.contactForce[k]);
    keep(from.frictionForce, same, state.frictionForce[k]);
    keep(from.slipping, same, state.slipping[k]);
    if (same < from.frictionWorkOf.size()) state.frictionWorkOf[k] = from.frictionWorkOf[same];
  }
  for (size_t k = 0; k < model.ties.size(); ++k)
    keep(from.tieForce,
         indexOf(storedPair(model, model.ties[k].pair(), model.ties[k].nonmortarNodes()), stored.ties),
         state.tieForce[k]);
  state.frictionWork = from.frictionWork;
  state.gapWork = from.gapWork;
  return state;
}

}  // namespace mortier
