// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/blocks/tridiagonal.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/equations/curve_equations.hpp>
#include <duet/spline/equations/rotation_vector_equations.hpp>
#include <duet/spline/rotation_vector_segment.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Equations for the velocities at the knots of a cubic rotation-vector spline.

namespace duet::detail {

/// Equations for the first rate w_0 of each knot, half the angular velocity in body axes. The next
/// rate must be equal on both sides of an inner knot, which involves the knot and its two
/// neighbours; an end condition at each end completes the system.
template <class T>
class rotation_vector_cubic_equations
    : public rotation_vector_equations<T, 4, rotation_vector_segment<T, 4>> {
  using piece = rotation_vector_segment<T, 4>;
  using base = rotation_vector_equations<T, 4, piece>;
  using base::ends_, base::steps_, base::pieces_;
  using typename base::ends_type, typename base::R;
  static constexpr std::size_t highest = ends_type::highest;
  using polynomial = std::array<vector3<T>, 4>;

public:
  using curve_type = rotation_vector_spline<T, 4>;
  using unknown = vector3<T>;
  using unknowns = std::vector<unknown>;
  using matrix = block_tridiagonal<R>;

  using base::base;

  /// Initial guess of Newton's method: velocities of parabolas through three samples, as for small
  /// rotations.
  [[nodiscard]] unknowns start() const {
    unknowns x(this->knots());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = this->parabola(i).first;
    }
    return x;
  }

  /// Residuals of the equations at x.
  void residuals(const unknowns& x, unknowns& r) const {
    r.resize(x.size());
    for (unknown& each : r) {
      each = unknown::Constant(T(R(0)));
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto w = pieces_[i].rates(polynomial_of(i, x), rates_of(i));
      for_each_term(i, [&](std::size_t row, int sign, std::size_t end, std::size_t derivative) {
        for (int a = 0; a < 3; ++a) {
          r[row][a] += sign * w[end][derivative][a];
        }
      });
    }
    if (!ends_.is_cyclic) {
      const R scale = this->unit_to(ends_.equations[0].derivative + 1);
      for (int a = 0; a < 3; ++a) {
        r.front()[a] -= ends_.values[0][0][a] * scale;
        r.back()[a] -= ends_.values[1][0][a] * scale;
      }
    }
  }

  /// Computes residuals and the factorised Jacobian; false if it is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    static_assert(Real<T>);
    residuals(x, r);
    auto& rows = jacobian.rows();
    rows.resize(x.size());
    for (auto& row : rows) {
      row.lower = row.diagonal = row.upper = matrix3<R>::Zero();
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto gradients =
          pieces_[i].gradients_by_velocities(x[i], x[(i + 1) % x.size()], rates_of(i));
      for_each_term(i, [&](std::size_t row, int sign, std::size_t end, std::size_t derivative) {
        const std::size_t equation = ends_.is_cyclic && row < i ? i + 1 : row;
        for (const std::size_t k : {0U, 1U}) {
          // The third block of an end equation is stored at the position of the corner block.
          add_multiple(rows[row].at((4 + i + k - equation) % 3), R(sign),
                       gradients[end][derivative][k]);
        }
      });
    }
    const std::size_t last = pieces_.size(), reach = ends_.reach();
    return jacobian.factorise(ends_.is_cyclic ? corners{last - 1, 0}
                                              : corners{1 + reach, last - 1 - reach});
  }

  /// Curve of a solution. Segments that meet at a knot are computed from the same rates at it.
  [[nodiscard]] curve_type curve(const std::vector<R>& u, std::vector<quaternion<T>> q,
                                 const unknowns& x) const {
    std::vector<polynomial> pieces(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      pieces[i] = polynomial_of(i, x);
    }
    share_accelerations(pieces);
    return this->made_of(u, std::move(q), std::move(pieces));
  }

private:
  /// Recomputes the polynomials from accelerations at the knots, each of which is evaluated on the
  /// longer adjacent segment, where it is most accurate.
  void share_accelerations(std::vector<polynomial>& polynomials) const {
    const std::size_t knots = this->knots();
    std::vector<std::array<vector3<T>, 2>> rates(knots);
    std::vector<R> lengths(knots, R(0));
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto w = pieces_[i].rates(polynomials[i], 2);
      for (const std::size_t end : {0U, 1U}) {
        const std::size_t knot = (i + end) % knots;
        if (steps_[i] > lengths[knot]) {
          rates[knot] = {w[end][0], w[end][1]};
          lengths[knot] = steps_[i];
        }
      }
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      polynomials[i] = pieces_[i].polynomial_of_accelerations(rates[i], rates[(i + 1) % knots]);
    }
  }

  [[nodiscard]] polynomial polynomial_of(std::size_t i, const unknowns& x) const {
    return pieces_[i].polynomial({x[i]}, {x[(i + 1) % x.size()]});
  }

  /// Number of derivatives of segment i that equations use; one more near the ends.
  [[nodiscard]] std::size_t rates_of(std::size_t i) const {
    const std::size_t reach = ends_.reach();
    const bool is_at_end = !ends_.is_cyclic && (i <= reach || i + reach + 1 >= pieces_.size());
    return is_at_end ? highest + 1 : highest;
  }

  /// Calls take(row, sign, end, derivative) for every term of piece i in the equations: a
  /// derivative of w at its start (end 0) or its end (1).
  template <class Take>
  void for_each_term(std::size_t i, const Take& take) const {
    const std::size_t last = pieces_.size();
    if (ends_.is_cyclic || i > 0) {
      take(i, -1, 0, 1);
    }
    if (ends_.is_cyclic || i + 1 < last) {
      take((i + 1) % last, 1, 1, 1);
    }
    if (!ends_.is_cyclic) {
      const auto [joint, derivative] = ends_.equations[0];
      if (joint == i) {
        take(0, joint > 0 ? -1 : 1, 0, derivative);
      }
      if (joint == i + 1) {
        take(0, 1, 1, derivative);
      }
      if (joint > 0 && i + joint == last) {
        take(last, -1, 0, derivative);
      }
      if (i + joint + 1 == last) {
        take(last, 1, 1, derivative);
      }
    }
  }
};

template <class Own, class T>
struct equations_of<rotation_vector_spline<Own, 4>, T> {
  using type = rotation_vector_cubic_equations<T>;
};

} // namespace duet::detail
