// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/derivative/structure.hpp>
#include <duet/spline/block_tridiagonal.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Curves through given orientations: the control quaternions of P2 are solved for.

namespace duet {
namespace detail {

/// \throws invalid_row unless the parameters are finite and increase
template <Real R>
void check_parameters(const std::vector<R>& u) {
  for (std::size_t i = 0; i < u.size(); ++i) {
    std::ostringstream reason;
    if (!(u[i] - u[i] == 0)) {
      reason << "parameter " << u[i] << " is not finite";
    } else if (i > 0 && !(u[i] > u[i - 1])) {
      reason << "parameter " << u[i] << " does not increase, the row before has " << u[i - 1];
    } else {
      continue;
    }
    throw invalid_row(i, reason.str());
  }
}

/// What a curve's end leaves unfulfilled, from its rates there: halves, in body axes.
template <class D>
[[nodiscard]] vector3<D> end_residual(const motion<D>& half, const natural&, bool) {
  return half.acceleration;
}
template <class D, class V>
[[nodiscard]] vector3<D> end_residual(const motion<D>& half, const clamped<V>& rates,
                                      bool at_start) {
  const V& omega = at_start ? rates.start : rates.end;
  return rotate(half.value, half.velocity) - (omega / 2).template cast<D>();
}

/// The interpolation problem of the cubic: n + 1 orientations Q_0 … Q_n at u_0 … u_n, knots
/// repeated four times at the ends. The first and last control quaternions are Q_0 and Q_n. The n +
/// 1 others are unknown; their equations are the two end conditions and S(u_i) = Q_i inside, where
/// three of them meet, so the Jacobian is tridiagonal in blocks of 3 × 3.
template <class R, class Ends>
class cubic_interpolation {
  using tag = derivative_tag<cubic_interpolation>;
  using D = dual<R, 9, tag>;
  using row = block_row<R, 3>;

public:
  cubic_interpolation(const std::vector<R>& u, std::vector<quaternion<R>> q, const Ends& ends)
      : basis_(clamped_knots(u, 4)), data_(std::move(q)), ends_(ends) {
    controls_.push_back(data_.front());
    controls_.insert(controls_.end(), data_.begin(), data_.end());
    controls_.push_back(data_.back());
  }

  [[nodiscard]] cumulative_bspline<R, 4> solve() {
    using std::sqrt;
    const R small = sqrt(std::numeric_limits<R>::epsilon());
    R last = std::numeric_limits<R>::infinity();
    std::vector<row> rows(data_.size());
    for (int iteration = 1; iteration <= max_iterations; ++iteration) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] = equation(i);
      }
      if (!solve_block_tridiagonal(rows)) {
        fail("meets a singular Jacobian", iteration, last);
      }
      R step(0);
      for (const row& r : rows) {
        if (!r.right.allFinite()) {
          fail("diverges", iteration, last);
        }
        step = std::max(step, R(r.right.norm()));
      }
      // Far from the solution full steps overshoot.
      const R fraction = step > longest_step ? longest_step / step : R(1);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const vector3<R> delta = fraction * rows[i].right;
        controls_[i + 1] = normalized(manifold<quaternion<R>>::plus(controls_[i + 1], delta));
      }
      // Once in the quadratic range, the next step ends at rounding.
      if (last <= small) {
        return cumulative_bspline<R, 4>(basis_.knots(), std::move(controls_), signs_as_given{});
      }
      last = step;
    }
    fail("does not converge", max_iterations, last);
  }

private:
  static constexpr int max_iterations = 50;
  static constexpr R longest_step = R(0.5); // rad

  /// Equation i involves controls i, i + 1, i + 2, moved by δ; row i of the Newton system.
  [[nodiscard]] row equation(std::size_t i) const {
    std::array<quaternion<D>, 3> c;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = i + j;
      const bool known = k == 0 || k + 1 == controls_.size();
      c[j] = known ? quaternion<D>(controls_[k]) : moved(controls_[k], int(j));
    }
    const vector3<D> r = residual(i, c);
    row result;
    for (int a = 0; a < 3; ++a) {
      result.right[a] = -r[a].value();
      for (int b = 0; b < 3; ++b) {
        result.lower(a, b) = r[a].partial(b);
        result.diagonal(a, b) = r[a].partial(3 + b);
        result.upper(a, b) = r[a].partial(6 + b);
      }
    }
    return result;
  }

  [[nodiscard]] static quaternion<D> moved(const quaternion<R>& q, int slot) {
    vector3<D> delta;
    for (int b = 0; b < 3; ++b) {
      delta[b] = D::variable(R(0), 3 * slot + b);
    }
    return manifold<quaternion<R>>::plus(q, delta);
  }

  /// log(S(u_i)⁻¹ Q_i) inside, the end conditions outside. At the start the curve begins with the
  /// controls i, i + 1, i + 2, at the end it ends with them, at an inner knot the fourth has no
  /// weight.
  [[nodiscard]] vector3<D> residual(std::size_t i, const std::array<quaternion<D>, 3>& c) const {
    const std::size_t last = data_.size() - 1;
    const std::array<vector3<D>, 2> increments{log(conj(c[0]) * c[1]).vec(),
                                               log(conj(c[1]) * c[2]).vec()};
    const bool at_end = i == last;
    const std::size_t span = at_end ? i - 1 : i;
    const auto all = basis_.template weights<2>(span, at_end ? basis_.back() : basis_.breaks()[i]);
    std::array<std::array<R, 2>, 3> weights;
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t d = 0; d < 3; ++d) {
        weights[d][j] = all[d][at_end ? j + 1 : j];
      }
    }
    const auto m = product_of_exponentials<2>(c[0], increments.data(), weights);
    if (i == 0 || at_end) {
      return end_residual(m, ends_, i == 0);
    }
    return log(conj(m.value) * quaternion<D>(data_[i])).vec();
  }

  [[noreturn]] void fail(const char* what, int iterations, const R& step) const {
    std::ostringstream message;
    message << "duet: interpolate: Newton's method " << what << " after " << iterations
            << " iterations, last step " << step
            << " rad; neighbouring orientations may be too far apart";
    throw no_convergence(message.str());
  }

  bspline_basis<4, R> basis_;
  std::vector<quaternion<R>> data_;
  std::vector<quaternion<R>> controls_;
  Ends ends_;
};

} // namespace detail

/// The curve of type `Spline` with S(u_i) = Q_i.
///
/// \param parameters    u_0 < u_1 < …, uniform or not
/// \param orientations  unit quaternions; signs are aligned first
/// \param ends          `natural{}` or `clamped{…}`
///
/// Spline is `cumulative_bspline<T, 4>`: the control quaternions are found by Newton's method with
/// AD Jacobian, O(n) a step (P2). Where neighbouring orientations are far apart or unevenly spaced,
/// neighbouring controls may come to lie more than half a turn apart: copy such a curve with
/// `signs_as_given`. Measured against smooth motion the cubic is third-order accurate in value,
/// second in angular velocity, first in angular acceleration. \throws invalid_row for a row that no
/// curve can go through, invalid_input where there are fewer than two rows, the counts differ or an
/// end rate is not finite, no_convergence where neighbours are too far apart (on randomly turning
/// axes from about 2.5 rad, less where parameters are uneven)
template <class Spline, class R, class T, class Ends = natural>
[[nodiscard]] Spline interpolate(const std::vector<R>& parameters,
                                 const std::vector<quaternion<T>>& orientations,
                                 const Ends& ends = {}) {
  static_assert(std::is_same_v<Spline, cumulative_bspline<T, 4>> && Real<T>,
                "duet: interpolate makes cumulative_bspline<T, 4> over real numbers");
  if (parameters.size() != orientations.size() || parameters.size() < 2) {
    std::ostringstream message;
    message
        << "duet: interpolate: needs two rows or more, each a parameter and an orientation, got "
        << parameters.size() << " and " << orientations.size();
    throw invalid_input(message.str());
  }
  detail::check_parameters(parameters);
  ends.check();
  return detail::cubic_interpolation<T, Ends>(parameters, aligned_orientations(orientations), ends)
      .solve();
}

} // namespace duet
