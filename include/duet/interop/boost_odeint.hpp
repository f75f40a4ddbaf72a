// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>

#include <boost/numeric/odeint/algebra/algebra_dispatcher.hpp>
#include <boost/numeric/odeint/algebra/range_algebra.hpp>
#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>

#include <Eigen/Core>

#include <cmath>
#include <type_traits>
#include <vector>

/// \file
/// Boost.Odeint with step size control over states of dual numbers: `std::vector` and Eigen
/// matrices. (`std::array`, and steppers of fixed step, do not need this header.)
///
/// The norm of an error is that of its values, so that the steps are those of the plain numbers and
/// sensitivities are the derivatives of exactly that integration.

namespace duet {
namespace detail {

/// The largest |value| in a range of duals, or the last of them that is NaN.
template <class Range>
[[nodiscard]] auto largest_value(const Range& range) {
  using std::abs;
  using std::isnan;
  using number = real_type_t<std::remove_cvref_t<decltype(*range.begin())>>;
  number largest(0);
  for (const auto& x : range) {
    const number size = abs(innermost(x));
    largest = select(
        size > largest || isnan(size), [&] { return size; }, [&] { return largest; });
  }
  return largest;
}

} // namespace detail

/// `boost::numeric::odeint::range_algebra` with the norm of the values.
struct odeint_algebra : boost::numeric::odeint::range_algebra {
  /// Largest absolute value of a component's value.
  template <class State>
  [[nodiscard]] static auto norm_inf(const State& error) {
    return detail::largest_value(error);
  }
};

} // namespace duet

namespace boost::numeric::odeint {

template <duet::RealInfinitesimal D, class Allocator>
struct algebra_dispatcher_sfinae<std::vector<D, Allocator>> {
  using algebra_type = duet::odeint_algebra;
};

template <duet::RealInfinitesimal D, int Rows, int Cols, int Options, int MaxRows, int MaxCols>
struct vector_space_norm_inf<Eigen::Matrix<D, Rows, Cols, Options, MaxRows, MaxCols>> {
  using result_type = duet::real_type_t<D>;
  [[nodiscard]] result_type
  operator()(const Eigen::Matrix<D, Rows, Cols, Options, MaxRows, MaxCols>& error) const {
    return duet::detail::largest_value(error.reshaped());
  }
};

} // namespace boost::numeric::odeint
