#include "contact/segments.h"

#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

/// Two ends closer than this part of the elements there are one point of Gamma_C.
constexpr double sameEnd = 1e-9;

}  // namespace

Overlap overlapOf(const Trace& nonmortar, const Trace& mortar) {
  const auto same = [](double a, double b, double elementA, double elementB) {
    return std::abs(a - b) <= sameEnd * std::min(elementA, elementB);
  };
  const size_t n = nonmortar.size();
  const size_t m = mortar.size();
  Overlap overlap{std::max(nonmortar[0], mortar[0]), std::min(nonmortar[n - 1], mortar[m - 1])};
  // The merged end is the nonmortar one: its node must not be lost by rounding.
  if (same(nonmortar[0], mortar[0], nonmortar[1] - nonmortar[0], mortar[1] - mortar[0]))
    overlap.begin = nonmortar[0];
  if (same(nonmortar[n - 1], mortar[m - 1], nonmortar[n - 1] - nonmortar[n - 2],
           mortar[m - 1] - mortar[m - 2]))
    overlap.end = nonmortar[n - 1];
  return overlap;
}

std::vector<Segment> commonRefinement(const Trace& nonmortar, const Trace& mortar) {
  std::vector<Segment> segments;
  const Overlap overlap = overlapOf(nonmortar, mortar);
  const auto elements = static_cast<int>(nonmortar.size()) - 1;
  const auto mortarElements = static_cast<int>(mortar.size()) - 1;
  int i = 0;
  int j = 0;
  double begin = overlap.begin;
  while (begin < overlap.end) {
    while (i + 1 < elements && nonmortar[i + 1] <= begin) ++i;
    while (j + 1 < mortarElements && mortar[j + 1] <= begin) ++j;
    double end = overlap.end;
    if (i + 1 < elements) end = std::min(end, nonmortar[i + 1]);
    if (j + 1 < mortarElements) end = std::min(end, mortar[j + 1]);
    segments.push_back({i, j, begin, end});
    begin = end;
  }
  return segments;
}

}  // namespace mortier
