// The note's measure of interpenetration, the integral over Gamma_C of ((u1 - u2).n - g0)_+, on the common
// refinement. Between its points the jump of linear traces is taken as linear (of curves in two halves), that
// of quadratic ones as the parabola through its value in the middle too: exact where the nonmortar line is
// straight. And the squares of the jump, element by element, from which the error between the nodes of
// contact is estimated.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "contact/common_refinement.h"

namespace mortier {

/// Of a stretch of the common refinement.
struct GapSquare {
  std::array<int, 2> nonmortar, mortar;  ///< vertex numbers of the two elements
  double element = 0;                    ///< length of the nonmortar one [m]
  double integral = 0;                   ///< [m^3], of the whole surface [m^4]
};

/// A piece of the common refinement, from its begin to its end along the nonmortar line.
struct RefinedPiece {
  std::array<int, 2> nonmortar, mortar;         ///< vertex numbers of the two elements
  std::array<double, 2> nonmortarAt, mortarAt;  ///< where it begins and ends, as parts of the elements
  std::array<Point, 2> normals;                 ///< directions of contact there
  std::array<double, 2> distances;              ///< of the bodies there [m]
  double length = 0;                            ///< [m]
};

class PenetrationIntegral {
 public:
  /// Adds a part of the nonmortar line with what it faces, which may turn about the axis x = 0.
  void add(const CommonRefinement& refinement, const DistanceAt& distance, bool axisymmetric = false);
  /// Takes the distances that were added for those between bodies that these displacements have moved.
  void setMoved(const Vector& uNonmortar, const Vector& uMortar);
  /// Displacements by dofs of the two bodies [m]. \returns [m^2], in the plane of the mesh whatever turns
  /// \param gap  by node of the nonmortar mesh, in place of the distance that was added; or empty [m]
  [[nodiscard]] double of(const Vector& uNonmortar, const Vector& uMortar, const Vector& gap = {}) const;
  /// The integral of the squared jump where a vertex of the nonmortar element is `pressed`, of its squared
  /// positive part elsewhere.
  [[nodiscard]] std::vector<GapSquare> squares(const Vector& uNonmortar, const Vector& uMortar,
                                               const std::function<bool(int vertex)>& pressed,
                                               const Vector& gap = {}) const;
  /// The common refinement, of straight elements where traces are linear.
  [[nodiscard]] std::vector<RefinedPiece> pieces() const;

 private:
  /// A point of the common refinement, on one of its segments.
  struct Place {
    EdgeNodes nonmortar, mortar;  ///< node numbers of the two elements
    EdgeValues phi, psi;          ///< their shape functions there
    Point normal;
    double distance = 0;
    [[nodiscard]] double jump(const Vector& uNonmortar, const Vector& uMortar, const Vector& gap = {}) const;
  };
  /// Between a place and the next one, or the next but one where it is a parabola.
  struct Stretch {
    int first = 0;
    bool parabola = false;
    double length = 0;
    double element = 0;  ///< length of the nonmortar one [m]
    double depth = 1;    ///< circumference in the middle where the line turns about the axis [m]
  };
  std::vector<Place> places_;
  std::vector<Stretch> stretches_;
};

}  // namespace mortier
