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

void Ranks::gatherToFirst(const std::vector<double>& own, const std::vector<size_t>& sizes, double* all) {
  gather(own, sizes, all);
}

bool anyOf(Ranks& ranks, bool own) {
  double any = own ? 1 : 0;
  ranks.largest(&any, 1);
  return any > 0;
}

std::string textOfAny(Ranks& ranks, const std::string& text) {
  double first = text.empty() ? 0 : ranks.count() - ranks.rank();
  const double own = first;
  ranks.largest(&first, 1);
  const bool reports = own > 0 && own == first;
  auto size = static_cast<double>(reports ? text.size() : 0);
  ranks.sum(&size, 1);
  std::vector<double> letters(static_cast<size_t>(size));
  if (reports) std::copy(text.begin(), text.end(), letters.begin());
  ranks.sum(letters.data(), letters.size());
  std::string result;
  for (const double letter : letters) result += static_cast<char>(letter);
  return result;
}

double numberOfFirst(Ranks& ranks, double number) {
  if (!ranks.first()) number = 0;
  ranks.sum(&number, 1);
  return number;
}

std::string textOfFirst(Ranks& ranks, const std::string& text) {
  return textOfAny(ranks, ranks.first() ? text : "");
}

}  // namespace mortier
