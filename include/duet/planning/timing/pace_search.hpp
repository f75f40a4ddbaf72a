// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/planning/timing/pace_bounds.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// The quickest pace within bounds. For those who extend duet.

namespace duet::detail {

/// One bound on a pace: |x| + beyond ≤ limit, with the derivatives of all three by its coefficients
/// from `first` on. Of an order n it is that of the n-th derivative by time.
struct pace_bound {
  int order;
  std::size_t first;
  double limit, beyond, x;
  const pace_row &limit_by, &beyond_by, &x_by;
};

/// A pace within bounds that becomes quicker and never leaves them, so that it may stop at any
/// time. Each step is one of Newton's method for weight · time − Σ log(what is left of limits), in
/// which second derivatives that may be negative are left out, halved until it stays inside.
///
/// A limit in proportion to 1 / √p of the pace p is replaced by (3 m − p) / (2 m √m), its tangent
/// at the pace m in the middle of a piece, which is below it.
class pace_search {
public:
  /// From a constant pace that is slow enough: in a time k times as long velocities, accelerations
  /// and jerks are k, k² and k³ times as small. \param bounds  has to outlive it
  explicit pace_search(const pace_bounds& bounds)
      : bounds_(bounds), pace_(bounds.pieces.back().first + 3, 1.0) {
    double stretch = 0;
    for_each_bound(pace_, [&](const pace_bound& b) {
      stretch = std::max(stretch, std::pow((std::abs(b.x) + b.beyond) / b.limit, 1.0 / b.order));
    });
    std::fill(pace_.begin(), pace_.end(), .7 / (stretch * stretch));
  }

  /// The coefficients of a pace that is nearly the quickest: what bounds are kept off their limits
  /// costs less than a thousandth of the time.
  [[nodiscard]] const std::vector<double>& quickest() {
    const double unit = double(bounds_.pieces.size()) / time(pace_);
    for (double weight = 40 * unit; weight < 1e4 * unit; weight *= 4) {
      for (int steps = 0; steps < 60 && step(weight) > .1; ++steps) {
      }
    }
    return pace_;
  }

private:
  /// The first derivatives of a function of the coefficients, and a band of second ones: (i, i),
  /// (i, i + 1) and (i, i + 2).
  struct model {
    std::vector<double> gradient;
    std::vector<pace_row> matrix;

    explicit model(std::size_t n) : gradient(n), matrix(n) {}
    /// Of f of what is linear in the coefficients: f' and f''.
    void add(std::size_t first, const pace_row& by, double slope, double curvature) {
      for (std::size_t i = 0; i < 3; ++i) {
        gradient[first + i] += slope * by[i];
        for (std::size_t j = i; j < 3; ++j) {
          matrix[first + i][j - i] += curvature * by[i] * by[j];
        }
      }
    }
    /// Where it is least: the matrix is L D Lᵀ.
    [[nodiscard]] std::vector<double> solution() {
      const std::size_t n = gradient.size();
      matrix[n - 1][1] = matrix[n - 1][2] = matrix[n - 2][2] = 0;
      std::vector<double> x(n + 2);
      for (std::size_t i = 0; i < n; ++i) {
        auto& [d, one, two] = matrix[i];
        x[i] -= gradient[i];
        if (i + 1 < n) {
          matrix[i + 1][0] -= one * one / d;
          matrix[i + 1][1] -= one * two / d;
        }
        if (i + 2 < n) {
          matrix[i + 2][0] -= two * two / d;
        }
        one /= d;
        two /= d;
        x[i + 1] -= one * x[i];
        x[i + 2] -= two * x[i];
      }
      x.resize(n);
      for (std::size_t i = n; i-- > 0;) {
        x[i] /= matrix[i][0];
        for (std::size_t k = 1; k < 3 && i + k < n; ++k) {
          x[i] -= matrix[i][k] * x[i + k];
        }
      }
      return x;
    }
  };

  void for_each_bound(const std::vector<double>& pace, const auto& f) const {
    static constexpr pace_row zero{};
    const joint_bounds* joint = bounds_.joints.data();
    const std::size_t joints = bounds_.joints.size() / bounds_.pieces.size();
    for (const piece_bounds& piece : bounds_.pieces) {
      const double* c = &pace[piece.first];
      const pace_row row = middle_of(piece);
      const double m = times(row, c), scale = 1 / (m * std::sqrt(m));
      std::array<double, 3> limit;
      std::array<pace_row, 3> limit_by;
      for (std::size_t r = 0; r < 3; ++r) {
        const double p = times(piece.pace[r], c);
        limit[r] = (3 * m - p) * scale / 2;
        for (std::size_t i = 0; i < 3; ++i) {
          limit_by[r][i] = (1.5 * (p / m - 1) * row[i] - piece.pace[r][i]) * scale / 2;
        }
        f(pace_bound{1, piece.first, limit[r], 0, piece.rate[r], limit_by[r], zero, zero});
      }
      for (std::size_t j = 0; j < joints; ++j, ++joint) {
        const double change = times(joint->beyond_acceleration, c);
        const double jerk = times(joint->beyond_jerk, c);
        for (std::size_t r = 0; r < 3; ++r) {
          f(pace_bound{2, piece.first, 1, change, times(joint->acceleration[r], c), zero,
                       joint->beyond_acceleration, joint->acceleration[r]});
          f(pace_bound{3, piece.first, limit[r], jerk, times(joint->jerk[r], c), limit_by[r],
                       joint->beyond_jerk, joint->jerk[r]});
        }
      }
    }
  }
  [[nodiscard]] static pace_row middle_of(const piece_bounds& piece) {
    pace_row result;
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = (piece.pace[0][i] + 2 * piece.pace[1][i] + piece.pace[2][i]) / 4;
    }
    return result;
  }
  void for_each_middle(const std::vector<double>& pace, const auto& f) const {
    for (const piece_bounds& piece : bounds_.pieces) {
      const pace_row row = middle_of(piece);
      f(piece, row, times(row, &pace[piece.first]));
    }
  }

  [[nodiscard]] double time(const std::vector<double>& pace) const {
    double result = 0;
    for_each_middle(pace, [&](const piece_bounds& piece, const pace_row&, double m) {
      result += piece.length / std::sqrt(m);
    });
    return result;
  }
  /// Of limits in proportion to 1 / √pace half a logarithm of the pace each goes off: else these
  /// would be the farther off the slower it is.
  [[nodiscard]] double rooted_limits() const {
    return 3 * (1 + double(bounds_.joints.size()) / double(bounds_.pieces.size()));
  }

  /// What is to be least, infinite outside the bounds.
  [[nodiscard]] double value(const std::vector<double>& pace, double weight) const {
    double sum = weight * time(pace), product = 1;
    bool is_inside = true;
    const auto take = [&](double factor) {
      is_inside = is_inside && factor > 0;
      product *= factor;
      if (!(product > 1e-100 && product < 1e100)) {
        sum -= std::log(product);
        product = 1;
      }
    };
    std::for_each(pace.begin(), pace.end(), take);
    for_each_bound(pace, [&](const pace_bound& b) {
      const double limit = b.limit - b.beyond;
      is_inside = is_inside && limit > 0;
      take((limit - b.x) * (limit + b.x));
    });
    for_each_middle(pace, [&](const piece_bounds&, const pace_row&, double m) {
      sum -= rooted_limits() * std::log(m);
    });
    return is_inside ? sum - std::log(product) : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] model model_of(double weight) const {
    model result(pace_.size());
    for (std::size_t i = 0; i < pace_.size(); ++i) {
      const double inverse = 1 / pace_[i];
      result.gradient[i] -= inverse;
      result.matrix[i][0] += inverse * inverse;
    }
    for_each_bound(pace_, [&](const pace_bound& b) {
      const double limit = b.limit - b.beyond;
      for (const int sign : {-1, 1}) {
        const double inverse = 1 / (limit + sign * b.x);
        pace_row by;
        for (std::size_t i = 0; i < 3; ++i) {
          by[i] = b.limit_by[i] - b.beyond_by[i] + sign * b.x_by[i];
        }
        result.add(b.first, by, -inverse, inverse * inverse);
      }
    });
    for_each_middle(pace_, [&](const piece_bounds& piece, const pace_row& row, double m) {
      const double by_time = weight * piece.length / (2 * m * std::sqrt(m));
      result.add(piece.first, row, -by_time - rooted_limits() / m,
                 (1.5 * by_time + rooted_limits() / m) / m);
    });
    return result;
  }

  /// \return by how much the model falls, twice; 0 where no step is found
  double step(double weight) {
    model here = model_of(weight);
    const std::vector<double> slope = here.gradient, way = here.solution();
    double fall = 0;
    for (std::size_t i = 0; i < way.size(); ++i) {
      fall -= slope[i] * way[i];
    }
    const double before = value(pace_, weight);
    std::vector<double> next(way.size());
    for (double part = 1; part > 1e-6; part /= 2) {
      for (std::size_t i = 0; i < way.size(); ++i) {
        next[i] = pace_[i] + part * way[i];
      }
      if (value(next, weight) < before - 1e-3 * part * fall) {
        pace_ = next;
        return fall;
      }
    }
    return 0;
  }

  const pace_bounds& bounds_;
  std::vector<double> pace_;
};

} // namespace duet::detail
