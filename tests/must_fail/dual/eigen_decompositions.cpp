// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: Eigen's SelfAdjointEigenSolver loses derivatives over dual numbers: symmetric_eigen

#include <duet/derivative/svd.hpp>
#include <duet/derivative/symmetric_eigen.hpp>
#include <duet/dual/taylor.hpp>

using D = duet::dual<double>;
using series = duet::taylor<double, 3>;
template <class T>
using matrix = Eigen::Matrix<T, 3, 3>;

#ifdef DUET_MUST_FAIL
void decompose(const matrix<D>& a, const matrix<series>& b, const matrix<std::complex<D>>& c) {
  const Eigen::SelfAdjointEigenSolver<matrix<D>> d(a);               // mistake
  const Eigen::SelfAdjointEigenSolver<matrix<series>> e(b);          // mistake
  Eigen::SelfAdjointEigenSolver<matrix<D>> f;                        // mistake
  const Eigen::GeneralizedSelfAdjointEigenSolver<matrix<D>> g(a, a); // mistake
  const Eigen::EigenSolver<matrix<D>> h(a);                          // mistake
  const Eigen::ComplexEigenSolver<matrix<std::complex<D>>> i(c);     // mistake
  const Eigen::GeneralizedEigenSolver<matrix<D>> j(a, a);            // mistake
  const Eigen::RealSchur<matrix<D>> k(a);                            // mistake
  const Eigen::ComplexSchur<matrix<std::complex<D>>> l(c);           // mistake
  const Eigen::RealQZ<matrix<D>> m(a, a);                            // mistake
  const Eigen::HessenbergDecomposition<matrix<D>> n(a);              // mistake
  const Eigen::Tridiagonalization<matrix<D>> o(a);                   // mistake
  const Eigen::JacobiSVD<matrix<D>> p(a);                            // mistake
  const Eigen::BDCSVD<Eigen::Matrix<D, -1, -1>> q(a);                // mistake
}
#else
auto decompose(const matrix<D>& a) {
  const Eigen::SelfAdjointEigenSolver<matrix<double>> plain(matrix<double>::Identity());
  return duet::make_vector(duet::symmetric_eigen(a).values[0], duet::svd(a).values[0],
                           plain.eigenvalues()[0]);
}
#endif
