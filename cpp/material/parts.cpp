#include "material/parts.h"

#include <algorithm>
#include <limits>

#include "base/worst.h"
#include "material/back_stress.h"
#include "material/interior_path.h"

namespace mortier {
namespace {

/// The paths of all parts, each with its own points.
class PartsPath final : public InteriorPath {
 public:
  using Paths = std::vector<std::unique_ptr<InteriorPath>>;
  explicit PartsPath(Paths paths) : paths_(std::move(paths)) {}

  [[nodiscard]] double flowAtTwiceYield() const override {
    double largest = 0;
    for (const auto& path : paths_) largest = std::max(largest, path->flowAtTwiceYield());
    return largest;
  }
  void begin(double flow) override {
    for (const auto& path : paths_) path->begin(flow);
  }
  [[nodiscard]] double complementarity() const override {
    double sum = 0;
    for (const auto& path : paths_) sum += path->complementarity();
    return sum;
  }
  [[nodiscard]] int points() const override {
    int sum = 0;
    for (const auto& path : paths_) sum += path->points();
    return sum;
  }
  void linearise(const Matrix& strain, double target, bool correct, Linearisation& result) override {
    for (const auto& path : paths_) path->linearise(strain, target, correct, result);
  }
  double direct(const Matrix& strainChange) override {
    double largest = std::numeric_limits<double>::infinity();
    for (const auto& path : paths_) largest = std::min(largest, path->direct(strainChange));
    return largest;
  }
  void advance(double step, Matrix& stress) override {
    for (const auto& path : paths_) path->advance(step, stress);
  }

 private:
  Paths paths_;
};

class Parts final : public Material, public BackStress {
 public:
  Parts(std::vector<std::shared_ptr<const Material>> materials, std::vector<int> materialOf)
      : materials_(std::move(materials)), materialOf_(std::move(materialOf)) {
    for (const auto& material : materials_)
      if (const double scale = material->stressScale();
          scale > 0 && (stressScale_ == 0 || scale < stressScale_))
        stressScale_ = scale;
  }

  [[nodiscard]] std::vector<LawDescription> laws() const override {
    std::vector<LawDescription> laws;
    for (const auto& material : materials_)
      for (const LawDescription& law : material->laws()) laws.push_back(law);
    return laws;
  }
  [[nodiscard]] int components() const override { return materials_.front()->components(); }
  [[nodiscard]] int tensorComponents() const override { return materials_.front()->tensorComponents(); }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int point) const override {
    return at(point).outOfPlane(stress, point);
  }
  [[nodiscard]] bool symmetricTangent() const override { return all(&Material::symmetricTangent); }
  [[nodiscard]] bool linear() const override { return all(&Material::linear); }
  [[nodiscard]] bool needsTotalStrain() const override {
    return std::any_of(materials_.begin(), materials_.end(),
                       [](const auto& m) { return m->needsTotalStrain(); });
  }
  [[nodiscard]] double stressScale() const override { return stressScale_; }
  [[nodiscard]] double stiffness(double weight) const override {
    double largest = 0;
    for (const auto& material : materials_) largest = std::max(largest, material->stiffness(weight));
    return largest;
  }
  [[nodiscard]] bool flows(const Matrix& stress, int point, const Matrix* strain) const override {
    return at(point).flows(stress, point, strain);
  }
  [[nodiscard]] PointVector backStress(const Matrix& viscoplasticStrain, int point) const override {
    return backStressOf(at(point), viscoplasticStrain, point);
  }
  [[nodiscard]] bool usesReturnMapping() const override {
    return std::all_of(materials_.begin(), materials_.end(),
                       [](const auto& m) { return m->usesReturnMapping(); });
  }

  using Material::choosePenalty, Material::elasticStrain, Material::interiorPath, Material::viscoplasticRate;

  LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                      int end) const override {
    return reported(begin, end, [&](const Material& material, int first, int last) {
      return material.linearise(step, stress, result, first, last);
    });
  }
  LawReport regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty,
                       double relaxation, Linearisation& result, int begin, int end) const override {
    return reported(begin, end, [&](const Material& material, int first, int last) {
      return material.regularise(step, stress, penalty, relaxation, result, first, last);
    });
  }
  void choosePenalty(const Matrix& stress, Vector& penalty, int begin, int end) const override {
    forEachRun(begin, end, [&](const Material& material, int first, int last) {
      material.choosePenalty(stress, penalty, first, last);
    });
  }
  void viscoplasticRate(const MaterialState& state, Matrix& rate, int begin, int end) const override {
    forEachRun(begin, end, [&](const Material& material, int first, int last) {
      material.viscoplasticRate(state, rate, first, last);
    });
  }
  void elasticStrain(const Matrix& stress, Matrix& strain, int begin, int end) const override {
    forEachRun(begin, end, [&](const Material& material, int first, int last) {
      material.elasticStrain(stress, strain, first, last);
    });
  }
  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(const PathStart& start,
                                                           std::vector<int> points) const override {
    std::vector<std::vector<int>> own(materials_.size());
    for (const int point : points) own[materialOf_[point]].push_back(point);
    PartsPath::Paths paths;
    for (size_t k = 0; k < own.size(); ++k)
      paths.push_back(materials_[k]->interiorPath(start, std::move(own[k])));
    return std::make_unique<PartsPath>(std::move(paths));
  }

 private:
  [[nodiscard]] const Material& at(int point) const { return *materials_[materialOf_[point]]; }
  [[nodiscard]] bool all(bool (Material::*holds)() const) const {
    return std::all_of(materials_.begin(), materials_.end(), [&](const auto& m) { return ((*m).*holds)(); });
  }

  /// Calls visit(material, first, last) for neighbours of one material.
  template <class Visit>
  void forEachRun(int begin, int end, Visit visit) const {
    for (int first = begin; first < end;) {
      int last = first + 1;
      while (last < end && materialOf_[last] == materialOf_[first]) ++last;
      visit(at(first), first, last);
      first = last;
    }
  }

  /// What call(material, first, last) reports in all. Changes are scaled so that one yield stress of their
  /// material is one stressScale_; that must not depend on the range of points.
  template <class Call>
  [[nodiscard]] LawReport reported(int begin, int end, Call call) const {
    Worst worst;
    int elastic = 0;
    forEachRun(begin, end, [&](const Material& material, int first, int last) {
      const LawReport report = call(material, first, last);
      worst.add(report.change * (material.stressScale() > 0 ? stressScale_ / material.stressScale() : 1));
      elastic += report.elastic;
    });
    return {worst.value(), elastic};
  }

  std::vector<std::shared_ptr<const Material>> materials_;
  std::vector<int> materialOf_;
  double stressScale_ = 0;
};

}  // namespace

std::shared_ptr<const Material> materialOfParts(std::vector<std::shared_ptr<const Material>> materials,
                                                std::vector<int> materialOf) {
  return std::make_shared<Parts>(std::move(materials), std::move(materialOf));
}

}  // namespace mortier
