// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: matrix<2, 4>\(...\) takes its 8 entries, row by row

#include <duet/expression/matrix.hpp>
#include <duet/expression/symbol.hpp>

int main() {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
#ifdef DUET_MUST_FAIL
  static_cast<void>(matrix<2, 2>(u, u, 1.0));
#else
  static_cast<void>(matrix<2, 2>(u, u, 1.0, 0.5));
#endif
}
