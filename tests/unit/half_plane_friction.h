// Contact of half planes with friction on n elements: known tractions, and a history of steps.
#pragma once

#include <cmath>

#include "unit/enumerated_friction.h"

namespace mortier {

/// Half a plane: the compliance log|x - y| against p and against t, coupled by beta as Dundurs has it.
inline FrictionCase halfPlane(int n, double mu, double beta, double push, double pull) {
  Matrix W = Matrix::Zero(2 * n, 2 * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double mean = 0;  // of -log over an element
      for (const int end : {-1, 1}) {
        const double x = i - j + 0.5 * end;
        mean -= end * x * (std::log(std::abs(x)) - 1);
      }
      W(i, j) = W(n + i, n + j) = mean + std::log(4.0 * n);
      const double side = i == j ? 0 : (i > j ? 1 : -1);
      W(i, n + j) = beta * M_PI / 2 * side;
      W(n + j, i) = beta * M_PI / 2 * side;
    }
  Vector q(2 * n);
  for (int i = 0; i < n; ++i) {
    const double x = (2.0 * i - n + 1) / n;
    q[i] = n * (4 * x * x - push);
    q[n + i] = n * pull;
  }
  return frictionCase(W, mu, q);
}

/// A step of a history on [0, 4]: pushed, pulled along, pulled back, let go, in so many steps each. What slip
/// there was is taken off q. \param slip  of the step before; becomes that of this one
inline FrictionCase stepOfHistory(int n, int step, int steps, double& slip) {
  const int phase = (step - 1) / steps;
  const double part = (step - phase * steps) / static_cast<double>(steps);
  const double push = 9 * (phase == 0 ? part : phase == 3 ? 1 - 1.5 * part : 1);  // on 80 % of the line
  const double pull = 2.5 * (phase == 1 ? part : phase == 2 ? 1 - 2 * part : phase == 3 ? -1 : 0);
  FrictionCase c = halfPlane(n, 0.4, 0.3, push, pull);
  c.q.tail(n).setConstant(n * (pull - slip));
  slip = pull;
  return c;
}

// Half planes pressed by a parabola to a half width of about 1, then pushed along (Cattaneo 1938, Mindlin
// 1949), on n elements of this line.
constexpr double halfOfMindlinsLine = 1.25;

inline double placeOfMindlin(int n, int i) {
  return ((i + 0.5) * 2 / n - 1) * halfOfMindlinsLine;
}

inline FrictionCase mindlinCase(int n, double mu) {
  const double h = 2 * halfOfMindlinsLine / n;
  FrictionCase c = halfPlane(n, mu, 0, 0, 0);
  // How far Hertz's pressure on [-r, r] moves the middle: forces on elements, the kernel of halfPlane.
  const auto depth = [&](double r) {
    return r * r / 2 * (std::log(4 * n * h) - std::log(r) + 0.5 + std::log(2.0));
  };
  for (int i = 0; i < n; ++i) {
    const double x = placeOfMindlin(n, i);
    c.q[i] = x * x / 2 - depth(1);
    c.q[n + i] = -mu * (depth(1) - depth(std::sqrt(0.2)));
  }
  return c;
}

/// The exact forces along the line by elements: mu times the difference of the pressures of Hertz under P and
/// under P - Q/mu.
inline Vector mindlinTraction(int n, double mu, double P, double Q) {
  const double h = 2 * halfOfMindlinsLine / n;
  const double a = std::sqrt(2 * P);
  // The integral of 2P/(pi a) sqrt(1 - x^2/a^2) over an element.
  const auto hertz = [&](double radius, int i) {
    const auto upTo = [&](double x) {
      const double s = std::clamp(x / radius, -1.0, 1.0);
      return radius * radius / (2 * M_PI) * (s * std::sqrt(1 - s * s) + std::asin(s));
    };
    return upTo(placeOfMindlin(n, i) + h / 2) - upTo(placeOfMindlin(n, i) - h / 2);
  };
  Vector t(n);
  for (int i = 0; i < n; ++i) t[i] = mu * (hertz(a, i) - hertz(a * std::sqrt(1 - Q / (mu * P)), i));
  return t;
}

}  // namespace mortier
