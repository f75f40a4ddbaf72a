// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/dual/dual.hpp>

double first_partial(const duet::dual<double, 4>& x);
double first_partial(const duet::dual<double, 4>& x) { return x.partial(0); }
