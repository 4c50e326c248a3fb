// A material in axes that are turned at every point: stresses and strains go into its axes, the answers back.
#include "base/error.h"
#include "material/anisotropy.h"
#include "material/interior_path.h"
#include "material/parts.h"

namespace mortier {
namespace {

class TurnedMaterial final : public Material, public Pointwise {
 public:
  TurnedMaterial(std::shared_ptr<const Material> inner, const std::vector<double>& angles)
      : inner_(std::move(inner)) {
    for (const double angle : angles)
      axes_.push_back({std::cos(2 * angle), std::sin(2 * angle), std::cos(angle), std::sin(angle)});
  }

  [[nodiscard]] std::vector<LawDescription> laws() const override { return inner_->laws(); }
  [[nodiscard]] int components() const override { return inner_->components(); }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int point) const override {
    Matrix own = stress;
    turn(own, point, into);
    return inner_->outOfPlane(own.col(0), 0);
  }
  [[nodiscard]] std::shared_ptr<const Material> restricted(const std::vector<int>& points) const override {
    auto own = std::make_shared<TurnedMaterial>(inner_, std::vector<double>());
    for (const int point : points) own->axes_.push_back(axes_[point]);
    return own;
  }
  [[nodiscard]] bool symmetricTangent() const override { return inner_->symmetricTangent(); }
  [[nodiscard]] bool linear() const override { return inner_->linear(); }
  [[nodiscard]] bool needsTotalStrain() const override { return inner_->needsTotalStrain(); }
  [[nodiscard]] double stressScale() const override { return inner_->stressScale(); }
  [[nodiscard]] double stiffness(double weight) const override { return inner_->stiffness(weight); }
  [[nodiscard]] bool flows(const Matrix& stress, int point, const Matrix* strain) const override {
    const bool known = strain != nullptr && needsTotalStrain();
    const Matrix own = known ? in(*strain, point, point + 1) : Matrix();
    return inner_->flows(in(stress, point, point + 1), 0, known ? &own : nullptr);
  }

  using Material::choosePenalty, Material::elasticStrain, Material::interiorPath, Material::viscoplasticRate;

  LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                      int end) const override {
    return answered(step, begin, end, result, [&](const MaterialStep& own, Linearisation& answer) {
      return inner_->linearise(own, in(stress, begin, end), answer, 0, end - begin);
    });
  }
  LawReport regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty,
                       double relaxation, Linearisation& result, int begin, int end) const override {
    return answered(step, begin, end, result, [&](const MaterialStep& own, Linearisation& answer) {
      return inner_->regularise(own, in(stress, begin, end), penalty.segment(begin, end - begin), relaxation,
                                answer, 0, end - begin);
    });
  }
  void choosePenalty(const Matrix& stress, Vector& penalty, int begin, int end) const override {
    Vector own(end - begin);
    inner_->choosePenalty(in(stress, begin, end), own, 0, end - begin);
    penalty.segment(begin, end - begin) = own;
  }
  void viscoplasticRate(const MaterialState& state, Matrix& rate, int begin, int end) const override {
    const Matrix stress = in(state.stress, begin, end);
    const Matrix strain = needsTotalStrain() ? in(*state.strain, begin, end) : Matrix();
    Matrix own(stress.rows(), stress.cols());
    inner_->viscoplasticRate({stress, &strain}, own, 0, end - begin);
    out(own, rate, begin);
  }
  void elasticStrain(const Matrix& stress, Matrix& strain, int begin, int end) const override {
    Matrix own(stress.rows(), end - begin);
    inner_->elasticStrain(in(stress, begin, end), own, 0, end - begin);
    out(own, strain, begin);
  }
  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(const PathStart& start,
                                                           std::vector<int> points) const override {
    return newtonPath(*this, start, std::move(points));
  }

 private:
  static constexpr double into = 1;
  static constexpr double back = -1;

  /// Turns q and r of all columns of a point, and in space the shears 13 and 23.
  void turn(Eigen::Ref<Matrix> columns, int point, double way) const {
    const auto& [c2, s2, c, s] = axes_[point];
    for (auto column : columns.colwise()) {
      const auto turnPair = [&](int k, double cosine, double sine) {
        const Point pair = column.segment<2>(k);
        column[k] = cosine * pair.x() + sine * pair.y();
        column[k + 1] = cosine * pair.y() - sine * pair.x();
      };
      turnPair(1, c2, way * s2);
      if (column.size() == 6) turnPair(3, c, way * s);
    }
  }
  [[nodiscard]] Matrix in(const Matrix& field, int begin, int end) const {
    Matrix own = field.middleCols(begin, end - begin);
    for (int i = begin; i < end; ++i) turn(own.col(i - begin), i, into);
    return own;
  }
  void out(Matrix& own, Matrix& field, int begin) const {
    for (Eigen::Index i = 0; i < own.cols(); ++i) turn(own.col(i), begin + static_cast<int>(i), back);
    field.middleCols(begin, own.cols()) = own;
  }

  template <class Ask>
  LawReport answered(const MaterialStep& step, int begin, int end, Linearisation& result, Ask ask) const {
    const Matrix stress0 = in(step.stress0, begin, end);
    const Matrix strain = in(step.strain, begin, end);
    const Matrix strain0 = needsTotalStrain() ? in(*step.strain0, begin, end) : Matrix();
    Linearisation answer = inner_->room(end - begin);
    const LawReport report =
        ask(MaterialStep{step.weight, stress0, strain, step.anticipate, &strain0}, answer);
    out(answer.predictor, result.predictor, begin);
    for (int i = begin; i < end; ++i) {
      Matrix D;
      if (stress0.rows() == 6)
        D = spaceModuliAt(answer.moduli, i - begin);
      else
        D = Eigen::Map<const Eigen::Matrix3d>(moduliAt(answer.moduli, i - begin).data());
      turn(D, i, back);
      D.transposeInPlace();
      turn(D, i, back);
      D.transposeInPlace();
      Eigen::Index next = 0;  // all of them, or the lower triangle
      for (Eigen::Index j = 0; j < D.cols(); ++j)
        for (Eigen::Index k = result.moduli.rows() < D.size() ? j : 0; k < D.rows(); ++k)
          result.moduli(next++, i) = D(k, j);
      // The row of s33, and the column of e33 where that is another.
      if (answer.beyond.size() == 0) continue;
      Matrix row = answer.beyond.col(i - begin).head<3>();
      turn(row, i, back);
      const bool both = result.beyond.rows() == 7;
      Matrix column = both && answer.beyond.rows() == 7 ? Matrix(answer.beyond.col(i - begin).tail<3>())
                                                        : Matrix(answer.beyond.col(i - begin).head<3>());
      turn(column, i, back);
      result.beyond.col(i).head<3>() = row;
      result.beyond(3, i) = answer.beyond(3, i - begin);
      if (both) result.beyond.col(i).tail<3>() = column;
    }
    return report;
  }

  std::shared_ptr<const Material> inner_;
  std::vector<std::array<double, 4>> axes_;  ///< cosine and sine of twice the angle, and of it
};

}  // namespace

std::shared_ptr<const Material> turnedMaterial(std::shared_ptr<const Material> inner,
                                               const std::vector<double>& angles) {
  return std::make_shared<TurnedMaterial>(std::move(inner), angles);
}

}  // namespace mortier
