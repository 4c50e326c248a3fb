// Text of others on one line, in valid UTF-8.
#include "base/printable.h"

#include <gtest/gtest.h>

#include <random>

namespace mortier::printable_test {

// The first and last characters of each number of bytes are there.
TEST(Printable, visibleTextStays) {
  for (const std::string text :
       {"", "a b~", "é 日本 𝄞", "\u00a0\u07ff\u0800\uffef\U00010000\U0010fffd", "\"'$<>\\"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, controlCharactersAndBrokenBytesAreShownAsQuestionMarks) {
  EXPECT_EQ(printable("a\nb\r\x1b[2J\x7f"), "a?b??[2J?");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\xc2\x9b"), "?");  // control characters of two bytes
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "x\xe2\x80\xa8"),
            "?x?");  // right to left, line separator
  EXPECT_EQ(printable("\xff\xc0\x80z\xed\xa0\x80"), "???z???");
  EXPECT_EQ(printable("\xf0\x9d\x84"), "???");  // cut off
}

TEST(Printable, lengthIsBoundedAndNoCharacterIsCut) {
  const std::string text = "begin" + std::string(1000000, 'x') + "end";
  const std::string shown = printable(text, 100);
  EXPECT_LE(shown.size(), 100);
  EXPECT_EQ(shown.substr(0, 6), "beginx");
  EXPECT_EQ(shown.substr(shown.size() - 4), "xend");
  std::string wide;
  for (int i = 0; i < 100; ++i) wide += "日";
  for (size_t most = 5; most < 40; ++most) {
    const std::string cut = printable(wide, most);
    EXPECT_LE(cut.size(), most);
    EXPECT_EQ(printable(cut), cut);
  }
}

TEST(Printable, isNeutralToItsOwnResult) {
  std::mt19937 random(3);
  for (int n = 0; n < 2000; ++n) {
    std::string bytes(random() % 40, ' ');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const std::string once = printable(bytes);
    EXPECT_EQ(printable(once), once);
    EXPECT_EQ(once.find('\n'), std::string::npos);
  }
}

}  // namespace mortier::printable_test
