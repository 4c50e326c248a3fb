// What a scene in space cannot have yet: refused by name before anything is solved.
#include "base/error.h"
#include "scene/readers.h"

namespace mortier {
namespace {

constexpr auto inThePlane = " with dimension = 3: known in the plane only";

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw InputError(where + ": " + what + ", expected none" + inThePlane);
}

void requireKnown(const BodyDescription& body) {
  const std::string where = body.where + ": body " + body.name;
  if (body.volume == Volume::averaged)
    throw InputError(body.volumeWhere + ", expected pointwise" + inThePlane);
}

void requireKnown(const ContactDescription& contact, int degree) {
  const std::string where = contact.where + ": contact";
  if (contact.friction.any()) refuse(where, "friction");
  if (contact.sliding == SlidingKind::finite) refuse(where, "sliding = \"finite\"");
  if (degree == 1 || contact.variant == CouplingKind::weighted) return;
  throw InputError(where + ": variant = \"" + word(contact.variant) +
                   "\", expected \"weighted\" with degree = 2: in space the integral of a quadratic vertex "
                   "function over a triangle is zero");
}

void requireKnown(const QuantityDescription& quantity) {
  using Kind = Quantity::Kind;
  const std::string where = quantity.where + ": quantity " + quantity.name;
  if (quantity.kind == Kind::meanPressure) refuse(where, "mean_pressure");
  if (quantity.kind == Kind::contactLength) refuse(where, "contact_length");
  if (quantity.kind == Kind::frictionWork) refuse(where, "friction_work");
}

}  // namespace

void requireOfDimension(const TableReader& table, const Keys& ofSpace, const Keys& ofPlane) {
  if (table.table().inSpace)
    table.rejectIfGiven(ofPlane, "none with dimension = 3");
  else
    table.rejectIfGiven(ofSpace, "it with dimension = 3 only");
}

void requireKnownInSpace(const TableReader& root, const SceneDescription& scene) {
  root.rejectIfGiven({"plane"}, "none with dimension = 3");
  root.rejectIfGiven({"tool"}, std::string("none") + inThePlane);
  if (const Node* accuracy = root.find("accuracy"))
    TableReader(*accuracy, "accuracy", "accuracy")
        .rejectIfGiven({"quantity", "bound"}, std::string("none") + inThePlane);
  const Node* solver = root.find("solver");
  if (solver != nullptr && scene.solver.method != Method::newton)
    refuse(solver->where, "solver: method = \"penalty-duality\"");
  for (const BodyDescription& body : scene.bodies) requireKnown(body);
  for (const ContactDescription& contact : scene.contacts) requireKnown(contact, scene.degree);
  for (const QuantityDescription& quantity : scene.quantities) requireKnown(quantity);
}

}  // namespace mortier
