// Quadrature rules: places and weights, which sum up to 1.
#pragma once

#include <array>

namespace mortier {

/// A place in [0, 1] and its weight.
struct EdgePlace {
  double at = 0, weight = 0;
};
/// Gauss's, exact for polynomials of degree 5 and 7.
inline constexpr std::array<EdgePlace, 3> gaussThree{{{0.11270166537925831, 5.0 / 18},  //
                                                      {0.5, 8.0 / 18},
                                                      {0.88729833462074169, 5.0 / 18}}};
inline constexpr std::array<EdgePlace, 4> gaussFour{{{0.069431844202973712, 0.17392742256872693},
                                                     {0.33000947820757187, 0.32607257743127307},
                                                     {0.66999052179242813, 0.32607257743127307},
                                                     {0.93056815579702629, 0.17392742256872693}}};
/// Lobatto's, with the ends, of degree 11.
inline constexpr std::array<EdgePlace, 7> lobattoSeven{{{0, 1.0 / 42},
                                                        {0.084888051860716535, 0.13841302368078297},
                                                        {0.26557560326464290, 0.21587269060493131},
                                                        {0.5, 128.0 / 525},
                                                        {0.73442439673535710, 0.21587269060493131},
                                                        {0.91511194813928346, 0.13841302368078297},
                                                        {1, 1.0 / 42}}};

/// Barycentric coordinates of a place in a triangle, and its weight.
struct TrianglePlace {
  std::array<double, 3> at{};
  double weight = 0;
};
/// The centroid, unless its weight is 0, and the three places each with one coordinate apart from the others.
template <size_t count, size_t groups>
constexpr std::array<TrianglePlace, count> symmetricRule(
    double ofCentroid, const std::array<std::array<double, 2>, groups>& apart) {
  std::array<TrianglePlace, count> rule{};
  size_t n = 0;
  if (ofCentroid > 0) rule[n++] = {{1.0 / 3, 1.0 / 3, 1.0 / 3}, ofCentroid};
  for (const auto& [own, weight] : apart)
    for (size_t k = 0; k < 3; ++k) {
      TrianglePlace& place = rule[n++];
      place.at.fill((1 - own) / 2);
      place.at[k] = own;
      place.weight = weight;
    }
  return rule;
}
/// Of degree 4 (Dunavant, International Journal for Numerical Methods in Engineering 21, 1985).
inline constexpr auto dunavantSix = symmetricRule<6, 2>(
    0, {{{0.10810301816807023, 0.22338158967801146}, {0.81684757298045851, 0.10995174365532187}}});
/// Of degree 5 (Radon, Monatshefte fuer Mathematik 52, 1948).
inline constexpr auto radonSeven = symmetricRule<7, 2>(
    0.225, {{{0.059715871789769820, 0.13239415278850618}, {0.79742698535308732, 0.12593918054482715}}});

}  // namespace mortier
