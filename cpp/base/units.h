// The units of a scene, and numbers that have one of their own ("210 GPa") in them. Units of length, force
// and stress are a set: N/mm^2 is MPa. That of time is free of them: nothing here has a mass or a power.
// Where a scene says nothing the names are those of SI, and any consistent set will do.
#pragma once

#include <optional>
#include <string>

namespace mortier {

/// Exponents of length, force and time.
struct Dimension {
  int length = 0;
  int force = 0;
  int time = 0;
  bool operator==(const Dimension&) const = default;
};

namespace dimensions {
constexpr Dimension length{1, 0, 0};
constexpr Dimension force{0, 1, 0};
constexpr Dimension time{0, 0, 1};
constexpr Dimension stress{-2, 1, 0};
constexpr Dimension viscosity{-2, 1, 1};
constexpr Dimension rate{0, 0, -1};
constexpr Dimension bodyForce{-3, 1, 0};
constexpr Dimension energy{1, 1, 0};
}  // namespace dimensions

/// factor 10^decades in m, N, s. Powers of ten stand apart, so that 210 GPa are exactly 210000 MPa.
struct Measure {
  double factor = 1;
  int decades = 0;
  Dimension dimension;
};

struct Units {
  std::string length = "m";
  std::string force = "N";
  std::string stress = "Pa";
  std::string time = "s";
  bool given = false;    ///< whether the scene says them
  bool perDepth = true;  ///< whether forces and energies are per depth, not of whole bodies
  bool inSpace = false;  ///< whether what is an area in the plane is a volume
  Measure lengthInSi{1, 0, dimensions::length};
  Measure forceInSi{1, 0, dimensions::force};
  Measure timeInSi{1, 0, dimensions::time};

  /// From "mm, N, MPa" or "mm, N, MPa, h", in any order. \throws InputError what was expected.
  static Units from(const std::string& text);

  [[nodiscard]] std::string area() const { return length + "^2"; }
  [[nodiscard]] std::string penetration() const { return inSpace ? length + "^3" : area(); }
  /// Forces, moments and energies are per depth, or of whole rings and of bodies in space.
  [[nodiscard]] std::string forcePerDepth() const { return perDepth ? force + "/" + length : force; }
  [[nodiscard]] std::string moment() const { return perDepth ? force : force + " " + length; }
  [[nodiscard]] std::string energyPerDepth() const {
    if (!perDepth) return given ? force + " " + length : "J";
    return given ? force + " " + length + "/" + length : "J/m";
  }
  [[nodiscard]] std::string bodyForce() const { return force + "/" + length + "^3"; }
  [[nodiscard]] std::string nameOf(const Dimension& dimension) const;

  /// A number of these units.
  [[nodiscard]] double in(const Measure& measure) const;
};

/// A unit, such as MPa, N/mm^2, "MPa s" or 1/h; none where one of its parts is not known.
std::optional<Measure> unitOf(const std::string& text);

/// A number and what may be meant as its unit: a word, and more of them with *, / and ^.
struct NumberAndUnit {
  double number = 0;
  std::string unit;
};
/// None where the text is anything else, such as an expression.
std::optional<NumberAndUnit> numberAndUnit(const std::string& text);

}  // namespace mortier
