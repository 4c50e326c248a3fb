#include "solver/step_system.h"

#include <algorithm>
#include <cmath>

#include "base/digits.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/worst.h"
#include "solver/friction_sets.h"
#include "solver/model.h"
#include "solver/state.h"
#include "solver/uncarried_load.h"

namespace mortier {
namespace {

/// A tool has no nonmortar side.
bool mayExchangeSides(const Model& model) {
  return std::ranges::any_of(model.interfaces, [&](const ContactInterface& each) {
    return !model.bodies[each.pair().nonmortar.body].rigid() &&
           !model.bodies[each.pair().mortar.body].rigid();
  });
}

std::vector<int> numberRows(const Model& model) {
  std::vector<int> first{0};
  for (const ContactInterface& interface : model.interfaces) first.push_back(first.back() + interface.rows());
  return first;
}

}  // namespace

FrictionSets joinedSets(const Iterate& iterate) {
  FrictionSets sets;
  for (const std::vector<char>& part : iterate.active)
    sets.closed.insert(sets.closed.end(), part.begin(), part.end());
  for (const std::vector<signed char>& part : iterate.slipping)
    sets.slip.insert(sets.slip.end(), part.begin(), part.end());
  for (const std::vector<SlipDirection>& part : iterate.slipDirections)
    sets.directions.insert(sets.directions.end(), part.begin(), part.end());
  return sets;
}

StepSystem::StepSystem(const Model& model, const SolverOptions& options)
    : model_(model),
      options_(options),
      threads_(threadsFor(model, options.threads)),
      firstRow_(numberRows(model)) {
  const bool sparse = solvesSparse(model, options);
  std::vector<std::optional<CondensedBody>> bodies(model.bodies.size());
  const auto make = [&](int b) { bodies[b].emplace(model, b, firstRow_, options, threads_, sparse); };
  threads_.forEach(static_cast<int>(bodies.size()), make);
  bodies_.reserve(bodies.size());
  for (size_t b = 0; b < bodies.size(); ++b) {
    bodies_.push_back(std::move(*bodies[b]));
    firstMotion_.push_back(firstMotion_.back() + static_cast<int>(bodies_[b].contact().R.cols()));
    uniqueSolutions_ = uniqueSolutions_ && model.bodies[b].material().symmetricTangent();
  }
  findFriction();
  requireHeld();
  if (!sparse) return;
  sparse_ = std::make_unique<SparseContact>(model, bodies_, firstRow_, options.linear, threads_);
}

void StepSystem::updateConstraints() {
  forEachBody([&](int b) { bodies_[b].contact().updateConstraints(model_, b, firstRow_); });
  joinMotions();
  contact_.along = {};
  findFriction();
}

Step StepSystem::step(const State& state0, const StepData& data) {
  Step step{state0, data, loadsAt(data.time), std::vector<Matrix>(model_.bodies.size())};
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    if (!body.material().needsTotalStrain()) continue;
    Matrix& strain = step.strains0[b];
    strain = totalStrain(body.material(), state0.bodies[b]);
    if (const Matrix* explicitStrain = step.explicitStrain(b)) strain += *explicitStrain;
    if (!data.thermal.empty()) strain -= data.thermal[b];
  }
  return step;
}

const std::vector<Vector>& StepSystem::loadsAt(double time) {
  for (size_t i = 0; i < loads_.size(); ++i)
    if (loads_[i].time == time) {
      latestLoads_ = i;
      return loads_[i].forces;
    }
  latestLoads_ = 1 - latestLoads_;
  Loads& loads = loads_[latestLoads_];
  loads = {time, {}};
  for (const Body& body : model_.bodies) loads.forces.push_back(body.load(time));
  return loads.forces;
}

Vector StepSystem::joined(const std::vector<Vector>& across, const std::vector<Vector>& along) {
  std::vector<double> all;
  for (const std::vector<Vector>* parts : {&across, &along})
    for (const Vector& part : *parts) all.insert(all.end(), part.begin(), part.end());
  return Eigen::Map<const Vector>(all.data(), static_cast<Eigen::Index>(all.size()));
}

std::vector<Vector> StepSystem::parted(const Vector& all) const {
  std::vector<Vector> parts;
  for (size_t k = 0; k + 1 < firstRow_.size(); ++k)
    parts.emplace_back(all.segment(firstRow_[k], firstRow_[k + 1] - firstRow_[k]));
  return parts;
}

void StepSystem::subtractContact(const std::vector<Vector>& p, const std::vector<Vector>& t,
                                 std::vector<Vector>& force) const {
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    Vector& nonmortar = force[interface.pair().nonmortar.body];
    Vector& mortar = force[interface.pair().mortar.body];
    interface.subtractForces(p[k], nonmortar, mortar);
    if (interface.hasFriction()) interface.subtractFriction(t[k], nonmortar, mortar);
  }
}

void StepSystem::subtractTies(const std::vector<Vector>& l, std::vector<Vector>& force) const {
  for (size_t k = 0; k < model_.ties.size(); ++k) model_.ties[k].subtractForces(l[k], force);
}

std::vector<Vector> StepSystem::tiesOf(const Vector& all) const {
  std::vector<Vector> parts;
  Eigen::Index first = conditions();
  for (const Tie& tie : model_.ties) {
    parts.emplace_back(all.segment(first, tie.rows()));
    first += tie.rows();
  }
  return parts;
}

StepSystem::Linearised StepSystem::linearise(const Step& step, Iterate& iterate, const LawOf& lawOf) {
  std::vector<double> residual(bodies_.size());
  forEachBody([&](int b) { bodies_[b].linearise(step.explicitStrain(b), iterate.bodies[b], lawOf(b)); });
  const double motion = largestMotion(iterate);
  forEachBody([&](int b) {
    residual[b] = bodies_[b].residual(step.state0.bodies[b].stress, iterate.bodies[b], motion);
  });
  Worst worst;
  for (const double value : residual) worst.add(value);
  return {*this, worst.value(), Key{}};
}

BodyLaw StepSystem::law(const Step& step, int body, double weight, bool anticipate) const {
  const Material& material = model_.bodies[body].material();
  const Matrix& stress0 = step.state0.bodies[body].stress;
  const Matrix* strain0 = step.strain0(body);
  return {[=, &material, &stress0](const BodyIterate& iterate, Linearisation& result, int begin, int end) {
    return material.linearise({weight, stress0, iterate.strain, anticipate, strain0}, iterate.stress, result,
                              begin, end);
  }};
}

StepSystem::Linearised StepSystem::linearise(const Step& step, Iterate& iterate, double weight,
                                             bool anticipate) {
  return linearise(step, iterate, [&](int b) { return law(step, b, weight, anticipate); });
}

std::optional<StuckPlace> StepSystem::worstPoint(const Step& step, Iterate& iterate, double weight) {
  linearise(step, iterate, weight, false);
  std::optional<StuckPlace> place;
  const double motion = largestMotion(iterate);
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const auto [point, residual] =
        bodies_[b].worstPoint(step.state0.bodies[b].stress, iterate.bodies[b], motion);
    if (point < 0 || residual <= (place ? place->residual : options_.tolerance)) continue;
    const Body& body = model_.bodies[b];
    place = {static_cast<int>(b), point / body.pointsOfTriangle(), body.placeOfPoint(point), residual,
             step.data.time};
  }
  return place;
}

std::optional<StepSystem::Factorised> StepSystem::Linearised::factorise(StepOutcome& outcome) const {
  std::vector<CondensedBody>& bodies = system_->bodies_;
  ContactProblem& contact = system_->contact_;
  std::vector<CondensedBody::Factors> factors(bodies.size());
  system_->olderFactors_ = false;
  system_->forEachBody([&](int b) { factors[b] = bodies[b].factorise(); });
  // After a restart there is neither yet, though factors were counted before it.
  bool changed = system_->sparse() ? !system_->sparse_->taken() : !system_->ties_.taken();
  bool regular = true;
  for (const CondensedBody::Factors& body : factors) {
    if (!body.failure.empty()) regular = outcome.fail(Reason::singular, body.failure);
    changed = changed || body.changed;
    outcome.factorisations += body.changed ? 1 : 0;
  }
  if (!regular) return std::nullopt;
  if (changed && system_->sparse()) {
    contact.symmetric = system_->uniqueSolutions();
    system_->sparse_->take(bodies);
  } else if (changed) {
    Matrix W = std::move(contact.W);
    W.setZero(system_->constraints(), system_->constraints());
    contact.symmetric = true;
    for (size_t b = 0; b < bodies.size(); ++b) {
      if (bodies[b].contact().none()) continue;
      contact.symmetric = contact.symmetric && system_->model_.bodies[b].material().symmetricTangent();
      bodies[b].addCompliance(W);
    }
    const auto addYielding = [&](int first, const Eigen::SparseMatrix<double>& S) {
      forEachEntry(S, [&](int row, int column, double value) { W(first + row, first + column) += value; });
    };
    for (size_t k = 0; k < system_->model_.interfaces.size(); ++k)
      addYielding(system_->firstRow_[k], system_->model_.interfaces[k].compliance());
    int first = system_->conditions();
    for (const Tie& tie : system_->model_.ties) {
      if (tie.elastic()) addYielding(first, tie.compliance());
      first += tie.rows();
    }
    contact.W = system_->ties_.take(std::move(W), contact.symmetric);
  }
  return keepFactors();
}

StepSystem::Factorised StepSystem::Linearised::keepFactors(bool older) const {
  system_->olderFactors_ = system_->olderFactors_ || older;
  return {*system_, Key{}};
}

StepSystem::Condensed StepSystem::Factorised::condense(const Step& step, const Iterate& iterate) const {
  const Model& model = system_->model_;
  std::vector<CondensedBody>& bodies = system_->bodies_;
  std::vector<Vector> force(bodies.size());
  system_->forEachBody(
      [&](int b) { force[b] = step.loads[b] - model.bodies[b].internalForce(bodies[b].law().predictor); });
  double& forceScale = system_->contact_.forceScale;
  forceScale = 0;
  for (const Vector& before : step.state0.contactForce)
    if (before.size() > 0) forceScale = std::max(forceScale, before.maxCoeff());
  system_->subtractContact(iterate.contactForce, iterate.frictionForce, force);
  system_->subtractTies(iterate.tieForce, force);
  Condensed result(*system_, Key{});
  auto& [slack, balance] = result.whole;
  slack = joined({-joined(gaps(model, step.gap0(), iterate), slips(model, iterate)),
                  -joined(jumps(model, step.state0, iterate))});
  result.p0 = joined(iterate.contactForce, iterate.frictionForce);
  result.sets = joinedSets(iterate);
  std::vector<Vector> motion;
  if (!system_->sparse())
    motion = system_->condenseBodies(force);
  else
    result.force = std::move(force);
  balance.resize(system_->firstMotion_.back());
  for (size_t b = 0; b < bodies.size(); ++b) {
    const ContactDofs& dofs = bodies[b].contact();
    if (dofs.none()) continue;
    if (!system_->sparse()) slack -= dofs.C * motion[b];
    balance.segment(system_->firstMotion_[b], dofs.R.cols()) = dofs.rigidForce(step.loads[b]);
  }
  balance -= system_->ties_.G().transpose() * joined({result.p0, joined(iterate.tieForce)});
  TieElimination::Whole ofContact = system_->ties_.reduced(result.whole);
  result.slack = std::move(ofContact.slack);
  result.balance = std::move(ofContact.balance);
  return result;
}

bool StepSystem::Condensed::expand(const ContactSolution& contact, Iterate& iterate,
                                   StepOutcome& outcome) && {
  const auto fallsBy = [&](const Vector& motion) {
    return outcome.fail(Reason::unheld, (system_->hasFriction() ? "contact and its friction cannot hold "
                                                                : "contact cannot hold ") +
                                            system_->describeRigid(system_->ties_.wholeMotion(motion)));
  };
  if (contact.outcome == ContactSolution::Outcome::unbalanced) return fallsBy(contact.rigid);
  if (contact.outcome != ContactSolution::Outcome::solved)
    if (const auto motion = uncarriedLoad(system_->contact_, balance + system_->contact_.G.transpose() * p0))
      return fallsBy(*motion);
  if (contact.outcome == ContactSolution::Outcome::cycled)
    return outcome.fail(Reason::contact,
                        "no solution of the contact problem of the linearised step was found; other factors "
                        "(solver.linear)" +
                            std::string(mayExchangeSides(system_->model_)
                                            ? " or another side as nonmortar (swap) may lead to one"
                                            : " may lead to one"));
  if (contact.outcome == ContactSolution::Outcome::dependent)
    return outcome.fail(Reason::contact, "with friction, contact conditions that depend on each other");
  if (contact.outcome == ContactSolution::Outcome::capped)
    return outcome.fail(Reason::contact, "the contact problem of the linearised step was given up after " +
                                             counted(contact.pivots, "active set") + ", the work of " +
                                             counted(std::lround(contact.work), "dense factorisation"));
  const ContactSolution all = system_->ties_.completed(contact, whole);
  std::vector<Vector> tieChange = system_->tiesOf(all.change);
  for (size_t k = 0; k < tieChange.size(); ++k) iterate.tieForce[k] += tieChange[k];
  system_->expandBodies(all, [&](int b, const Vector& d) {
    const Body& body = system_->model_.bodies[b];
    const Linearisation& law = system_->bodies_[b].law();
    Matrix& stress = iterate.bodies[b].stress;
    iterate.bodies[b].increment += d;
    stress.resizeLike(law.predictor);
    forEachBlock(body.points(), system_->threads_, [&](int begin, int end) {
      stress.middleCols(begin, end - begin) = law.predictor.middleCols(begin, end - begin);
      body.addStressOf(d, law, stress, begin, end);
    });
  });
  iterate.contactForce = system_->parted(p0 + contact.change);
  iterate.largestTension = 0;
  for (size_t k = 0; k < iterate.contactForce.size(); ++k) {
    Vector& p = iterate.contactForce[k];
    const auto first = contact.active.begin() + system_->firstRow_[k];
    iterate.active[k].assign(first, first + p.size());
    if (p.size() > 0) iterate.largestTension = std::max(iterate.largestTension, -p.minCoeff());
    p = p.cwiseMax(0);
  }
  Eigen::Index node = 0;
  for (size_t k = 0; k < iterate.contactForce.size(); ++k) {
    const ContactInterface& interface = system_->model_.interfaces[k];
    if (!interface.hasFriction()) continue;
    const int components = interface.slipComponents();
    Vector& t = iterate.frictionForce[k];
    t = (p0 + contact.change).segment(system_->rows() + components * node, interface.slipRows());
    const auto first = contact.slipping.begin() + node;
    iterate.slipping[k].assign(first, first + interface.rows());
    if (components > 1) {
      const auto directions = contact.directions.begin() + node;
      iterate.slipDirections[k].assign(directions, directions + interface.rows());
    }
    const Vector bound = interface.frictionBound(iterate.contactForce[k]);  // sums have left it by rounding
    for (Eigen::Index i = 0; i < bound.size(); ++i) {
      signed char& slips = iterate.slipping[k][i];
      if (bound[i] == 0) slips = 0;
      if (components > 1) {
        const Point along = iterate.slipDirections[k][i].along;
        t.segment<2>(2 * i) =
            slips == 0 ? withinBall(t.segment<2>(2 * i), bound[i]) : Point(bound[i] * along);
      } else {
        t[i] = bound[i] == 0 ? 0 : slips == 0 ? std::clamp(t[i], -bound[i], bound[i]) : slips * bound[i];
      }
    }
    node += interface.rows();
  }
  return true;
}

bool StepSystem::completes() const {
  const bool inSpace =
      std::ranges::any_of(model_.bodies, [](const Body& body) { return body.dimension() == 3; });
  return inSpace && uniqueSolutions_ && !sparse() && !hasFriction();
}

bool StepSystem::inSinglePrecision() const {
  return std::ranges::any_of(bodies_, &CondensedBody::inSinglePrecision);
}

void StepSystem::useNextEngine() {
  for (CondensedBody& body : bodies_) body.useNextEngine();
  if (sparse()) sparse_->useSuiteSparse();
}

SolverMemory StepSystem::memory() const {
  SolverMemory memory;
  for (const CondensedBody& body : bodies_) {
    memory.enginesGivenUp.push_back(static_cast<char>(body.enginesGivenUp()));
    memory.elasticFactors.push_back(body.elasticFactors() ? 1 : 0);
  }
  return memory;
}

void StepSystem::resume(const SolverMemory& memory) {
  for (size_t b = 0; b < memory.enginesGivenUp.size(); ++b) {
    for (int i = 0; i < memory.enginesGivenUp[b]; ++i) {
      bodies_[b].useNextEngine();
      if (sparse()) sparse_->useSuiteSparse();
    }
    // Without reductions factors are made and counted in every solve.
    if (memory.elasticFactors[b] != 0 && options_.reduce) bodies_[b].restoreCount();
  }
}

}  // namespace mortier
