// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/jet.hpp"
#include "support/random.hpp"

#include <duet/dual/second_dual.hpp>
#include <duet/dual/taylor.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// \file
/// What the functions of the library return, against oracles in 100 digits: the rows of
/// docs/accuracy.md.
///
/// An error is counted in units of 2⁻⁵³ (‖f‖ + a + c). Where f is a derivative, a is the root mean
/// square of what it is along a few random directions just as long: a derivative is a sum over
/// pairs, triples … of directions, and no algorithm knows that some of these sums vanish. c is the
/// conditioning, the root mean square of how f changes, to first order, when everything that was
/// put in, directions included, changes by its own norm in a few random ways. Parts that differ in
/// kind, as the scalar and the vector part of a quaternion, or rotation and translation, have norms
/// of their own, and so have derivatives of different order.

namespace duet_test::accuracy {

using numbers = std::vector<double>;

/// Where to differentiate, and along what.
struct input {
  std::string where;
  numbers x;
  numbers direction;
  std::vector<std::size_t> parts; ///< how many numbers belong together
};

/// One row of the table: the worst errors of the value and of derivatives by order.
struct row {
  std::string name;
  long inputs = 0;
  std::array<double, 5> worst = {};
  int orders = 0;               ///< the highest derivative probed
  std::string worst_where = {}; ///< and its order
};
using rows = std::vector<row>;

/// How many inputs each row takes: a few for the test, many for the page.
enum class extent { test, page };

/// The row of several functions: the worst of all, and of which.
[[nodiscard]] row worst_of(const std::string& name, const rows& each);

/// One family of functions each.
rows rotation_rows(extent e);
rows pose_rows(extent e);
rows mixed_rows(extent e);
rows curve_rows(extent e);
rows interpolation_rows(extent e);
rows fit_rows(extent e);

using oracle_function = std::function<jets(const jets&)>;

/// What was computed at an input: coefficients[i][n] is the coefficient of the n-th monomial in the
/// i-th result.
struct computed_results {
  std::vector<numbers> coefficients;
  std::vector<std::size_t> parts; ///< how many results belong together
  std::vector<int> orders;        ///< which derivative each part itself is, if not the value
};
/// Judges them by an oracle, d₂ as below, and takes the worst into the row.
void judge(row& r, const input& at, const numbers& d2, const oracle_function& exact,
           const computed_results& computed);

using line = duet::taylor<double, 4>;
using plane = duet::second_order_dual<double, 2>;

/// A function of lists of numbers, and where to probe it.
template <class T>
struct probed {
  const char* name;
  std::vector<std::size_t> parts; ///< how many results belong together
  std::vector<T> (*function)(const std::vector<T>&);
  oracle_function exact;
  input (*inputs)(int n, random_source& random);
};

/// Derivatives up to the fourth along lines x + t d.
[[nodiscard]] row probe_lines(const probed<line>& f, int count);
/// Second derivatives, mixed ones among them, on planes x + t d + s d₂.
[[nodiscard]] row probe_planes(const probed<plane>& f, int count);

} // namespace duet_test::accuracy
