#include "report/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/error.h"

namespace mortier {

namespace {
constexpr size_t bufferSize = size_t{1} << 16;

[[noreturn]] void fail(const std::string& path) {
  throw OutputError(path + ": cannot be written: " + std::strerror(errno));
}
}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) {
    fail(path_);
  }
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  buffer_.reserve(bufferSize);
}

OutputFile::OutputFile(std::string path, const FileRecord& keep)
    : path_(std::move(path)),
      written_(keep.bytes),
      sum_{keep.checksum},
      file_(std::fopen(path_.c_str(), "r+b")) {
  const auto size = static_cast<off_t>(keep.bytes);
  if (!file_ || ftruncate(fileno(file_.get()), size) != 0 || fseeko(file_.get(), size, SEEK_SET) != 0) {
    fail(path_);
  }
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  buffer_.reserve(bufferSize);
}

OutputFile& OutputFile::operator<<(std::string_view text) {
  write(text.data(), text.size());
  return *this;
}

OutputFile& OutputFile::operator<<(double value) {
  if (!std::isfinite(value)) {
    throw OutputError(path_ + ": a number that is not finite was to be written; the run is not valid");
  }
  char text[32];
  return *this << std::string_view(text, std::to_chars(text, text + sizeof text, value).ptr - text);
}

void OutputFile::write(const void* data, size_t size) {
  written_ += size;
  sum_.add({static_cast<const char*>(data), size});
  if (buffer_.size() + size > bufferSize) {
    flush();
  }
  if (size > bufferSize) {
    if (std::fwrite(data, 1, size, file_.get()) != size) {
      fail(path_);
    }
  } else {
    buffer_.append(static_cast<const char*>(data), size);
  }
}

void OutputFile::flush() {
  if (!buffer_.empty() && std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) {
    fail(path_);
  }
  buffer_.clear();
}

FileRecord OutputFile::sync() {
  flush();
  if (fsync(fileno(file_.get())) != 0 && errno != EINVAL) {
    fail(path_);
  }
  return {written_, sum_.value};
}

FileRecord OutputFile::close() {
  flush();
  if (std::fclose(file_.release()) != 0) {
    fail(path_);
  }
  return {written_, sum_.value};
}

}  // namespace mortier
