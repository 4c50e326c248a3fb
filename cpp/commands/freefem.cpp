#include "commands/freefem.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/whole_file.h"
#include "commands/exit_code.h"
#include "commands/shipped.h"
#include "scene/build.h"
#include "scene/document.h"

namespace mortier {

namespace {

namespace fs = std::filesystem;

/// Functions that mean the same in both languages, and how FreeFEM calls them.
const std::map<std::string, std::string>& freefemWords() {
  static const std::map<std::string, std::string> words = [] {
    std::map<std::string, std::string> same;
    for (const char* word : {"x",    "y",     "t",    "pi",   "sin",  "cos",   "tan",   "asin",  "acos",
                             "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp",
                             "log",  "log10", "sqrt", "abs",  "min",  "max",   "sign",  "rint"}) {
      same[word] = word;
    }
    same["ln"] = "log";
    same["_pi"] = "pi";
    same["_e"] = "exp(1.)";
    return same;
  }();
  return words;
}

/// The expression with every number real (FreeFEM divides integers as integers) and every word FreeFEM's.
std::string translated(const Expression& expression) {
  const std::string& text = expression.text;
  std::string result;
  for (size_t i = 0; i < text.size();) {
    const auto is = [&](size_t k, auto test) {
      return k < text.size() && test(static_cast<unsigned char>(text[k])) != 0;
    };
    const size_t begin = i;
    if (is(i, [](int c) { return std::isalpha(c) != 0 || c == '_' ? 1 : 0; })) {
      while (is(i, [](int c) { return std::isalnum(c) != 0 || c == '_' ? 1 : 0; })) ++i;
      const auto word = freefemWords().find(text.substr(begin, i - begin));
      if (word == freefemWords().end()) {
        throw InputError(expression.where + ": " + text.substr(begin, i - begin) +
                         " is not known to FreeFEM");
      }
      result += word->second;
    } else if (is(i, [](int c) { return std::isdigit(c) != 0 || c == '.' ? 1 : 0; })) {
      bool real = false;
      for (; is(i, [](int c) { return std::isalnum(c) != 0 || c == '.' ? 1 : 0; }) ||
             ((text[i] == '-' || text[i] == '+') && i < text.size() && i > begin &&
              std::tolower(text[i - 1]) == 'e');
           ++i) {
        real = real || text[i] == '.' || std::tolower(text[i]) == 'e';
      }
      result += text.substr(begin, i - begin) + (real ? "" : ".");
    } else {
      result += text[i++];
    }
  }
  return result;
}

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

void writeBody(std::ostream& out, const BodyDescription& body, int number) {
  const auto& [elasticity, flow] = body.material;
  out << "string name" << number << " = \"" << body.name << "\";\n"
      << "string mesh" << number << " = \"" << body.mesh << "\";\n"
      << "string projection" << number << " = \"" << word(flow ? flow->projection : Projection::frobenius)
      << "\";\n"
      << "real E" << number << " = " << shortest(elasticity.young) << ", nu" << number << " = "
      << shortest(elasticity.poisson) << ";  // [Pa], [-]\n"
      << "real lambda" << number << " = " << shortest(flow ? flow->viscosity : 0) << ", sigmaY" << number
      << " = " << shortest(flow ? flow->yieldStress : 1)
      << ";  // viscosity [Pa s] (0: elastic body), yield stress [Pa]\n";
}

void writeConditions(std::ostream& out, const BodyDescription& body, int number) {
  bool held = false;  // a macro must not be empty
  out << "macro supports" << number << ' ';
  for (const ConditionDescription& c : body.conditions) {
    if (c.kind == ConditionDescription::Kind::displacement) {
      if (c.component != alongX && c.component != alongY) {
        throw InputError(c.value.where +
                         ": the FreeFEM method knows no rollers on sloped sides, expected ux, uy");
      }
      out << "+ on(" << c.label << ", u" << c.component + 1 << " = " << translated(c.value) << ") ";
      held = true;
    }
  }
  out << (held ? "" : "+ int1d(Body" + std::to_string(number) + ")(0.*u1*v1) ") << "//\nmacro loads" << number
      << " + int2d(Body" << number << ")(0.*v2) ";
  for (const ConditionDescription& c : body.conditions) {
    if (c.kind == ConditionDescription::Kind::traction) {
      out << "+ int1d(Body" << number << ", " << c.label << ")((" << translated(c.value) << ")*";
      if (c.component == alongNormal) {
        out << "(N.x*v1 + N.y*v2)) ";
      } else {
        out << "v" << c.component + 1 << ") ";
      }
    }
  }
  for (const int c : {0, 1}) {
    if (body.force[c]) {
      out << "+ int2d(Body" << number << ")((" << translated(*body.force[c]) << ")*v" << c + 1 << ") ";
    }
  }
  out << "//\n";
}

std::string script(const SceneDescription& scene) {
  const ContactDescription& contact = scene.contacts.front();
  const bool first = contact.nonmortar.body == scene.bodies[0].name;
  const std::string method = methodFolder(scene.path);
  std::ostringstream out;
  out << "// " << (scene.title.empty() ? scene.path : scene.title) << "\n// Written by mortier freefem "
      << scene.path << "; run from the folder in which that was called.\n\n// Bodies (plane stress)\n";
  for (const int b : {0, 1}) {
    writeBody(out, scene.bodies[b], b + 1);
  }
  out << "\n// Boundary conditions and loads, functions of x, y and t\n";
  for (const int b : {0, 1}) {
    writeConditions(out, scene.bodies[b], b + 1);
  }
  out << "\n// Contact and time\nstring nonmortar = \"" << contact.nonmortar.body
      << "\";\nstring variant = \"" << word(contact.variant)
      << "\";\nint contactLabel1 = " << (first ? contact.nonmortar : contact.mortar).label
      << ", contactLabel2 = " << (first ? contact.mortar : contact.nonmortar).label
      << ";\nreal endTime = " << shortest(scene.time.end) << ";  // [s]\nint steps = " << scene.time.steps
      << ";  // backward Euler, equal steps\n\n";
  for (const char* part : {"bodies", "coupling", "contact", "loop"}) {
    out << "include \"" << method << '/' << part << ".idp\"\n";
  }
  return out.str();
}

}  // namespace

int writeFreefem(const FreefemCommand& command) {
  // 1. The scene, as checked as for a run of our own.
  const SceneDescription scene = readScene(command.scene, command.settings);
  std::vector<std::string> warnings;
  static_cast<void>(buildModel(scene, warnings));
  if (scene.bodies.size() != 2 || scene.contacts.size() != 1) {
    throw InputError(
        scene.path + ": " + std::to_string(scene.bodies.size()) + " bodies and " +
        std::to_string(scene.contacts.size()) +
        " contact interfaces, expected two bodies and one interface (all that the FreeFEM method knows)");
  }
  const ContactDescription& contact = scene.contacts.front();
  if (!contact.sidesGiven || contact.gap || contact.initial != InitialGap::asMeshed) {
    throw InputError(
        contact.where +
        ": contact: sides, gap or initial, expected nonmortar and mortar at their distance as meshed "
        "(all that the FreeFEM method knows)");
  }
  if (scene.time.scheme != Scheme::backwardEuler) {
    throw InputError(scene.path + ": scheme = " + word(scene.time.scheme) +
                     ", expected backward-euler (all that the FreeFEM method knows)");
  }

  if (scene.time.tolerance > 0) {
    throw InputError(scene.path + ": tolerance = " + shortest(scene.time.tolerance) +
                     ", expected equal steps (all that the FreeFEM method knows)");
  }
  for (const BodyDescription& body : scene.bodies) {
    const bool stressed = std::any_of(body.initialStress.begin(), body.initialStress.end(),
                                      [](const auto& component) { return component.has_value(); });
    if (stressed || !body.regions.empty()) {
      throw InputError(body.where + ": body " + body.name +
                       ": the FreeFEM method knows neither regions nor initial stress");
    }
  }

  // 2. The script.
  const std::string text = script(scene);
  if (command.file.empty()) {
    std::cout << text;
    return exitDone;
  }
  writeWhole(command.file, text);
  return exitDone;
}

}  // namespace mortier
