// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a product of matrices of sizes that do not fit

#include <duet/expression/matrix.hpp>
#include <duet/expression/symbol.hpp>

int main() {
  using namespace duet::expression;
  constexpr matrix_symbol<"A", 2, 4> A;
  constexpr matrix_symbol<"B", 4, 2> B;
#ifdef DUET_MUST_FAIL
  static_cast<void>(A * A);
#else
  static_cast<void>(A * B);
#endif
}
