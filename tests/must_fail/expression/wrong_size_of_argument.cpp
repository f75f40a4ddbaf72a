// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a matrix symbol is given a value of another size

#include <duet/expression/matrix.hpp>
#include <duet/expression/symbol.hpp>

int main() {
  using namespace duet::expression;
  constexpr matrix_symbol<"A", 2, 4> A;
  const Eigen::Matrix<double, 2, 4> A0 = Eigen::Matrix<double, 2, 4>::Ones();
  const Eigen::Matrix<double, 4, 2> B0 = A0.transpose();
#ifdef DUET_MUST_FAIL
  static_cast<void>(trace(A * transpose(A))(A = B0));
#else
  static_cast<void>(trace(A * transpose(A))(A = A0));
#endif
}
