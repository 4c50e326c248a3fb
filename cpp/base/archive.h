// Plain data to bytes and back. Numbers, texts, matrices, lists and maps are known; for any other type the
// archive calls visitMembers(archive, value), which names the members. Bytes are in this machine's order.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/types.h"

namespace mortier {

/// Writes values into `bytes`, or reads them from it. \throws InputError where these do not match the types.
template <bool reads>
class Archive {
 public:
  explicit Archive(std::conditional_t<reads, std::string_view, std::string> from = {}) : bytes(from) {}

  std::conditional_t<reads, std::string_view, std::string> bytes;  ///< written so far, or still to be read

  template <class... T>
  void operator()(T&... values) {
    (take(values), ...);
  }

 private:
  void raw(void* data, size_t size) {
    if constexpr (reads) {
      if (size > bytes.size()) throw InputError("too short");
      if (size > 0) std::memcpy(data, bytes.data(), size);
      bytes.remove_prefix(size);
    } else {
      bytes.append(static_cast<const char*>(data), size);
    }
  }
  /// The number of items that follow, each of a byte at least.
  uint64_t size(uint64_t n) {
    raw(&n, sizeof n);
    if (reads && n > bytes.size()) throw InputError("too short");
    return n;
  }
  void take(bool& value) {
    char byte = value ? 1 : 0;
    raw(&byte, sizeof byte);
    if (byte != 0 && byte != 1) throw InputError("neither true nor false");
    value = byte == 1;
  }
  void take(std::string& text) {
    text.resize(size(text.size()));
    raw(text.data(), text.size());
  }
  template <class T>
  void take(std::optional<T>& value) {
    bool given = value.has_value();
    take(given);
    if (!given) value.reset();
    if (given) take(value ? *value : value.emplace());
  }
  template <class T, size_t n>
  void take(std::array<T, n>& values) {
    for (T& value : values) take(value);
  }
  template <int Rows, int Columns>
  void take(Eigen::Matrix<double, Rows, Columns>& m) {
    uint64_t shape[2] = {static_cast<uint64_t>(m.rows()), static_cast<uint64_t>(m.cols())};
    if (Rows == Eigen::Dynamic) raw(shape, sizeof shape);
    const uint64_t most = bytes.size() / sizeof(double);
    const bool fits = Columns == Eigen::Dynamic || shape[1] == static_cast<uint64_t>(Columns);
    if (reads &&
        (!fits || std::max(shape[0], shape[1]) > most + 4 || (shape[0] != 0 && shape[1] > most / shape[0])))
      throw InputError("too short");
    m.resize(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
    raw(m.data(), m.size() * sizeof(double));
  }
  template <class Key, class T>
  void take(std::map<Key, T>& values) {
    uint64_t n = size(values.size());
    if constexpr (reads) {
      for (; n > 0; --n) {
        Key key{};
        take(key);
        take(values[key]);
      }
    } else {
      for (auto& [key, value] : values) {
        Key copy = key;
        (*this)(copy, value);
      }
    }
  }
  template <class T>
  void take(std::vector<T>& values) {
    const uint64_t n = size(values.size());
    if (reads) values.clear();
    for (uint64_t i = 0; i < n; ++i) take(reads ? values.emplace_back() : values[i]);
  }
  template <class T>
  void take(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
      raw(&value, sizeof value);
    else
      visitMembers(*this, value);
  }
};

using ArchiveWriter = Archive<false>;
using ArchiveReader = Archive<true>;

}  // namespace mortier
