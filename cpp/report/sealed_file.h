// Binary files that are read again by the program: a first line that names what they are, their size, the
// content and a checksum of it all.
#pragma once

#include <string>
#include <string_view>

namespace mortier {

std::string sealed(std::string_view firstLine, const std::string& content);

/// The content of such a file. \throws InputError where it has another first line, or is damaged
std::string readSealed(const std::string& path, std::string_view firstLine);

}  // namespace mortier
