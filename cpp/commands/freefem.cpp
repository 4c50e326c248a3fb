#include "commands/freefem.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "base/error.h"
#include "base/whole_file.h"
#include "commands/exit_code.h"
#include "commands/freefem_expression.h"
#include "commands/freefem_materials.h"
#include "commands/freefem_steps.h"
#include "commands/freefem_text.h"
#include "commands/shipped.h"
#include "contact/smooth_part.h"
#include "fem/element.h"
#include "mesh/gmsh.h"
#include "mesh/medit.h"
#include "scene/build.h"
#include "scene/document.h"

namespace mortier {

namespace {

namespace fs = std::filesystem;

/// The folder that holds the method: beside the current folder, the scene or the program, or above them.
std::string methodFolder(const std::string& scene) {
  const auto folder = shippedFolder("freefem", "bodies.idp", {fs::current_path(), fs::absolute(scene)});
  if (!folder)
    throw InputError(
        scene +
        ": the FreeFEM method (freefem/bodies.idp) is found neither above the current folder nor "
        "above the scene or the program");
  return fs::proximate(*folder).generic_string();
}

/// FreeFEM reads whole Medit files of two dimensions.
bool isReadByFreefem(const MeshSource& mesh) {
  return !mesh.shape && !isGmshFile(mesh.path) && mesh.regions.empty();
}

/// `meshFile`: as FreeFEM opens it.
void writeBody(std::ostream& out, const BodyDescription& body, const std::string& meshFile, int number,
               const Units& units) {
  const Elasticity& elasticity = body.material.elasticity;
  const auto* flow = body.material.as<Viscoplasticity>();
  out << "string name" << number << " = \"" << body.name << "\";\n"
      << "string meshFile" << number << " = "
      << freefemString(meshFile, body.meshWhere + ": body " + body.name + ": mesh") << ";\n"
      << "string projection" << number << " = \"" << word(flow ? flow->projection : Projection::frobenius)
      << "\";\n"
      << "real E" << number << " = " << shortest(elasticity.young) << ", nu" << number << " = "
      << shortest(elasticity.poisson) << ";  // [" << units.stress << "], [-]\n"
      << "real lambda" << number << " = " << shortest(flow ? flow->viscosity : 0) << ", sigmaY" << number
      << " = " << shortest(flow ? flow->yieldStress : 1) << ";  // viscosity ["
      << units.nameOf(dimensions::viscosity) << "] (0: elastic body), yield stress [" << units.stress
      << "]\n";
}

using Kind = ConditionDescription::Kind;

bool isRoller(const ConditionDescription& condition) {
  return condition.kind == Kind::displacement &&
         (condition.component == alongNormal || condition.component == alongTangent);
}

/// Loads by the rules that mortier takes (docs/theory.md) where these integrate them, with quadratic
/// displacements by FreeFEM's own of degree 5; others, which mortier resolves, by those of degree 9 on
/// edges and triangles. A macro must not be empty.
void writeConditions(std::ostream& out, const BodyDescription& body, int number,
                     const SceneDescription& scene) {
  const std::string n = std::to_string(number);
  const std::string own = scene.plane == Plane::axisymmetric ? "*2*pi*x" : "";  // beside FreeFEM's rules
  const int degree = scene.degree;
  std::ostringstream supports;
  std::ostringstream loads;
  for (const ConditionDescription& c : body.conditions) {
    const std::string value = freefemExpression(c.value);
    if (c.point) continue;
    if (c.kind == Kind::displacement && !isRoller(c)) {
      supports << "+ on(" << c.label << ", u" << c.component + 1 << " = " << value << ") ";
    } else if (c.kind == Kind::traction) {
      const std::string direction =
          c.component == alongNormal ? "(N.x*v1 + N.y*v2)" : "v" + std::to_string(c.component + 1);
      const bool simpson = degree == 1 && c.value.value.degree <= LinearTriangle::edgeExact;
      const bool rough = c.value.value.degree > QuadraticTriangle::edgeExact;
      loads << (simpson ? "+ simpson(" + n + ", " : "+ int1d(Body" + n + ", ") << c.label
            << (simpson ? ", ("
                : rough ? ", qfe = qf5pE)(("
                        : ")((")
            << value << ")*" << direction << (simpson ? "" : own) << ") ";
    }
  }
  for (const int c : {0, 1}) {
    if (body.force[c]) {
      const bool midpoints = degree == 1 && body.force[c]->value.degree <= LinearTriangle::loadExact;
      const bool rough = body.force[c]->value.degree > QuadraticTriangle::loadExact;
      loads << (midpoints ? "+ midpoints(" + n + ", (" : "+ int2d(Body" + n)
            << (midpoints ? ""
                : rough   ? ", qft = qf9pT)(("
                          : ")((")
            << freefemExpression(*body.force[c]) << ")*v" << c + 1 << (midpoints ? "" : own) << ") ";
    }
  }
  const auto orNothing = [&](const std::ostringstream& terms, const char* nothing) {
    const std::string text = terms.str();
    return text.empty() ? "+ int2d(Body" + n + ")(" + nothing + ") " : text;
  };
  out << "macro supports" << n << ' ' << orNothing(supports, "0.*u1*v1") << "//\nmacro loads" << n << ' '
      << orNothing(loads, "0.*v2") << "//\n";
}

/// One macro for all bodies; none where there are no rollers.
std::string rollers(const SceneDescription& scene) {
  std::string text;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    for (const ConditionDescription& c : scene.bodies[b].conditions) {
      if (isRoller(c)) {
        text += "roller(" + std::to_string(b + 1) + ", " + std::to_string(c.label) + ", " +
                (c.component == alongNormal ? "normal" : "tangent") + ", " + freefemExpression(c.value) +
                ") ";
      }
    }
  }
  return text.empty() ? text : "macro rollers " + text + "//  body, label, direction, displacement\n";
}

/// One macro for all bodies; none where no point is held.
std::string heldPoints(const SceneDescription& scene) {
  std::string text;
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    for (const ConditionDescription& c : scene.bodies[b].conditions)
      if (c.point)
        text += "heldPoint(" + std::to_string(b + 1) + ", " + shortest(c.point->x()) + ", " +
                shortest(c.point->y()) + ", " + std::to_string(c.component + 1) + ", " +
                freefemExpression(c.value) + ") ";
  return text.empty() ? text : "macro heldPoints " + text + "//  body, x, y, component, displacement\n";
}

/// What an interface has in place of its distance as meshed; none where it is that everywhere.
std::string distances(const SceneDescription& scene, const Model& model) {
  std::string text;
  for (size_t k = 0; k < scene.contacts.size(); ++k) {
    const ContactDescription& contact = scene.contacts[k];
    if (!contact.gap && contact.initial != InitialGap::close) continue;
    const ContactPair& pair = model.interfaces[k].pair();
    text += "distance(" + std::to_string(k + 1) + ", " + std::to_string(pair.nonmortar.body + 1) + ", " +
            std::to_string(pair.mortar.body + 1) + ", " +
            (contact.gap ? freefemExpression(*contact.gap) : "0.") + ") ";
  }
  const bool moves = std::any_of(scene.contacts.begin(), scene.contacts.end(),
                                 [](const ContactDescription& c) { return c.gap && c.gap->inTime; });
  return text.empty() ? text
                      : "macro distances " + text + "//  interface, its bodies, distance\n" +
                            (moves ? "macro distancesMove yes //  they change in time\n" : "");
}

/// Of every interface; none where there is no friction.
std::string friction(const SceneDescription& scene) {
  std::string coefficients;
  std::string limits;
  bool any = false;
  for (const ContactDescription& contact : scene.contacts) {
    const std::string comma = coefficients.empty() ? "" : ", ";
    coefficients += comma + shortest(contact.friction.coefficient);
    limits += comma + shortest(contact.friction.limit);
    any = any || contact.friction.any();
  }
  if (!any) return "";
  return "macro rough yes //  friction of each: Coulomb's coefficient, Tresca's limit\nreal[int] friction = "
         "[" +
         coefficients + "], shearLimit = [" + limits + "];\n";
}

/// One word where all interfaces have the same.
std::string variants(const SceneDescription& scene) {
  std::vector<std::string> words;
  for (const ContactDescription& contact : scene.contacts) words.push_back(word(contact.variant));
  std::string list;
  for (const std::string& each : words) list += (list.empty() ? "\"" : ", \"") + each + '"';
  const bool same = std::equal(words.begin() + 1, words.end(), words.begin());
  return "string variant = \"" + words.front() + "\";\n" +
         (same ? "" : "macro severalVariants yes //\nstring[int] variants = [" + list + "];\n");
}

/// Other labels than those of SI.
std::string unitNames(const Units& units) {
  if (!units.given) return "";
  return "macro unitsOfScene yes //\nstring unitLength = \"" + units.length + "\";\nstring unitForce = \"" +
         units.force + "\";\nstring unitStress = \"" + units.stress + "\";\nstring unitTime = \"" +
         units.time + "\";\n";
}

/// The ends of steps that are not equal; none where they are.
std::string stepEnds(const std::vector<double>& times) {
  if (times.empty()) return "";
  std::string text = "macro stepsGiven yes //\nreal[int] stepEnds = [";
  for (size_t i = 0; i < times.size(); ++i)
    text += (i == 0 ? "" : i % 6 == 0 ? ",\n  " : ", ") + shortest(times[i]);
  return text + "];\n";
}

std::string script(const SceneDescription& scene, const Model& model,
                   const std::vector<std::string>& meshFiles, const std::vector<double>& times) {
  const std::string method = methodFolder(scene.path);
  const int bodies = static_cast<int>(scene.bodies.size());
  std::ostringstream out;
  out << freefemComment(scene.title.empty() ? scene.path : scene.title)
      << freefemComment("Written by mortier freefem " + scene.path +
                        "; run from the folder in which that was called.")
      << "\nstring plane = \"" << word(scene.plane) << "\";\n"
      << unitNames(scene.units) << (scene.degree == 2 ? "macro quadratic yes //  P2 displacements\n" : "")
      << "\n// Bodies\n"
      << "macro eachBody(what)";
  for (int b = 0; b < bodies; ++b) out << " what(" << b + 1 << ')';
  out << " //\n";
  for (int b = 0; b < bodies; ++b) writeBody(out, scene.bodies[b], meshFiles[b], b + 1, scene.units);
  out << freefemMaterials(scene) << freefemPatches(model)
      << "\n// Boundary conditions and loads, functions of x, y and t\n";
  for (int b = 0; b < bodies; ++b) writeConditions(out, scene.bodies[b], b + 1, scene);
  out << rollers(scene) << heldPoints(scene)
      << "\n// Contact: nonmortar body and label, mortar body and label; time\nint[int, int] contact = ";
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[k].pair();
    out << (k == 0 ? "[[" : ", [") << nonmortar.body + 1 << ", " << nonmortar.label << ", " << mortar.body + 1
        << ", " << mortar.label << ']';
  }
  out << "];\n"
      << friction(scene) << distances(scene, model) << variants(scene)
      << "real endTime = " << shortest(scene.time.end) << ";  // [" << scene.units.time << "]\n"
      << stepEnds(times)
      << "int steps = " << (times.empty() ? scene.time.steps : static_cast<int>(times.size()))
      << ";  // backward Euler, " << (times.empty() ? "equal steps" : "steps of their own lengths") << "\n\n";
  const bool own = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const BodyDescription& body) {
    return body.material.as<OwnLaw>() != nullptr;
  });
  for (const std::string part : {"bodies", "strain", "supports", "lines", "coupling", "friction", "system",
                                 "own_law", "law", "contact", "picture", "loop"}) {
    if (part == "own_law" && !own) continue;
    out << "include " << freefemString(method + '/' + part + ".idp", scene.path + ": the FreeFEM method")
        << '\n';
  }
  return out.str();
}

[[noreturn]] void refuse(const std::string& what, const std::string& expected) {
  throw InputError(what + ", expected " + expected + " (all that the FreeFEM method knows)");
}

/// \throws InputError for the first thing in the scene that the FreeFEM method does not know.
void requireKnown(const SceneDescription& scene, bool stepsGiven) {
  if (scene.contacts.empty()) refuse(scene.path + ": no contact interface", "one at least");
  if (scene.time.scheme != Scheme::backwardEuler) {
    refuse(scene.path + ": scheme = " + word(scene.time.scheme), "backward-euler");
  }
  if (scene.time.controlled() && !stepsGiven) {
    refuse(scene.path + ": tolerance = " + shortest(scene.time.tolerance),
           "equal steps, or those of a run (--steps-of)");
  }
  for (const BodyDescription& body : scene.bodies) {
    const bool stressed = std::any_of(body.initialStress.begin(), body.initialStress.end(),
                                      [](const auto& component) { return component.has_value(); });
    if (stressed || !body.regions.empty()) {
      refuse(body.where + ": body " + body.name + ": regions or initial stress", "neither");
    }
    if (const auto* own = body.material.as<OwnLaw>()) {
      if (!own->texts) refuse(own->where, "a law of mortier's own or \"expression\"");
      if (body.temperature) refuse(body.temperature->where + ": temperature", "none beside such a law");
      if (scene.plane == Plane::axisymmetric)
        refuse(own->where + " beside plane = \"axisymmetric\"", "\"stress\" or \"strain\"");
    }
    const MaterialDescription& material = body.material;
    if (material.anisotropy && material.flows())
      refuse(material.anisotropy->where, "\"isotropic\" beside flow");
    if (material.anisotropy && body.temperature)
      refuse(body.temperature->where + ": temperature", "none beside elasticity that is not isotropic");
  }
}

/// Whether the elements stand for one circle, or for nothing that is known.
bool isOneCurve(const SmoothPart& part) {
  const Arc& first = part.arcs.front();
  return std::all_of(part.arcs.begin(), part.arcs.end(), [&](const Arc& arc) {
    return !arc.curve.known() && arc.known == first.known && (!arc.known || arc.curvature == first.curvature);
  });
}

/// \throws InputError where quadratic triangles have curved sides: FreeFEM's are straight.
void requireStraightSides(const SceneDescription& scene, const Model& model) {
  constexpr double rounding = 1e-12;
  if (scene.degree != 2) return;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const TriangleMesh& mesh = model.bodies[b].mesh();
    for (size_t e = 0; e < mesh.edgeMiddles.size(); ++e) {
      const auto& [from, to] = mesh.boundaryEdges[e];
      const Point side = mesh.vertices[to] - mesh.vertices[from];
      const Point off = mesh.edgeMiddles[e] - mesh.vertices[from] - side / 2;
      if (off.allFinite() && off.norm() > rounding * side.norm())
        refuse(scene.bodies[b].meshWhere + ": body " + scene.bodies[b].name + ": a mesh with curved sides",
               "straight ones beside degree = 2");
    }
  }
}

/// \throws InputError where a line of contact has corners that count, is closed or is made of several curves.
void requireSmooth(const SceneDescription& scene, const Model& model) {
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactPair& pair = model.interfaces[k].pair();
    const auto partsOf = [&](const ContactSide& side) {
      return smoothParts(boundaryLine(model.bodies[side.body].mesh(), side.label));
    };
    const std::vector<SmoothPart> parts = partsOf(pair.nonmortar);
    const std::vector<SmoothPart> across = partsOf(pair.mortar);
    const auto straight = [](const SmoothPart& part) { return part.straight; };
    const bool cornersCount =
        parts.size() > 1 || (across.size() > 1 && !(parts.front().straight &&
                                                    std::all_of(across.begin(), across.end(), straight)));
    if (cornersCount || parts.front().closed || across.front().closed)
      refuse(scene.contacts[k].where + ": contact: a closed line, or one with corners",
             "open lines without corners");
    if (!isOneCurve(parts.front()) || !std::all_of(across.begin(), across.end(), isOneCurve))
      refuse(scene.contacts[k].where + ": contact: a line of several curves",
             "one circle, one straight line, or a polygon");
  }
}

void requireAll(const SceneDescription& scene, const Model& model, bool stepsGiven) {
  requireKnown(scene, stepsGiven);
  requireSmooth(scene, model);
  requireStraightSides(scene, model);
}

}  // namespace

std::string freefemObstacle(const SceneDescription& scene, const Model& model, bool stepsGiven) {
  std::vector<std::string> meshFiles;
  for (const BodyDescription& body : scene.bodies) meshFiles.push_back(body.name + ".mesh");
  try {
    requireAll(scene, model, stepsGiven);
    script(scene, model, meshFiles, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

int writeFreefem(const FreefemCommand& command) {
  // 1. The scene, checked as for a run of our own.
  ResolvedScene resolved = resolveScene(readScene(command.scene, command.settings));
  const Model model = buildModel(resolved);
  const SceneDescription& scene = resolved.description;
  requireAll(scene, model, !command.stepsOf.empty());

  // 2. The meshes that FreeFEM does not read, beside the script.
  std::vector<std::string> meshFiles;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    meshFiles.push_back(body.mesh.path);
    if (isReadByFreefem(body.mesh)) continue;
    if (command.file.empty())
      throw InputError(body.meshWhere + ": body " + body.name + ": mesh " + body.mesh.path +
                       ", expected a file for the script, beside which the mesh is written for FreeFEM");
    meshFiles.back() = (fs::path(command.file).replace_extension() += "-" + body.name + ".mesh").string();
    writeMedit(model.bodies[b].mesh(), meshFiles.back());
  }

  // 3. The script.
  std::vector<double> times;
  if (!command.stepsOf.empty()) times = stepsOfRun(command.stepsOf, scene.time.end);
  const std::string text = script(scene, model, meshFiles, times);
  if (command.file.empty()) {
    std::cout << text;
    return exitDone;
  }
  writeWhole(command.file, text);
  return exitDone;
}

}  // namespace mortier
