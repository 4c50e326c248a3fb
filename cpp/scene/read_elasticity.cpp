#include "base/error.h"
#include "scene/readers.h"

namespace mortier {
namespace {

enum Symmetry { isotropic, orthotropic, general };

/// Rows of finite numbers. \param counts  of rows \param length  of a row; 0: as many as there are rows
Matrix readRows(const TableReader& table, const std::string& key, const std::string& expected,
                const std::vector<size_t>& counts, size_t length = 0) {
  const Node& node = table.require(key, expected);
  const size_t n = node.elements.size();
  if (!node.isArray() || std::find(counts.begin(), counts.end(), n) == counts.end())
    table.reject(key, expected);
  Matrix rows(n, length > 0 ? length : n);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Node& row = node.elements[i];
    if (!row.isArray() || static_cast<Eigen::Index>(row.elements.size()) != rows.cols())
      table.reject(key, expected);
    for (Eigen::Index j = 0; j < rows.cols(); ++j) {
      if (!row.elements[j].isNumeric() || !std::isfinite(row.elements[j].value))
        table.refuse(row.elements[j], key + " has " + row.elements[j].quoted() + ", expected finite numbers");
      rows(i, j) = row.elements[j].value;
    }
  }
  return rows;
}

/// NaN where it is not given: plane strain and space require it then.
Orthotropy readOrthotropy(const TableReader& table) {
  requireOfDimension(table, {"shear13", "shear23"}, {});
  return {{table.number("young1"), table.number("young2"), table.number("young3", NAN)},
          {table.number("poisson12"), table.number("poisson13", NAN), table.number("poisson23", NAN)},
          {table.number("shear12"), table.number("shear13", NAN), table.number("shear23", NAN)}};
}

/// Axis 1 and a vector in the plane of axes 1 and 2, as orthonormal columns.
Eigen::Matrix3d readAxes(const TableReader& table) {
  constexpr const char* expected = "two vectors that are not parallel, [[x, y, z], [x, y, z]]";
  constexpr double parallel = 1e-6;
  requireOfDimension(table, {"axes"}, {});
  if (!table.has("axes")) return Eigen::Matrix3d::Identity();
  const Matrix rows = readRows(table, "axes", expected, {2}, 3);
  const SpacePoint first = rows.row(0).normalized();
  const SpacePoint third = first.cross(SpacePoint(rows.row(1).normalized()));
  if (!(third.norm() > parallel)) table.reject("axes", expected);
  Eigen::Matrix3d axes;
  axes << first, third.normalized().cross(first), third.normalized();
  return axes;
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
    if (const auto* stiffness = std::get_if<Matrix>(&moduli))
      return turned(anisotropyOf(*stiffness, plane), axes);
    const auto& [young, poisson, shear] = std::get<Orthotropy>(moduli);
    if (plane != Plane::stress && std::isnan(young[2] + poisson[1] + poisson[2]))
      throw InputError(std::string("expected young3, poisson13 and poisson23 as well ") +
                       (plane == Plane::strain ? "in plane strain"
                        : plane == Plane::none ? "in space"
                                               : "around an axis"));
    if (plane == Plane::none && std::isnan(shear[1] + shear[2]))
      throw InputError("expected shear13 and shear23 as well in space");
    return turned(anisotropyOf(std::get<Orthotropy>(moduli), plane), axes);
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
      own.moduli = readRows(table, "stiffness",
                            "three rows of three numbers, four of four in plane strain, six of six in space",
                            {3, 4, 6});
      material.elasticity.young = std::get<Matrix>(own.moduli).cwiseAbs().maxCoeff();
    }
    own.axes = readAxes(table);
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
