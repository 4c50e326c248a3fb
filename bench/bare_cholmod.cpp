#include "bare_cholmod.h"

#include <cblas.h>
#include <cholmod.h>
#include <omp.h>

#include <algorithm>
#include <stdexcept>

namespace mortier::bench {

struct BareCholmod::Matrix {
  Matrix() { cholmod_start(&common); }
  Matrix(const Matrix&) = delete;
  Matrix& operator=(const Matrix&) = delete;
  ~Matrix() {
    cholmod_free_sparse(&K, &common);
    cholmod_free_dense(&right, &common);
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
  }

  cholmod_common common{};
  cholmod_sparse* K = nullptr;
  cholmod_dense* right = nullptr;
  cholmod_factor* L = nullptr;
};

BareCholmod::BareCholmod() = default;
BareCholmod::BareCholmod(BareCholmod&&) noexcept = default;
BareCholmod::~BareCholmod() = default;

void BareCholmod::add(const Body& body) {
  Linearisation law;
  law.predictor.resize(3, body.points());
  law.moduli.resize(9, body.points());
  const mortier::Matrix zero = mortier::Matrix::Zero(3, body.points());
  body.material().linearise({0, zero, zero}, zero, law, 0, body.points());
  std::vector<double> values;
  body.tangent(law.moduli, values);

  const SparsePattern& pattern = body.pattern();
  auto matrix = std::make_unique<Matrix>();
  matrix->K = cholmod_allocate_sparse(pattern.size, pattern.size, pattern.entries(), 1, 1, -1, CHOLMOD_REAL,
                                      &matrix->common);
  matrix->right = cholmod_ones(pattern.size, 1, CHOLMOD_REAL, &matrix->common);
  std::copy(pattern.columnStart.begin(), pattern.columnStart.end(), static_cast<int*>(matrix->K->p));
  std::copy(pattern.rows.begin(), pattern.rows.end(), static_cast<int*>(matrix->K->i));
  std::copy(values.begin(), values.end(), static_cast<double*>(matrix->K->x));
  matrices_.push_back(std::move(matrix));
}

void BareCholmod::analyse() {
  for (auto& matrix : matrices_) {
    cholmod_free_factor(&matrix->L, &matrix->common);
    matrix->common.supernodal = CHOLMOD_SUPERNODAL;
    matrix->common.nmethods = 1;
    matrix->common.method[0].ordering = CHOLMOD_METIS;
    matrix->L = cholmod_analyze(matrix->K, &matrix->common);
    if (matrix->L == nullptr) throw std::runtime_error("CHOLMOD: the analysis failed");
  }
}

void BareCholmod::factoriseAndSolve(int blasThreads) {
  omp_set_num_threads(1);
  openblas_set_num_threads(blasThreads);
  for (auto& matrix : matrices_) {
    cholmod_factorize(matrix->K, matrix->L, &matrix->common);
    if (matrix->common.status != CHOLMOD_OK) throw std::runtime_error("CHOLMOD: the stiffness is singular");
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, matrix->L, matrix->right, &matrix->common);
    if (solution == nullptr) throw std::runtime_error("CHOLMOD: the solve failed");
    cholmod_free_dense(&solution, &matrix->common);
  }
  openblas_set_num_threads(1);
}

}  // namespace mortier::bench
