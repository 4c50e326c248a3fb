// What a scene in space cannot have yet: refused by name before anything is solved.
#include "base/error.h"
#include "scene/readers.h"

namespace mortier {
namespace {

constexpr auto inThePlane = " with dimension = 3: known in the plane only";

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw InputError(where + ": " + what + ", expected none" + inThePlane);
}

void requireKnown(const BodyDescription& body, int degree) {
  if (body.volume == Volume::averaged && degree == 2)
    throw InputError(body.volumeWhere +
                     ", expected pointwise with degree = 2: quadratic tetrahedra do not lock");
}

void requireKnown(const ContactDescription& contact, int degree) {
  if (degree == 1 || contact.variant == CouplingKind::weighted) return;
  throw InputError(contact.where + ": contact: variant = \"" + word(contact.variant) +
                   "\", expected \"weighted\" with degree = 2: in space the integral of a quadratic vertex "
                   "function over a triangle is zero");
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
  if (const Node* accuracy = root.find("accuracy"))
    TableReader(*accuracy, "accuracy", "accuracy")
        .rejectIfGiven({"quantity", "bound"}, std::string("none") + inThePlane);
  const Node* solver = root.find("solver");
  if (solver != nullptr && scene.solver.method != Method::newton)
    refuse(solver->where, "solver: method = \"penalty-duality\"");
  if (solver != nullptr && scene.solver.listSolutions)
    TableReader(*solver, "solver", "solver")
        .reject("list_solutions", std::string("false") + inThePlane + ", of friction");
  for (const BodyDescription& body : scene.bodies) requireKnown(body, scene.degree);
  forEachPair(scene, [&](const ContactDescription& contact) { requireKnown(contact, scene.degree); });
}

}  // namespace mortier
