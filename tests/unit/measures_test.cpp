// Units of a scene, and numbers that have their own.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "base/error.h"
#include "base/units.h"

namespace mortier::measures_test {

double inUnits(const Units& units, double number, const std::string& unit) {
  Measure measure = unitOf(unit).value();
  measure.factor *= number;
  return units.in(measure);
}

TEST(Units, ofASetLabelWhatTheyAreOf) {
  const Units units = Units::from("MPa, mm,N");
  EXPECT_EQ(units.length, "mm");
  EXPECT_EQ(units.stress, "MPa");
  EXPECT_EQ(units.area(), "mm^2");
  EXPECT_EQ(units.forcePerDepth(), "N/mm");
  EXPECT_EQ(units.energyPerDepth(), "N mm/mm");
  EXPECT_EQ(units.nameOf(dimensions::viscosity), "MPa s");
  EXPECT_EQ(Units().energyPerDepth(), "J/m");
  EXPECT_EQ(Units().bodyForce(), "N/m^3");
}

TEST(Units, ofASetAreConsistent) {
  for (const char* set :
       {"m, N, Pa", "mm, N, MPa", "mm, N, N/mm^2", "mm, kN, GPa", "m, kN, kPa", "m, MN, MPa, s",
        "um, uN, MPa", "cm, N, N/cm^2", "in, lbf, psi", "mm, mN, kPa", "s, m, N, J/m^3", "mm, N, MPa, h"})
    EXPECT_NO_THROW(Units::from(set)) << set;
  const std::array<std::array<const char*, 2>, 9> wrong{
      {{"mm, N, Pa", "expected a consistent set: 1 Pa is 1e-06 N/mm^2"},
       {"in, lbf, ksi", "expected a consistent set: 1 ksi is 1000 lbf/in^2"},
       {"mm, N", "expected a length, a force and a stress"},
       {"", "is no unit that is known"},
       {"mm, N, MPa, ", "is no unit that is known"},
       {"mm, N, MPas", "\"MPas\" is no unit that is known"},
       {"mm, m, N", "each once"},
       {"mm, N, MPa, h, s", "each once"},
       {"mm, N, MPa, MPa s", "each once"}}};
  for (const auto& [set, message] : wrong) {
    try {
      Units::from(set);
      ADD_FAILURE() << set;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << set << ": " << error.what();
    }
  }
}

// Powers of ten are no rounding.
TEST(Units, convertDecimalsExactly) {
  const Units units = Units::from("mm, N, MPa");
  EXPECT_EQ(inUnits(units, 210, "GPa"), 210000);
  EXPECT_EQ(inUnits(units, 0.3, "m"), 300);
  EXPECT_EQ(inUnits(units, 78, "kN/m^3"), 7.8e-5);
  EXPECT_EQ(inUnits(units, 50, "MPa s"), 50);
  EXPECT_EQ(inUnits(units, 50, "Pa*s"), 5e-5);
  EXPECT_EQ(inUnits(units, 3, "N/mm^2"), 3);
  EXPECT_EQ(inUnits(units, 2, "min"), 120);
  EXPECT_DOUBLE_EQ(inUnits(units, 1, "in"), 25.4);
  EXPECT_NEAR(inUnits(units, 1, "ksi"), 6.894757293168361, 1e-14);
  EXPECT_EQ(inUnits(Units::from("m, N, Pa"), 210, "GPa"), 210e9);
}

TEST(Units, knowTheirDimension) {
  EXPECT_EQ(unitOf("N/mm^2")->dimension, dimensions::stress);
  EXPECT_EQ(unitOf("kJ/m^3")->dimension, dimensions::stress);
  EXPECT_EQ(unitOf("GPa h")->dimension, dimensions::viscosity);
  EXPECT_EQ(unitOf("1/h")->dimension, dimensions::rate);
  for (const char* none : {"", " ", "x", "N/", "/N", "N//m", "1/", "1//s", "m^", "m^0", "m^9", "m2", "Nm",
                           "kpsi", "kmin", "m^2^2", "MPa\ns", "<b>"})
    EXPECT_FALSE(unitOf(none)) << none;
}

TEST(Units, standBehindNumbersAlone) {
  for (const char* text : {"210 GPa", " -0.1mm ", "1e-3 m", "+.5 N/mm^2", "5. MPa s", "3 apples", "2e-5 1/h"})
    EXPECT_TRUE(numberAndUnit(text)) << text;
  EXPECT_EQ(numberAndUnit("-1.5e3 kN/m")->number, -1500);
  EXPECT_EQ(numberAndUnit("-1.5e3 kN/m")->unit, "kN/m");
  for (const char* text : {"", "GPa", "-10*t", "2", "1 + x", "2 min(t, 1)", "2 1/", "1/s", "2/s", "-", "nan",
                           "inf m", "0x10 m", "1e5", "sin(t)", "t < 1 ? 2 : 3", "1.5.2 m."})
    EXPECT_FALSE(numberAndUnit(text)) << text;
}

}  // namespace mortier::measures_test
