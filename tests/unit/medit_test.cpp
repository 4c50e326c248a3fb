#include "mesh/read.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "mesh/boundary_line.h"
#include "mesh/generate.h"
#include "unit/messages.h"

namespace mortier::medit_test {

// A file of this process, removed at the end of the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content = "")
      : path(testing::TempDir() + "medit_test_" + std::to_string(getpid()) + ".mesh") {
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
      {"Dimension 2", "Dimension 1", ":2: Dimension 1, expected 2 or 3"},
      {"Dimension 2", "Dimension 3",
       ":7: vertex 2 at z = 1.000000, expected all vertices in the plane z = 0.000000"},
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
      {"1 1 0", "1 1e-13 0", ":15: triangle 1 (1 2 3) is degenerate: area 5e-14, longest edge 1"},
      {"Triangles\n2", "Triangles\n3\n2 3 1 5", ":16: triangle 2 (1 2 3) repeats triangle 1"},
      {"Triangles\n2", "Triangles\n3\n1 2 4 5", ":16: triangles 1 and 2 lie on the same side of edge 1 2"},
      {"4 8", "4 8 Triangles 0", ":16: 'Triangles', expected this section once"},
      {"1 2 1\n", "1 9 1\n", ":11: edge 1 (1 9), expected vertices from 1 to 4"},
      {"1 2 1\n", "1 1 1\n", ":11: edge 1 (1 1) is not an edge of a triangle"},
      {"1 2 1\n", "2 4 1\n", ":11: edge 1 (2 4) is not an edge of a triangle"},
      {"1 2 1\n", "3 1 1\n", ":11: edge 1 (3 1) lies between two triangles"},
      {"1 2 1\n", "2 3 1\n",
       ":12: edge 2 (3 2) from (1, 1) to (1, 0) is labelled twice, 1 and 2, expected once"},
      {"End", "Tetrahedra\n0\nHexahedra\n1\n1 2 3 4 1 2 3 4 0\nEnd",
       ":20: 1 Hexahedra, expected triangles or quadrangles, or dimension = 3 at the top of the scene"},
      {"End", "Quadrilaterals\n1\n1 2 3 4 0\nEnd", ":19: triangle 3 (1 2 3) repeats triangle 1"},
      {"1 3 4 8\nEnd\n", "1 3 4 # 8\n", ":16: end of file, expected a label"},
      {"1 3 4 8\nEnd\n", "1 3 4 8", ":16: end of file within a line, expected a line break or End"},
      {"Triangles\n2\n1 2 3 7\n1 3 4 8\nEnd\n", "",
       ":12: end of file, expected Vertices, Edges, Triangles or End"},
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

// As FreeFEM does; a file that is cut off within a section or a line is refused above.
TEST(Medit, readsAFileWithoutEnd) {
  EXPECT_EQ(readText(replaced(square, "End\n", "")).triangles.size(), 2u);
  EXPECT_EQ(readText(replaced(square, "End\n", "# label 2 = top\n")).labelNames.at("top"), 2);
  for (size_t length = 0; length < square.size() - 4; ++length) {
    if (square.substr(0, length + 1).ends_with("1 3 4 8\n")) continue;
    EXPECT_NE(messageOf([&] { readText(square.substr(0, length)); }), "no error") << length;
  }
}

// Each from its smallest vertex: the diagonals of neighbours of one numbering run alike.
TEST(Medit, quadranglesAreCut) {
  const TriangleMesh mesh =
      readText(replaced(square, "Triangles\n2\n1 2 3 7\n1 3 4 8\n", "Quadrilaterals\n1\n3 4 1 2 9\n"));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.regions, (std::vector<int>{9, 9}));
  EXPECT_EQ(mesh.changed, "cells with more corners are cut into triangles");
}

// What is kept of a mesh is looked up by its vertices: they must be there.
TEST(Medit, namesAVertexThatIsNotThereWhereARegionIsAskedFor) {
  for (const auto& [from, to, message] :
       {std::array{"1 2 3 7", "1 2 9 7", ":15: triangle 1 (1 2 9), expected vertices from 1 to 4"},
        std::array{"1 3 4 8", "1 3 9 8", ":16: triangle 2 (1 3 9), expected vertices from 1 to 4"},
        std::array{"1 2 1\n", "1 9 1\n", ":11: edge 1 (1 9), expected vertices from 1 to 4"}}) {
    const TemporaryFile file(replaced(square, from, to));
    EXPECT_EQ(messageOf([&] { readMedit(file.path, {"7"}); }).find(file.path + message), 0u) << message;
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

// As Gmsh writes it.
TEST(Medit, readsThreeCoordinatesInAPlane) {
  std::string text = replaced(square, "Dimension 2", "Dimension 3");
  text = replaced(text, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", "0 0 2 0\n1 0 2 0\n1 1 2 0\n0 1 2 0\n");
  EXPECT_EQ(readText(text).vertices, readText(square).vertices);
}

TEST(Medit, namesStandBehindTheEnd) {
  TriangleMesh mesh =
      readText(square + "\n# label 2 = right side\r\n# label 9 = \n# region 8 = a = b\n# title\n");
  EXPECT_EQ(mesh.labelNames, (std::map<std::string, int>{{"right side", 2}}));
  EXPECT_EQ(mesh.regionNames, (std::map<std::string, int>{{"a = b", 8}}));
  mesh.labelNames["two\nlines"] = 1;
  const TemporaryFile file;
  writeMedit(mesh, file.path);
  const TriangleMesh back = readMedit(file.path);
  EXPECT_EQ(back.labelNames, (std::map<std::string, int>{{"right side", 2}}));
  EXPECT_EQ(back.regionNames, mesh.regionNames);
}

// The diagonal is a side of both triangles: labelled, it is a fault of the whole and a boundary of each.
TEST(Medit, regionsAreBodies) {
  std::string text = replaced(square, "Edges\n2\n", "Edges\n3\n3 1 5\n");
  EXPECT_NE(messageOf([&] { readText(text); }).find("lies between two triangles"), std::string::npos);
  const TemporaryFile file(text);
  const TriangleMesh upper = readMedit(file.path, {"8"});
  EXPECT_EQ(upper.vertices, (std::vector<Point>{{0, 0}, {1, 1}, {0, 1}}));
  EXPECT_EQ(upper.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}}));
  EXPECT_EQ(upper.boundaryEdges, (std::vector<std::array<int, 2>>{{0, 1}}));
  EXPECT_EQ(upper.boundaryLabels, (std::vector<int>{5}));
  EXPECT_EQ(readMedit(file.path, {"7"}).boundaryLabels, (std::vector<int>{5, 1, 2}));
  EXPECT_EQ(messageOf([&] {
              readMedit(file.path, {"7", "9"});
            }),
            file.path + ": no region 9, expected one of 7, 8");
  EXPECT_EQ(messageOf([&] { readMedit(file.path, {"7x"}); }),
            file.path + ": no region 7x, expected one of 7, 8");
  // A fault is reported with its line, whatever is kept.
  const TemporaryFile broken(replaced(text, "1 3 4 8", "1 3 5 8"));
  EXPECT_NE(messageOf([&] { readMedit(broken.path, {"7"}); }).find(":17: triangle 2"), std::string::npos);
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

}  // namespace mortier::medit_test
