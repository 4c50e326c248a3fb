#include "bound/strip_balance.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "linear/matrix_entries.h"
#include "linear/strip_solver.h"
#include "material/stress.h"

namespace mortier {
namespace {

/// Of triangles: so many, and on long lines one for so many nodes where forces are left over.
constexpr int fewestRings = 8;
constexpr int nodesOfARing = 20;
/// The last ones are far.
constexpr int farRings = 3;
/// Forces that are no more than this part of all are what the solution of the body left by rounding,
constexpr double rounding = 1e-11;
/// and those that strips may leave.
constexpr double balanced = 1e-12;
/// Stiffness of springs, over that of the equations, for strips that nothing else holds.
constexpr double spring = 1e-12;

class Strip {
 public:
  Strip(const Body& body, const Sides& sides, const std::vector<Eigen::Matrix3d>& moduli)
      : body_(body), sides_(sides), moduli_(moduli) {}

  /// Triangles around the nodes where forces are left over.
  void choose(const Vector& left, double least) {
    const TriangleMesh& mesh = body_.mesh();
    std::vector<char> known(mesh.triangles.size(), 0);
    std::vector<char> reached(body_.nodes(), 0);
    std::vector<int> ring;
    for (int v = 0; v < body_.nodes(); ++v)
      if (left.segment<2>(2 * v).cwiseAbs().maxCoeff() > least) {
        reached[v] = 1;
        ring.push_back(v);
      }
    const int rings = std::max(fewestRings, static_cast<int>(ring.size()) / nodesOfARing);
    for (int i = 0; i < rings; ++i) {
      std::vector<int> next;
      for (const int v : ring)
        for (const int t : sides_.trianglesAt(v)) {
          if (std::exchange(known[t], 1) != 0) continue;
          triangles_.push_back(t);
          if (i >= rings - farRings) far_.push_back(t);
          for (const int other : mesh.triangles[t])
            if (std::exchange(reached[other], 1) == 0) next.push_back(other);
        }
      ring = std::move(next);
    }
    std::sort(triangles_.begin(), triangles_.end());
    number_.assign(body_.freeDofs(), -1);
    for (const int t : triangles_)
      for (const int v : mesh.triangles[t])
        for (const auto& [equation, value] : body_.parts(v, Point(0, 0)))
          if (equation >= 0 && number_[equation] < 0) {
            number_[equation] = static_cast<int>(equations_.size());
            equations_.push_back(equation);
          }
  }

  /// Energy of a stress less another in the far rings; none where all of the body is in the strip [J/m].
  [[nodiscard]] double farEnergy(const std::vector<Stress>& stress, const std::vector<Stress>& other) const {
    if (triangles_.size() == stress.size()) return 0;
    double energy = 0;
    for (const int t : far_) {
      const Eigen::Vector3d s = fromCartesian(Stress(stress[t] - other[t]));
      energy += body_.weights()[t] * s.dot(moduli_[t].inverse() * s);
    }
    return energy;
  }

  /// Of forces (dofs) in the strip.
  [[nodiscard]] double largest(const Vector& forces) const {
    const Vector all = body_.gather(forces);
    double result = 0;
    for (const int equation : equations_) result = std::max(result, std::abs(all[equation]));
    return result;
  }

  bool factorise() {
    std::vector<MatrixEntry> entries;
    entries.reserve(21 * triangles_.size());
    for (const int t : triangles_) {
      const Eigen::Matrix<double, 3, 6> B = strains(t);
      const Eigen::Matrix<double, 6, 6> K = body_.weights()[t] * B.transpose() * moduli_[t] * B;
      const std::array<int, 6> at = equationsOf(t);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          if (at[j] >= 0 && at[i] >= at[j]) entries.push_back({at[j], at[i], K(i, j)});
    }
    auto [pattern, values] = assembled(static_cast<int>(equations_.size()), entries);
    for (int c = 0; c < pattern.size; ++c) values[pattern.columnStart[c]] *= 1 + spring;  // the diagonal
    solver_ = stripSolver(pattern);
    return solver_->factorise(values);
  }

  /// Adds the stresses of the strip under forces (dofs), and takes these from them.
  void solve(Vector& left, std::vector<Stress>& stress) const {
    const Vector all = body_.gather(left);
    Vector x = all(equations_);
    solver_->condense(x);
    solver_->expand(x);
    for (const int t : triangles_) {
      const std::array<int, 6> at = equationsOf(t);
      Eigen::Matrix<double, 6, 1> u;
      for (int i = 0; i < 6; ++i) u[i] = at[i] < 0 ? 0 : x[at[i]];
      const Eigen::Matrix<double, 3, 6> B = strains(t);
      const Eigen::Vector3d s = moduli_[t] * (B * u);
      stress[t] += toCartesian(s);
      const Eigen::Matrix<double, 6, 1> forces = body_.weights()[t] * B.transpose() * s;
      for (int i = 0; i < 3; ++i)
        left.segment<2>(2 * body_.mesh().triangles[t][i]) -=
            directions(t, i).transpose() * forces.segment<2>(2 * i);
    }
  }

 private:
  /// Of the two equations of a corner, as rows.
  [[nodiscard]] Eigen::Matrix2d directions(int t, int i) const {
    const int v = body_.mesh().triangles[t][i];
    const auto x = body_.parts(v, Point(1, 0));
    const auto y = body_.parts(v, Point(0, 1));
    Eigen::Matrix2d result;
    result << x[0].value, y[0].value, x[1].value, y[1].value;
    return result;
  }
  [[nodiscard]] std::array<int, 6> equationsOf(int t) const {
    std::array<int, 6> result{};
    for (int i = 0; i < 3; ++i) {
      const auto parts = body_.parts(body_.mesh().triangles[t][i], Point(0, 0));
      for (int k = 0; k < 2; ++k) result[2 * i + k] = parts[k].equation < 0 ? -1 : number_[parts[k].equation];
    }
    return result;
  }
  /// (p, q, r) of the strain by the equations of the corners.
  [[nodiscard]] Eigen::Matrix<double, 3, 6> strains(int t) const {
    const auto& v = body_.mesh().triangles[t];
    Eigen::Matrix<double, 3, 6> B;
    for (int i = 0; i < 3; ++i) {
      const Point opposite = body_.mesh().vertices[v[(i + 2) % 3]] - body_.mesh().vertices[v[(i + 1) % 3]];
      const Point g = Point(-opposite.y(), opposite.x()) / (2 * body_.weights()[t]);
      Eigen::Matrix<double, 3, 2> ofCorner;
      ofCorner.col(0) = fromCartesian({g.x(), 0, g.y() / 2});
      ofCorner.col(1) = fromCartesian({0, g.y(), g.x() / 2});
      B.middleCols<2>(2 * i) = ofCorner * directions(t, i).transpose();
    }
    return B;
  }

  const Body& body_;
  const Sides& sides_;
  const std::vector<Eigen::Matrix3d>& moduli_;
  std::vector<int> triangles_, far_, equations_;
  std::vector<int> number_;  ///< of an equation of the body in the strip; -1 outside
  std::unique_ptr<CondensingSolver> solver_;
};

}  // namespace

std::optional<double> balanceStrip(const Body& body, const Sides& sides,
                                   const std::vector<Eigen::Matrix3d>& moduli, double size, Vector& left,
                                   std::vector<Stress>& stress) {
  constexpr int most = 6;
  const Vector free = body.gather(left);
  if (free.lpNorm<Eigen::Infinity>() <= rounding * size) return 0;
  if (!body.material().symmetricTangent()) return std::nullopt;
  Strip strip(body, sides, moduli);
  strip.choose(body.spread(free), rounding * size);
  if (!strip.factorise()) return std::nullopt;
  std::vector<Stress> found = stress;
  Vector forces = left;
  for (int i = 0; i < most; ++i) {
    strip.solve(forces, found);
    if (!(strip.largest(forces) <= balanced * size)) continue;
    const double far = strip.farEnergy(found, stress);
    left = std::move(forces);
    stress = std::move(found);
    return far;
  }
  return std::nullopt;
}

}  // namespace mortier
