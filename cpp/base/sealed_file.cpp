#include "base/sealed_file.h"

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

std::string sealed(const std::string& firstLine, const std::string& content) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes = firstLine + "\n";
  const uint64_t size = bytes.size() + content.size() + 2 * sizeof(uint64_t);
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
  bytes += content;
  const uint64_t sum = sumOf(bytes);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return bytes;
}

std::string readSealed(const std::string& path, std::string_view kind) {
  constexpr std::streamsize longest = 100;  // line
  std::ifstream file(path, std::ios::binary);
  const uint64_t size = std::filesystem::file_size(path);
  std::string bytes(longest, '\0');
  file.getline(bytes.data(), longest);
  bytes.resize(static_cast<size_t>(file.gcount()));
  if (!file.good() || bytes.compare(0, kind.size(), kind) != 0)
    throw InputError("not of this version of mortier");
  bytes.back() = '\n';
  // The rest is not read where the file has another size.
  const size_t head = bytes.size() + sizeof(uint64_t);
  uint64_t sum = 0;
  uint64_t stored = 0;
  if (size < head + sizeof sum) throw InputError("too short");
  if (!file.read(reinterpret_cast<char*>(&stored), sizeof stored)) throw InputError("cannot be read");
  if (stored != size) throw InputError("damaged");
  bytes.append(reinterpret_cast<const char*>(&stored), sizeof stored);
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
