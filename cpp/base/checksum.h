// The FNV-1a checksum (64 bits) of bytes that are added in pieces. It detects accidental damage.
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
