// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: an entry or a block that is not in the matrix

#include <duet/expression/matrix.hpp>
#include <duet/expression/symbol.hpp>

int main() {
  using namespace duet::expression;
  constexpr matrix_symbol<"A", 2, 4> A;
#ifdef DUET_MUST_FAIL
  static_cast<void>(entry<2, 0>(A));
#else
  static_cast<void>(entry<1, 3>(A));
#endif
}
