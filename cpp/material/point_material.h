// A material from the law of one point. A law is a small class with
//
//   static constexpr int components;              3, on p, q, r (stress.h), or 4, s33 beside them; and those
//                                                 that it remembers; or the 6 of space and those
//   static constexpr bool linear, needsTotalStrain;
//                                                 its moduli depend on nothing; G on the total strain
//   bool symmetric() const;                       whether its moduli are, whatever the stress
//   double stressScale() const;                   [Pa], 0 for none
//   double stiffness(double weight) const;        viscous over elastic compliance [-]
//   PointAnswer linearise(PointStep) const;       s + H^-1 r, H^-1 r and H^-1; r and H as in material.h
//   PointAnswer regularise(PointStep, Lanes penalty) const;     t - s and D
//   Lanes penalty(stress) const;
//   stress rate(stress, total strain) const;      G [1/s]
//   stress elasticStrain(stress) const;           E^-1 s [-]
//   mask or bool flows(stress) const;             of eight points or of one; or, where G depends on the total
//   bool flows(stress, total strain) const;       strain
//   double outOfPlane(Eigen::Vector3d) const;     where there are 4 components
//   ConeLaw cone(double weight) const;            where its interior path is known (interior_path.h)
//   static constexpr int remembered;              how many components, the last, are none of the tensor
//   bool usesReturnMapping() const;               as in material.h
//   stress backStress(viscoplastic strain) const; where it hardens kinematically
//
// E is any symmetric elliptic tensor and G any function: nothing else is assumed of them. Stresses and
// strains are arrays of components, each for eight points (base/lanes.h); this class runs the law over a
// body's points.
#pragma once

#include <utility>

#include "material/back_stress.h"
#include "material/interior_path.h"
#include "material/law_lanes.h"
#include "material/material.h"

namespace mortier {

/// What a law is asked at a point.
template <size_t n>
struct PointStep {
  std::array<Lanes, n> stress;   ///< the iterate s [Pa]
  std::array<Lanes, n> stress0;  ///< at the start of the step [Pa]
  std::array<Lanes, n> strain;   ///< increment of the total strain minus the scheme's shift [-]
  std::array<Lanes, n> total;    ///< strain eps at the end, where the law depends on it [-]
  double weight = 0;             ///< [s]
  bool anticipate = false;
};

template <size_t n>
struct PointAnswer {
  std::array<Lanes, n> predictor;   ///< next stress [Pa]
  std::array<Lanes, n> change;      ///< it minus s
  std::array<Lanes, n * n> moduli;  ///< column major [Pa]
  bool flows = false;               ///< whether the moduli of any lane may be other than those of elasticity
};

/// Keeps H^-1 of a batch, column major, as Linearisation has it.
template <size_t n>
void storeModuli(const Batch& batch, const std::array<Lanes, n * n>& H, Linearisation& result) {
  if constexpr (n >= 6) {
    std::array<Lanes, 36> all;
    std::array<Lanes, 21> lower;
    size_t next = 0;
    for (size_t j = 0; j < 6; ++j)
      for (size_t i = 0; i < 6; ++i) {
        all[6 * j + i] = H[n * j + i];
        if (i >= j) lower[next++] = H[n * j + i];
      }
    if constexpr (n == 7)
      batch.store(std::array<Lanes, 7>{H[6], H[13], H[20], H[27], H[34], H[41], H[48]}, result.beyond.data());
    if (result.moduli.rows() == 36) return batch.store(all, result.moduli.data());
    return batch.store(lower, result.moduli.data());
  }
  if (result.moduli.rows() == 6)
    batch.store(std::array<Lanes, 6>{H[0], H[1], H[2], H[n + 1], H[n + 2], H[2 * n + 2]},
                result.moduli.data());
  else
    batch.store(std::array<Lanes, 9>{H[0], H[1], H[2], H[n], H[n + 1], H[n + 2], H[2 * n], H[2 * n + 1],
                                     H[2 * n + 2]},
                result.moduli.data());
  if constexpr (n == 4) {
    if (result.beyond.rows() == 4)
      batch.store(std::array<Lanes, 4>{H[3], H[7], H[11], H[15]}, result.beyond.data());
    else
      batch.store(std::array<Lanes, 7>{H[3], H[7], H[11], H[15], H[12], H[13], H[14]}, result.beyond.data());
  }
  if constexpr (n == 5)
    batch.store(std::array<Lanes, 9>{H[3], H[8], H[13], H[18], H[4], H[9], H[14], H[24], H[19]},
                result.beyond.data());
}

template <class Law>
class PointMaterial final : public Material, public BackStress {
 public:
  PointMaterial(Law law, LawDescription description)
      : law_(std::move(law)), description_(std::move(description)) {}

  [[nodiscard]] std::vector<LawDescription> laws() const override { return {description_}; }
  [[nodiscard]] int components() const override { return n; }
  [[nodiscard]] int tensorComponents() const override { return static_cast<int>(n) - remembered; }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int /*point*/) const override {
    if constexpr (n - remembered == 4) return law_.outOfPlane(stress);
    return 0;
  }
  [[nodiscard]] bool symmetricTangent() const override { return law_.symmetric(); }
  [[nodiscard]] bool linear() const override { return Law::linear; }
  [[nodiscard]] bool needsTotalStrain() const override { return Law::needsTotalStrain; }
  [[nodiscard]] double stressScale() const override { return law_.stressScale(); }
  [[nodiscard]] double stiffness(double weight) const override { return law_.stiffness(weight); }
  [[nodiscard]] bool flows(const Matrix& stress, int point, const Matrix* strain) const override {
    const std::array<double, n> s = at(stress, point);
    if constexpr (requires { law_.flows(s, s); })
      return strain == nullptr || law_.flows(s, at(*strain, point));
    else
      return law_.flows(s);
  }
  [[nodiscard]] PointVector backStress(const Matrix& viscoplasticStrain, int point) const override {
    PointVector back = PointVector::Zero(n);
    if constexpr (requires(std::array<Lanes, n> strain) { law_.backStress(strain); }) {
      std::array<Lanes, n> strain;
      for (size_t k = 0; k < n; ++k) strain[k] = viscoplasticStrain(static_cast<Eigen::Index>(k), point);
      const std::array<Lanes, n> all = law_.backStress(strain);
      for (size_t k = 0; k < n; ++k) back[static_cast<Eigen::Index>(k)] = all[k][0];
    }
    return back;
  }
  [[nodiscard]] bool usesReturnMapping() const override {
    if constexpr (requires { law_.usesReturnMapping(); }) return law_.usesReturnMapping();
    return Law::linear;
  }

  using Material::choosePenalty, Material::elasticStrain, Material::interiorPath, Material::viscoplasticRate;

  [[gnu::flatten]] LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result,
                                       int begin, int end) const override {
    Largest change;
    bool flows = false;
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      const PointAnswer<n> answer = law_.linearise(pointStep(batch, step, stress));
      change.add(answer.change);
      flows = flows || answer.flows;
      batch.store(answer.predictor, result.predictor.data());
      storeModuli<n>(batch, answer.moduli, result);
    }
    return {change.value(), flows ? 0 : end - begin};
  }

  LawReport regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty,
                       double relaxation, Linearisation& result, int begin, int end) const override {
    Largest change;
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      PointStep<n> point = pointStep(batch, step, stress);
      const PointAnswer<n> answer = law_.regularise(point, batch.load<1>(penalty.data())[0]);
      change.add(answer.change);
      for (size_t k = 0; k < n; ++k) point.stress[k] += relaxation * answer.change[k];
      batch.store(point.stress, result.predictor.data());
      storeModuli<n>(batch, answer.moduli, result);
    }
    return {change.value(), Law::linear ? end - begin : 0};
  }

  void choosePenalty(const Matrix& stress, Vector& penalty, int begin, int end) const override {
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      batch.store(std::array<Lanes, 1>{law_.penalty(batch.load<n>(stress.data()))}, penalty.data());
    }
  }

  void viscoplasticRate(const MaterialState& state, Matrix& rate, int begin, int end) const override {
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      std::array<Lanes, n> total{};
      if constexpr (Law::needsTotalStrain) total = batch.load<n>(state.strain->data());
      batch.store(law_.rate(batch.load<n>(state.stress.data()), total), rate.data());
    }
  }

  void elasticStrain(const Matrix& stress, Matrix& strain, int begin, int end) const override {
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      batch.store(law_.elasticStrain(batch.load<n>(stress.data())), strain.data());
    }
  }

  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(const PathStart& start,
                                                           std::vector<int> points) const override {
    if constexpr (requires { law_.cone(0.0); })
      return conePath(law_.cone(start.weight), start.stress0, std::move(points));
    else
      return newtonPath(*this, start, std::move(points));
  }

 private:
  static constexpr size_t n = Law::components;
  static constexpr int remembered = [] {
    if constexpr (requires { Law::remembered; }) return Law::remembered;
    return 0;
  }();

  static std::array<double, n> at(const Matrix& field, int point) {
    std::array<double, n> s;
    for (size_t k = 0; k < n; ++k) s[k] = field(static_cast<Eigen::Index>(k), point);
    return s;
  }

  static PointStep<n> pointStep(const Batch& batch, const MaterialStep& step, const Matrix& stress) {
    PointStep<n> point;
    point.stress = batch.load<n>(stress.data());
    point.stress0 = batch.load<n>(step.stress0.data());
    point.strain = batch.load<n>(step.strain.data());
    if constexpr (Law::needsTotalStrain) {
      point.total = batch.load<n>(step.strain0->data());
      for (size_t k = 0; k < n; ++k) point.total[k] += point.strain[k];
    }
    point.weight = step.weight;
    point.anticipate = step.anticipate;
    return point;
  }

  Law law_;
  LawDescription description_;
};

/// \returns the material whose law is that of each point.
template <class Law>
std::shared_ptr<const Material> pointMaterial(Law law, LawDescription description) {
  return std::make_shared<PointMaterial<Law>>(std::move(law), std::move(description));
}

}  // namespace mortier
