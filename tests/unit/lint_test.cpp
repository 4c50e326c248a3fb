#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/digits.h"
#include "lint/fault.h"
#include "lint/topology.h"
#include "mesh/boundary_line.h"
#include "mesh/generate.h"

namespace mortier::lint_test {

TEST(Faults, kindsHaveIdsOfTheirOwnAndRemedies) {
  std::set<std::string> ids;
  for (const FaultKind& kind : faultKinds()) {
    EXPECT_TRUE(ids.insert(kind.id).second) << kind.id;
    EXPECT_FALSE(kind.what.empty() || kind.remedy.empty()) << kind.id;
  }
  EXPECT_THROW(static_cast<void>(faultKind("none of them")), std::logic_error);
}

TEST(Faults, whatIsAllowedIsNotNamedButErrorsAre) {
  Faults faults({"sliver", "data"});
  faults.add("sliver", "a.mesh", "flat");
  faults.add("data", "scene.toml:3", "not finite");
  EXPECT_EQ(faults.count(Severity::warning), 0);
  EXPECT_EQ(faults.count(Severity::error), 1);
}

TEST(Faults, areSaidOnce) {
  Faults faults;
  for (int component = 0; component < 2; ++component)
    faults.add("load-on-contact", "scene.toml:8", "label 3 is in contact and carries a traction");
  faults.add("load-on-contact", "scene.toml:9", "label 3 is in contact and carries a traction");
  EXPECT_EQ(faults.all().size(), 2u);
}

TEST(Faults, manyOfAKindAreCounted) {
  Faults faults;
  for (int round = 0; round < 2; ++round)
    for (int i = 0; i < 100000; ++i)
      faults.add("missing-label", "scene.toml:" + std::to_string(i), "no edge has it");
  faults.add("sliver", "a.mesh: triangle 3", "one is flat");
  EXPECT_EQ(faults.all().size(), 21u);
  EXPECT_EQ(faults.count(Severity::error), 100000);
  EXPECT_EQ(faults.count(Severity::warning), 1);
  const std::string last = oneLine(faults.all()[19]);
  EXPECT_EQ(last.substr(last.find(" [")), " [missing-label] and 99980 more of this kind");
  const auto word = [](size_t i) { return std::to_string(i); };
  EXPECT_EQ(listed(3, word), "0, 1, 2");
  const std::string many = listed(100000, word);
  EXPECT_EQ(many.substr(many.rfind(',')), ", 19 and 99980 more");
}

TEST(Faults, aLineHasPlaceSeverityMessageRemedyAndId) {
  Faults faults;
  faults.add("sliver", "a.mesh: triangle 3", "one is flat");
  EXPECT_EQ(oneLine(faults.all().front()),
            "a.mesh: triangle 3: warning: one is flat; mesh again with a lower bound on angles [sliver]");
  EXPECT_EQ(counted(1, "vertex"), "1 vertex");
  EXPECT_EQ(counted(2, "vertex"), "2 vertices");
  EXPECT_EQ(counted(0, "edge"), "0 edges");
  EXPECT_EQ(counted(3, "held vertex"), "3 held vertices");
}

// n x n cells with one diagonal: 4 n edges around, the others between two triangles.
TEST(Topology, countsTheEdgesOfAGrid) {
  const int n = 7;
  const TriangleMesh mesh =
      gridMesh({.n1 = n, .n2 = n, .at = [](int i, int j) { return Point(i, 2 * j); }}, Cut::rising, "grid");
  const Topology topology = topologyOf(mesh);
  EXPECT_EQ(topology.boundary.size(), 4u * n);
  EXPECT_EQ(topology.neighbours.size(), (3u * 2 * n * n - 4 * n) / 2);
  for (const BoundaryEdge& edge : topology.boundary) {
    EXPECT_NE(edge.label, noLabel);
    const Point middle = (mesh.vertices[edge.from] + mesh.vertices[edge.to]) / 2;
    const SegmentTree tree(mesh, topology);
    double nearest = INFINITY;
    tree.near(middle, middle,
              [&](int e) { nearest = std::min(nearest, distanceToSegment(middle, tree.segments()[e])); });
    EXPECT_EQ(nearest, 0);
  }
  EXPECT_EQ(distanceToSegment({3, 4}, {Point(0, 0), Point(0, 0)}), 5);
  EXPECT_EQ(distanceToSegment({-3, 4}, {Point(0, 0), Point(7, 0)}), 5);
}

}  // namespace mortier::lint_test
