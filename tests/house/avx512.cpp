// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Batches of vectors of 512 bits, compiled for machines that have them.

#include <duet/core/batch/math.hpp>
#include <duet/dual/dual.hpp>
#include <duet/quaternion/exponential.hpp>

using numbers = duet::batch<double, 8>;
using singles = duet::batch<float, 16>;

duet::quaternion<numbers> power(const duet::quaternion<numbers>& q, const numbers& exponent);
duet::dual<singles> root(const duet::dual<singles>& x);

duet::quaternion<numbers> power(const duet::quaternion<numbers>& q, const numbers& exponent) {
  return pow(q, exponent);
}

duet::dual<singles> root(const duet::dual<singles>& x) {
  return duet::select(
      x < 1, [&] { return sqrt(x); }, [&] { return sin(x) / 2; });
}
