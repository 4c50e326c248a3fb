// Mortar on the contact whose solution and end are known: a body on a rigid base, two bodies of any contrast.
#include <gtest/gtest.h>

#include <array>
#include <iostream>

#include "theory/half_open_contact.h"

namespace mortier::known_end_test {

using namespace scenes;

constexpr double contactForce = 0.769126488659;  // 2/3 1.1^(3/2)

/// A body that is held on all of its contact line: a rigid base, whatever its stiffness.
Body rigidBase(int cells) {
  return {
      "base",
      crissCrossMesh({.lower = {-0.9, -1}, .upper = {1.1, 0}, .cellsX = cells, .cellsY = (cells + 1) / 2}),
      elasticMaterial({1, 0.3}),
      {{{top, 0, constant(0)}, {top, 1, constant(0)}}, {}, {}}};
}

struct Solved {
  std::vector<double> errors;  ///< in energy, of each deformable body over its exact solution
  double force = 0;            ///< of contact
  double end = 1;              ///< place of the first node in contact, exact 0
  Certificate residuals;
};

/// Bodies above and, where it is deformable, below the line.
struct Setting {
  std::string name;
  double contrast = 1;  ///< E of the lower body over that of the upper
  std::vector<HalfOpenContact> exact;
  int nonmortar = upperBody;

  [[nodiscard]] Solved solve(int upperCells, int lowerCells) const {
    Body lower = exact.size() == 2 ? exact[1].body(lowerCells) : rigidBase(lowerCells);
    const Model model =
        contactModel(exact[0].body(upperCells), std::move(lower), CouplingKind::mortar, nonmortar);
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    Solved solved;
    solved.residuals = report.worst;
    for (size_t b = 0; b < exact.size(); ++b) {
      double error = 0;
      double norm = 0;
      exact[b].addEnergies(model.bodies[b], state.bodies[b].stress, error, norm);
      solved.errors.push_back(std::sqrt(error / norm));
    }
    solved.force = state.contactForce[0].sum();
    const ContactInterface& interface = model.interfaces[0];
    for (int i = 0; i < interface.rows(); ++i)
      if (state.contactForce[0][i] > 0)
        solved.end =
            std::min(solved.end, model.bodies[nonmortar].mesh().vertices[interface.nonmortarNodes()[i]].x());
    return solved;
  }
};

std::vector<Setting> settings(Plane plane = Plane::stress) {
  std::vector<Setting> all;
  for (const int nonmortar : {upperBody, lowerBody}) {
    const std::string side = nonmortar == upperBody ? ", nonmortar coarse" : ", nonmortar fine";
    all.push_back({"one body" + side, 1, {{{1, 0.3}, false, plane}}, nonmortar});
    for (const double contrast : {1.0, 1e3, 1e6})
      all.push_back({"contrast " + std::to_string(static_cast<int>(contrast)) + side,
                     contrast,
                     {{{1, 0.3}, false, plane}, {{contrast, 0.2}, true, plane}},
                     nonmortar});
  }
  return all;
}

void expectFirstOrder(const std::vector<Setting>& all) {
  constexpr double leastOrder = 0.95;      // tends to 1
  constexpr double forceTolerance = 1e-4;  // of order h^2
  const std::array<std::pair<int, int>, 4> meshes{{{8, 12}, {16, 24}, {32, 49}, {64, 97}}};
  for (const Setting& setting : all) {
    std::vector<double> h;
    std::vector<std::vector<double>> errors(setting.exact.size());
    Solved solved;
    for (const auto& [upperCells, lowerCells] : meshes) {
      solved = setting.solve(upperCells, lowerCells);
      h.push_back(1.0 / upperCells);
      EXPECT_LE(std::abs(solved.end), 2.0 / (setting.nonmortar == upperBody ? upperCells : lowerCells))
          << setting.name << ", " << upperCells << " cells";
      for (size_t b = 0; b < errors.size(); ++b) errors[b].push_back(solved.errors[b]);
    }
    std::cout << setting.name << ": contact force " << solved.force - contactForce << " off";
    for (size_t b = 0; b < errors.size(); ++b) {
      std::cout << (b == upperBody ? "; energy error, upper body" : "; lower body") << ", order "
                << fittedOrder(h, errors[b]) << ", last " << errors[b].back();
      EXPECT_GE(fittedOrder(h, errors[b]), leastOrder) << setting.name;
    }
    std::cout << "\n";
    EXPECT_NEAR(solved.force, contactForce, forceTolerance) << setting.name;
  }
}

TEST(KnownEnd, mortarIsOfFirstOrderInEveryBody) {
  expectFirstOrder(settings());
}

TEST(KnownEnd, mortarIsOfFirstOrderInPlaneStrain) {
  expectFirstOrder(settings(Plane::strain));
}

// Distance of the first node in contact from the end of contact, on meshes that lie in many ways to it. It is
// below an element of the nonmortar side where that is the coarser one, or as soft as the other. A stiff
// nonmortar side that is finer asks more than the soft side can follow between two of its nodes: there it may
// be two elements, one and a half of the coarser side.
TEST(KnownEnd, contactEndsWithinOneElement) {
  for (const Setting& setting : settings()) {
    const bool rigid = setting.exact.size() == 1;
    if (rigid && setting.nonmortar == lowerBody) continue;  // forces are not unique there
    double inNonmortar = 0;
    double inCoarser = 0;
    double inFiner = 0;
    for (int upperCells = 8; upperCells <= 48; upperCells += 4)
      for (const double ratio : {1.23, 1.5}) {
        const int lowerCells = static_cast<int>(std::lround(ratio * upperCells));
        const double distance = std::abs(setting.solve(upperCells, lowerCells).end);
        inCoarser = std::max(inCoarser, distance * upperCells / 2);
        inFiner = std::max(inFiner, distance * lowerCells / 2);
        inNonmortar = setting.nonmortar == upperBody ? inCoarser : inFiner;
      }
    std::cout << setting.name << ": at most " << inNonmortar << " nonmortar elements, " << inCoarser
              << " of the coarser, " << inFiner << " of the finer mesh\n";
    const bool stiffAndFine = setting.nonmortar == lowerBody && setting.contrast > 1;
    EXPECT_LE(inNonmortar, stiffAndFine ? 2 : 1) << setting.name;
    EXPECT_LE(inCoarser, stiffAndFine ? 1.5 : 1) << setting.name;
  }
}

// Between two nodes of the body the rigid line has more than one: conditions depend on each other, forces are
// not unique, rounding decides on their signs. Each problem is solved all the same, with the exact resultant.
TEST(KnownEnd, rigidNonmortarLineFinerThanTheBodyIsSolved) {
  const Setting rigid{"one body, nonmortar fine", 1, {{{1, 0.3}, false}}, lowerBody};
  double worst = 0;
  for (const auto& [upperCells, lowerCells] :
       std::vector<std::pair<int, int>>{{8, 12}, {24, 36}, {32, 48}, {33, 50}, {48, 59}, {48, 72}}) {
    const Solved solved = rigid.solve(upperCells, lowerCells);
    worst = std::max(worst, std::abs(solved.force - contactForce) * upperCells * upperCells);
    EXPECT_LE(solved.residuals.complementarity, 1e-10) << upperCells << " on " << lowerCells;
  }
  std::cout << "error of the force at most " << worst << " / cells^2\n";
  EXPECT_LE(worst, 0.5);
}

}  // namespace mortier::known_end_test
