#include "base/error.h"
#include "scene/readers.h"

namespace mortier {
namespace {

enum Symmetry { isotropic, orthotropic, general };

/// NaN where it is not given: plane strain asks for it then.
Orthotropy readOrthotropy(const TableReader& table) {
  return {{table.number("young1"), table.number("young2"), table.number("young3", NAN)},
          {table.number("poisson12"), table.number("poisson13", NAN), table.number("poisson23", NAN)},
          table.number("shear12")};
}

Matrix readStiffness(const TableReader& table) {
  const std::string expected = "three rows of three numbers, or four of four in plane strain";
  const Node& node = table.require("stiffness", expected);
  const size_t n = node.elements.size();
  if (!node.isArray() || (n != 3 && n != 4)) table.reject("stiffness", expected);
  Matrix stiffness(n, n);
  for (size_t i = 0; i < n; ++i) {
    const Node& row = node.elements[i];
    if (!row.isArray() || row.elements.size() != n) table.reject("stiffness", expected);
    for (size_t j = 0; j < n; ++j) {
      if (!row.elements[j].isNumeric() || !std::isfinite(row.elements[j].value))
        table.refuse(row.elements[j],
                     "stiffness has " + row.elements[j].quoted() + ", expected finite numbers");
      stiffness(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row.elements[j].value;
    }
  }
  return stiffness;
}

void readExpansion(const TableReader& table, MaterialDescription& material) {
  if (!table.has("expansion") || !table.find("expansion")->isArray()) {
    material.expansion.fill(table.number("expansion"));
    return;
  }
  const std::vector<double> values = table.numbers("expansion");
  if (values.size() != 3 || !material.anisotropy)
    table.reject("expansion", "a number, or one for each of the three axes beside elasticity that has axes");
  std::copy(values.begin(), values.end(), material.expansion.begin());
}

}  // namespace

Anisotropy AnisotropyDescription::in(Plane plane) const {
  try {
    if (const auto* stiffness = std::get_if<Matrix>(&moduli)) return anisotropyOf(*stiffness, plane);
    const auto& orthotropy = std::get<Orthotropy>(moduli);
    const bool third = !std::isnan(orthotropy.young[2]);
    const bool all = third && !std::isnan(orthotropy.poisson[1]) && !std::isnan(orthotropy.poisson[2]);
    if (plane != Plane::stress && !all)
      throw InputError(std::string("expected young3, poisson13 and poisson23 as well ") +
                       (plane == Plane::strain ? "in plane strain" : "around an axis"));
    return anisotropyOf(orthotropy, plane);
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  }
}

void readElasticity(const TableReader& table, MaterialDescription& material) {
  const Keys& kinds = keyAt("body.material", "elasticity").words;
  const auto kind = table.choice<Symmetry>("elasticity");
  table.requireBeside("elasticity", kinds[kind]);
  if (kind != isotropic)
    table.rejectIfGiven({"young", "poisson"}, "it beside elasticity = \"isotropic\" only");
  if (kind == isotropic) {
    material.elasticity = {table.number("young"), table.number("poisson")};
  } else {
    AnisotropyDescription& own = material.anisotropy.emplace();
    own.where = table.message(table.find("elasticity")->where, "elasticity = \"" + kinds[kind] + '"');
    if (kind == orthotropic) {
      own.moduli = readOrthotropy(table);
      material.elasticity.young = std::get<Orthotropy>(own.moduli).young[0];
    } else {
      own.moduli = readStiffness(table);
      material.elasticity.young = std::get<Matrix>(own.moduli).cwiseAbs().maxCoeff();
    }
    own.angle = table.datum("angle");
    if (own.angle && own.angle->inTime) table.reject("angle", "an angle in x and y, the same at all times");
  }
  readExpansion(table, material);
}

void requireTakesElasticity(const TableReader& table, const MaterialDescription& material) {
  if (!material.anisotropy) return;
  if (material.flow.index() > 0 && !material.as<Viscoplasticity>() && !material.as<NortonCreep>())
    table.reject("elasticity", "\"isotropic\" beside this law");
  if (const auto* flow = material.as<Viscoplasticity>(); flow && flow->projection != Projection::frobenius)
    table.reject("projection", "\"frobenius\" beside elasticity that is not isotropic");
}

}  // namespace mortier
