// The estimated error of the stress against the true one.
#include "fem/error_estimate.h"

#include <gtest/gtest.h>

#include <iostream>

#include "theory/half_open_contact.h"

namespace mortier::error_estimate_test {

using namespace scenes;

constexpr Elasticity unit{1, 0.3};

Body block(TriangleMesh mesh) {
  return {"block", std::move(mesh), elasticMaterial(unit), {}};
}

Eigen::Vector3d linearStress(const Point& x) {
  return {1 + 2 * x.x() - x.y(), -3 + x.x() + 4 * x.y(), 0.5 - x.x() + x.y()};
}

// With s linear the estimate is the integral of |s - s(centre)|^2, which corner values give: area/12 of their
// sum.
TEST(ErrorEstimate, linearStressesAreRecoveredExactly) {
  for (const Cut cut : {Cut::rising, Cut::both}) {
    const Body body = block(rectangleMesh({.lower = {0, 0}, .upper = {2, 1}, .cellsX = 7, .cellsY = 5}, cut));
    const TriangleMesh& mesh = body.mesh();
    Matrix stress(3, body.points());
    Vector exact(body.points());
    for (int t = 0; t < body.points(); ++t) {
      Point centre = Point::Zero();
      for (const int v : mesh.triangles[t]) centre += mesh.vertices[v] / 3;
      stress.col(t) = linearStress(centre);
      exact[t] = 0;
      for (const int v : mesh.triangles[t])
        exact[t] += body.weights()[t] / 12 *
                    complementaryEnergy(linearStress(mesh.vertices[v]) - stress.col(t), unit);
    }
    const ErrorEstimate estimate = ErrorEstimator(body)(stress);
    EXPECT_LE((estimate.error - exact).lpNorm<Eigen::Infinity>(), 1e-12 * exact.maxCoeff());
  }
}

TEST(ErrorEstimate, stressesMayJumpBetweenRegions) {
  TriangleMesh mesh = square(0, 6);
  const Matrix one = Eigen::Vector3d(1, 2, 3);
  Matrix stress(3, static_cast<Eigen::Index>(mesh.triangles.size()));
  for (Eigen::Index t = 0; t < stress.cols(); ++t) {
    const bool above = mesh.vertices[mesh.triangles[t][0]].y() + mesh.vertices[mesh.triangles[t][1]].y() +
                           mesh.vertices[mesh.triangles[t][2]].y() >
                       1.5;
    mesh.regions[t] = above ? 7 : 3;
    stress.col(t) = (above ? 5 : -1) * one;
  }
  const Body parts = block(mesh);
  EXPECT_LE(ErrorEstimator(parts)(stress).relative(), 1e-14);
  std::fill(mesh.regions.begin(), mesh.regions.end(), 1);
  const Body whole = block(mesh);
  EXPECT_GT(ErrorEstimator(whole)(stress).relative(), 0.1);
}

TEST(ErrorEstimate, threadsChangeNothing) {
  TriangleMesh mesh = square(0, 60);  // some blocks
  for (size_t t = 0; t < mesh.triangles.size(); ++t) mesh.regions[t] = t < 5000 ? 1 : 2;
  for (const int degree : {1, 2}) {
    const Body body("block", mesh, elasticMaterial(unit), {}, degree);
    const Matrix stress = Matrix::Random(3, body.points());
    const ErrorEstimate one = ErrorEstimator(body)(stress);
    for (const int count : {2, 5}) {
      Threads threads(count);
      const ErrorEstimate many = ErrorEstimator(body)(stress, threads);
      EXPECT_TRUE(many.error == one.error && many.energy == one.energy) << count << " threads";
    }
  }
}

TEST(ErrorEstimate, nothingIsEstimatedWithoutStress) {
  const Body body = block(square(0, 2));
  EXPECT_EQ(ErrorEstimator(body)(Matrix::Zero(3, body.points())).relative(), 0);
}

struct Compared {
  double estimated = 0;
  double error = 0;
};

/// Over both bodies of the contact with a known end.
Compared compareHalfOpen(int upperCells, int lowerCells, double contrast, CouplingKind coupling) {
  const HalfOpenContact exact[] = {{{1, 0.3}, false}, {{contrast, 0.2}, true}};
  const Model model = contactModel(exact[0].body(upperCells), exact[1].body(lowerCells), coupling, lowerBody);
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  double error = 0;
  double norm = 0;
  double estimated = 0;
  for (size_t b = 0; b < 2; ++b) {
    exact[b].addEnergies(model.bodies[b], state.bodies[b].stress, error, norm);
    estimated += ErrorEstimator(model.bodies[b])(state.bodies[b].stress).error.sum();
  }
  return {std::sqrt(estimated / norm), std::sqrt(error / norm)};
}

// Estimated over true error tends to 1 where the error is that of the mesh.
TEST(ErrorEstimate, estimatesTheErrorOfContactWithAKnownEnd) {
  for (const double contrast : {1.0, 1e3}) {
    std::cout << "mortar, contrast " << contrast << ", estimated over true error:";
    double last = 0;
    for (const int cells : {8, 16, 32, 64}) {
      const Compared found = compareHalfOpen(cells, 3 * cells / 2 + 1, contrast, CouplingKind::mortar);
      last = found.estimated / found.error;
      std::cout << "  " << last << " (" << found.error << ")";
      EXPECT_NEAR(last, 1, 0.05);
    }
    std::cout << "\n";
    EXPECT_NEAR(last, 1, 0.005);
  }
}

/// The note's compression test, elastic, whose stress is constant: all that is estimated is error.
Compared comparePressed(CouplingKind coupling, int refined) {
  const Model model =
      compression(6 * refined, 16 * refined, elasticMaterial(noteElasticity), coupling, upperBody);
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  const Eigen::Vector3d exact = fromCartesian({0, -10, 0});
  Compared found;
  double norm = 0;
  for (size_t b = 0; b < 2; ++b) {
    found.estimated += ErrorEstimator(model.bodies[b])(state.bodies[b].stress).error.sum();
    for (int t = 0; t < model.bodies[b].points(); ++t) {
      const double weight = model.bodies[b].weights()[t];
      found.error += weight * complementaryEnergy(state.bodies[b].stress.col(t) - exact, noteElasticity);
      norm += weight * complementaryEnergy(exact, noteElasticity);
    }
  }
  return {std::sqrt(found.estimated / norm), std::sqrt(found.error / norm)};
}

TEST(ErrorEstimate, tellsFalseStressesOfInterpolation) {
  EXPECT_LE(comparePressed(CouplingKind::mortar, 1).estimated, 1e-12);
  for (const int refined : {1, 2, 4}) {
    const Compared found = comparePressed(CouplingKind::interpolation, refined);
    std::cout << "interpolation, constant stress: estimated " << found.estimated << ", true " << found.error
              << "\n";
    EXPECT_NEAR(found.estimated / found.error, 1, 0.25);
  }
}

}  // namespace mortier::error_estimate_test
