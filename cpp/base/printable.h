// Text of others (titles, names, paths, messages of libraries) where it is shown: on one line, in valid UTF-8
// and of bounded length.
#pragma once

#include <string>
#include <string_view>

namespace mortier {

/// What is no visible character of UTF-8 (control characters, those that turn the direction of writing,
/// broken bytes) becomes `?`. Of more than `most` bytes, the middle is left out.
std::string printable(std::string_view text, size_t most = 2000);

}  // namespace mortier
