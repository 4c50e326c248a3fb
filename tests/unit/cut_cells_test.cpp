// Cells cut into simplices: whatever the numbers of their vertices, neighbours agree and no volume is lost.
#include "mesh/cut_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "mesh/tetrahedron_mesh.h"

namespace mortier::cut_cells_test {

constexpr int cells = 3;  // along each axis

int vertexAt(int i, int j, int k) {
  return i + (cells + 1) * (j + (cells + 1) * k);
}

/// Cubes, each as a hexahedron or as two prisms, of a lattice with sheared vertices.
TetrahedronMesh lattice(bool prisms, std::mt19937& random) {
  constexpr int count = (cells + 1) * (cells + 1) * (cells + 1);
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  std::shuffle(numbers.begin(), numbers.end(), random);
  TetrahedronMesh mesh;
  mesh.name = "lattice";
  mesh.vertices.resize(count);
  for (int k = 0; k <= cells; ++k)
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i)
        mesh.vertices[numbers[vertexAt(i, j, k)]] = SpacePoint(i + 0.2 * j, j, k + 0.1 * i);
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        std::array<int, 8> v{};
        for (int c = 0; c < 8; ++c) {
          const int along = c % 4;
          v[c] = numbers[vertexAt(i + (along == 1 || along == 2 ? 1 : 0), j + along / 2, k + c / 4)];
        }
        if (prisms) {
          cutCell(std::array{v[0], v[1], v[2], v[4], v[5], v[6]}, mesh.tetrahedra);
          cutCell(std::array{v[0], v[2], v[3], v[4], v[6], v[7]}, mesh.tetrahedra);
        } else {
          cutCell(v, mesh.tetrahedra);
        }
      }
  mesh.regions.assign(mesh.tetrahedra.size(), 0);
  return mesh;
}

TEST(CutCells, neighboursAgreeWhateverTheNumbers) {
  std::mt19937 random(3);
  for (int round = 0; round < 40; ++round) {
    TetrahedronMesh mesh = lattice(round % 2 == 1, random);
    EXPECT_EQ(mesh.tetrahedra.size(), 6u * cells * cells * cells);
    ASSERT_NO_THROW(validate(mesh));
    EXPECT_EQ(outerTriangles(mesh).size(), 6u * 2 * cells * cells)
        << "a diagonal that neighbours do not share";
    double sum = 0;
    for (const auto& tetrahedron : mesh.tetrahedra) sum += volume(mesh, tetrahedron);
    EXPECT_NEAR(sum, cells * cells * cells, 1e-12 * cells * cells * cells * 10);
  }
}

TEST(CutCells, quadranglesAreCutFromTheirSmallestVertex) {
  std::vector<std::array<int, 3>> triangles;
  cutCell(std::array{7, 9, 2, 4}, triangles);
  EXPECT_EQ(triangles, (std::vector<std::array<int, 3>>{{2, 4, 7}, {2, 7, 9}}));
}

// Collapsed, as other programs write prisms where they have hexahedra only.
TEST(CutCells, whatHasNoVolumeIsLeftOut) {
  std::vector<std::array<int, 4>> prism;
  std::vector<std::array<int, 4>> collapsed;
  cutCell(std::array{0, 1, 2, 3, 4, 5}, prism);
  cutCell(std::array{0, 1, 2, 2, 3, 4, 5, 5}, collapsed);
  std::sort(prism.begin(), prism.end());
  std::sort(collapsed.begin(), collapsed.end());
  EXPECT_EQ(prism.size(), 3u);
  EXPECT_EQ(collapsed.size(), 3u);
  std::vector<std::array<int, 3>> triangles;
  cutCell(std::array{3, 1, 2, 2}, triangles);
  EXPECT_EQ(triangles.size(), 1u);
}

}  // namespace mortier::cut_cells_test
