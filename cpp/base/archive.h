// Plain data to bytes and back. Numbers, texts, matrices, lists and maps are known; for any other type the
// archive calls visitMembers(archive, value), which names the members. Bytes are in this machine's order.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
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

template <class T>
concept PlainValue = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Writes values into a string of bytes.
class ArchiveWriter {
 public:
  std::string bytes;

  template <class... T>
  void operator()(T&... values) {
    (put(values), ...);
  }

 private:
  void raw(const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }
  void size(uint64_t n) { raw(&n, sizeof n); }
  template <PlainValue T>
  void put(T& value) {
    raw(&value, sizeof value);
  }
  void put(std::string& text) {
    size(text.size());
    raw(text.data(), text.size());
  }
  void put(Point& p) { raw(p.data(), 2 * sizeof(double)); }
  void put(SpacePoint& p) { raw(p.data(), 3 * sizeof(double)); }
  template <class T>
  void put(std::optional<T>& value) {
    bool given = value.has_value();
    put(given);
    if (given) put(*value);
  }
  template <class T, size_t n>
  void put(std::array<T, n>& values) {
    for (T& value : values) put(value);
  }
  template <int Columns>
  void put(Eigen::Matrix<double, Eigen::Dynamic, Columns>& m) {
    size(m.rows());
    size(m.cols());
    raw(m.data(), m.size() * sizeof(double));
  }
  template <class T>
  void put(std::map<std::string, T>& values) {
    size(values.size());
    for (auto& [key, value] : values) {
      std::string name = key;
      (*this)(name, value);
    }
  }
  template <class T>
  void put(std::vector<T>& values) {
    size(values.size());
    for (T& value : values) put(value);
  }
  template <class T>
  void put(T& value) {
    visitMembers(*this, value);
  }
};

/// Reads them from it. \throws InputError where the bytes do not match the types.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  [[nodiscard]] bool atEnd() const { return bytes_.empty(); }

 private:
  void raw(void* data, size_t size) {
    if (size > bytes_.size()) throw InputError("too short");
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  uint64_t size() {
    uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > bytes_.size()) throw InputError("too short");
    return n;
  }
  template <PlainValue T>
  void get(T& value) {
    raw(&value, sizeof value);
  }
  void get(bool& value) {
    char byte = 0;
    raw(&byte, sizeof byte);
    if (byte != 0 && byte != 1) throw InputError("neither true nor false");
    value = byte == 1;
  }
  void get(std::string& text) {
    text.resize(size());
    raw(text.data(), text.size());
  }
  void get(Point& p) { raw(p.data(), 2 * sizeof(double)); }
  void get(SpacePoint& p) { raw(p.data(), 3 * sizeof(double)); }
  template <class T>
  void get(std::optional<T>& value) {
    bool given = false;
    get(given);
    value.reset();
    if (given) get(value.emplace());
  }
  template <class T, size_t n>
  void get(std::array<T, n>& values) {
    for (T& value : values) get(value);
  }
  template <int Columns>
  void get(Eigen::Matrix<double, Eigen::Dynamic, Columns>& m) {
    uint64_t shape[2];
    raw(shape, sizeof shape);
    const uint64_t most = bytes_.size() / sizeof(double);
    const bool fits = Columns == Eigen::Dynamic || shape[1] == static_cast<uint64_t>(Columns);
    if (!fits || std::max(shape[0], shape[1]) > most + 4 || (shape[0] != 0 && shape[1] > most / shape[0]))
      throw InputError("too short");
    m.resize(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
    raw(m.data(), m.size() * sizeof(double));
  }
  template <class T>
  void get(std::map<std::string, T>& values) {
    for (uint64_t n = size(); n > 0; --n) {
      std::string key;
      (*this)(key);
      (*this)(values[key]);
    }
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.clear();
    for (uint64_t n = size(); n > 0; --n) get(values.emplace_back());
  }
  template <class T>
  void get(T& value) {
    visitMembers(*this, value);
  }

  std::string_view bytes_;
};

}  // namespace mortier
