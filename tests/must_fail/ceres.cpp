// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/interop/ceres_curves.hpp>

#include <ceres/jet.h>

#include <memory>
#include <vector>

//// jet
// expect: duet: a quaternion cannot have ceres::Jet as its scalar: duet::cost_function

using number = ceres::Jet<double, 4>; // wrong
using number = double;                // right
const duet::quaternion<number> q(number(1.));
static_cast<void>(q);

//// real_function
// expect: duet: cost_function: the function must take any scalar

const auto f = [](double x) { return x; };      // wrong
const auto f = [](const auto& x) { return x; }; // right
const std::unique_ptr<ceres::CostFunction> cost(duet::cost_function(f, duet::number_block()));

//// unknown_size
// expect: duet: cost_function: the function must return a number, or a vector or std::array

const auto f = [](const auto& x) { return std::vector{x, x}; }; // wrong
const auto f = [](const auto& x) { return std::array{x, x}; };  // right
const std::unique_ptr<ceres::CostFunction> cost(duet::cost_function(f, duet::number_block()));

//// position_of_rotations
// expect: duet: a residual of positions needs a curve of poses or a split curve

const duet::bspline_basis<4> basis(std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1});
const std::vector<duet::quaternion<double>> rotations(4, duet::quaternion<double>(1.));
const duet::curve_blocks<double> curve(duet::cumulative_bspline<double>(basis, rotations)); // wrong
const std::vector<duet::vector3<double>> positions(4, duet::vector3<double>(0, 0, 0));      // right
const duet::split_curve_blocks<4> curve(duet::split_bspline<double>(basis, rotations,
                                                                    positions)); // right
const std::unique_ptr<ceres::CostFunction> cost(position_residual(curve, .5,
                                                                  duet::vector3<double>(0, 0, 0)));
