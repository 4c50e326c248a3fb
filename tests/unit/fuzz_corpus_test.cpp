// The corpus of tests/fuzz, and what becomes of it by seeded changes: no reader crashes, whatever it is
// given.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <vector>

#include "fuzz/readers.h"

namespace mortier::fuzz_corpus_test {

std::vector<std::string> corpus() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(MORTIER_CORPUS)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> found;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    found.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return found;
}

/// Some bytes changed, gone, doubled, or taken from another text of the same reader.
std::string changed(std::string text, const std::vector<std::string>& all, std::mt19937& random) {
  const auto at = [&] { return 1 + random() % std::max<size_t>(text.size(), 2); };
  for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
    const size_t begin = std::min<size_t>(at(), text.size());
    const size_t size = random() % 12;
    switch (random() % 5) {
      case 0:
        if (begin < text.size()) text[begin] = static_cast<char>(random());
        break;
      case 1:
        text.erase(begin, size);
        break;
      case 2:
        text.insert(begin, text.substr(begin, size));
        break;
      case 3: {
        const std::string& other = all[random() % all.size()];
        text.insert(begin, other.substr(std::min<size_t>(random() % (other.size() + 1), other.size()), size));
        break;
      }
      default: {
        constexpr const char* words[] = {"1e999", "-1", "nan", "\"", "\n", "[", "}", "99999999999999999999",
                                         "\xff"};
        text.insert(begin, words[random() % std::size(words)]);
      }
    }
  }
  return text;
}

TEST(Readers, takeOrRefuseTheCorpus) {
  std::map<char, int> taken;
  std::map<char, int> refused;
  for (const std::string& bytes : corpus()) ++(isRefused(bytes) ? refused : taken)[bytes[0]];
  for (const char reader : std::string("smetocp")) EXPECT_GT(taken[reader], 0) << reader;
  for (const char reader : std::string("smgetoc")) EXPECT_GT(refused[reader], 0) << reader;
}

TEST(Readers, takeOrRefuseWhatBecomesOfIt) {
  constexpr int each = 200;
  constexpr int few = 2;  // of those that need a process
  const std::vector<std::string> all = corpus();
  std::mt19937 random(5);
  int refused = 0;
  for (const std::string& bytes : all)
    for (int n = 0; n < (bytes[0] == 'g' ? few : each); ++n)
      refused += isRefused(changed(bytes, all, random)) ? 1 : 0;
  EXPECT_GT(refused, each);
}

}  // namespace mortier::fuzz_corpus_test
