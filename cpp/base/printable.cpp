#include "base/printable.h"

#include <algorithm>
#include <cstdint>

namespace mortier {

namespace {

/// Bytes of the character that text begins with, 0 where it is not valid; and its code point.
std::pair<size_t, uint32_t> firstCharacter(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {1, byte(0)};
  const size_t size = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < size) return {0, 0};
  uint32_t code = byte(0) & (0xffU >> (size + 1));
  for (size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return {0, 0};
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return {code < least[size] || surrogate || code > 0x10ffff ? 0 : size, code};
}

bool isVisible(uint32_t code) {
  const auto within = [&](uint32_t first, uint32_t last) { return code >= first && code <= last; };
  return !(within(0, 0x1f) || within(0x7f, 0x9f) || within(0x200b, 0x200f) || within(0x2028, 0x202e) ||
           within(0x2060, 0x206f) || code == 0xfeff || within(0xfff0, 0xfffb) || (code & 0xfffeU) == 0xfffe ||
           within(0xe0000, 0xe0fff) || code == 0x061c);
}

bool isContinued(std::string_view text, size_t i) {
  return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0U) == 0x80;
}

}  // namespace

std::string printable(std::string_view text, size_t most) {
  constexpr std::string_view gap = " ... ";
  std::string result;
  while (!text.empty()) {
    const auto [size, code] = firstCharacter(text);
    if (size > 0 && isVisible(code))
      result += text.substr(0, size);
    else
      result += '?';
    text.remove_prefix(std::max<size_t>(size, 1));
  }
  if (result.size() <= most) return result;
  const size_t half = (most - std::min(most, gap.size())) / 2;
  size_t head = half;
  while (head > 0 && isContinued(result, head)) --head;
  size_t tail = result.size() - half;
  while (isContinued(result, tail)) ++tail;
  return result.substr(0, head).append(gap).append(result.substr(tail));
}

}  // namespace mortier
