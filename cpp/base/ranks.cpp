#include "base/ranks.h"

#include <algorithm>

namespace mortier {

namespace {
Ranks one;
}  // namespace

Ranks* Ranks::all_ = &one;

void Ranks::gather(const std::vector<double>& own, const std::vector<size_t>& /*sizes*/, double* all) {
  std::copy(own.begin(), own.end(), all);
}

double numberOfFirst(Ranks& ranks, double number) {
  if (!ranks.first()) number = 0;
  ranks.sum(&number, 1);
  return number;
}

std::string textOfFirst(Ranks& ranks, const std::string& text) {
  std::vector<double> letters(static_cast<size_t>(numberOfFirst(ranks, static_cast<double>(text.size()))));
  if (ranks.first()) std::copy(text.begin(), text.end(), letters.begin());
  ranks.sum(letters.data(), letters.size());
  std::string result;
  for (const double letter : letters) result += static_cast<char>(letter);
  return result;
}

}  // namespace mortier
