// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: Eigen's (exp|sqrt|log|pow|sin, cos, sinh or cosh) of a matrix loses
// forms: 5

#include <duet/derivative/matrix_exponential.hpp>

#include <unsupported/Eigen/MatrixFunctions>

using matrix = Eigen::Matrix<duet::dual<double>, 3, 3>;

#if DUET_MUST_FAIL == 1
matrix f(const matrix& a) { return a.exp(); }
#elif DUET_MUST_FAIL == 2
matrix f(const matrix& a) { return a.sqrt(); }
#elif DUET_MUST_FAIL == 3
matrix f(const matrix& a) { return a.log(); }
#elif DUET_MUST_FAIL == 4
matrix f(const matrix& a) { return a.pow(duet::dual<double>(0.5)); }
#elif DUET_MUST_FAIL == 5
matrix f(const matrix& a) { return a.cos(); }
#else
matrix f(const matrix& a) { return duet::matrix_exponential(a) + matrix(a.array().exp()); }
#endif
