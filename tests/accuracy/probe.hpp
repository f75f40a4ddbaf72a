// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/jet.hpp"
#include "support/random.hpp"

#include <duet/dual/second_dual.hpp>
#include <duet/dual/taylor.hpp>

/// \file
/// Errors of functions of the library relative to oracles in 100 digits: the rows of
/// docs/reference/accuracy.md.
///
/// The unit of errors is 2⁻⁵³ (‖f‖ + a + c). If f is a derivative, a is the root mean square of the
/// derivative along a few random directions of the same norm: a derivative is a sum over pairs,
/// triples … of directions, and no algorithm can use that some of these sums vanish. c is the
/// conditioning: the root mean square of the first-order change of f if all inputs, directions
/// included, change by their own norm in a few random directions. Parts of different kind, as the
/// scalar and the vector part of a quaternion, or rotation and translation, have separate norms,
/// and so do derivatives of different order.

namespace duet_test::accuracy {

using numbers = std::vector<double>;

/// Point and directions of differentiation.
struct input {
  std::string where;
  numbers x;
  numbers direction;
  std::vector<std::size_t> parts; ///< numbers of variables in each part
};

/// One row of the table: the worst errors of the value and of derivatives by order.
struct row {
  std::string name;
  long inputs = 0;
  std::array<double, 5> worst = {};
  int orders = 0;               ///< the highest derivative probed
  std::string worst_where = {}; ///< input with the largest error, and the order
};
using rows = std::vector<row>;

/// Number of inputs of each row: a few for the test, many for the page.
enum class extent { test, page };

/// The row of several functions: largest errors of all, and the function that has them.
[[nodiscard]] row worst_of(const std::string& name, const rows& each);

/// Rows of one family of functions each.
rows rotation_rows(extent e);
rows pose_rows(extent e);
rows mixed_rows(extent e);
rows curve_rows(extent e);
rows interpolation_rows(extent e);
rows fit_rows(extent e);

using oracle_function = std::function<jets(const jets&)>;

/// Result at an input: coefficients[i][n] is the coefficient of the n-th monomial in the
/// i-th result.
struct computed_results {
  std::vector<numbers> coefficients;
  std::vector<std::size_t> parts; ///< numbers of results in each part
  std::vector<int> orders;        ///< order of derivative of each part itself, 0 for a value
};
/// Compares a result with an oracle, d₂ as below, and adds the largest errors to the row.
void judge(row& r, const input& at, const numbers& d2, const oracle_function& exact,
           const computed_results& computed);

using line = duet::taylor<double, 4>;
using plane = duet::second_order_dual<double, 2>;

/// A function of lists of numbers and the inputs to test it at.
template <class T>
struct probed {
  const char* name;
  std::vector<std::size_t> parts; ///< numbers of results in each part
  std::vector<T> (*function)(const std::vector<T>&);
  oracle_function exact;
  input (*inputs)(int n, random_source& random);
};

/// Derivatives up to the fourth along lines x + t d.
[[nodiscard]] row probe_lines(const probed<line>& f, int count);
/// Second derivatives, mixed ones among them, on planes x + t d + s d₂.
[[nodiscard]] row probe_planes(const probed<plane>& f, int count);

} // namespace duet_test::accuracy
