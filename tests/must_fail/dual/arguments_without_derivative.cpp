// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: [a-z_0-9]+ has no derivative with respect to its (order|modulus|characteristic)

#include <duet/interop/special_functions.hpp>

using D = duet::dual<double>;

void special_functions(const D& x) {
#ifdef DUET_MUST_FAIL
  cyl_bessel_j(x, D(2));   // mistake
  cyl_neumann(x, D(2));    // mistake
  cyl_bessel_i(x, 2.0);    // mistake
  cyl_bessel_k(x, D(2));   // mistake
  ellint_1(x, D(2));       // mistake
  ellint_2(x, 2.0);        // mistake
  ellint_3(x, 0.25, D(2)); // mistake
  ellint_3(0.5, x, D(2));  // mistake
  comp_ellint_3(x, 0.25);  // mistake
  comp_ellint_3(0.5, x);   // mistake
#else
  static_cast<void>(cyl_bessel_j(1, x) + cyl_neumann(1, x) + cyl_bessel_i(1, x));
  static_cast<void>(cyl_bessel_k(1, x) + ellint_1(0.5, x) + ellint_2(0.5, x));
  static_cast<void>(ellint_3(0.5, 0.25, x));
#endif
}
