#include "commands/freefem.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>

#include "base/error.h"
#include "base/shipped.h"
#include "base/whole_file.h"
#include "commands/command_line.h"
#include "contact/smooth_part.h"
#include "mesh/read.h"
#include "plan/loads.h"
#include "scene/build.h"
#include "scene/document.h"
#include "scene/keys.h"

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

/// FreeFEM reads whole Medit files of triangles or tetrahedra.
template <class Mesh>
bool isReadByFreefem(const MeshSource& source, const Mesh& mesh) {
  return !source.shape && !source.inSpace && !source.sweep && isMeditFile(source.path) &&
         source.regions.empty() && mesh.changed.empty();
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
  return freefemMacro("distances", text, "interface, its bodies, distance") +
         (moves ? "macro distancesMove yes //  they change in time\n" : "");
}

/// Of every interface, between commas.
std::string ofContacts(const SceneDescription& scene,
                       const std::function<std::string(const ContactDescription&)>& of) {
  std::string list;
  for (const ContactDescription& contact : scene.contacts) list += (list.empty() ? "" : ", ") + of(contact);
  return list;
}

/// A list of 0 and 1 of every interface under a macro; nothing where all are 0.
std::string flags(const std::string& list, const std::string& macro, const std::string& name) {
  if (list.find('1') == std::string::npos) return "";
  return "macro " + macro + "\nint[int] " + name + " = [" + list + "];\n";
}

/// Of every interface; none where there is no friction and no tie.
std::string friction(const SceneDescription& scene) {
  const std::string ties =
      flags(ofContacts(scene, [](const auto& contact) { return contact.tied ? "1" : "0"; }),
            "anyTied yes //  sides move as one", "tied");
  if (!hasFriction(scene)) return ties;
  return ties +
         "macro rough yes //  friction of each: Coulomb's coefficient, Tresca's limit\nreal[int] friction = "
         "[" +
         ofContacts(scene, [](const auto& contact) { return shortest(contact.friction.coefficient); }) +
         "], shearLimit = [" +
         ofContacts(scene, [](const auto& contact) { return shortest(contact.friction.limit); }) + "];\n";
}

/// Of every interface, whether contact follows the bodies; none where it does nowhere.
std::string sliding(const SceneDescription& scene) {
  const auto follows = [](const auto& contact) { return contact.sliding == SlidingKind::finite ? "1" : "0"; };
  return flags(ofContacts(scene, follows), "sliding yes //  contact follows the bodies", "slidesFar");
}

/// Of every interface, whether its conditions are stabilised; none where they are nowhere.
std::string stabilised(const SceneDescription& scene) {
  return flags(ofContacts(scene, [](const auto& contact) { return contact.stabilised ? "1" : "0"; }),
               "anyStabilised yes //  conditions yield", "stabilised");
}

/// Of every interface, whether the mortar line is made of several straight sides; none where no one is.
std::string polygons(const Model& model) {
  std::string list;
  for (const ContactInterface& interface : model.interfaces) {
    const ContactSide& mortar = interface.pair().mortar;
    const std::vector<SmoothPart> parts =
        smoothParts(boundaryLine(model.bodies[mortar.body].mesh(), mortar.label), Kinks::ofStraightElements);
    const bool straight =
        std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.straight; });
    list += (list.empty() ? "" : ", ") + std::string(straight && parts.size() > 1 ? "1" : "0");
  }
  return flags(list, "straightSides yes //  no circle is behind the mortar line", "polygons");
}

/// One word where all interfaces have the same.
std::string variants(const SceneDescription& scene) {
  const CouplingKind first = scene.contacts.front().variant;
  const bool same = std::all_of(scene.contacts.begin(), scene.contacts.end(),
                                [&](const ContactDescription& contact) { return contact.variant == first; });
  const auto quotedWord = [](const auto& contact) { return '"' + word(contact.variant) + '"'; };
  return "string variant = \"" + word(first) + "\";\n" +
         (same ? ""
               : "macro severalVariants yes //\nstring[int] variants = [" + ofContacts(scene, quotedWord) +
                     "];\n");
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
      << (scene.inSpace() ? "" : "\nstring plane = \"" + std::string(word(scene.plane)) + "\";\n")
      << unitNames(scene.units) << (scene.degree == 2 ? "macro quadratic yes //  P2 displacements\n" : "")
      << "\n// Bodies\n"
      << "macro eachBody(what)";
  for (int b = 0; b < bodies; ++b) out << " what(" << b + 1 << ')';
  out << " //\n";
  const auto strains = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                     [](const BodyDescription& body) { return !body.isTool(); });
  if (strains < bodies)
    out << "macro rigidTools yes //  the bodies after the first so many\nint strainingBodies = " << strains
        << ";\n";
  for (int b = 0; b < bodies; ++b) writeBody(out, scene.bodies[b], meshFiles[b], b + 1, scene.units);
  if (!scene.inSpace()) out << freefemMaterials(scene);
  out << freefemPatches(model);
  out << "\n// Boundary conditions and loads, functions of x, y" << (scene.inSpace() ? ", z" : "")
      << " and t\n";
  for (int b = 0; b < bodies; ++b) out << freefemConditions(scene, model, b);
  out << (scene.inSpace() ? "" : freefemSpecialSupports(scene))
      << "\n// Contact: nonmortar body and label, mortar body and label; time\nint[int, int] contact = ";
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[k].pair();
    out << (k == 0 ? "[[" : ", [") << nonmortar.body + 1 << ", " << nonmortar.label << ", " << mortar.body + 1
        << ", " << mortar.label << ']';
  }
  out << "];\n"
      << friction(scene) << sliding(scene) << stabilised(scene)
      << (scene.inSpace() ? "" : distances(scene, model) + polygons(model)) << variants(scene)
      << "real endTime = " << shortest(scene.time.end) << ";  // [" << scene.units.time << "]\n"
      << stepEnds(times)
      << "int steps = " << (times.empty() ? scene.time.steps : static_cast<int>(times.size()))
      << ";  // backward Euler, " << (times.empty() ? "equal steps" : "steps of their own lengths") << "\n\n";
  const bool own = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const BodyDescription& body) {
    return body.material.as<OwnLaw>() != nullptr;
  });
  const std::vector<std::string> parts =
      scene.inSpace()
          ? std::vector<std::string>{"space", "space_surfaces", "space_yield", "space_contact", "space_steps"}
          : std::vector<std::string>{"bodies",  "strain",   "supports", "lines",   "coupling",
                                     "rows",    "friction", "system",   "own_law", "law",
                                     "contact", "picture",  "loop"};
  for (const std::string& part : parts) {
    if (part == "own_law" && !own) continue;
    out << "include " << freefemString(method + '/' + part + ".idp", scene.path + ": the FreeFEM method")
        << '\n';
  }
  return out.str();
}

/// Makes contacts of ties: the script keeps all of their rows. \throws InputError for those of which the rows
/// are others
void takeTies(SceneDescription& scene, Model& model) {
  constexpr double touching = 1e-9;
  for (size_t k = 0; k < model.ties.size(); ++k) {
    const Tie& tie = model.ties[k];
    const auto count = static_cast<int>(tie.nonmortarNodes().size());
    const bool apart = tie.distance() > touching * model.bodies[tie.pair().nonmortar.body].extent();
    const ContactDescription& of = scene.ties[k];
    const bool plain = of.tieKind == TieKind::surface && of.stiffness == 0 && of.offset.empty();
    if (scene.inSpace() || !plain || apart || tie.rows() != tie.dimension() * count)
      throw InputError(
          scene.ties[k].where +
          ": contact: kind = \"tied\", expected two rigidly joined sides in the plane that touch, with "
          "no nonmortar node that is held or tied twice (all that the FreeFEM method knows)");
    scene.contacts.push_back(scene.ties[k]);
    addContact(scene, scene.ties[k], model);
  }
  scene.ties.clear();
}

}  // namespace

std::string freefemObstacle(const SceneDescription& given, const Model& ofRun, bool stepsGiven) {
  std::vector<std::string> meshFiles;
  for (const BodyDescription& body : given.bodies) meshFiles.push_back(body.name + ".mesh");
  try {
    SceneDescription scene = given;
    Model withTies;
    if (!scene.ties.empty()) withTies = ofRun;
    const Model& model = scene.ties.empty() ? ofRun : withTies;
    takeTies(scene, withTies);
    requireFreefemKnows(scene, model, stepsGiven);
    script(scene, model, meshFiles, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

namespace {

/// The ends of the steps of a run, ascending, from the history.csv in its folder [s, or the run's unit].
/// \throws InputError where there is none, or it is not of a run to `end` from time 0
std::vector<double> stepsOfRun(const std::string& folder, double end) {
  const std::string path = folder + "/history.csv";
  const auto refuse = [&](int line, const std::string& what, const std::string& expected) {
    throw InputError(path + (line > 0 ? ':' + std::to_string(line) : "") + ": " + what + ", expected " +
                     expected);
  };
  std::istringstream file(readWhole(path, "the history of a run"));
  std::string line;
  if (!std::getline(file, line)) refuse(0, "cannot be read", "the history of a run");
  size_t column = 0;
  const Keys names = split(line, ',');
  while (column < names.size() && names[column].compare(0, 5, "time[") != 0) ++column;
  if (column == names.size()) refuse(1, "no column time[...]", "the history of a run");
  std::vector<double> times;
  for (int number = 2; std::getline(file, line); ++number) {
    const Keys row = split(line, ',');
    double time = 0;
    const std::string text = column < row.size() ? row[column] : "";
    const auto [rest, fault] = std::from_chars(text.data(), text.data() + text.size(), time);
    if (number == 2 && text == "0") continue;  // what acts at once is no step
    const double last = times.empty() ? 0 : times.back();
    if (fault != std::errc() || rest != text.data() + text.size() || !(time > last) || !(time <= end))
      refuse(number, "time " + text, "a number above the one before, up to the end of the scene");
    times.push_back(time);
  }
  if (times.empty() || times.back() != end)
    refuse(0, "no step to the end of the scene", "a run that has ended");
  return times;
}

struct FreefemOptions : SceneOptions {
  std::string file;     ///< empty: standard output
  std::string stepsOf;  ///< the folder of a run whose steps are to be taken; empty: none
};

int writeFreefem(const FreefemOptions& command) {
  // 1. The scene, checked as for a run of our own.
  ResolvedScene resolved = resolveScene(readScene(command.scene, command.settings));
  Model model = buildModel(resolved);
  SceneDescription& scene = resolved.description;
  takeTies(scene, model);
  requireFreefemKnows(scene, model, !command.stepsOf.empty());

  // 2. The meshes that FreeFEM does not read, beside the script.
  std::vector<std::string> meshFiles;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    meshFiles.push_back(body.mesh.path);
    if (model.bodies[b].withMesh(
            [&](const auto& mesh, const auto&) { return isReadByFreefem(body.mesh, mesh); }))
      continue;
    if (command.file.empty())
      throw InputError(body.meshWhere + ": body " + body.name + ": mesh " + body.mesh.path +
                       ", expected a file for the script, beside which the mesh is written for FreeFEM");
    meshFiles.back() = (fs::path(command.file).replace_extension() += "-" + body.name + ".mesh").string();
    model.bodies[b].withMesh([&](const auto& mesh, const auto&) { writeMedit(mesh, meshFiles.back()); });
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

}  // namespace

Command addFreefem(CLI::App& app) {
  CLI::App* command = app.add_subcommand("freefem", "write a scene as a FreeFEM script");
  const auto options = std::make_shared<FreefemOptions>();
  options->addScene(*command);
  command->add_option("FILE", options->file, ".edp file to write (default: standard output)");
  options->addSettings(*command);
  command->add_option("--steps-of", options->stepsOf, "results of a run of the scene, whose steps it takes")
      ->type_name("FOLDER");
  return {command, [options] {
            options->requireScene();
            return writeFreefem(*options);
          }};
}

}  // namespace mortier
