#include <array>
#include <filesystem>

#include "base/error.h"
#include "fem/supports.h"
#include "scene/readers.h"

namespace mortier {

namespace {

/// Two data for one component of one place would have to be ordered by a rule that nobody remembers.
void addCondition(BodyDescription& body, const ConditionDescription& added) {
  for (const ConditionDescription& other : body.conditions) {
    if (other.label == added.label && other.labelName == added.labelName && other.point == added.point &&
        other.pointInSpace == added.pointInSpace && other.component == added.component) {
      static constexpr std::array directions{"component x", "component y", "component z", "the normal",
                                             "the tangent"};
      throw InputError(added.value.where + ", expected one condition for " + directions[added.component] +
                       " of " + nameOfPlace(added) + ", there is one at " + other.where);
    }
  }
  body.conditions.push_back(added);
}

void readBoundary(const Node& node, BodyDescription& body) {
  const TableReader table(node, "body.boundary", "body " + body.name);
  using Datum = ConditionDescription::Kind;
  const TableReader::Label label = table.label("label");
  const size_t before = body.conditions.size();
  const bool space = node.inSpace;
  const auto add = [&](const std::string& key, Datum kind, int component) {
    const bool moves = kind == Datum::displacement;
    std::optional<Expression> datum = moves ? table.displacement(key) : table.datum(key);
    if (!datum) return;
    ConditionDescription condition{kind,
                                   label.number,
                                   label.name,
                                   component,
                                   key == "pressure" ? negated(std::move(*datum)) : std::move(*datum),
                                   table.find(key)->where};
    condition.whereItIs = moves && table.isHeld(key);
    addCondition(body, condition);
  };
  requireOfDimension(table, {"uz", "tz"}, {"ut"});
  add("ux", Datum::displacement, alongX);
  add("uy", Datum::displacement, alongY);
  add("uz", Datum::displacement, alongZ);
  add("un", Datum::displacement, alongNormal);
  add("ut", Datum::displacement, alongTangent);
  add("tx", Datum::traction, alongX);
  add("ty", Datum::traction, alongY);
  add("tz", Datum::traction, alongZ);
  add("pressure", Datum::traction, alongNormal);
  if (body.conditions.size() == before)
    table.refuse(node, "boundary label " + label.text() + " has no condition, expected one of ux, uy, " +
                           (space ? "uz, un, tx, ty, tz, pressure" : "un, ut, tx, ty, pressure"));
}

void readPoint(const Node& node, BodyDescription& body) {
  const TableReader table(node, "body.point", "body " + body.name);
  requireOfDimension(table, {"uz", "fz"}, {});
  ConditionDescription condition;
  if (node.inSpace)
    condition.pointInSpace = table.spacePoint("at");
  else
    condition.point = table.point("at");
  condition.where = table.find("at")->where;
  const size_t before = body.conditions.size();
  const std::array<Keys, 2> keys{{{"ux", "uy", "uz"}, {"fx", "fy", "fz"}}};
  for (const auto kind : {ConditionDescription::Kind::displacement, ConditionDescription::Kind::traction})
    for (condition.component = 0; condition.component < 3; ++condition.component) {
      const bool moves = kind == ConditionDescription::Kind::displacement;
      const std::string& key = keys[moves ? 0 : 1][condition.component];
      const auto datum = moves ? table.displacement(key) : table.datum(key);
      if (!datum) continue;
      condition.kind = kind;
      condition.value = *datum;
      condition.whereItIs = moves && table.isHeld(key);
      addCondition(body, condition);
    }
  if (body.conditions.size() == before)
    table.refuse(node, nameOfPlace(condition) + " has no condition, expected one of ux, uy, " +
                           (node.inSpace ? "uz, fx, fy, fz" : "fx, fy"));
}

StressDescription readInitialStress(const TableReader& owner, const std::string& path,
                                    const std::string& subject) {
  StressDescription stress;
  if (!owner.has("initial_stress")) return stress;
  const TableReader table(*owner.find("initial_stress"), path, subject);
  requireOfDimension(table, {"s13", "s23"}, {});
  const std::string keys[] = {"s11", "s22", "s12", "s33", "s13", "s23"};
  for (size_t c = 0; c < stress.size(); ++c) stress[c] = table.datum(keys[c]);
  return stress;
}

void readRegion(const Node& node, BodyDescription& body) {
  const std::string subject = "body " + body.name;
  const TableReader table(node, "body.region", subject);
  RegionDescription region;
  const TableReader::Label label = table.label("label");
  region.label = label.number;
  region.labelName = label.name;
  region.where = table.find("label")->where;
  for (const RegionDescription& other : body.regions)
    if (other.label == region.label && other.labelName == region.labelName)
      table.reject("label", "a region of its own, there is one at " + other.where);
  const std::string here = subject + ", region " + label.text();
  if (const Node* material = table.find("material"))
    region.material = readMaterial(*material, "body.region.material", here);
  region.initialStress = readInitialStress(table, "body.region.initial_stress", here);
  if (!region.material && table.find("initial_stress") == nullptr)
    table.refuse(node, "region label " + label.text() + " says nothing, expected material or initial_stress");
  body.regions.push_back(std::move(region));
}

/// A datum, or a file of nodal values with a factor in x, y and t.
TemperatureDescription readTemperature(const TableReader& owner, const std::string& scenePath,
                                       const std::string& subject) {
  const Node& node = *owner.find("temperature");
  const std::string where = node.where + ": " + subject;
  if (!node.isTable() || node.find("file") == nullptr) return {*owner.datum("temperature"), "", where};
  const TableReader table(node, "body.temperature", subject + ": temperature");
  static_cast<void>(table.string("file"));
  const Node& file = *table.find("file");
  const std::optional<Expression> factor = table.datum("factor");
  return {factor ? *factor : constantExpression(1, table.message(file.where, "factor = 1")),
          pathOf(file, scenePath), where};
}

/// Beside a file there is nothing that says what a mesh is of.
void requireFileKeys(const TableReader& table) {
  Keys known{"file", "region", "size", "parameters"};
  if (table.table().inSpace) known.insert(known.end(), sweepKeys().begin(), sweepKeys().end());
  for (const Node& member : table.table().members)
    if (!isOneOf(member.key, known)) table.reject(member.key, "it beside shape; of a file " + joined(known));
}

}  // namespace

std::string pathOf(const Node& node, const std::string& scenePath) {
  const std::filesystem::path path(node.text);
  if (path.is_absolute() || node.fromCommandLine) return path.string();
  return (std::filesystem::path(scenePath).parent_path() / path).lexically_normal().string();
}

/// A path, or a table with what is to be made of the file, or of what shape the mesh is.
void readMeshSource(const TableReader& owner, const std::string& scenePath, BodyDescription& body) {
  const Node& node = owner.require("mesh", "a Medit .mesh file, or a file for Gmsh");
  body.meshWhere = node.where;
  if (!node.isTable()) {
    static_cast<void>(owner.string("mesh"));
    body.mesh.path = pathOf(node, scenePath);
  } else {
    const TableReader table(node, "body.mesh", "body " + body.name + ": mesh");
    const Node* shape = table.find("shape");
    if (shape == nullptr || !isSolidShape(shape->text)) body.mesh.sweep = readSweep(table);
    if (shape != nullptr) {
      if (node.inSpace && !body.mesh.sweep)
        body.mesh.inSpace = readSpaceShape(table);
      else
        body.mesh.shape = readShape(table);
      body.mesh.path = shape->text;
      return;
    }
    requireFileKeys(table);
    static_cast<void>(table.string("file"));
    body.mesh.path = pathOf(*table.find("file"), scenePath);
    body.mesh.regions = table.labels("region");
    if (table.find("size") != nullptr) body.mesh.size = table.number("size");
    if (const Node* parameters = table.find("parameters")) {
      if (!parameters->isTable()) table.reject("parameters", "a table of numbers, { R = 8, ... }");
      for (const Node& parameter : parameters->members) {
        if (!parameter.isNumeric() || !std::isfinite(parameter.value))
          table.refuse(parameter, "parameters." + parameter.key + " = " + parameter.quoted() +
                                      ", expected a finite number");
        body.mesh.parameters[parameter.key] = parameter.value;
      }
    }
  }
  if (std::error_code ignored; !std::filesystem::is_regular_file(body.mesh.path, ignored))
    owner.reject("mesh", "a Medit .mesh file, or a file for Gmsh (there is none at " + body.mesh.path + ")");
}

BodyDescription readBody(const Node& node, const std::string& scenePath, size_t index) {
  const Node* name = node.find("name");
  const bool named = name != nullptr && name->isString();
  const TableReader table(node, "body", "body " + (named ? name->text : std::to_string(index)));
  BodyDescription body;
  body.where = node.where;
  body.name = table.string("name");
  if (!isName(body.name)) table.reject("name", "letters, digits, _ and -");
  const std::string subject = "body " + body.name;
  readMeshSource(table, scenePath, body);
  body.material =
      readMaterial(table.require("material", "{ young = ..., poisson = ... }"), "body.material", subject);
  body.initialStress = readInitialStress(table, "body.initial_stress", subject);
  for (const Node* region : table.tables("region")) readRegion(*region, body);
  if (const Node* force = table.find("force")) {
    const TableReader components(*force, "body.force", subject);
    body.force[0] = components.datum("x");
    body.force[1] = components.datum("y");
    requireOfDimension(components, {"z"}, {});
    body.force[2] = components.datum("z");
  }
  if (table.find("temperature") != nullptr) body.temperature = readTemperature(table, scenePath, subject);
  body.volume = table.choice<Volume>("volume");
  if (body.volume != Volume::automatic)
    body.volumeWhere = table.message(table.find("volume")->where,
                                     body.volume == Volume::averaged ? "volume = \"averaged\"" : "volume");
  for (const Node* boundary : table.tables("boundary")) readBoundary(*boundary, body);
  for (const Node* point : table.tables("point")) readPoint(*point, body);
  return body;
}

}  // namespace mortier
