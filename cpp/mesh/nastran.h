#pragma once

#include <string>

namespace mortier {

/// Gmsh passes over blank fields of a card, of which the next then take the place, and over systems of
/// coordinates. \throws InputError `file:line: what` of the first card that it would read as another
void requireCardsOfGmsh(const std::string& path);

}  // namespace mortier
