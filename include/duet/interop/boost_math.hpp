// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/functions.hpp>

#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/hypot.hpp>

/// \file
/// Functions of Boost.Math that duet has too, with duet's derivatives.
///
/// Boost answers some arguments from tables or special cases, as Γ(3) = 2 and erf(0) = 0, where the
/// derivative would be lost: the result is a constant. Most of Boost.Math takes dual numbers
/// without any header of duet's; docs/boost.md says what to look out for.

namespace boost::math {

using duet::erf;
using duet::erfc;
using duet::hypot;
using duet::lgamma;
using duet::tgamma;

} // namespace boost::math
