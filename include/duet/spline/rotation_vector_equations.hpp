// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/dual.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/rotation_vector_ends.hpp>
#include <duet/spline/rotation_vector_segment.hpp>
#include <duet/spline/shared_accelerations.hpp>
#include <duet/spline/wide_block_tridiagonal.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// What the rates at the knots of a rotation-vector spline have to fulfil.

namespace duet::detail {

/// Unknown are the k/2 − 1 rates of each knot: derivatives of w in body axes. As many further
/// derivatives must be the same on both sides of an inner knot, which involves the knot and its two
/// neighbours; as many end conditions complete the system. The parameter is counted in units of
/// about one step, so that all derivatives have one size.
template <class T, int Order>
class rotation_vector_equations {
  static constexpr std::size_t own = std::size_t(Order) / 2 - 1;
  static constexpr int n = 3 * int(own);
  using R = real_type_t<T>;
  using ends_type = rotation_vector_ends<T, Order>;
  using piece = rotation_vector_segment<T, Order>;
  template <class S>
  using knot_rates = typename piece::template knot_rates<S>;
  using polynomial = std::array<vector3<T>, std::size_t(Order)>;

public:
  using real_type = R;
  using unknown = Eigen::Matrix<T, n, 1>;
  using unknowns = std::vector<unknown>;
  using matrix = wide_block_tridiagonal<R, n, own + 1>;

  /// \param u  increasing, as many as `ends` need or more
  /// \param q  as many unit elements, signs aligned
  rotation_vector_equations(const std::vector<R>& u, const std::vector<quaternion<T>>& q,
                            const ends_type& ends)
      : ends_(ends), reach_(ends.reach()), last_(u.size() - 1) {
    using std::frexp;
    using std::ldexp;
    int exponent = 0;
    static_cast<void>(frexp(R((u.back() - u.front()) / R(last_)), &exponent));
    unit_ = ldexp(R(1), exponent);
    steps_.reserve(last_);
    turns_.reserve(last_);
    for (std::size_t i = 0; i < last_; ++i) {
      steps_.push_back((u[i + 1] - u[i]) / unit_);
      turns_.push_back(log_vector(turn_between(q[i], q[i + 1]), "interpolate"));
    }
    make_pieces();
  }

  /// Number of unknowns, one a knot, and of equations.
  [[nodiscard]] std::size_t size() const { return last_ + (ends_.is_cyclic ? 0 : 1); }

  /// The same for a motion that turns less: turns from row to row and rates at the ends times λ.
  [[nodiscard]] rotation_vector_equations scaled(const R& lambda) const {
    rotation_vector_equations result = *this;
    for (vector3<T>& turn : result.turns_) {
      turn = detail::scaled(lambda, turn);
    }
    for (auto& end : result.ends_.given) {
      for (vector3<T>& rate : end) {
        rate = detail::scaled(lambda, rate);
      }
    }
    result.make_pieces();
    return result;
  }

  /// The longest interval of the parameter as a multiple of the shortest.
  [[nodiscard]] R unevenness() const {
    const auto [shortest, longest] = std::minmax_element(steps_.begin(), steps_.end());
    return *longest / *shortest;
  }

  /// How large a step from x is in relation to what it changes. For real T.
  [[nodiscard]] R relative_step(const unknowns& x, const unknowns& step) const {
    return relative_step_of_rates(x, step, turns_, steps_);
  }

  /// The largest turn from one row to the next, rad, and the row it starts from.
  [[nodiscard]] std::pair<R, std::size_t> largest_turn() const {
    using std::sqrt;
    std::pair<R, std::size_t> largest{R(-1), 0};
    for (std::size_t i = 0; i < last_; ++i) {
      const R angle = 2 * sqrt(R(innermost(inner_product(turns_[i], turns_[i]))));
      if (angle > largest.first) {
        largest = {angle, i};
      }
    }
    return largest;
  }

  /// Where Newton's method starts: the rates of parabolas through three rows, as if turns were
  /// small.
  [[nodiscard]] unknowns start() const {
    unknowns x(size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t left = i > 0 ? i - 1 : ends_.is_cyclic ? last_ - 1 : 0;
      const std::size_t right = i < last_ ? i : last_ - 1;
      const vector3<T> before = turns_[left] / steps_[left];
      const vector3<T> after = turns_[right] / steps_[right];
      const R h = steps_[left] + steps_[right];
      x[i].template head<3>() = (before * steps_[right] + after * steps_[left]) / h;
      if constexpr (own > 1) {
        x[i].template tail<3>() = (after - before) * (2 / h);
      }
    }
    return x;
  }

  /// What x leaves of the equations.
  void residuals(const unknowns& x, unknowns& r) const {
    r.assign(x.size(), unknown::Constant(T(R(0))));
    for_each_term<T>(
        [&](std::size_t k, std::size_t i) { return rates_of(x[(i + k) % x.size()]); },
        [&](std::size_t row, std::size_t part, int sign, const vector3<T>& value, std::size_t) {
          for (int a = 0; a < 3; ++a) {
            r[row][3 * int(part) + a] += sign * value[a];
          }
        });
    subtract_given(r);
  }

  /// Residuals and factorised Jacobian; false where that is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    static_assert(Real<T>);
    using tag = derivative_tag<rotation_vector_equations>;
    using D = dual<R, 2 * n, tag>;
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
          for (int a = 0; a < n; ++a) {
            result[std::size_t(a) / 3][a % 3] = D::variable(values[a], int(k) * n + a);
          }
          return result;
        },
        [&](std::size_t row, std::size_t part, int sign, const vector3<D>& value, std::size_t i) {
          const bool is_end = !ends_.is_cyclic && (row == 0 || row == last_);
          for (const std::size_t k : {0, 1}) {
            block& target = is_end     ? row == 0 ? ends[0][i + k] : ends[1][last_ - i - k]
                                : row == i ? k == 0 ? rows[row].diagonal : rows[row].upper
                            : k == 0   ? rows[row].lower
                                       : rows[row].diagonal;
            for (int a = 0; a < 3; ++a) {
              for (int b = 0; b < n; ++b) {
                target(3 * int(part) + a, b) += sign * value[a].partial(int(k) * n + b);
              }
            }
          }
          for (int a = 0; a < 3; ++a) {
            r[row][3 * int(part) + a] += sign * value[a].value();
          }
        });
    subtract_given(r);
    return ends_.is_cyclic ? jacobian.factorise_cyclic() : jacobian.factorise(ends, reach_ + 1);
  }

  /// The curve's polynomials as `rotation_vector_spline` takes them, in units of the parameter.
  /// Those that meet at a knot are made of the same numbers there.
  [[nodiscard]] std::vector<polynomial> polynomials(const unknowns& x) const {
    std::vector<polynomial> result;
    result.reserve(last_);
    for (std::size_t i = 0; i < last_; ++i) {
      result.push_back(
          pieces_[i].template polynomial<T>(rates_of(x[i]), rates_of(x[(i + 1) % x.size()])));
    }
    if constexpr (Order == 4) {
      share_accelerations(pieces_, steps_, x.size(), result);
    }
    for (polynomial& each : result) {
      R per_unit(1);
      for (vector3<T>& coefficient : each) {
        coefficient = detail::scaled(per_unit, coefficient);
        per_unit /= unit_;
      }
    }
    return result;
  }

private:
  void make_pieces() {
    pieces_.clear();
    pieces_.reserve(last_);
    for (std::size_t i = 0; i < last_; ++i) {
      pieces_.emplace_back(steps_[i], turns_[i]);
    }
  }

  /// Every vector equation, term by term: take(row, part, sign, value, i) with a derivative of w at
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
    for (std::size_t k = 0; k < own; ++k) {
      if (ends_.is_cyclic || i > 0) {
        take(i, k, -1, w.start[own + k], i);
      }
      if (ends_.is_cyclic || i + 1 < last_) {
        take(i + 1 == last_ ? 0 : i + 1, k, 1, w.end[own + k], i);
      }
    }
  }

  /// What piece i contributes to the equations of the ends.
  template <class Rates, class Take>
  void end_terms(std::size_t i, const Rates& w, Take&& take) const {
    for (std::size_t k = 0; k < own; ++k) {
      const auto [joint, derivative] = ends_.equations[k];
      if (joint == i) {
        take(0, k, joint > 0 ? -1 : 1, w.start[derivative], i);
      }
      if (joint == i + 1) {
        take(0, k, 1, w.end[derivative], i);
      }
      if (joint > 0 && i + joint == last_) {
        take(last_, k, -1, w.start[derivative], i);
      }
      if (i + joint + 1 == last_) {
        take(last_, k, 1, w.end[derivative], i);
      }
    }
  }

  /// What is given at the ends, on the other side of the equations.
  void subtract_given(unknowns& r) const {
    for (std::size_t k = 0; k < own && !ends_.is_cyclic; ++k) {
      const R scale = ends_.equations[k].derivative == 0 ? unit_ : R(unit_ * unit_);
      for (int a = 0; a < 3; ++a) {
        r.front()[3 * int(k) + a] -= ends_.given[0][k][a] * scale;
        r.back()[3 * int(k) + a] -= ends_.given[1][k][a] * scale;
      }
    }
  }

  [[nodiscard]] static knot_rates<T> rates_of(const unknown& y) {
    knot_rates<T> result;
    for (int a = 0; a < n; ++a) {
      result[std::size_t(a) / 3][a % 3] = y[a];
    }
    return result;
  }

  ends_type ends_;
  std::size_t reach_, last_;
  R unit_;
  std::vector<R> steps_;
  std::vector<vector3<T>> turns_;
  std::vector<piece> pieces_;
};

} // namespace duet::detail
