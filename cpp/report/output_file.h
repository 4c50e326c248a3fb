// A text or binary file that is either complete or an error: buffered, every write checked, no number that is
// not finite.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "base/checksum.h"
#include "report/manifest.h"

namespace mortier {

class OutputFile {
 public:
  /// \throws OutputError when the file cannot be created.
  explicit OutputFile(std::string path);
  /// Goes on after what `keep` records of a file that is there. \throws OutputError
  OutputFile(std::string path, const FileRecord& keep);

  OutputFile& operator<<(std::string_view text);
  OutputFile& operator<<(char c) { return *this << std::string_view(&c, 1); }
  /// The shortest decimal that reads back the same. \throws OutputError when it is not finite.
  OutputFile& operator<<(double value);
  OutputFile& operator<<(std::integral auto value) {
    return *this << std::string_view(std::to_string(value));
  }

  /// Brings everything to the disk. \returns what is written so far. \throws OutputError
  FileRecord sync();
  /// \returns what was written. \throws OutputError when anything could not be (a full disk shows here).
  FileRecord close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void require(bool done) const;
  void put(std::string_view text);
  void flush();

  std::string path_;
  std::string buffer_;  ///< not yet written
  uint64_t written_ = 0;
  Checksum sum_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace mortier
