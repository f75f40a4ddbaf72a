// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>

#include <complex>
#include <concepts>

/// \file
/// Dual and Taylor numbers over the complex numbers: derivatives f′(z) of analytic functions.
///
/// Beside algebra, ==, pow and streams they have `exp`, `log`, `sqrt`, `sin`, `cos`, `tan`, `sinh`,
/// `cosh` and `tanh`, on the branches of `<complex>`. There is no order, and there are no `abs`,
/// `arg`, `conj`, `real`, `imag`, which have no complex derivative; for those take the other
/// nesting, `std::complex<dual<T>>`.

namespace duet {

template <std::floating_point T>
struct field_traits<std::complex<T>> {
  static constexpr bool is_field = true;
  using constant_type = T;
};

} // namespace duet
