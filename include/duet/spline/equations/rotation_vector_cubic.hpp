// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/dual.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/blocks/tridiagonal.hpp>
#include <duet/spline/curve_ends.hpp>
#include <duet/spline/equations/curve_equations.hpp>
#include <duet/spline/equations/rotation_vector_equations.hpp>
#include <duet/spline/rotation_vector_segment.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// What the velocities at the knots of a cubic rotation-vector spline have to fulfil.

namespace duet::detail {

/// Unknown is the first rate w_0 of each knot, half the angular velocity in body axes. The next one
/// must be the same on both sides of an inner knot, which involves the knot and its two neighbours;
/// an end condition at each end completes the system.
template <class T>
class rotation_vector_cubic_equations
    : public rotation_vector_equations<T, 4, rotation_vector_segment<T, 4>> {
  using piece = rotation_vector_segment<T, 4>;
  using base = rotation_vector_equations<T, 4, piece>;
  using base::ends_, base::steps_, base::pieces_;
  using typename base::ends_type, typename base::R;
  template <class S>
  using knot_rates = typename piece::template knot_rates<S>;
  using polynomial = std::array<vector3<T>, 4>;

public:
  using curve_type = rotation_vector_spline<T, 4>;
  using unknown = vector3<T>;
  using unknowns = std::vector<unknown>;
  using matrix = block_tridiagonal<R, 3>;

  using base::base;

  /// Where Newton's method starts: the velocities of parabolas through three rows, as if turns were
  /// small.
  [[nodiscard]] unknowns start() const {
    unknowns x(this->knots());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = this->parabola(i).first;
    }
    return x;
  }

  /// What x leaves of the equations.
  void residuals(const unknowns& x, unknowns& r) const {
    r.assign(x.size(), unknown::Constant(T(R(0))));
    for_each_term<T>(
        [&](std::size_t k, std::size_t i) { return knot_rates<T>{x[(i + k) % x.size()]}; },
        [&](std::size_t row, int sign, const vector3<T>& value, std::size_t) {
          for (int a = 0; a < 3; ++a) {
            r[row][a] += sign * value[a];
          }
        });
    subtract_given(r);
  }

  /// Residuals and factorised Jacobian; false where that is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    static_assert(Real<T>);
    using tag = derivative_tag<rotation_vector_cubic_equations>;
    using D = dual<R, 6, tag>;
    auto& rows = jacobian.rows();
    rows.assign(x.size(), {matrix3<R>::Zero(), matrix3<R>::Zero(), matrix3<R>::Zero()});
    r.assign(x.size(), unknown::Zero());
    for_each_term<D>(
        [&](std::size_t k, std::size_t i) {
          const unknown& values = x[(i + k) % x.size()];
          knot_rates<D> result;
          for (int a = 0; a < 3; ++a) {
            result[0][a] = D::variable(values[a], 3 * int(k) + a);
          }
          return result;
        },
        [&](std::size_t row, int sign, const vector3<D>& value, std::size_t i) {
          const std::size_t equation = ends_.is_cyclic && row < i ? i + 1 : row;
          for (const std::size_t k : {0, 1}) {
            // The third block of an equation of the ends has the place of the one outside.
            matrix3<R>& target = rows[row].at((4 + i + k - equation) % 3);
            for (int a = 0; a < 3; ++a) {
              for (int b = 0; b < 3; ++b) {
                target(a, b) += sign * value[a].partial(3 * int(k) + b);
              }
            }
          }
          for (int a = 0; a < 3; ++a) {
            r[row][a] += sign * value[a].value();
          }
        });
    subtract_given(r);
    const std::size_t last = pieces_.size(), reach = ends_.reach();
    return jacobian.factorise(ends_.is_cyclic ? corners{last - 1, 0}
                                              : corners{1 + reach, last - 1 - reach});
  }

  /// Pieces that meet at a knot are made of the same numbers there.
  [[nodiscard]] curve_type curve(const std::vector<R>& u, std::vector<quaternion<T>> q,
                                 const unknowns& x) const {
    std::vector<polynomial> pieces;
    pieces.reserve(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      pieces.push_back(pieces_[i].template polynomial<T>({x[i]}, {x[(i + 1) % x.size()]}));
    }
    share_accelerations(pieces);
    this->in_own_units(pieces);
    return curve_type::from_pieces(u, std::move(q), std::move(pieces));
  }

private:
  /// The polynomials once more, from accelerations at the knots that are those of the longer piece
  /// there, which knows them best.
  void share_accelerations(std::vector<polynomial>& polynomials) const {
    const std::size_t knots = this->knots();
    std::vector<std::array<vector3<T>, 2>> rates(knots);
    std::vector<R> lengths(knots, R(0));
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto w = pieces_[i].template rates<2, T>(polynomials[i]);
      const auto take = [&](std::size_t knot, const std::array<vector3<T>, 2>& its) {
        if (steps_[i] > lengths[knot]) {
          rates[knot] = its;
          lengths[knot] = steps_[i];
        }
      };
      take(i, w.start);
      take((i + 1) % knots, w.end);
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      polynomials[i] = pieces_[i].polynomial_of_accelerations(rates[i], rates[(i + 1) % knots]);
    }
  }

  /// Every vector equation, term by term: take(row, sign, value, i) with a derivative of w at
  /// an end of piece i, over the scalar S of the rates that `at(k, i)` gives to knot k of piece i
  /// (0 its start, 1 its end).
  template <class S, class At, class Take>
  void for_each_term(At&& at, Take&& take) const {
    const std::size_t last = pieces_.size(), reach = ends_.reach();
    for (std::size_t i = 0; i < last; ++i) {
      const auto x = pieces_[i].template polynomial<S>(at(0, i), at(1, i));
      if (!ends_.is_cyclic && (i <= reach || i + reach + 1 >= last)) {
        const auto w = pieces_[i].template rates<ends_type::highest + 1, S>(x);
        smoothness_terms(i, w, take);
        end_terms(i, w, take);
      } else {
        smoothness_terms(i, pieces_[i].template rates<ends_type::highest, S>(x), take);
      }
    }
  }

  /// What piece i contributes to the smoothness of the knots at its ends.
  template <class Rates, class Take>
  void smoothness_terms(std::size_t i, const Rates& w, Take&& take) const {
    if (ends_.is_cyclic || i > 0) {
      take(i, -1, w.start[1], i);
    }
    if (ends_.is_cyclic || i + 1 < pieces_.size()) {
      take((i + 1) % pieces_.size(), 1, w.end[1], i);
    }
  }

  /// What piece i contributes to the equations of the ends.
  template <class Rates, class Take>
  void end_terms(std::size_t i, const Rates& w, Take&& take) const {
    const auto [joint, derivative] = ends_.equations[0];
    const std::size_t last = pieces_.size();
    if (joint == i) {
      take(0, joint > 0 ? -1 : 1, w.start[derivative], i);
    }
    if (joint == i + 1) {
      take(0, 1, w.end[derivative], i);
    }
    if (joint > 0 && i + joint == last) {
      take(last, -1, w.start[derivative], i);
    }
    if (i + joint + 1 == last) {
      take(last, 1, w.end[derivative], i);
    }
  }

  /// What is given at the ends, on the other side of the equations.
  void subtract_given(unknowns& r) const {
    if (!ends_.is_cyclic) {
      const R scale = this->unit_to(ends_.equations[0].derivative + 1);
      for (int a = 0; a < 3; ++a) {
        r.front()[a] -= ends_.given[0][0][a] * scale;
        r.back()[a] -= ends_.given[1][0][a] * scale;
      }
    }
  }
};

template <class Own, class T>
struct equations_of<rotation_vector_spline<Own, 4>, T> {
  using type = rotation_vector_cubic_equations<T>;
};

} // namespace duet::detail
