// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// The functions of one number that formulas have, to write something for each of them. For those
/// who extend duet.

/// apply(name) for each function whose slope is that of its rule.
#define DUET_EACH_FUNCTION_WITH_SLOPE(apply)                                                       \
  apply(sqrt) apply(cbrt) apply(exp) apply(exp2) apply(expm1) apply(log) apply(log2) apply(log10)  \
      apply(log1p) apply(tan) apply(asin) apply(acos) apply(atan) apply(tanh) apply(asinh)         \
          apply(acosh) apply(atanh) apply(erf) apply(erfc)

/// apply(name) for each function with derivatives, and the gamma functions.
#define DUET_EACH_FUNCTION(apply)                                                                  \
  DUET_EACH_FUNCTION_WITH_SLOPE(apply)                                                             \
  apply(sin) apply(cos) apply(sinh) apply(cosh) apply(tgamma) apply(lgamma) apply(abs)

/// apply(name) for each function that rounds to whole numbers.
#define DUET_EACH_ROUNDING(apply) apply(floor) apply(ceil) apply(trunc) apply(round)
