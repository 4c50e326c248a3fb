// The keys that a scene may hold, table by table: what the reader accepts and what --set can reach.
#pragma once

#include <string>
#include <vector>

namespace mortier {

using Keys = std::vector<std::string>;

/// The keys of the table at a dotted path without indices ("" is the scene itself, "body.boundary" one
/// condition); empty where there is no such table.
const Keys& keysOf(const std::string& path);

/// "a, b, c".
std::string joined(const Keys& keys);

/// The key that `word` is most likely a misspelling of; empty when none is close.
std::string nearest(const std::string& word, const Keys& keys);

}  // namespace mortier
