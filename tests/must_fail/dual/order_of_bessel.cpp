// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: cyl_bessel_j has no derivative by its order; give a plain number there

#include <duet/interop/special_functions.hpp>

using D = duet::dual<double>;

#ifdef DUET_MUST_FAIL
void order() { cyl_bessel_j(D::variable(1), D(2)); } // the mistake
#else
D order() { return cyl_bessel_j(1, D::variable(2)); }
#endif
