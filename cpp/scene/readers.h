// The parts of a scene that are read one by one (scene.cpp). Whatever is wrong is an InputError with one line
// `file:line: subject: key = value, expected ...`.
#pragma once

#include <optional>
#include <string>

#include "mesh/shape.h"
#include "scene/document.h"
#include "scene/expression.h"
#include "scene/keys.h"
#include "scene/scene.h"

namespace mortier {

// Typed access to one table of a scene, by the table of keys. Whatever is wrong becomes one line:
//   scenes/compression.toml:14: body upper: poisson = 0.6, expected -1 < poisson < 0.5

class TableReader {
 public:
  /// `table` is at the `path` of the table of keys; `subject` names it in messages ("body upper", may be
  /// empty). \throws InputError when it is no table or has a key that is not known.
  TableReader(const Node& table, std::string path, std::string subject);

  [[nodiscard]] const Node& table() const { return table_; }
  [[nodiscard]] const Node* find(const std::string& key) const { return table_.find(key); }
  [[nodiscard]] bool has(const std::string& key) const { return find(key) != nullptr; }
  /// \throws InputError when `key` is missing; `expected` says what it should hold.
  [[nodiscard]] const Node& require(const std::string& key, const std::string& expected) const;
  /// \throws InputError where a key stands that belongs to other words of the key `governing`.
  void requireBeside(const std::string& governing, const std::string& word,
                     const std::string& except = "") const;

  // In the range of the table of keys. A missing key gives the fallback, else the default of that table; it
  // is an error where there is neither.
  /// \param range  in place of that of the table
  [[nodiscard]] double number(const std::string& key, std::optional<double> fallback = {},
                              const std::string& range = "") const;
  [[nodiscard]] int integer(const std::string& key, std::optional<int> fallback = {}) const {
    return static_cast<int>(number(key, fallback));
  }
  [[nodiscard]] bool boolean(const std::string& key) const;
  [[nodiscard]] std::string string(const std::string& key, std::optional<std::string> fallback = {}) const;
  /// The strings of a list; none where the key is missing.
  [[nodiscard]] std::vector<std::string> strings(const std::string& key) const;
  /// The one of its words, which are in the order of the enumeration.
  template <class Choice>
  [[nodiscard]] Choice choice(const std::string& key, std::optional<Choice> fallback = {}) const {
    const int otherwise = fallback ? static_cast<int>(*fallback) : -1;
    return static_cast<Choice>(oneOf(key, keyAt(path_, key).words, otherwise));
  }
  /// The index of the value among `words`; of the default where `otherwise` is negative.
  [[nodiscard]] int oneOf(const std::string& key, const Keys& words, int otherwise = -1) const;
  /// A label: a number >= 0, or a name in the mesh.
  struct Label {
    int number = 0;
    std::string name;
    [[nodiscard]] std::string text() const { return name.empty() ? std::to_string(number) : name; }
  };
  [[nodiscard]] Label label(const std::string& key) const;
  /// One label or a list of them, as text; none where the key is missing.
  [[nodiscard]] std::vector<std::string> labels(const std::string& key) const;
  /// An array of finite numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& key) const;
  /// [x, y]
  [[nodiscard]] Point point(const std::string& key, std::optional<Point> fallback = {}) const;
  /// [x, y, z]
  [[nodiscard]] SpacePoint spacePoint(const std::string& key, std::optional<SpacePoint> fallback = {}) const;
  /// A number, an expression in x, y, in space z, and t, or a table in time; none where the key is missing.
  [[nodiscard]] std::optional<Expression> datum(const std::string& key) const;
  /// Of a displacement: whether it is "held", as it is at the start of the run.
  [[nodiscard]] bool isHeld(const std::string& key) const;
  /// The same; 0 where it is held.
  [[nodiscard]] std::optional<Expression> displacement(const std::string& key) const;
  /// The table or tables under `key` (an array of tables or a single one), none where it is missing.
  [[nodiscard]] std::vector<const Node*> tables(const std::string& key) const;

  /// `where: subject: message`
  [[nodiscard]] std::string message(const std::string& where, const std::string& text) const;
  /// \throws InputError `where: subject: message`
  [[noreturn]] void refuse(const Node& at, const std::string& text) const;
  /// \throws InputError `where: subject: key = value, expected ...`
  [[noreturn]] void reject(const std::string& key, const std::string& expected) const;
  /// The same if the key is there, as it is not to be.
  void rejectIfGiven(const Keys& keys, const std::string& expected) const;

 private:
  [[nodiscard]] Expression timeTable(const std::string& key, const Node& node) const;

  const Node& table_;
  std::string path_;
  std::string subject_;
};

/// Sets `path=value` in the document, before it is validated. Where the path meets an array of tables its
/// next component is the name of an element (or the label, in body.boundary), or its index from 0, or is left
/// out, which means every element:
///   time.steps=20   contact.variant=interpolation   body.upper.mesh=a.mesh
///   body.material.projection=frobenius
/// \param place  of the setting in the scene; empty: on the command line
void applyOverride(Node& document, const std::string& setting, const std::string& place);
/// Applies those of the stage that `stage=NAME` among the settings chooses, and the others after them.
/// \returns the stage before that one; empty where it is the first, or the scene has no stages
std::string applySettings(Node& document, const std::vector<std::string>& settings);

/// The units that a scene says.
Units readUnits(const Node& scene);
/// Makes numbers of the scene's units of all numbers with a unit, young = "210 GPa". What has no unit that is
/// known, or one of another dimension, is refused, and any unit in a scene that says none.
void convertMeasures(Node& scene, const Units& units);

/// The path of a file that a key names: relative to the scene, on the command line to the current folder.
std::string pathOf(const Node& node, const std::string& scenePath);

/// [time]: equal steps, or steps chosen by their error.
TimePlan readTime(const Node& node);

/// [[body]]: mesh, materials, regions, forces and boundary conditions. `scenePath` is the file that names the
/// mesh; `index` names a body that has no name yet.
BodyDescription readBody(const Node& node, const std::string& scenePath, size_t index);
/// `mesh = { shape = "rectangle", ... }`
MeshShape readShape(const TableReader& table);
/// The same in space.
SpaceShape readSpaceShape(const TableReader& table);
/// Whether a word of `shape` is one in space.
bool isSolidShape(const std::string& word);
/// What makes a body in space of a plane mesh; none where no key gives it.
std::optional<Sweep> readSweep(const TableReader& table);
const Keys& sweepKeys();

/// Its mesh. \param owner  of the key `mesh`
void readMeshSource(const TableReader& owner, const std::string& scenePath, BodyDescription& body);
/// [[tool]]; the plane of the scene is known.
BodyDescription readTool(const Node& node, const SceneDescription& scene, size_t index);
/// [[x, y], ...] \throws InputError that says what was expected
std::vector<Point> readPoints(const TableReader& table, const std::string& key, const std::string& expected);

/// Elasticity, and the law by which it flows; a key that belongs to another law is refused.
MaterialDescription readMaterial(const Node& node, const std::string& path, const std::string& subject);
/// Plasticity has no rate at a given stress: a scene whose steps need one is refused.
void requireRates(const BodyDescription& body, const SceneDescription& scene);
/// Isotropic by young and poisson, orthotropic by nine constants, general by its matrix, and the axes it is
/// turned by; the coefficients of thermal expansion.
void readElasticity(const TableReader& table, MaterialDescription& material);
/// Refuses a law that requires isotropic elasticity beside another.
void requireTakesElasticity(const TableReader& table, const MaterialDescription& material);
/// law = "expression": rate11, rate22, rate12, rate33 in s11, s22, s12, s33, e11, e22, e12, e33 and what
/// `parameters` names, numbers and expressions.
OwnLaw readExpressionLaw(const TableReader& table);
/// A law that a program has registered (scene/registered_laws.h).
OwnLaw readRegisteredLaw(const TableReader& table);

/// Refuses keys of space in the plane, and those of the plane in space.
void requireOfDimension(const TableReader& table, const Keys& ofSpace, const Keys& ofPlane);
/// Refuses what is not known in space.
void requireKnownInSpace(const TableReader& root, const SceneDescription& scene);

/// `body` of a table: one that the scene has.
std::string nameOfBody(const TableReader& table, const SceneDescription& scene);
/// [[contact]]; `scene` holds the bodies and the contacts that were read before.
ContactDescription readContact(const Node& node, const SceneDescription& scene);
/// [[quantity]]; the bodies of the scene are there.
QuantityDescription readQuantity(const Node& node, const SceneDescription& scene);

}  // namespace mortier
