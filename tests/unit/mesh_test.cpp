#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "base/error.h"
#include "mesh/boundary_line.h"
#include "mesh/generate.h"
#include "mesh/medit.h"
#include "mesh/triangle_mesh.h"

namespace mortier {
namespace {

// A file of this process, removed at the end of the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content = "")
      : path(testing::TempDir() + "mesh_test_" + std::to_string(getpid()) + ".mesh") {
    std::ofstream(path, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::string content() const {
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    return out.str();
  }

  const std::string path;
};

TriangleMesh readText(const std::string& text) {
  return readMedit(TemporaryFile(text).path);
}

// The message of the InputError that `f` throws, or "no error".
template <class F>
std::string messageOf(const F& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Unit square, two triangles; the line numbers count in namesTheLineOfAFault.
const std::string square =
    "MeshVersionFormatted 2\n"
    "Dimension 2\n"
    "Vertices\n4\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"  // lines 5 to 8
    "Edges\n2\n"
    "1 2 1\n3 2 2\n"  // lines 11 and 12
    "Triangles\n2\n"
    "1 2 3 7\n1 3 4 8\n"  // lines 15 and 16
    "End\n";

TEST(Medit, readsASquare) {
  const TriangleMesh mesh = readText(square);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[2], Point(1, 1));
  EXPECT_EQ(mesh.triangles[1], (std::array<int, 3>{0, 2, 3}));
  EXPECT_EQ(mesh.regions, (std::vector<int>{7, 8}));
  EXPECT_EQ(mesh.boundaryEdges[1], (std::array<int, 2>{1, 2})) << "turned: the body lies to the left";
  EXPECT_EQ(mesh.boundaryLabels, (std::vector<int>{1, 2}));
}

TEST(Medit, readsWhatOtherProgramsWrite) {
  EXPECT_EQ(
      readText(replaced(square, "Edges", "Corners\n2\n1 2\nRequiredVertices 1 4\nEdges")).vertices.size(),
      4u);
  EXPECT_EQ(readText(replaced(square, "Edges", "Tangents\n1\n0.5 -1e-3\nEdges")).triangles.size(), 2u);
  EXPECT_EQ(
      readText(replaced(square, "Vertices", "Identifier\n\"a # b\"\nGeometry \"c\"\nVertices")).regions[0],
      7);
  EXPECT_EQ(readText(replaced(square, "Edges", "Quadrilaterals 0\nEdges")).regions[1], 8);
  EXPECT_EQ(readText(replaced(square, "Vertices\n4", "# comment 1\nVertices # 2\n\t+4\r")).regions[1], 8);
}

TEST(Medit, namesTheLineOfAFault) {
  struct Fault {
    std::string from, to, message;
  };
  const Fault faults[] = {
      {"MeshVersionFormatted", "MeshFormat", ":1: 'MeshFormat', expected MeshVersionFormatted"},
      {"Dimension 2", "Dimension 3", ":2: Dimension 3, expected 2"},
      {"Dimension 2", "Dimension two", ":2: 'two', expected a dimension"},
      {"Vertices", "Nodes", ":3: 'Nodes', expected Vertices, Edges, Triangles or End"},
      {"Vertices\n4", "Vertices\n3", ":8: '0', expected Vertices, Edges"},
      {"Vertices\n4", "Vertices\n2000000000", ":4: Vertices 2000000000, expected a count from 0 to"},
      {"Vertices\n4", "Vertices\n-1", ":4: Vertices -1, expected a count"},
      {"Vertices\n4", "Vertices\n99999999999999999999", ":4: '99999999999999999999', expected a count"},
      {"1 1 0", "1 x 0", ":7: 'x', expected a coordinate"},
      {"1 1 0", "1 1e999 0", ":7: '1e999', expected a coordinate"},
      {"1 1 0", "nan 1 0", ":7: vertex 3 at (nan, 1), expected finite"},
      {"1 1 0", "1 -inf 0", ":7: vertex 3 at (1, -inf), expected finite"},
      {"Vertices\n4", "Vertices\n5\n0 2 0", ":9: vertex 5 is unused, expected a corner"},
      {"1 2 3 7", "1 2 9 7", ":15: triangle 1 (1 2 9), expected vertices from 1 to 4"},
      {"1 2 3 7", "0 2 3 7", ":15: vertex 0, expected a vertex number from 1"},
      {"1 2 3 7", "1 2.5 3 7", ":15: '2.5', expected a vertex number"},
      {"1 3 4 8", "1 4 3 8", ":16: triangle 2 (1 4 3) is clockwise, expected counterclockwise"},
      {"1 3 4 8", "3 3 4 8", ":16: triangle 2 (3 3 4) is degenerate"},
      {"1 1 0", "1 1e-13 0", ":15: triangle 1 (1 2 3) is degenerate: area 5e-14 m^2, longest edge 1 m"},
      {"Triangles\n2", "Triangles\n3\n2 3 1 5", ":16: triangle 2 (1 2 3) repeats triangle 1"},
      {"Triangles\n2", "Triangles\n3\n1 2 4 5", ":16: triangles 1 and 2 lie on the same side of edge 1 2"},
      {"4 8", "4 8 Triangles 0", ":16: 'Triangles', expected this section once"},
      {"1 2 1\n", "1 9 1\n", ":11: edge 1 (1 9), expected vertices from 1 to 4"},
      {"1 2 1\n", "1 1 1\n", ":11: edge 1 (1 1) is not an edge of a triangle"},
      {"1 2 1\n", "2 4 1\n", ":11: edge 1 (2 4) is not an edge of a triangle"},
      {"1 2 1\n", "3 1 1\n", ":11: edge 1 (3 1) lies between two triangles"},
      {"1 2 1\n", "2 3 1\n", ":12: edge 2 (3 2) is labelled twice, expected once"},
      {"End", "Tetrahedra\n0\nQuadrilaterals\n1\n1 2 3 4 0\nEnd",
       ":20: 1 Quadrilaterals, expected triangles only"},
      {"1 3 4 8\nEnd\n", "1 3 4 # 8\n", ":16: end of file, expected a label"},
      {"End", "", ":16: end of file, expected Vertices, Edges, Triangles or End"},
      {"Vertices", "Identifier \"x\nVertices", ":3: string without end"},
      {"Edges", std::string("\x01\xff\0Edges", 8), ":9: '???Edges', expected Vertices"},
  };
  for (const Fault& fault : faults) {
    const TemporaryFile file(replaced(square, fault.from, fault.to));
    const std::string message = messageOf([&] { readMedit(file.path); });
    EXPECT_EQ(message.find(file.path + fault.message), 0u) << message << "\nexpected " << fault.message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(Medit, refusesThreeTrianglesOnAnEdge) {
  const std::string text =
      "MeshVersionFormatted 2\nDimension 2\nVertices 5\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n1 1 0\n"
      "Triangles 3\n1 2 3 0\n2 1 4 0\n1 2 5 0\nEnd\n";
  const std::string message = messageOf([&] { readText(text); });
  EXPECT_NE(message.find(":12: edge 1 2 is shared by 3 triangles, expected 2 at most"), std::string::npos)
      << message;
}

TEST(Medit, namesAFileThatIsNone) {
  for (const std::string path : {"no/such.mesh", "/", "/dev/zero"}) {
    const std::string message = messageOf([&] { readMedit(path); });
    EXPECT_EQ(message.find(path + ": not a file, expected a Medit mesh"), 0u) << message;
  }
  EXPECT_NE(messageOf([] { readText(""); }).find(":1: end of file, expected MeshVersionFormatted"),
            std::string::npos);
  EXPECT_THROW(writeMedit(readText(square), "no/such/folder/a.mesh"), OutputError);
}

TEST(Medit, roundTripIsBitExact) {
  TriangleMesh mesh = crissCrossMesh({{-1.0 / 3, 1e-5}, {std::sqrt(2.0), std::acos(-1.0)}, 7, 5});
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> shift(-1e-3, 1e-3);
  for (Point& p : mesh.vertices) p += Point(shift(random), shift(random));
  const TemporaryFile file;
  writeMedit(mesh, file.path);
  const TriangleMesh back = readMedit(file.path);
  ASSERT_EQ(back.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(std::memcmp(back.vertices.data(), mesh.vertices.data(), sizeof(Point) * mesh.vertices.size()), 0);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.regions, mesh.regions);
  EXPECT_EQ(back.boundaryEdges, mesh.boundaryEdges);
  EXPECT_EQ(back.boundaryLabels, mesh.boundaryLabels);
}

// Each fault of a mesh shows itself as InputError or not at all; sanitizers see the rest.
TEST(Medit, survivesMutations) {
  const TemporaryFile file;
  writeMedit(crissCrossMesh({{0, 0}, {1, 1}, 2, 2}), file.path);
  const std::string sound = file.content();
  const std::string pieces[] = {"\n",  " ",       "-", "nan", "1e308", "4294967297",
                                "End", "Edges\n", "0", "#",   "\""};
  std::mt19937 random(2);
  const auto pick = [&random](size_t n) { return size_t(random()) % n; };
  int readable = 0;
  for (int round = 0; round < 600; ++round) {
    std::string text = sound;
    for (size_t i = 0; i <= pick(3); ++i) {
      const size_t at = pick(text.size());
      switch (pick(5)) {
        case 0:
          text[at] = char(pick(256));
          break;
        case 1:
          text.erase(at, 1 + pick(8));
          break;
        case 2:
          text.insert(at, pieces[pick(std::size(pieces))]);
          break;
        case 3:
          text.insert(at, text.substr(pick(text.size()), 20));
          break;
        default:
          text[at] = char('0' + pick(10));
      }
    }
    if (pick(10) == 0) text.resize(pick(text.size()));
    const std::string message = messageOf([&] {
      const TriangleMesh mesh = readText(text);
      for (int label : boundaryLabels(mesh)) messageOf([&] { boundaryLine(mesh, label); });
      ++readable;
    });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_GT(readable, 0) << "mutations too wild to pass the reader";
  EXPECT_LT(readable, 600);
}

TEST(TriangleMesh, measuresTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}, {4, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}, {0, 3, 2}};
  EXPECT_DOUBLE_EQ(doubleArea(mesh, 0), std::sqrt(0.75));
  EXPECT_DOUBLE_EQ(doubleArea(mesh, 1), -std::sqrt(0.75));
  EXPECT_NEAR(aspectRatio(mesh, 0), 1, 1e-15);
  EXPECT_NEAR(aspectRatio(mesh, 2), 4, 1e-15);
  EXPECT_EQ(extent(mesh), 4);
}

TEST(TriangleMesh, judgesAtEveryScale) {
  for (const double scale : {1e-100, 1e-9, 1e9, 1e100}) {
    TriangleMesh mesh = rectangleMesh({{0, 0}, {scale, 1e-6 * scale}, 3, 2});
    EXPECT_EQ(messageOf([&] { validate(mesh); }), "no error") << scale;
    mesh.vertices[0] = mesh.vertices[1];
    EXPECT_NE(messageOf([&] { validate(mesh); }).find("degenerate"), std::string::npos) << scale;
  }
  EXPECT_THROW(rectangleMesh({{0, 0}, {1e200, 1e200}, 1, 1}), InputError);
}

TEST(TriangleMesh, mayHaveFreeBoundary) {
  TriangleMesh mesh = rectangleMesh({});
  mesh.boundaryEdges.clear();
  EXPECT_NE(messageOf([&] { validate(mesh); }).find("numbers of labels"), std::string::npos);
  mesh.boundaryLabels.clear();
  EXPECT_NO_THROW(validate(mesh));
  EXPECT_NE(messageOf([&] { boundaryLine(mesh, 1); }).find("no edge is labelled"), std::string::npos);
}

TEST(CrissCross, hasTheNotesCounts) {
  const TriangleMesh upper = crissCrossMesh({{0, 0}, {1, 1}, 6, 6});
  const TriangleMesh lower = crissCrossMesh({{0, -1}, {1, 0}, 16, 16});
  EXPECT_EQ(upper.triangles.size() + lower.triangles.size(), 1168u);
  EXPECT_EQ(upper.vertices.size() + lower.vertices.size(), 630u);
}

TEST(CrissCross, numbersGridNodesThenCentres) {
  const TriangleMesh mesh = crissCrossMesh({{0, 0}, {3, 2}, 3, 2});
  EXPECT_EQ(mesh.vertices[3], Point(3, 0));
  EXPECT_EQ(mesh.vertices[4], Point(0, 1));
  EXPECT_EQ(mesh.vertices[12], Point(0.5, 0.5));
  EXPECT_EQ(mesh.vertices[17], Point(2.5, 1.5));
  EXPECT_EQ(mesh.triangles[0], (std::array<int, 3>{0, 1, 12}));
}

TEST(Rectangle, meetsItsSidesExactly) {
  const Point lower(-0.1, 0.7), upper(0.3, 1.1);
  for (const TriangleMesh& mesh :
       {rectangleMesh({lower, upper, 49, 10}), crissCrossMesh({lower, upper, 49, 10})}) {
    for (const Point& p : boundaryLine(mesh, 1).points) EXPECT_EQ(p.y(), lower.y());
    for (const Point& p : boundaryLine(mesh, 2).points) EXPECT_EQ(p.x(), upper.x());
    for (const Point& p : boundaryLine(mesh, 3).points) EXPECT_EQ(p.y(), upper.y());
    for (const Point& p : boundaryLine(mesh, 4).points) EXPECT_EQ(p.x(), lower.x());
    double area = 0;
    for (int t = 0; t < int(mesh.triangles.size()); ++t) area += doubleArea(mesh, t) / 2;
    EXPECT_NEAR(area, 0.16, 1e-14);
  }
}

TEST(Rectangle, refusesWhatIsNoRectangle) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Rectangle wrong[] = {{{0, 0}, {1, 1}, 0, 1},         {{0, 0}, {1, 1}, 1, -2},
                             {{0, 0}, {0, 1}, 1, 1},         {{0, 1}, {1, 0}, 1, 1},
                             {{0, nan}, {1, 1}, 1, 1},       {{0, 0}, {HUGE_VAL, 1}, 1, 1},
                             {{1, 1}, {1 + 1e-15, 2}, 9, 1}, {{0, 0}, {1, 1}, 2147483647, 2147483647}};
  for (const Rectangle& r : wrong) {
    EXPECT_THROW(rectangleMesh(r), InputError);
    EXPECT_THROW(crissCrossMesh(r), InputError);
  }
}

TEST(BoundaryLine, runsWithTheBodyToItsLeft) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {3, 1}, 3, 1});
  std::swap(mesh.boundaryEdges[0], mesh.boundaryEdges[2]);        // the order in the mesh does not matter,
  std::swap(mesh.boundaryEdges[1][0], mesh.boundaryEdges[1][1]);  // nor does the direction
  validate(mesh);
  const BoundaryLine bottom = boundaryLine(mesh, 1), top = boundaryLine(mesh, 3);
  EXPECT_EQ(bottom.nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(top.nodes, (std::vector<int>{7, 6, 5, 4}));
  EXPECT_EQ(top.points.front(), Point(3, 1));
  EXPECT_FALSE(top.closed);
  EXPECT_EQ(boundaryLabels(mesh), (std::vector<int>{1, 2, 3, 4}));
}

TEST(BoundaryLine, closesAroundTheBody) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {1, 1}, 2, 2});
  mesh.boundaryLabels.assign(mesh.boundaryLabels.size(), 5);
  const BoundaryLine line = boundaryLine(mesh, 5);
  EXPECT_TRUE(line.closed);
  EXPECT_EQ(line.nodes, (std::vector<int>{0, 1, 2, 5, 8, 7, 6, 3, 0}));
  EXPECT_EQ(line.points.front(), line.points.back());
}

TEST(BoundaryLine, refusesWhatIsNoLine) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {1, 1}, 2, 2});
  const auto fault = [&mesh](int label) { return messageOf([&] { boundaryLine(mesh, label); }); };
  EXPECT_NE(fault(9).find("boundary label 9 is missing, expected one of 1 2 3 4"), std::string::npos)
      << fault(9);
  for (int& label : mesh.boundaryLabels) label = label == 3 ? 1 : label;
  EXPECT_NE(fault(1).find("is not connected: vertex 1 at (0, 0) and vertex 9 at (1, 1)"), std::string::npos)
      << fault(1);

  // An open line and a ring around a hole: as many edges as vertices, still two pieces.
  TriangleMesh ring = rectangleMesh({{0, 0}, {3, 3}, 3, 3});
  ring.triangles.erase(ring.triangles.begin() + 8, ring.triangles.begin() + 10);
  ring.regions.resize(ring.triangles.size());
  for (const auto& edge : {std::array<int, 2>{5, 6}, {6, 10}, {10, 9}, {9, 5}}) {
    ring.boundaryEdges.push_back(edge);
    ring.boundaryLabels.push_back(1);
  }
  validate(ring);
  EXPECT_EQ(ring.boundaryEdges.back(), (std::array<int, 2>{5, 9})) << "clockwise around the hole";
  EXPECT_NE(messageOf([&] { boundaryLine(ring, 1); }).find("not connected"), std::string::npos);

  // Two triangles that meet in a vertex.
  mesh.vertices = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  mesh.boundaryEdges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  mesh.regions.assign(2, 0);
  mesh.boundaryLabels.assign(6, 1);
  validate(mesh);
  EXPECT_NE(fault(1).find("branches in vertex 1 at (0, 0)"), std::string::npos) << fault(1);
}

}  // namespace
}  // namespace mortier
