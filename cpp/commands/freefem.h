// `mortier freefem`: a scene as a script for the FreeFEM method in freefem/.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "solver/model.h"

namespace mortier {

/// Why `mortier freefem` would refuse the scene, in the same words; empty where it would not.
/// \param stepsGiven  whether the steps of a run are given
std::string freefemObstacle(const SceneDescription& scene, const Model& model, bool stepsGiven);
/// \throws InputError for the first thing in the scene that the FreeFEM method does not know
void requireFreefemKnows(const SceneDescription& scene, const Model& model, bool stepsGiven);

/// \throws InputError for the first thing that the method does not know in a scene in space
void requireFreefemKnowsSpace(const SceneDescription& scene, const Model& model);
/// Supports and loads of a body.
std::string freefemConditions(const SceneDescription& scene, const Model& model, size_t b);
/// Macros for all bodies: rollers, points that are held, and tools that forces move.
std::string freefemSpecialSupports(const SceneDescription& scene);

/// One macro for all bodies or interfaces, with its text; empty where the text is.
std::string freefemMacro(const std::string& name, const std::string& text, const std::string& comment);
/// What materials have beside isotropic elasticity and Perzyna's law: macros and numbers of every body
/// (freefem/README.md); nothing where no body has any of it.
std::string freefemMaterials(const SceneDescription& scene);
/// The patches on which bodies average their volumetric strain; nothing where none does.
std::string freefemPatches(const Model& model);

/// An expression of a scene in FreeFEM's language: every number real (FreeFEM divides integers as integers),
/// every a ? b : c in parentheses (FreeFEM nests them in no other way), FreeFEM's words.
/// \throws InputError for a word that FreeFEM does not know.
std::string freefemExpression(const Expression& expression);
/// An expression of other variables: `names` has what each is in FreeFEM.
std::string freefemFormula(const std::string& text, const std::string& where,
                           const std::map<std::string, std::string>& names);
/// The names in a text that are none of functions or constants, in their order.
std::vector<std::string> namesIn(const std::string& text);

// Text of others in a script stands there and is never run. FreeFEM reads strings of at most 255 printable
// ASCII characters, with escapes of its own, and ends a comment at a line feed or a carriage return.

/// `"text"`. \throws InputError `where = "text", expected ...` for what could be read as something else.
std::string freefemString(const std::string& text, const std::string& where);
/// `// text` and the end of the line, whatever the text holds.
std::string freefemComment(const std::string& text);

}  // namespace mortier
