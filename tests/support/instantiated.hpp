// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/compare.hpp>
#include <duet/spline/fit.hpp>
#include <duet/spline/interpolate.hpp>

#include <string>
#include <vector>

/// \file
/// Templates that many tests use: `compare`, `interpolate` and `fit` over double. They are compiled
/// once for all tests, optimised, in instantiated.cpp; without, or with DUET_TEST_INSTANTIATES_ALL,
/// each test instantiates them.

#ifndef DUET_TEST_INSTANTIATES_ALL

#ifndef DUET_TEST_INSTANTIATED
#define DUET_TEST_INSTANTIATED extern template
#endif

namespace duet {
namespace detail {

DUET_TEST_INSTANTIATED comparison compared(const std::string&, const formula_pair&,
                                           const std::vector<coordinates>&,
                                           std::vector<worst_errors>, const comparison_options&);

DUET_TEST_INSTANTIATED class cubic_equations<double>;
DUET_TEST_INSTANTIATED class rotation_vector_cubic_equations<double>;
DUET_TEST_INSTANTIATED class rotation_vector_quintic_equations<double>;
DUET_TEST_INSTANTIATED class spline_newton<cubic_equations<double>>;
DUET_TEST_INSTANTIATED class spline_newton<rotation_vector_cubic_equations<double>>;
DUET_TEST_INSTANTIATED class spline_newton<rotation_vector_quintic_equations<double>>;
DUET_TEST_INSTANTIATED cumulative_bspline<double> curve_through(const std::vector<double>&,
                                                                std::vector<quaternion<double>>,
                                                                const curve_ends<double>&,
                                                                interpolation_report*);
DUET_TEST_INSTANTIATED rotation_vector_spline<double> curve_through(const std::vector<double>&,
                                                                    std::vector<quaternion<double>>,
                                                                    const curve_ends<double>&,
                                                                    interpolation_report*);
DUET_TEST_INSTANTIATED rotation_vector_spline<double, 6>
curve_through(const std::vector<double>&, std::vector<quaternion<double>>,
              const curve_ends<double>&, interpolation_report*);
DUET_TEST_INSTANTIATED cumulative_bspline<screw_dual<double>>
curve_through(const std::vector<double>&, std::vector<quaternion<screw_dual<double>>>,
              const curve_ends<screw_dual<double>>&, interpolation_report*);
DUET_TEST_INSTANTIATED rotation_vector_spline<screw_dual<double>>
curve_through(const std::vector<double>&, std::vector<quaternion<screw_dual<double>>>,
              const curve_ends<screw_dual<double>>&, interpolation_report*);
DUET_TEST_INSTANTIATED rotation_vector_spline<screw_dual<double>, 6>
curve_through(const std::vector<double>&, std::vector<quaternion<screw_dual<double>>>,
              const curve_ends<screw_dual<double>>&, interpolation_report*);

} // namespace detail

DUET_TEST_INSTANTIATED fit_result<cumulative_bspline<double>>
fit(std::vector<double>, std::vector<quaternion<double>>, std::vector<double>, const fit_options&);
DUET_TEST_INSTANTIATED fit_result<cumulative_bspline<screw_dual<double>>>
fit(std::vector<double>, std::vector<quaternion<screw_dual<double>>>, std::vector<double>,
    const fit_options&);

} // namespace duet

#endif
