#include "report/manifest.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/checksum.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/whole_file.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format = "mortier result 1";

bool isNumber(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// `name.tmp-PID`, as whole files are called before they are whole.
bool isUnderWay(const std::string& name, const std::string& whole) {
  const std::string begin = whole + ".tmp-";
  return name.rfind(begin, 0) == 0 && isNumber(std::string_view(name).substr(begin.size()));
}

[[noreturn]] void cannotBeRead(const std::string& path) {
  throw OutputError(path + ": cannot be read: " + std::strerror(errno));
}

/// False where it is not there. A file that cannot be looked at is no file of others: \throws OutputError
bool isRegular(const std::string& path) {
  std::error_code error;
  const fs::file_type type = fs::symlink_status(path, error).type();
  if (type == fs::file_type::none) throw OutputError(path + ": cannot be read: " + error.message());
  return type == fs::file_type::regular;
}

}  // namespace

void writeManifest(const std::string& folder, const Manifest& manifest) {
  Json json;
  json["format"] = format;
  json["status"] = manifest.failed ? "failed" : "complete";
  json["files"] = Json::object();
  for (const auto& [name, record] : manifest.files)
    json["files"][name] = {{"bytes", record.bytes}, {"fnv1a", formatted("%016" PRIx64, record.checksum)}};
  writeWhole(folder + "/" + manifestName, json.dump(2) + "\n", true);
}

std::optional<Manifest> readManifest(const std::string& folder) {
  const std::string path = folder + "/" + manifestName;
  if (!isRegular(path) || fs::file_size(path) > mostBytes) return {};
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad()) cannotBeRead(path);
  const Json json = Json::parse(text, nullptr, false);
  try {
    if (json.at("format") != format) return {};
    Manifest manifest{json.at("status") == "failed", {}};
    for (const auto& [name, entry] : json.at("files").items()) {
      const std::string sum = entry.at("fnv1a");
      FileRecord record{entry.at("bytes"), 0};
      std::from_chars(sum.data(), sum.data() + sum.size(), record.checksum, 16);
      if (!isResultName(name)) return {};
      manifest.files[name] = record;
    }
    return manifest;
  } catch (const Json::exception&) {
    return {};
  }
}

bool matches(const std::string& path, const FileRecord& record, bool whole) {
  if (!isRegular(path)) return false;
  const uint64_t size = fs::file_size(path);
  if (size < record.bytes || (whole && size != record.bytes)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string block(size_t{1} << 16, ' ');
  Checksum sum;
  for (uint64_t left = record.bytes; left > 0;) {
    const size_t next = std::min<uint64_t>(left, block.size());
    if (!file.read(block.data(), static_cast<std::streamsize>(next))) cannotBeRead(path);
    sum.add({block.data(), next});
    left -= next;
  }
  return sum.value == record.checksum;
}

bool isSound(const std::string& folder, const Manifest& manifest) {
  return std::all_of(manifest.files.begin(), manifest.files.end(),
                     [&](const auto& file) { return matches(folder + "/" + file.first, file.second); });
}

bool isResultName(const std::string& name) {
  constexpr std::array fixed{"fields.pvd", "contact.csv", "history.csv", "summary.json", "state"};
  if (std::find(fixed.begin(), fixed.end(), name) != fixed.end()) return true;
  // <body>.mesh, <body>_<step>.vtu
  const fs::path path(name);
  if (path.extension() == ".mesh") return name.find('/') == std::string::npos;
  const std::string stem = path.stem().string();
  const size_t line = stem.rfind('_');
  return path.extension() == ".vtu" && name.find('/') == std::string::npos && line != std::string::npos &&
         line > 0 && stem.size() - line > 6 && isNumber(std::string_view(stem).substr(line + 1));
}

bool isWorkName(const std::string& name) {
  const fs::path path(name);
  if (path.extension() == keptSuffix) return isResultName(path.stem().string());
  return name == checkpointName || name == previousCheckpointName || isUnderWay(name, checkpointName) ||
         name == manifestName || isUnderWay(name, manifestName);
}

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
