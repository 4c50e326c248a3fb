// What goes to standard error: one printable line of bounded length each, whatever a scene or a file name
// holds.
#pragma once

#include <string>

namespace mortier {

/// `mortier: text`
void complain(const std::string& text);
/// `mortier: warning: text`, once each
void warn(const std::string& text);

/// Writes out what standard output still holds. A reader that has gone away (`mortier run ... | head`) is no
/// error.
/// \throws OutputError when it cannot be written.
void finishStandardOutput();

}  // namespace mortier
