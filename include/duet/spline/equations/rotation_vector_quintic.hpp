// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/blocks/band_lu.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/equations/curve_equations.hpp>
#include <duet/spline/equations/quintic_piece.hpp>
#include <duet/spline/equations/rotation_vector_equations.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Equations for the rates at the knots of a quintic rotation-vector spline.

namespace duet::detail {

/// Equations for all rates w_0 … w_3 that the segments share at each knot: those of every segment,
/// and two at each end. With w_0 and w_1 as the only unknowns, w_2 and w_3 would be differences
/// divided by powers of h, which lose all digits for a segment much shorter than its neighbours.
template <class T>
class rotation_vector_quintic_equations : public rotation_vector_equations<T, 6, quintic_piece<T>> {
  using piece = quintic_piece<T>;
  using base = rotation_vector_equations<T, 6, piece>;
  using base::ends_, base::steps_, base::pieces_;
  using typename base::R;
  static constexpr std::size_t count = piece::count;
  static constexpr int n = 3 * int(count);

public:
  using curve_type = rotation_vector_spline<T, 6>;
  using unknown = Eigen::Matrix<T, n, 1>;
  using unknowns = std::vector<unknown>;
  using matrix = block_band_lu<R, n>;

  rotation_vector_quintic_equations(const std::vector<R>& u, const std::vector<quaternion<T>>& q,
                                    const curve_ends<T>& ends)
      : base(u, q, ends), lengths_(this->knots(), R(0)) {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      for (const std::size_t knot : {i, next(i)}) {
        lengths_[knot] = std::max(lengths_[knot], steps_[i]);
      }
    }
  }

  /// Initial guess of Newton's method: rates of parabolas through three samples, as for small
  /// rotations.
  [[nodiscard]] unknowns start() const {
    unknowns x(lengths_.size(), unknown::Zero());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto [velocity, acceleration] = this->parabola(i);
      x[i].template head<3>() = velocity;
      x[i].template segment<3>(3) = acceleration;
    }
    return x;
  }

  /// Residuals of the equations at x: of each piece, then of the ends.
  void residuals(const unknowns& x, unknowns& r) const {
    r.assign(x.size(), unknown::Constant(T(R(0))));
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto of_piece = pieces_[i].residuals(taylor(i, x), scale_of(i));
      for (std::size_t m = 0; m < count; ++m) {
        r[i].template segment<3>(3 * int(m)) = of_piece[m];
      }
    }
    for_each_end_equation([&](std::size_t end, std::size_t k, std::size_t knot, const R& scale) {
      vector3<T> of_end;
      const auto [joint, derivative] = ends_.equations[k];
      if (joint == 0) {
        of_end =
            rates(x[knot])[derivative] - ends_.values[end][k] * T(this->unit_to(derivative + 1));
      } else {
        const auto before = pieces_[knot - 1].last_rate_at_end(taylor(knot - 1, x));
        const auto after = pieces_[knot].last_rate_at_start(taylor(knot, x));
        of_end = before[0] + before[1] - after[0] - after[1];
      }
      r.back().template segment<3>(end_row(end, k)) = (scale * components(of_end)).eigen();
    });
  }

  /// Computes residuals and the factorised Jacobian; false if it is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    static_assert(Real<T>);
    using equations = typename matrix::equations;
    using panel = typename matrix::panel;
    residuals(x, r);
    // Adds factor · v to three rows.
    const auto add = [](auto&& rows, const R& factor, const typename piece::gradient& v) {
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < n; ++b) {
          rows(a, b) += factor * v(a, b);
        }
      }
    };
    std::vector<equations> groups;
    groups.reserve(pieces_.size() + 4);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto e = pieces_[i].taylor_gradients(taylor(i, x));
      const auto of_x = pieces_[i].factors_of_start(scale_of(i));
      const auto of_y = pieces_[i].factors_of_end(scale_of(i));
      panel at_start = panel::Zero(n, n), at_end = at_start;
      for (std::size_t m = 0; m < count; ++m) {
        for (std::size_t k = 0; k < count; ++k) {
          add(at_start.template middleRows<3>(3 * Eigen::Index(m)), of_x[m][k], e.x[k]);
          add(at_end.template middleRows<3>(3 * Eigen::Index(m)), of_y[m][k], e.y[k]);
        }
      }
      equations group{i, i * std::size_t(n), {}, {}};
      if (!ends_.is_cyclic || i + 2 < pieces_.size()) {
        group.coefficients.resize(n, 2 * n);
        group.coefficients << at_start, at_end;
      } else if (i + 2 == pieces_.size()) {
        group.coefficients = at_start;
        group.of_last = at_end;
      } else { // from the last knot to the first one
        group.first = 0;
        group.coefficients = at_end;
        group.of_last = at_start;
      }
      groups.push_back(std::move(group));
    }
    for_each_end_equation([&](std::size_t end, std::size_t k, std::size_t knot, const R& scale) {
      const auto [joint, derivative] = ends_.equations[k];
      const std::size_t row = pieces_.size() * std::size_t(n) + std::size_t(end_row(end, k));
      equations group{joint == 0 ? knot : knot - 1, row, {}, {}};
      if (joint == 0) {
        group.coefficients = panel::Zero(3, n);
        group.coefficients.template middleCols<3>(3 * Eigen::Index(derivative))
            .diagonal()
            .fill(scale);
      } else {
        group.coefficients = panel::Zero(3, 3 * n);
        const auto of = [&](int at) { return group.coefficients.template middleCols<n>(at * n); };
        const auto before = pieces_[knot - 1].gradients_of_last_rate_at_end(taylor(knot - 1, x));
        const auto after = pieces_[knot].gradients_of_last_rate_at_start(taylor(knot, x));
        add(of(0), scale, before[0]);
        add(of(1), scale, before[1]);
        add(of(1), R(-scale), after[0]);
        add(of(2), R(-scale), after[1]);
      }
      groups.push_back(std::move(group));
    });
    return jacobian.factorise(units(), std::move(groups), ends_.is_cyclic);
  }

  [[nodiscard]] curve_type curve(const std::vector<R>& u, std::vector<quaternion<T>> q,
                                 const unknowns& x) const {
    std::vector<std::array<vector3<T>, 6>> pieces(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      pieces[i] = pieces_[i].polynomial(taylor(i, x));
    }
    return this->made_of(u, std::move(q), std::move(pieces));
  }

private:
  [[nodiscard]] std::size_t next(std::size_t i) const { return (i + 1) % lengths_.size(); }
  /// Factor that scales the rates at a piece's ends to one size.
  [[nodiscard]] R scale_of(std::size_t i) const { return std::min(lengths_[i], lengths_[next(i)]); }

  /// Rates at a knot.
  [[nodiscard]] static typename piece::coefficients rates(const unknown& x) {
    typename piece::coefficients result;
    for (int a = 0; a < n; ++a) {
      result[std::size_t(a / 3)][a % 3] = x[a];
    }
    return result;
  }

  /// Taylor coefficients of piece i for the rates at its knots.
  [[nodiscard]] auto taylor(std::size_t i, const unknowns& x) const {
    return pieces_[i].taylor(rates(x[i]), rates(x[next(i)]));
  }

  /// Calls f(end, k, knot, scale) for equation k of either end at its knot, with the factor that
  /// scales it to the size of the other equations.
  template <class F>
  void for_each_end_equation(F&& f) const {
    for (std::size_t end = 0; end < 2 && !ends_.is_cyclic; ++end) {
      for (std::size_t k = 0; k < 2; ++k) {
        const auto [joint, derivative] = ends_.equations[k];
        const std::size_t knot = end == 0 ? joint : pieces_.size() - joint;
        R scale(1);
        if (joint == 0) {
          for (std::size_t i = 0; i < derivative; ++i) {
            scale *= lengths_[knot];
          }
        } else {
          const R l = std::min({lengths_[knot - 1], lengths_[knot], lengths_[knot + 1]});
          scale = std::min(steps_[knot - 1], steps_[knot]) * l * l * l;
        }
        f(end, k, knot, scale);
      }
    }
  }
  [[nodiscard]] static int end_row(std::size_t end, std::size_t k) {
    return 6 * int(end) + 3 * int(k);
  }

  /// Units of the unknowns at each knot: the rates of a rotation by 1 over the longer adjacent
  /// segment.
  [[nodiscard]] std::vector<typename matrix::block> units() const {
    std::vector<typename matrix::block> result(lengths_.size());
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      R power(1);
      for (int k = 0; k < int(count); ++k) {
        result[i].template segment<3>(3 * k).fill(power);
        power /= lengths_[i];
      }
    }
    return result;
  }

  std::vector<R> lengths_; ///< length of the longer piece at each knot
};

template <class Own, class T>
struct equations_of<rotation_vector_spline<Own, 6>, T> {
  using type = rotation_vector_quintic_equations<T>;
};

} // namespace duet::detail
