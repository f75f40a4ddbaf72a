// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/dual.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/blocks/wide_tridiagonal.hpp>
#include <duet/spline/curve_ends.hpp>
#include <duet/spline/equations/curve_equations.hpp>
#include <duet/spline/equations/rotation_vector_ends.hpp>
#include <duet/spline/equations/rotation_vector_table.hpp>
#include <duet/spline/equations/shared_accelerations.hpp>
#include <duet/spline/equations/small_turns.hpp>
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
class rotation_vector_cubic_equations {
  using R = real_type_t<T>;
  using ends_type = rotation_vector_ends<T, 4>;
  using piece = rotation_vector_segment<T, 4>;
  template <class S>
  using knot_rates = typename piece::template knot_rates<S>;
  using polynomial = std::array<vector3<T>, 4>;

public:
  using curve_type = rotation_vector_spline<T, 4>;
  using real_type = R;
  using unknown = vector3<T>;
  using unknowns = std::vector<unknown>;
  using matrix = wide_block_tridiagonal<R, 3, 2>;

  /// \param u  increasing, as many as `ends` need or more
  /// \param q  as many unit elements, signs aligned
  rotation_vector_cubic_equations(const std::vector<R>& u, const std::vector<quaternion<T>>& q,
                                  const curve_ends<T>& ends)
      : ends_(ends, q.front(), q.back()), reach_(ends_.reach()), last_(u.size() - 1), table_(u, q) {
    make_pieces();
  }

  /// Number of unknowns, one a knot, and of equations.
  [[nodiscard]] std::size_t size() const { return last_ + (ends_.is_cyclic ? 0 : 1); }

  [[nodiscard]] static std::size_t least_rows(end_kind kind) { return ends_type::least_rows(kind); }

  /// The equations of a motion that turns less: turns from row to row and rates at the ends times
  /// λ.
  [[nodiscard]] rotation_vector_cubic_equations scaled(const R& lambda) const {
    rotation_vector_cubic_equations result = *this;
    for (vector3<T>& turn : result.table_.turns) {
      turn = lambda * components(turn);
    }
    for (auto& end : result.ends_.given) {
      for (vector3<T>& rate : end) {
        rate = lambda * components(rate);
      }
    }
    result.make_pieces();
    return result;
  }

  [[nodiscard]] R unevenness() const { return table_.unevenness(); }
  [[nodiscard]] std::pair<R, std::size_t> largest_turn() const { return table_.largest_turn(); }

  /// How large a step from x is in relation to what it changes. For real T.
  [[nodiscard]] R relative_step(const unknowns& x, const unknowns& step) const {
    return relative_step_of_rates(x, step, table_.turns, table_.steps);
  }

  /// Where Newton's method starts: the velocities of parabolas through three rows, as if turns were
  /// small.
  [[nodiscard]] unknowns start() const {
    unknowns x(size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = table_.parabola(i, ends_.is_cyclic).first;
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
    using block = typename matrix::matrix;
    const block zero = block::Zero();
    auto& rows = jacobian.rows();
    rows.assign(x.size(), {zero, zero, zero});
    std::array<typename matrix::end_row, 2> ends;
    ends[0].fill(zero);
    ends[1].fill(zero);
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
          const bool is_end = !ends_.is_cyclic && (row == 0 || row == last_);
          for (const std::size_t k : {0, 1}) {
            block& target = is_end     ? row == 0 ? ends[0][i + k] : ends[1][last_ - i - k]
                                : row == i ? k == 0 ? rows[row].diagonal : rows[row].upper
                            : k == 0   ? rows[row].lower
                                       : rows[row].diagonal;
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
    return ends_.is_cyclic ? jacobian.factorise_cyclic() : jacobian.factorise(ends, reach_ + 1);
  }

  /// Pieces that meet at a knot are made of the same numbers there.
  [[nodiscard]] curve_type curve(const std::vector<R>& u, std::vector<quaternion<T>> q,
                                 const unknowns& x) const {
    std::vector<polynomial> pieces;
    pieces.reserve(last_);
    for (std::size_t i = 0; i < last_; ++i) {
      pieces.push_back(pieces_[i].template polynomial<T>({x[i]}, {x[(i + 1) % x.size()]}));
    }
    share_accelerations(pieces_, table_.steps, x.size(), pieces);
    table_.in_own_units(pieces);
    return curve_type::from_pieces(u, std::move(q), std::move(pieces));
  }

private:
  void make_pieces() {
    pieces_.clear();
    pieces_.reserve(last_);
    for (std::size_t i = 0; i < last_; ++i) {
      pieces_.emplace_back(table_.steps[i], table_.turns[i]);
    }
  }

  /// Every vector equation, term by term: take(row, sign, value, i) with a derivative of w at
  /// an end of piece i, over the scalar S of the rates that `at(k, i)` gives to knot k of piece i
  /// (0 its start, 1 its end).
  template <class S, class At, class Take>
  void for_each_term(At&& at, Take&& take) const {
    const typename piece::identity_coefficients at_identity(R(0));
    for (std::size_t i = 0; i < last_; ++i) {
      const auto x = pieces_[i].template polynomial<S>(at(0, i), at(1, i));
      const bool is_at_joint = reach_ > 0 && (i <= reach_ || i + reach_ + 1 >= last_);
      if (is_at_joint) {
        const auto w = pieces_[i].template rates<ends_type::highest + 1, S>(at_identity, x);
        smoothness_terms(i, w, take);
        end_terms(i, w, take);
      } else {
        const auto w = pieces_[i].template rates<ends_type::highest, S>(at_identity, x);
        smoothness_terms(i, w, take);
        if (!ends_.is_cyclic && (i == 0 || i + 1 == last_)) {
          end_terms(i, w, take);
        }
      }
    }
  }

  /// What piece i contributes to the smoothness of the knots at its ends.
  template <class Rates, class Take>
  void smoothness_terms(std::size_t i, const Rates& w, Take&& take) const {
    if (ends_.is_cyclic || i > 0) {
      take(i, -1, w.start[1], i);
    }
    if (ends_.is_cyclic || i + 1 < last_) {
      take(i + 1 == last_ ? 0 : i + 1, 1, w.end[1], i);
    }
  }

  /// What piece i contributes to the equations of the ends.
  template <class Rates, class Take>
  void end_terms(std::size_t i, const Rates& w, Take&& take) const {
    const auto [joint, derivative] = ends_.equations[0];
    if (joint == i) {
      take(0, joint > 0 ? -1 : 1, w.start[derivative], i);
    }
    if (joint == i + 1) {
      take(0, 1, w.end[derivative], i);
    }
    if (joint > 0 && i + joint == last_) {
      take(last_, -1, w.start[derivative], i);
    }
    if (i + joint + 1 == last_) {
      take(last_, 1, w.end[derivative], i);
    }
  }

  /// What is given at the ends, on the other side of the equations.
  void subtract_given(unknowns& r) const {
    if (!ends_.is_cyclic) {
      const R scale = table_.unit_to(ends_.equations[0].derivative + 1);
      for (int a = 0; a < 3; ++a) {
        r.front()[a] -= ends_.given[0][0][a] * scale;
        r.back()[a] -= ends_.given[1][0][a] * scale;
      }
    }
  }

  ends_type ends_;
  std::size_t reach_, last_;
  rotation_vector_table<T> table_;
  std::vector<piece> pieces_;
};

template <class Own, class T>
struct equations_of<rotation_vector_spline<Own, 4>, T> {
  using type = rotation_vector_cubic_equations<T>;
};

} // namespace duet::detail
