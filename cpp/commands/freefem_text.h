// Text of others in a FreeFEM script: it stands there and is never run. FreeFEM reads strings of at most 255
// printable ASCII characters, with escapes of its own, and ends a comment at a line feed or a carriage
// return.
#pragma once

#include <string>

namespace mortier {

/// `"text"`. \throws InputError `where = "text", expected ...` for what could be read as something else.
std::string freefemString(const std::string& text, const std::string& where);

/// `// text` and the end of the line, whatever the text holds.
std::string freefemComment(const std::string& text);

}  // namespace mortier
