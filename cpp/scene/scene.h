// A scene as written: what docs/scene.md documents, validated key by key. resolve.h decides what it leaves to
// its meshes, build.h turns it into a Model.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/units.h"
#include "contact/interface.h"
#include "contact/tie.h"
#include "material/anisotropy.h"
#include "material/norton.h"
#include "material/overstress.h"
#include "material/own_material.h"
#include "material/perzyna.h"
#include "material/viscoelastic.h"
#include "mesh/read.h"
#include "scene/document.h"
#include "scene/expression.h"
#include "time/march.h"
#include "time/quantity.h"

namespace mortier {

/// What a material does beside elasticity; the first: nothing.
using FlowLaw =
    std::variant<std::monostate, Viscoplasticity, NortonCreep, Viscoelasticity, Overstress, OwnLaw>;

/// Elasticity that is not isotropic, in axes that may be turned.
struct AnisotropyDescription {
  /// Or the stiffness: stresses of (e11, e22, 2 e12, e33, 2 e13, 2 e23) [Pa].
  std::variant<Orthotropy, Matrix> moduli;
  std::optional<Expression> angle;  ///< from x to axis 1, or of the axes about z, in x, y and z [rad]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, before they are turned by the angle
  std::string where;                                   ///< what a message about it begins with

  /// In the body, but for the angle. \throws InputError where it is not elliptic.
  [[nodiscard]] Anisotropy in(Plane plane) const;
};

struct MaterialDescription {
  Elasticity elasticity;  ///< beside an anisotropy only its order of magnitude
  FlowLaw flow;
  std::optional<AnisotropyDescription> anisotropy = {};
  std::array<double, 3> expansion{};  ///< thermal strain per kelvin along the axes [1/K]
  std::string unusedProjection = {};  ///< where an elastic material has one

  [[nodiscard]] bool flows() const { return flow.index() > 0; }
  /// The parameters of a law; null where the material follows another.
  template <class Law>
  [[nodiscard]] const Law* as() const {
    return std::get_if<Law>(&flow);
  }
};

/// A displacement [m] or a traction [Pa] along one direction on a labelled part of the boundary, or a
/// displacement of a vertex.
struct ConditionDescription {
  enum class Kind { displacement, traction };
  Kind kind = Kind::displacement;
  int label = 0;
  std::string labelName;  ///< where the label is a name; resolveScene finds it
  int component = 0;      ///< Component (fem/supports.h)
  Expression value;
  std::string where;                ///< file and line of the label, or the --set that gave it
  std::optional<Point> point = {};  ///< in place of the label; resolveScene makes it that of a vertex [m]
  std::optional<SpacePoint> pointInSpace = {};  ///< the same in space
  bool onAxis = false;                          ///< of the axis of revolution, in place of the label
  bool whereItIs = false;                       ///< a displacement: that in which the run begins

  [[nodiscard]] bool actsOn(int boundary) const {
    return !point && !pointInSpace && !onAxis && label == boundary;
  }
  /// Of a motion of a tool: whether it is a rotation.
  [[nodiscard]] bool turns() const { return component >= (pointInSpace ? 3 : 2); }
};

/// "label 3", "point [0.5, 1]" or "the axis".
std::string nameOfPlace(const ConditionDescription& condition);

/// s11, s22, s12, s33, s13, s23 at t = 0 [Pa].
using StressDescription = std::array<std::optional<Expression>, 6>;

/// What is different in the triangles of one region.
struct RegionDescription {
  int label = 0;
  std::string labelName;  ///< where the label is a name; resolveScene finds it
  std::optional<MaterialDescription> material;
  StressDescription initialStress;
  std::string where;
};

/// Temperature above that at which nothing is strained: a datum, times nodal values of a file where there is
/// one [K].
struct TemperatureDescription {
  Expression value;
  std::string file;  ///< empty: none
  std::string where;
};

/// The volumetric strain that the material of a body gets (fem/volume_patches.h).
enum class Volume { automatic, pointwise, averaged };

struct BodyDescription {
  std::string name;
  MeshSource mesh;
  std::string meshWhere;
  MaterialDescription material;
  std::optional<Expression> force[3];  ///< x, y and, in space, z [N/m^3]
  std::optional<TemperatureDescription> temperature = {};
  std::vector<ConditionDescription> conditions;
  StressDescription initialStress;
  std::vector<RegionDescription> regions;
  Volume volume = Volume::automatic;  ///< resolveScene decides an automatic one
  std::string volumeWhere;            ///< empty where the scene does not say it
  std::string volumeChoice;           ///< why it is that one, where the program has chosen it for a reason
  /// Of a tool, which is rigid and has no material: the point about which it turns, z = 0 in the plane [m].
  /// Its conditions are those of its motions, all at this point: along x, along y, and the rotation, in space
  /// along x, y, z and the rotations about these axes, as displacements [m], [rad] or as forces and moments.
  std::optional<SpacePoint> reference = {};
  std::string where;

  bool point = false;  ///< a tool without a surface, for ties

  /// Whether it is a tool that a datum may turn.
  [[nodiscard]] bool turns() const;
  [[nodiscard]] bool isTool() const { return reference.has_value(); }
};

/// The material of a body and those of its regions.
std::vector<const MaterialDescription*> materialsOf(const BodyDescription& body);
/// Whether one of them can flow.
bool mayFlow(const BodyDescription& body);

struct SideDescription {
  std::string body;
  int label = 0;
  std::string labelName;  ///< where the label is a name; resolveScene finds it
  std::string where;
};

/// What contact makes of bodies that slide along each other.
enum class SlidingKind {
  refuse,  ///< slips are taken as small; a run ends where a node passes the end of the line that it touches
  allow,   ///< the same, and goes on
  finite   ///< contact follows the bodies
};

struct ContactDescription {
  bool tied = false;                     ///< whether the sides move as one
  std::array<SideDescription, 2> sides;  ///< as the scene names them
  /// Which of them is nonmortar; empty, then the first, until the meshes decide it (scene/resolve.h).
  std::optional<int> nonmortarSide;
  bool otherSide = false;  ///< where meshes decide it: the one that they would not choose
  std::string choice;      ///< why it is that one, where the program has chosen
  CouplingKind variant = CouplingKind::mortar;
  bool stabilised = false;  ///< contact/pressure_compliance.h
  InitialGap initial = InitialGap::asMeshed;
  std::optional<Expression> gap;  ///< [m]
  Friction friction;
  SlidingKind sliding = SlidingKind::refuse;
  // Of ties (contact/tie.h).
  TieKind tieKind = TieKind::surface;
  std::array<bool, 3> along{true, true, true};
  double stiffness = 0;  ///< 0: rigid [N/m^3]
  std::string offset;    ///< the tool that moves the sides apart; empty: none
  std::string where;

  [[nodiscard]] const SideDescription& nonmortar() const { return sides[nonmortarSide.value_or(0)]; }
  [[nodiscard]] const SideDescription& mortar() const { return sides[1 - nonmortarSide.value_or(0)]; }
};

/// A number that the run is to report (time/quantity.h).
struct QuantityDescription {
  std::string name;
  Quantity::Kind kind = Quantity::Kind::reaction;
  std::string body;
  int label = 0;
  std::string labelName;       ///< where the label is a name; resolveScene finds it
  std::optional<Point> point;  ///< in place of the label: of a displacement, or of a support [m]
  std::optional<SpacePoint> pointInSpace = {};  ///< the same in space
  Quantity::Component component = Quantity::Component::x;
  SpacePoint about{0, 0, 0};
  struct Part {
    Point from, to;     ///< [m]
    double margin = 0;  ///< [m]
  };
  std::optional<Part> part;  ///< of the line of a mean pressure; none: all of it
  bool whole = false;        ///< of a tool, in place of the label
  std::string where;         ///< of the label or the point
};

/// An error that the run is to reach by itself (adapt/rounds.h).
struct AccuracyGoal {
  double energy = 0;         ///< relative, in the energy norm, of meshes and steps together; 0: none is asked
  std::string quantity;      ///< in place of it, of this quantity; empty: none
  double tolerance = 0;      ///< of its error, relative
  std::string where;         ///< of its name
  double maxUnknowns = 1e6;  ///< of a round
  double maxSeconds = INFINITY;  ///< wall time of all rounds [s]
  bool bound = false;            ///< whether the error at the end is to have a guaranteed bound

  /// What is asked for, relative; 0: nothing is, and the meshes stay as they are.
  [[nodiscard]] double asked() const { return quantity.empty() ? energy : tolerance; }
};

struct SceneDescription {
  std::string path;                      ///< the file
  std::string text;                      ///< of it
  std::vector<std::string> settings;     ///< key=value, that were applied
  std::shared_ptr<const Node> document;  ///< with the settings, for the places of its keys
  std::string title;                     ///< may be empty
  Units units;                           ///< of all numbers below
  int dimension = 2;                     ///< 3: bodies of tetrahedra, no plane
  Plane plane = Plane::stress;
  int degree = 1;  ///< of the displacements: 1 or 2
  std::vector<BodyDescription> bodies;
  std::vector<ContactDescription> contacts;
  std::vector<ContactDescription> ties;
  std::vector<QuantityDescription> quantities;
  TimePlan time;
  SolverOptions solver;
  AccuracyGoal accuracy;
  int every =
      0;  ///< keep each so many steps (and the initial state) beside the last one; 0: the last one only
  std::string start;  ///< the result with whose last state the run begins; empty: bodies as drawn, at rest
  std::string startWhere;            ///< file and line of it
  std::string after;                 ///< the stage before the one that it is; empty where there is none
  bool keepsState = false;           ///< whether the result is to have the last state, for another run
  std::vector<std::string> allowed;  ///< faults that mortier check is not to name (docs/check.md)

  [[nodiscard]] bool inSpace() const { return dimension == 3; }
  /// Whether it does not begin from bodies at rest.
  [[nodiscard]] bool goesOn() const { return !start.empty() || !after.empty(); }
};

/// Reads a scene, applies the settings (`key=value`) in their order, and validates.
/// \throws InputError with one line `file:line: subject: key = value, expected ...`.
SceneDescription readScene(const std::string& path, const std::vector<std::string>& settings = {});

/// The names of the stages of a scene file, in turn; none where it has none or the settings choose one.
/// \throws InputError
std::vector<std::string> stagesToRun(const std::string& path, const std::vector<std::string>& settings);

/// Calls visit with every contact and every tie.
template <class Scene, class Visit>
void forEachPair(Scene& scene, const Visit& visit) {
  for (auto* pairs : {&scene.contacts, &scene.ties})
    for (auto& pair : *pairs) visit(pair);
}

/// Words of the scene for what a scene can choose.
std::string word(Plane plane);
std::string word(CouplingKind kind);
/// Of a tie: "kinematic" or "distributing", else that of its rows.
std::string wordOfTie(const ContactDescription& tie);
std::string word(Projection projection);
std::string word(Scheme scheme);

/// Whether a text is letters, digits, _ and -: names become names of files and columns.
bool isName(const std::string& text);

/// The index of the body called `name`; -1 where there is none.
int bodyIndex(const SceneDescription& scene, const std::string& name);
/// Whether contact follows a body, which may move far then.
bool isFollowed(const SceneDescription& scene, const std::string& body);

}  // namespace mortier
