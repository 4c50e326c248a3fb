#include "time/overlap_check.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/formatted.h"
#include "mesh/shape.h"
#include "time/overlap_places.h"

namespace mortier {

const Body& OverlapCheck::body(size_t b) const {
  return model_.bodies[b];
}

OverlapCheck::OverlapCheck(const Model& model) : model_(model) {
  const size_t count = model.bodies.size();
  spaceOutlines_.reserve(count);  // surfaces point to them
  for (size_t b = 0; b < count; ++b) {
    if (const SpaceElements* space = body(b).space()) {
      spaceOutlines_.push_back(outlineOf(space->mesh(), space->nodes()));
      spaceDrawn_.emplace_back(spaceOutlines_.back(), space->nodes().places);
    } else {
      outlines_.push_back(outlineOf(body(b).mesh(), body(b).elementNodes()));
      drawn_.emplace_back(outlines_.back(), body(b).elementNodes().places);
    }
  }
  for (const Tie& tie : model.ties) {
    std::map<size_t, std::vector<int>>& nodes = tiedNodes_.emplace_back();
    for (size_t k = 0; k < 2 && tie.sides()[0].body != tie.sides()[1].body; ++k) {
      std::set<int> of;
      forEachEntry(tie.sides()[k].C, [&](int, int dof, double) { of.insert(dof / tie.dimension()); });
      nodes[static_cast<size_t>(tie.sides()[k].body)] = {of.begin(), of.end()};
    }
  }
  for (const ContactInterface& interface : model.interfaces) {
    const ContactPair& pair = interface.pair();
    Vector& distance = distanceDrawn_.emplace_back(interface.rows());
    for (int row = 0; row < interface.rows(); ++row) {
      const SpacePoint x = model.bodies[pair.nonmortar.body].placeOfNode(interface.nonmortarNodes()[row]);
      distance[row] = spaceDrawn_.empty() ? drawn_[pair.mortar.body].nearest(x.head<2>()).distance
                                          : spaceDrawn_[pair.mortar.body].nearest(x).distance;
    }
  }
}

std::string BodyOverlap::text(int dimension) const {
  return "bodies " + bodies[0] + " and " + bodies[1] +
         formatted(" overlap by %.3g at (%.5g, %.5g", depth, place.x(), place.y()) +
         (dimension == 3 ? formatted(", %.5g)", place.z()) : ")");
}

/// Of elements that are turned over nothing is inside.
bool OverlapCheck::turnsOver(size_t b, const Places& places) const {
  const Body& of = body(b);
  if (of.rigid()) return false;
  if (const SpaceElements* space = of.space()) {
    const auto& x = places.inSpace[b];
    return std::any_of(space->mesh().tetrahedra.begin(), space->mesh().tetrahedra.end(), [&](const auto& t) {
      return !((x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).dot(x[t[3]] - x[t[0]]) > 0);
    });
  }
  const auto& x = places.inPlane[b];
  return std::any_of(of.mesh().triangles.begin(), of.mesh().triangles.end(),
                     [&](const auto& t) { return !(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]) > 0); });
}

/// The sides of a tool that close its outline, and are no part of it.
bool OverlapCheck::drawnOnly(size_t b, int label) const {
  const auto& names = body(b).mesh().labelNames;
  const auto found = names.find(sideBehind);
  return body(b).rigid() && found != names.end() && found->second == label;
}

std::vector<OverlapCheck::Between> OverlapCheck::between(size_t one, size_t other, const Places& places,
                                                         const std::vector<Vector>& force,
                                                         double time) const {
  std::vector<Between> contacts;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    const auto n = static_cast<size_t>(interface.pair().nonmortar.body);
    const auto m = static_cast<size_t>(interface.pair().mortar.body);
    if (!(n == one && m == other) && !(n == other && m == one)) continue;
    Between& contact = contacts.emplace_back(Between{&interface, k, {}, {}});
    const Vector distance = interface.distance(time);
    const bool given = interface.distanceIsGiven();
    for (int row = 0; row < interface.rows(); ++row) {
      const int node = interface.nonmortarNodes()[row];
      if (force[k][row] > 0) contact.pressing.push_back(places.of(n, node));
      if (interface.follows()) continue;
      const double drawn = distanceDrawn_[k][row];
      const double asked =
          given ? distance[row] - drawn : std::min(0.0, distance[row]) - std::min(0.0, drawn);
      if (asked > 0) contact.asked.emplace_back(node, asked);
    }
    std::sort(contact.asked.begin(), contact.asked.end());
  }
  return contacts;
}

OverlapCheck::AtPoint OverlapCheck::atPoint(const std::vector<Between>& contacts, size_t own,
                                            const std::array<int, 2>& labels,
                                            const std::array<double, 2>& sizes,
                                            const std::array<std::array<int, 3>, 2>& nodes) {
  AtPoint result;
  for (const Between& contact : contacts) {
    const ContactPair& pair = contact.interface->pair();
    const size_t nonmortar = pair.nonmortar.body == static_cast<int>(own) ? 0 : 1;
    result.nonmortar = std::max(result.nonmortar, sizes[nonmortar]);
    result.named = result.named ||
                   (pair.nonmortar.label == labels[nonmortar] && pair.mortar.label == labels[1 - nonmortar]);
    for (const int node : nodes[nonmortar]) {
      const auto at = std::lower_bound(contact.asked.begin(), contact.asked.end(), std::pair(node, 0.0));
      if (at != contact.asked.end() && at->first == node) result.asked = std::max(result.asked, at->second);
    }
  }
  return result;
}

/// Sides that are tied overlap as they are drawn, and beside their ends by what is left of the jump.
void OverlapCheck::dropTied(const Places& places, std::vector<Sample>& samples) const {
  constexpr double reach = 1.5;  // elements between a place and a node of the tie
  for (const auto& nodes : tiedNodes_)
    std::erase_if(samples, [&](const Sample& sample) {
      const auto isOf = [&](size_t b) {
        return sample.bodies[0] == static_cast<int>(b) || sample.bodies[1] == static_cast<int>(b);
      };
      return !nodes.empty() &&
             std::ranges::all_of(nodes, [&](const auto& side) { return isOf(side.first); }) &&
             std::ranges::any_of(nodes, [&](const auto& side) {
               return std::ranges::any_of(side.second, [&](int node) {
                 return (places.of(side.first, node) - sample.at).norm() <= reach * sample.size;
               });
             });
    });
}

/// What explains a sample explains those within an element as well: a corner is deep in an edge beside it.
void OverlapCheck::judge(const Region& region, const std::vector<Between>& contacts,
                         BodyOverlap& worst) const {
  constexpr double reach = 2;    // elements between a place and a row that presses
  constexpr double deep = 0.25;  // of an element: a deeper overlap ends a step
  const auto nearest = [&](const Sample& sample) {
    double least = infinity;
    for (const Between& contact : contacts)
      for (const SpacePoint& x : contact.pressing) least = std::min(least, (x - sample.at).norm());
    return least;
  };
  // Small sliding leaves overlaps of second order beside contact that presses, and bodies anywhere that move
  // far.
  const bool follows = std::any_of(contacts.begin(), contacts.end(),
                                   [](const Between& contact) { return contact.interface->follows(); });
  const bool idle = std::all_of(contacts.begin(), contacts.end(),
                                [](const Between& contact) { return contact.pressing.empty(); });
  const auto isNamed = [&](const Sample& sample) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const Between& contact) {
      const ContactPair& pair = contact.interface->pair();
      const auto is = [&](const ContactSide& side, int k) {
        return side.body == sample.bodies[k] && side.label == sample.labels[k];
      };
      return (is(pair.nonmortar, 0) && is(pair.mortar, 1)) || (is(pair.nonmortar, 1) && is(pair.mortar, 0));
    });
  };
  std::vector<double> allowed;
  std::vector<char> presses;
  for (const Sample& sample : region.samples) {
    presses.push_back(sample.depth > sample.always && nearest(sample) <= reach * sample.size ? 1 : 0);
    allowed.push_back(sample.always + (presses.back() != 0 ? sample.pressed : 0));
  }
  for (size_t i = 0; i < allowed.size(); ++i) {
    const Sample& sample = region.samples[i];
    bool explained = sample.depth <= allowed[i];
    for (size_t j = 0; j < allowed.size() && !explained; ++j)
      explained = sample.depth <= allowed[j] && (region.samples[j].at - sample.at).norm() <= sample.nonmortar;
    const bool named = isNamed(sample);
    const double ofMesh = presses[i] == 0 ? sample.pressed : 0;
    const bool shallow =
        !explained && (!(follows || contacts.empty() || (idle && named)) ||
                       sample.depth <= sample.always + std::max(ofMesh, deep * sample.nonmortar));
    const int grade = explained ? 0 : shallow ? 1 : 2;
    const int before = worst.explained ? 0 : worst.shallow ? 1 : 2;
    if (grade < before || (grade == before && sample.depth <= worst.depth)) continue;
    worst.explained = explained;
    worst.shallow = shallow;
    worst.area = region.area;
    worst.depth = sample.depth;
    worst.place = sample.at;
    worst.drawn = sample.drawn;
    worst.bodies = {body(sample.bodies[0]).name(), body(sample.bodies[1]).name()};
    worst.labels = sample.labels;
    worst.words.clear();
    if (explained) continue;
    const int dimension = model_.bodies.front().dimension();
    const auto label = [&](int k) {
      const Body& of = body(sample.bodies[k]);
      return of.withMesh([&](const auto& mesh, const auto&) { return labelText(mesh, sample.labels[k]); });
    };
    worst.words =
        worst.text(dimension) + ": " +
        (!named ? "no [[contact]] names " + label(0) + " of " + worst.bodies[0] + " and " + label(1) +
                      " of " + worst.bodies[1]
         : presses[i] == 0 ? "no contact presses there"
                           : formatted("contact there leaves at most %.2g between nodes", allowed[i]));
  }
}

BodyOverlap OverlapCheck::find(const std::vector<Vector>& u, const std::vector<Vector>& force, double time,
                               double residual) const {
  BodyOverlap worst;
  worst.time = time;
  Places places;
  places.residual = 0;
  double largest = 0;
  for (size_t b = 0; b < u.size(); ++b) {
    places.add(body(b), u[b]);
    places.residual = std::max(places.residual, residual * body(b).extent());
    largest = std::max(largest, places.largest(b));
  }
  places.rounding = roundingOfSums * largest;
  if (spaceDrawn_.empty())
    for (size_t b = 0; b < u.size(); ++b) places.outlines.emplace_back(outlines_[b], places.inPlane[b]);
  else
    for (size_t b = 0; b < u.size(); ++b) places.surfaces.emplace_back(spaceOutlines_[b], places.inSpace[b]);
  for (size_t one = 0; one < u.size(); ++one)
    for (size_t other = one + 1; other < u.size(); ++other) {
      if (body(one).rigid() && body(other).rigid()) continue;
      if (!body(one).hasSurface() || !body(other).hasSurface()) continue;
      if (places.apart(one, other)) continue;
      if (turnsOver(one, places) || turnsOver(other, places)) continue;
      const std::vector<Between> contacts = between(one, other, places, force, time);
      for (Region& region : spaceDrawn_.empty() ? inPlane(one, other, places, contacts)
                                                : inSpace(one, other, places, contacts)) {
        dropTied(places, region.samples);
        judge(region, contacts, worst);
      }
      for (const Region& region : behindMeshes(contacts, places, u, time)) judge(region, contacts, worst);
    }
  return worst;
}

}  // namespace mortier
