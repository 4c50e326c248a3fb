// FNV-1a of 64 bits, of bytes that come bit by bit: tells accidental damage.
#pragma once

#include <cstdint>
#include <string_view>

namespace mortier {

struct Checksum {
  uint64_t value = 14695981039346656037U;

  void add(std::string_view bytes) {
    for (const char byte : bytes) value = (value ^ static_cast<unsigned char>(byte)) * 1099511628211U;
  }
};

}  // namespace mortier
