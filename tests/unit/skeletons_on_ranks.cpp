// Skeletons distributed by MUMPS, against the factor that every rank holds and against dense matrices. To be
// started by mpirun (mumps_test.py); every rank checks.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <random>
#include <typeinfo>
#include <vector>

#include "ranks/mpi_ranks.h"

namespace mortier {
namespace {

constexpr double rounding = 1e-12;  // of the largest value

/// A random matrix for every rank, over equations of its own; all ranks know those of all.
struct Random {
  std::vector<std::vector<int>> places;
  std::vector<Matrix> matrices;
  int size;
  bool symmetric;

  /// \param ranks  that have any
  Random(unsigned seed, int equations, bool isSymmetric, int ranks)
      : size(equations), symmetric(isSymmetric) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(-1, 1);
    for (int r = 0; r < Ranks::all().count(); ++r) {
      places.emplace_back();
      for (int i = 0; i < size && r < ranks; ++i)
        if (i % ranks == r || value(random) > 0.4) places.back().push_back(i);
      const auto n = static_cast<Eigen::Index>(places.back().size());
      Matrix B(n, n);
      for (double& entry : B.reshaped()) entry = value(random);
      matrices.emplace_back(B * B.transpose() / static_cast<double>(size) + Matrix::Identity(n, n));
      if (!symmetric) matrices.back() += 0.1 * B;
    }
  }

  [[nodiscard]] SkeletonShape shape(int kept) const {
    return {size, kept, symmetric, places[Ranks::all().rank()]};
  }
  [[nodiscard]] Matrix own() const {
    const Matrix& all = matrices[Ranks::all().rank()];
    return symmetric ? Matrix(all.triangularView<Eigen::Lower>()) : all;
  }
  [[nodiscard]] Matrix sum() const {
    Matrix K = Matrix::Zero(size, size);
    for (size_t r = 0; r < places.size(); ++r) K(places[r], places[r]) += matrices[r];
    return K;
  }
};

double difference(const Matrix& one, const Matrix& other) {
  EXPECT_EQ(one.rows(), other.rows());
  EXPECT_EQ(one.cols(), other.cols());
  return one.size() > 0 ? (one - other).cwiseAbs().maxCoeff() / other.cwiseAbs().maxCoeff() : 0;
}

/// Its Schur complement and solution, of loads that all ranks have a part of.
void expectSolves(Skeleton& skeleton, const Random& random, int kept, double within = rounding) {
  const Matrix K = random.sum();
  const int n = random.size - kept;
  const Eigen::PartialPivLU<Matrix> interior(K.topLeftCorner(n, n));
  const Matrix S = kept == 0
                       ? Matrix(0, 0)
                       : Matrix(K.bottomRightCorner(kept, kept) -
                                K.bottomLeftCorner(kept, n) * interior.solve(K.topRightCorner(n, kept)));
  EXPECT_LE(difference(skeleton.schurComplement(), S), within);
  for (int load = 1; load < 3; ++load) {
    const Vector whole = Vector::LinSpaced(random.size, -load, 3);
    Vector f =
        whole * (Ranks::all().rank() + 1.0) * 2 / (Ranks::all().count() * (Ranks::all().count() + 1.0));
    skeleton.condense(f);
    const Vector condensed = whole.tail(kept) - K.bottomLeftCorner(kept, n) * interior.solve(whole.head(n));
    EXPECT_LE(difference(f.tail(kept), condensed), within);
    Vector x(random.size);
    x.tail(kept) = Vector::LinSpaced(kept, 1, 2);
    x.head(n) = interior.solve(whole.head(n) - K.topRightCorner(n, kept) * x.tail(kept));
    f.tail(kept) = x.tail(kept);
    skeleton.expand(f);
    EXPECT_LE(difference(f, x), within);
  }
}

TEST(MumpsSkeleton, agreesWithTheFactorOnEveryRank) {
  Ranks& all = Ranks::all();
  for (const bool symmetric : {true, false})
    for (const int kept : {0, 40, 149}) {
      const int ranks = kept == 40 ? all.count() : std::max(1, all.count() - 1);
      const Random first(1, 150, symmetric, ranks);
      const auto skeleton = mumpsSkeleton(first.shape(kept), all);
      const auto replicated = replicatedSkeleton(first.shape(kept), multifrontalSolver, all);
      for (const unsigned seed : {1, 2}) {  // the pattern of the first one
        Random random = first;
        for (Matrix& each : random.matrices) each *= seed;
        ASSERT_TRUE(skeleton->factorise(random.own(), true, Threads::none()));
        ASSERT_TRUE(replicated->factorise(random.own(), true, Threads::none()));
        EXPECT_LE(difference(skeleton->schurComplement(), replicated->schurComplement()), rounding);
        expectSolves(*skeleton, random, kept);
        expectSolves(*replicated, random, kept);
      }
    }
}

TEST(MumpsSkeleton, givesTheSameAgain) {
  for (const bool symmetric : {true, false}) {
    const Random random(3, 600, symmetric, Ranks::all().count());
    const auto skeleton = mumpsSkeleton(random.shape(50), Ranks::all());
    ASSERT_TRUE(skeleton->factorise(random.own(), true, Threads::none()));
    const Matrix S = skeleton->takeSchurComplement();
    for (int again = 0; again < 5; ++again) {
      ASSERT_TRUE(skeleton->factorise(random.own(), true, Threads::none()));
      EXPECT_LE(difference(skeleton->schurComplement(), S), rounding);
    }
  }
}

// Pivots that are 0 where they stand, which the factor on every rank cannot exchange with others.
TEST(MumpsSkeleton, pivotsInTheWholeMatrix) {
  Random random(4, 200, false, 1);
  Matrix& K = random.matrices.front();
  K.diagonal().setZero();
  const auto skeleton = mumpsSkeleton(random.shape(20), Ranks::all());
  ASSERT_TRUE(skeleton->factorise(random.own(), true, Threads::none()));
  expectSolves(*skeleton, random, 20, 1e3 * rounding);  // its condition
}

// Equations of one rank alone that have no pivots before those of all are there: more space than foreseen.
TEST(MumpsSkeleton, makesRoomForDelayedPivots) {
  constexpr int alone = 150;
  const int count = Ranks::all().count();
  Random random(8, alone * count * 2 + 20, false, count);
  std::mt19937 numbers(9);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int r = 0; r < count; ++r) {
    std::vector<int>& places = random.places[r];
    places.clear();
    for (int i = 0; i < random.size; ++i)
      if (i / alone == r || i >= alone * count) places.push_back(i);
    random.matrices[r].resize(places.size(), places.size());
    for (double& entry : random.matrices[r].reshaped()) entry = value(numbers);
    random.matrices[r].topLeftCorner(alone, alone).setZero();
  }
  for (const int kept : {0, 20}) {
    const auto skeleton = mumpsSkeleton(random.shape(kept), Ranks::all());
    ASSERT_TRUE(skeleton->factorise(random.own(), true, Threads::none())) << kept;
    expectSolves(*skeleton, random, kept, 1e4 * rounding);  // its condition
  }
}

TEST(MumpsSkeleton, isSingularOnAllRanksWhereOneIs) {
  Ranks& all = Ranks::all();
  for (const bool symmetric : {true, false})
    for (const int kept : {0, 30}) {
      const Random sound(5, 120, symmetric, all.count());
      const auto skeleton = mumpsSkeleton(sound.shape(kept), all);
      const auto isRegular = [&](const Random& random, bool regular = true) {
        return skeleton->factorise(random.own(), regular, Threads::none());
      };
      Random empty = sound;  // an equation without entries
      for (size_t r = 0; r < empty.places.size(); ++r)
        for (size_t i = 0; i < empty.places[r].size(); ++i)
          if (empty.places[r][i] == 60) {
            empty.matrices[r].row(i).setZero();
            empty.matrices[r].col(i).setZero();
          }
      EXPECT_FALSE(isRegular(empty)) << symmetric << kept;
      Random negative = sound;
      for (Matrix& each : negative.matrices) each *= -1;
      EXPECT_EQ(isRegular(negative), !symmetric) << kept;
      EXPECT_FALSE(isRegular(sound, all.rank() + 1 < all.count()));
      Random unknown = sound;
      unknown.matrices.back()(1, 0) = std::numeric_limits<double>::quiet_NaN();
      EXPECT_FALSE(isRegular(unknown));
      ASSERT_TRUE(isRegular(sound));
      expectSolves(*skeleton, sound, kept);
    }
}

TEST(MumpsSkeleton, anEquationOfNoRankIsSingular) {
  for (const bool symmetric : {true, false}) {
    const Random random(6, 50, symmetric, Ranks::all().count());
    SkeletonShape shape = random.shape(10);
    ++shape.size;
    for (int& each : shape.places)
      if (each >= 20) ++each;
    EXPECT_FALSE(mumpsSkeleton(shape, Ranks::all())->factorise(random.own(), true, Threads::none()));
  }
}

// The way is that of startRanks().
TEST(MumpsSkeleton, isUsedWhereItIsWorthIt) {
  const Random random(7, 100, true, Ranks::all().count());
  const auto isDistributed = [&](int kept, int smallest) {
    const auto skeleton = newSkeleton(random.shape(kept), multifrontalSolver, Ranks::all(), smallest);
    EXPECT_TRUE(skeleton->factorise(random.own(), true, Threads::none()));
    expectSolves(*skeleton, random, kept);
    const auto* one = skeleton.get();
    const auto mumps = mumpsSkeleton(random.shape(1), Ranks::all());
    const auto* other = mumps.get();
    return typeid(*one) == typeid(*other);
  };
  EXPECT_TRUE(isDistributed(40, 60));
  EXPECT_FALSE(isDistributed(40, 61));
  EXPECT_FALSE(isDistributed(100, 0));
}

}  // namespace
}  // namespace mortier

int main(int argc, char** argv) {
  mortier::startRanks(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  const int code = RUN_ALL_TESTS();
  static_cast<void>(mortier::Ranks::all().end(code));
  mortier::Ranks::all().leave();
  return code;
}
