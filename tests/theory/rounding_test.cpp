// The same scene with its meshes turned or renumbered: only rounding differs, and by no more than the
// certificate says.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "theory/scenes.h"

namespace mortier::rounding_test {

using namespace scenes;

struct Numbering {
  std::vector<int> vertex;    ///< new number of each
  std::vector<int> triangle;  ///< old number at each new place
};

Numbering shuffled(const TriangleMesh& mesh, unsigned seed) {
  Numbering result{std::vector<int>(mesh.vertices.size()), std::vector<int>(mesh.triangles.size())};
  std::mt19937 random(seed);
  for (std::vector<int>* order : {&result.vertex, &result.triangle}) {
    std::iota(order->begin(), order->end(), 0);
    if (seed > 0) std::shuffle(order->begin(), order->end(), random);
  }
  return result;
}

TriangleMesh changed(const TriangleMesh& mesh, const Numbering& numbering, double angle) {
  TriangleMesh result = mesh;
  for (size_t v = 0; v < mesh.vertices.size(); ++v)
    result.vertices[numbering.vertex[v]] = Eigen::Rotation2D<double>(angle) * mesh.vertices[v];
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int a = 0; a < 3; ++a)
      result.triangles[t][a] = numbering.vertex[mesh.triangles[numbering.triangle[t]][a]];
  for (auto& edge : result.boundaryEdges)
    for (int& v : edge) v = numbering.vertex[v];
  return result;
}

struct Solved {
  std::vector<std::vector<double>> vonMises;  ///< per body, in the first numbering
  RunReport report;
  int open = 0;
};

/// The note's blocks, pressed on the left half of the top and pulled on the right one, where contact opens.
Solved solve(double angle, unsigned seed, Projection projection, CouplingKind coupling) {
  const auto material = perzynaMaterial(noteElasticity, noteLaw(projection));
  const TriangleMesh upper = square(0, 6);
  const TriangleMesh lower = square(-1, 16);
  const Numbering numberings[] = {shuffled(upper, seed), shuffled(lower, seed)};
  const Function load = [angle](double x, double y, double t) {
    const Point before = Eigen::Rotation2D<double>(-angle) * Point(x, y);
    return before.x() < 0.45 ? -10 * t : 3 * t;
  };
  Body upperBlock("upper", changed(upper, numberings[0], angle), material,
                  {{{left, alongNormal, constant(0)}}, {{top, alongNormal, load}}, {}});
  Body lowerBlock("lower", changed(lower, numberings[1], angle), material,
                  {{{left, alongNormal, constant(0)}, {bottom, alongNormal, constant(0)}}, {}, {}});
  const Model model = contactModel(std::move(upperBlock), std::move(lowerBlock), coupling, upperBody);
  const Result result = run(model, 1, 4);
  Solved solved{{}, result.report, 0};
  for (size_t b = 0; b < 2; ++b) {
    solved.vonMises.emplace_back(model.bodies[b].points());
    for (int i = 0; i < model.bodies[b].points(); ++i)
      solved.vonMises[b][numberings[b].triangle[i]] = vonMises(result.state.bodies[b].stress.col(i));
  }
  solved.open = static_cast<int>((result.state.contactForce[0].array() == 0).count());
  return solved;
}

TEST(Rounding, turnedAndRenumberedScenesDifferByWhatTheCertificateSays) {
  for (const Projection projection : {Projection::elasticity, Projection::frobenius})
    for (const CouplingKind coupling : couplings) {
      const Solved one = solve(0, 0, projection, coupling);
      ASSERT_EQ(one.report.status, Status::converged) << one.report.reason;
      EXPECT_GT(one.open, 0);
      for (const auto& [angle, seed] : {std::pair{0.0, 1U}, std::pair{0.7, 0U}, std::pair{2.0, 2U}}) {
        const Solved other = solve(angle, seed, projection, coupling);
        ASSERT_EQ(other.report.status, Status::converged) << other.report.reason;
        double worst = 0;
        for (size_t b = 0; b < 2; ++b)
          for (size_t i = 0; i < one.vonMises[b].size(); ++i)
            worst = std::max(worst, std::abs(one.vonMises[b][i] - other.vonMises[b][i]));
        const auto said = [](const Certificate& c) { return c.materialResidual + c.rounding; };
        const double bound =
            said(one.report.worst) + said(other.report.worst);  // over the yield stress, 1 Pa
        EXPECT_LE(worst, bound);
        std::cout << nameOf(coupling) << ", turned by " << angle << ", numbering " << seed
                  << ": stresses differ by " << worst << " Pa, certified " << bound << "\n";
      }
    }
}

}  // namespace mortier::rounding_test
