// Eigen's factorisations of dense matrices, and the products that they rest on, compiled once
// (dense_templates.cpp): to a source that includes this header they cost nothing, to others 3 to 10 s each.
#pragma once

#include <Eigen/Dense>

namespace Eigen::internal {

template <int storage>
using MatrixReader = const_blas_data_mapper<double, Index, storage>;

}  // namespace Eigen::internal

#define MORTIER_DENSE_TEMPLATES(extern)                                                                      \
  extern template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>&                                            \
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&, int);    \
  extern template Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>&                                            \
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>::compute(const Eigen::EigenBase<Eigen::Matrix4d>&, int);    \
  extern template class Eigen::PartialPivLU<Eigen::MatrixXd>;                                                \
  extern template class Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>>;                                    \
  extern template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;                                         \
  extern template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::_solve_impl(const Eigen::VectorXd&,      \
                                                                                Eigen::VectorXd&) const;     \
  extern template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::_solve_impl(const Eigen::MatrixXd&,      \
                                                                                Eigen::MatrixXd&) const;     \
  extern template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;                             \
  extern template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::_solve_impl(                 \
      const Eigen::VectorXd&, Eigen::VectorXd&) const;                                                       \
  extern template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::_solve_impl(                 \
      const Eigen::MatrixXd&, Eigen::MatrixXd&) const;                                                       \
  extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;                                                   \
  namespace Eigen::internal {                                                                                \
  extern template struct general_matrix_vector_product<Index, double, MatrixReader<ColMajor>, ColMajor,      \
                                                       false, double, MatrixReader<ColMajor>, false>;        \
  extern template struct general_matrix_vector_product<Index, double, MatrixReader<ColMajor>, ColMajor,      \
                                                       false, double, MatrixReader<RowMajor>, false>;        \
  extern template struct general_matrix_vector_product<Index, double, MatrixReader<RowMajor>, RowMajor,      \
                                                       false, double, MatrixReader<ColMajor>, false>;        \
  extern template struct general_matrix_vector_product<Index, double, MatrixReader<RowMajor>, RowMajor,      \
                                                       false, double, MatrixReader<RowMajor>, false>;        \
  extern template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>,       \
                                     gebp_traits<double, double>::mr, gebp_traits<double, double>::nr>;      \
  extern template struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor,       \
                                                 ColMajor, 1>;                                               \
  extern template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, \
                                                 1>;                                                         \
  }

MORTIER_DENSE_TEMPLATES(extern)
