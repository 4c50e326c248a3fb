#include "material/parts.h"

#include <algorithm>
#include <limits>

#include "base/worst.h"
#include "material/interior_path.h"

namespace mortier {
namespace {

/// The paths of all parts, each with its own points; linear parts have none and follow the strain.
class PartsPath final : public InteriorPath {
 public:
  struct Part {
    const Material* material = nullptr;
    std::vector<int> points;
    Matrix stress0;
    std::unique_ptr<InteriorPath> path;
    Linearisation law;  ///< of the last linearise()
    Matrix next;        ///< stress at the end of the last direction, of a linear part
  };

  PartsPath(double weight, std::vector<Part> parts) : weight_(weight), parts_(std::move(parts)) {
    for (Part& part : parts_) part.path = part.material->interiorPath(weight, part.stress0);
  }

  [[nodiscard]] double flowAtTwiceYield() const override {
    double largest = 0;
    for (const Part& part : parts_)
      if (part.path) largest = std::max(largest, part.path->flowAtTwiceYield());
    return largest;
  }
  void begin(double flow) override {
    for (Part& part : parts_)
      if (part.path) part.path->begin(flow);
  }
  [[nodiscard]] double complementarity() const override {
    double sum = 0;
    for (const Part& part : parts_) sum += part.path ? part.path->complementarity() : 0;
    return sum;
  }
  [[nodiscard]] int points() const override {
    int sum = 0;
    for (const Part& part : parts_) sum += part.path ? part.path->points() : 0;
    return sum;
  }

  void linearise(const Matrix& strain, double target, bool correct, Linearisation& result) override {
    for (Part& part : parts_) {
      const auto count = static_cast<int>(part.points.size());
      part.law.predictor.resize(result.predictor.rows(), count);
      part.law.moduli.resize(result.moduli.rows(), count);
      part.law.beyond.resize(result.beyond.rows(), count);
      const Matrix own = strain(Eigen::all, part.points);
      if (part.path)
        part.path->linearise(own, target, correct, part.law);
      else
        part.material->linearise({weight_, part.stress0, own}, part.stress0, part.law, 0, count);
      result.predictor(Eigen::all, part.points) = part.law.predictor;
      result.moduli(Eigen::all, part.points) = part.law.moduli;
      if (result.beyond.rows() > 0) result.beyond(Eigen::all, part.points) = part.law.beyond;
    }
  }

  double direct(const Matrix& strainChange) override {
    double largest = std::numeric_limits<double>::infinity();
    for (Part& part : parts_) {
      const Matrix own = strainChange(Eigen::all, part.points);
      if (part.path) {
        largest = std::min(largest, part.path->direct(own));
        continue;
      }
      part.next = part.law.predictor;
      for (int i = 0; i < static_cast<int>(part.points.size()); ++i) {
        part.next.col(i) += stressOf(part.law, own.col(i), i);
      }
    }
    return largest;
  }

  void advance(double step, Matrix& stress) override {
    for (Part& part : parts_) {
      Matrix own = stress(Eigen::all, part.points);
      if (part.path)
        part.path->advance(step, own);
      else
        own += step * (part.next - own);
      stress(Eigen::all, part.points) = own;
    }
  }

 private:
  double weight_;
  std::vector<Part> parts_;
};

class Parts final : public Material {
 public:
  Parts(std::vector<std::shared_ptr<const Material>> materials, std::vector<int> materialOf)
      : materials_(std::move(materials)), materialOf_(std::move(materialOf)), points_(materials_.size()) {
    for (size_t i = 0; i < materialOf_.size(); ++i) points_[materialOf_[i]].push_back(static_cast<int>(i));
    for (const auto& material : materials_)
      if (const double scale = material->stressScale();
          scale > 0 && (stressScale_ == 0 || scale < stressScale_))
        stressScale_ = scale;
  }

  [[nodiscard]] int components() const override { return materials_.front()->components(); }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int point) const override {
    return materials_[materialOf_[point]]->outOfPlane(stress, point);
  }
  [[nodiscard]] bool symmetricTangent() const override {
    return std::all_of(materials_.begin(), materials_.end(),
                       [](const auto& m) { return m->symmetricTangent(); });
  }
  [[nodiscard]] bool linear() const override {
    return std::all_of(materials_.begin(), materials_.end(), [](const auto& m) { return m->linear(); });
  }
  [[nodiscard]] double stressScale() const override { return stressScale_; }
  [[nodiscard]] double stiffness(double weight) const override {
    double largest = 0;
    for (const auto& material : materials_) largest = std::max(largest, material->stiffness(weight));
    return largest;
  }

  double linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                   int end) const override {
    return worstOf(begin, end, [&](const Material& material, int first, int last) {
      return material.linearise(step, stress, result, first, last);
    });
  }

  double regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty, double relaxation,
                    Linearisation& result, int begin, int end) const override {
    return worstOf(begin, end, [&](const Material& material, int first, int last) {
      return material.regularise(step, stress, penalty, relaxation, result, first, last);
    });
  }

  void choosePenalty(const Matrix& stress, Vector& penalty) const override {
    penalty.resize(stress.cols());
    forEachPart([&](const Material& material, const std::vector<int>& points) {
      Vector part;
      material.choosePenalty(stress(Eigen::all, points), part);
      penalty(points) = part;
    });
  }

  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(double weight,
                                                           const Matrix& stress0) const override {
    if (linear()) return nullptr;
    std::vector<PartsPath::Part> parts(materials_.size());
    for (size_t k = 0; k < parts.size(); ++k) {
      parts[k].material = materials_[k].get();
      parts[k].points = points_[k];
      parts[k].stress0 = stress0(Eigen::all, points_[k]);
    }
    return std::make_unique<PartsPath>(weight, std::move(parts));
  }

  void viscoplasticRate(const Matrix& stress, Matrix& rate) const override {
    rate.resize(stress.rows(), stress.cols());
    forEachPart([&](const Material& material, const std::vector<int>& points) {
      Matrix part;
      material.viscoplasticRate(stress(Eigen::all, points), part);
      rate(Eigen::all, points) = part;
    });
  }

  void elasticStrain(const Matrix& stress, Matrix& strain) const override {
    strain.resize(stress.rows(), stress.cols());
    forEachPart([&](const Material& material, const std::vector<int>& points) {
      Matrix part;
      material.elasticStrain(stress(Eigen::all, points), part);
      strain(Eigen::all, points) = part;
    });
  }

  [[nodiscard]] bool flows(const Matrix& stress, int point) const override {
    return materials_[materialOf_[point]]->flows(stress, point);
  }

 private:
  /// Calls residual(material, first, last) for neighbours of one material; \returns the largest, scaled.
  template <class Residual>
  [[nodiscard]] double worstOf(int begin, int end, Residual residual) const {
    Worst worst;
    for (int first = begin; first < end;) {
      int last = first + 1;
      while (last < end && materialOf_[last] == materialOf_[first]) ++last;
      const Material& material = *materials_[materialOf_[first]];
      worst.add(residual(material, first, last) * weightOf(material));
      first = last;
    }
    return worst.value();
  }

  /// What makes a residual of this material one over stressScale_. It must not depend on the range of points.
  [[nodiscard]] double weightOf(const Material& material) const {
    return material.stressScale() > 0 ? stressScale_ / material.stressScale() : 1;
  }

  template <class Visit>
  void forEachPart(Visit visit) const {
    for (size_t k = 0; k < materials_.size(); ++k) visit(*materials_[k], points_[k]);
  }

  std::vector<std::shared_ptr<const Material>> materials_;
  std::vector<int> materialOf_;
  std::vector<std::vector<int>> points_;
  double stressScale_ = 0;
};

}  // namespace

std::shared_ptr<const Material> materialOfParts(std::vector<std::shared_ptr<const Material>> materials,
                                                std::vector<int> materialOf) {
  return std::make_shared<Parts>(std::move(materials), std::move(materialOf));
}

}  // namespace mortier
