// Binary files that the program reads again: a line of text that names their kind, their size, the content,
// a checksum of it all.
#pragma once

#include <string>
#include <string_view>

namespace mortier {

/// The bytes of such a file.
std::string sealed(const std::string& firstLine, const std::string& content);

/// The content of such a file. \throws InputError where its line does not begin with `kind`, or it is damaged
std::string readSealed(const std::string& path, std::string_view kind);

}  // namespace mortier
