// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: no match for .operator\*|invalid operands to binary expression

#include <duet/dual/math.hpp>
#include <duet/interop/boost_rational.hpp>

using rational = boost::rational<long long>;

#ifdef DUET_MUST_FAIL
auto half(const duet::dual<rational>& x) { return x * 0.5; }
#else
auto half(const duet::dual<rational>& x) { return x * rational(1, 2); }
#endif
