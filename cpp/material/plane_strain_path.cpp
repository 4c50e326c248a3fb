#include "material/plane_strain_path.h"

#include "material/deviator.h"
#include "material/perzyna_path.h"

namespace mortier {
namespace {

Split<double> splitAt(const Matrix& m, Eigen::Index i) {
  return split(std::array<double, 4>{m(0, i), m(1, i), m(2, i), m(3, i)});
}

Matrix deviators(const Matrix& m) {
  Matrix result(3, m.cols());
  for (Eigen::Index i = 0; i < m.cols(); ++i)
    result.col(i) = Eigen::Map<const Eigen::Vector3d>(splitAt(m, i).deviator.data());
  return result;
}

Vector pressures(const Matrix& m) {
  Vector result(m.cols());
  for (Eigen::Index i = 0; i < m.cols(); ++i) result[i] = splitAt(m, i).pressure;
  return result;
}

void join(const Matrix& deviator, const Vector& pressure, Matrix& result) {
  for (Eigen::Index i = 0; i < result.cols(); ++i) {
    const std::array<double, 4> s =
        joined(Split<double>{{deviator(0, i), deviator(1, i), deviator(2, i)}, pressure[i]});
    result.col(i) = Eigen::Map<const Eigen::Vector4d>(s.data());
  }
}

class PlaneStrainPath final : public InteriorPath {
 public:
  PlaneStrainPath(double shear, double bulk, double yieldStress, double theta, const Matrix& stress0)
      : bulk_(bulk), deviator0_(deviators(stress0)), pressure0_(pressures(stress0)) {
    const Eigen::Array3d round = Eigen::Array3d::Constant(1.5);
    path_ = perzynaPath({Eigen::Array3d::Constant(shear), round, round, yieldStress, theta}, deviator0_);
    law_.predictor.resize(3, stress0.cols());
    law_.moduli.resize(6, stress0.cols());
  }

  [[nodiscard]] double flowAtTwiceYield() const override { return path_->flowAtTwiceYield(); }
  void begin(double flow) override {
    path_->begin(flow);
    pressure_ = pressure0_;
  }
  [[nodiscard]] double complementarity() const override { return path_->complementarity(); }
  [[nodiscard]] int points() const override { return path_->points(); }

  void linearise(const Matrix& strain, double target, bool correct, Linearisation& result) override {
    path_->linearise(deviators(strain), target, correct, law_);
    predicted_ = pressure0_ + bulk_ * pressures(strain);
    join(law_.predictor, predicted_, result.predictor);
    for (int i = 0; i < static_cast<int>(strain.cols()); ++i) {
      const PlaneModuli<double> moduli = planeModuli(moduliAt(law_.moduli, i), bulk_);
      storeModuli(Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(moduli.plane.data())), result.moduli, i);
      result.beyond.col(i) = Eigen::Map<const Eigen::Vector4d>(moduli.beyond.data());
    }
  }

  double direct(const Matrix& strainChange) override {
    next_ = predicted_ + bulk_ * pressures(strainChange);
    return path_->direct(deviators(strainChange));
  }

  void advance(double step, Matrix& stress) override {
    Matrix deviator(3, stress.cols());
    path_->advance(step, deviator);
    pressure_ += step * (next_ - pressure_);
    join(deviator, pressure_, stress);
  }

 private:
  double bulk_;
  Matrix deviator0_;
  Vector pressure0_;
  std::unique_ptr<InteriorPath> path_;
  Linearisation law_;  ///< of the deviators, as last linearised
  Vector pressure_;    ///< of the iterate
  Vector predicted_;   ///< as last linearised
  Vector next_;        ///< at the end of the last direction
};

}  // namespace

std::unique_ptr<InteriorPath> planeStrainPath(double shear, double bulk, double yieldStress, double theta,
                                              const Matrix& stress0) {
  return std::make_unique<PlaneStrainPath>(shear, bulk, yieldStress, theta, stress0);
}

}  // namespace mortier
