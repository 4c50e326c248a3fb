#include "report/sealed_file.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/checksum.h"
#include "base/error.h"

namespace mortier {
namespace {

uint64_t sumOf(std::string_view bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.value;
}

}  // namespace

std::string sealed(std::string_view firstLine, const std::string& content) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes(firstLine);
  const uint64_t size = firstLine.size() + content.size() + 2 * sizeof(uint64_t);
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
  bytes += content;
  const uint64_t sum = sumOf(bytes);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return bytes;
}

std::string readSealed(const std::string& path, std::string_view firstLine) {
  const size_t head = firstLine.size() + sizeof(uint64_t);  // the rest is not read where it has another size
  std::ifstream file(path, std::ios::binary);
  const uint64_t size = std::filesystem::file_size(path);
  uint64_t sum = 0;
  uint64_t stored = 0;
  if (size < head + sizeof sum) throw InputError("too short");
  std::string bytes(head, '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(head))) throw InputError("cannot be read");
  if (bytes.compare(0, firstLine.size(), firstLine) != 0) throw InputError("not of this version of mortier");
  std::memcpy(&stored, bytes.data() + firstLine.size(), sizeof stored);
  if (stored != size) throw InputError("damaged");
  bytes.resize(size);
  if (!file.read(bytes.data() + head, static_cast<std::streamsize>(size - head)))
    throw InputError("cannot be read");
  std::memcpy(&sum, bytes.data() + size - sizeof sum, sizeof sum);
  bytes.resize(size - sizeof sum);
  if (sum != sumOf(bytes)) throw InputError("damaged");
  bytes.erase(0, head);
  return bytes;
}

}  // namespace mortier
