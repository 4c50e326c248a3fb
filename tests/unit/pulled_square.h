// A square on rollers whose top is pulled: the stress (0, f(t), 0) is that of every point, whatever flows.
#pragma once

#include <functional>

#include "base/error.h"
#include "material/perzyna.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "time/march.h"
#include "unit/plate.h"

namespace mortier::pulled {

using namespace plate;

constexpr double young = 100;

/// Yields at a stress of 1.
inline Model square(const std::function<double(double)>& load) {
  Conditions conditions;
  conditions.displacements = {{left, alongX, constant(0)}, {bottom, alongY, constant(0)}};
  conditions.tractions = {{top, alongY, [load](double, double, double t) { return load(t); }}};
  Model model;
  model.bodies.emplace_back("square", crissCrossMesh({.cellsX = 1, .cellsY = 2}),
                            perzynaMaterial({young, 0.3}, {0.5, 1, Projection::frobenius}), conditions);
  return model;
}

inline Matrix uniform(const Model& model, double stress) {
  return fromCartesian(Eigen::Vector3d(0, stress, 0)).replicate(1, model.bodies[0].points());
}

inline void expectStress(const State& state, double stress) {
  const Matrix& all = state.bodies[0].stress;
  for (Eigen::Index i = 0; i < all.cols(); ++i)
    EXPECT_LE((toCartesian(all.col(i)) - Eigen::Vector3d(0, stress, 0)).norm(), 1e-11 * (1 + stress));
}

/// The viscoplastic rate under that stress.
inline Vector rate(const Model& model, double stress) {
  Matrix result;
  model.bodies[0].material().viscoplasticRate(uniform(model, stress), result);
  return result.col(0);
}

inline double topDisplacement(const Model& model, const State& state) {
  const std::vector<Point>& vertices = model.bodies[0].mesh().vertices;
  for (size_t v = 0; v < vertices.size(); ++v)
    if (vertices[v].y() == 1) return state.bodies[0].displacement[2 * static_cast<Eigen::Index>(v) + 1];
  return NAN;
}

inline const Observer unobserved = [](const State&, const StepReport&) {};

}  // namespace mortier::pulled
