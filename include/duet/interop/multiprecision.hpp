// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>

/// \file
/// Numbers of many digits, to distinguish a slip in a formula from round-off.

namespace duet {

/// A real number of 50 decimal digits, over which every function of duet works.
/// Example: `compare<double, real_50>(label, automatic, closed_form, inputs)`
using real_50 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                              boost::multiprecision::et_off>;

} // namespace duet
