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
}

void OutputFile::require(bool done) const {
  if (!done) throw OutputError(path_ + ": cannot be written: " + std::strerror(errno));
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  require(file_ != nullptr);
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
}

OutputFile::OutputFile(std::string path, const FileRecord& keep)
    : path_(std::move(path)),
      written_(keep.bytes),
      sum_{keep.checksum},
      file_(std::fopen(path_.c_str(), "r+b")) {
  const auto size = static_cast<off_t>(keep.bytes);
  require(file_ && ftruncate(fileno(file_.get()), size) == 0 && fseeko(file_.get(), size, SEEK_SET) == 0);
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
}

OutputFile& OutputFile::operator<<(std::string_view text) {
  written_ += text.size();
  sum_.add(text);
  if (buffer_.size() + text.size() > bufferSize) flush();
  if (text.size() > bufferSize)
    put(text);
  else
    buffer_ += text;
  return *this;
}

void OutputFile::put(std::string_view text) {
  require(text.empty() || std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size());
}

void OutputFile::flush() {
  put(buffer_);
  buffer_.clear();
}

OutputFile& OutputFile::operator<<(double value) {
  if (!std::isfinite(value))
    throw OutputError(path_ + ": a number that is not finite was to be written; the run is not valid");
  char text[32];
  return *this << std::string_view(text, std::to_chars(text, text + sizeof text, value).ptr - text);
}

FileRecord OutputFile::sync() {
  flush();
  require(fsync(fileno(file_.get())) == 0 || errno == EINVAL);
  return {written_, sum_.value};
}

FileRecord OutputFile::close() {
  flush();
  require(std::fclose(file_.release()) == 0);
  return {written_, sum_.value};
}

}  // namespace mortier
