// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a matrix in a formula has 1 to 6 rows and columns, known to the compiler

#include <duet/expression/matrix.hpp>
#include <duet/expression/symbol.hpp>

int main() {
  using namespace duet::expression;
  constexpr matrix_symbol<"A", 2, 4> A;
  const Eigen::Matrix<double, 4, 2> B0 = Eigen::Matrix<double, 4, 2>::Ones();
#ifdef DUET_MUST_FAIL
  static_cast<void>(A * Eigen::MatrixXd(B0));
#else
  static_cast<void>(A * B0);
#endif
}
