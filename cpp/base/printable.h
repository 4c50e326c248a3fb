// Text of others (titles, names, paths, messages of libraries) where it is shown: on one line, in valid UTF-8
// and of bounded length.
#pragma once

#include <string>
#include <string_view>

namespace mortier {

/// Everything but visible UTF-8 characters (control characters, those that turn the direction of writing,
/// broken bytes) becomes `?`. A text of more than `most` bytes is shown without its middle.
std::string printable(std::string_view text, size_t most = 2000);

}  // namespace mortier
