// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/oracles_of_curves.hpp"

namespace duet_test::accuracy::oracle {

namespace {

jet_quaternion derivative(const jet_quaternion& q) {
  jet_quaternion r;
  for (std::size_t i = 0; i < 4; ++i) {
    r[i] = accuracy::derivative(q[i]);
  }
  return r;
}
jet_quaternion operator+(const jet_quaternion& a, const jet_quaternion& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}
jet_quaternion operator-(const jet_quaternion& a, const jet_quaternion& b) {
  return a + b * jet(-1);
}
jet_quaternion unit(const jet_quaternion& q) { return q * (jet(1) / sqrt(squared_norm(q))); }
/// The n-th derivative at t = 0, without higher powers of t.
jet_quaternion at_zero(jet_quaternion q, int n) {
  for (; n > 0; --n) {
    q = derivative(q);
  }
  for (jet& each : q) {
    for (std::size_t k = 0; k < each.c.size(); ++k) {
      each.c[k] = jet_shape::current->monomials[k][0] > 0 ? real(0) : each.c[k];
    }
  }
  return q;
}
/// 2 Q* Q′ and 2 Q′ Q*
jet_quaternion body_rate(const jet_quaternion& q) { return conj(q) * derivative(q) * jet(2); }
jet_quaternion spatial_rate(const jet_quaternion& q) { return derivative(q) * conj(q) * jet(2); }

void append_real_and_dual(jets& result, const jet_quaternion& q, std::size_t first, over what) {
  for (std::size_t i = first; i < 4; ++i) {
    result.push_back(without_epsilon(q[i]));
  }
  for (std::size_t i = first; i < 4 && what == over::poses; ++i) {
    result.push_back(epsilon_part(q[i]));
  }
}

/// The inverse of a matrix by Gauss–Jordan elimination.
std::vector<std::vector<real>> inverse(std::vector<std::vector<real>> a) {
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i) {
    a[i].resize(2 * n, real(0));
    a[i][n + i] = 1;
  }
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) {
      pivot = abs(a[i][k]) > abs(a[pivot][k]) ? i : pivot;
    }
    std::swap(a[k], a[pivot]);
    const real reciprocal = 1 / a[k][k];
    for (std::size_t j = k; j < 2 * n; ++j) {
      a[k][j] *= reciprocal;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const real factor = a[i][k];
      for (std::size_t j = k; j < 2 * n && i != k && factor != 0; ++j) {
        if (a[k][j] != 0) {
          a[i][j] -= factor * a[k][j];
        }
      }
    }
  }
  for (auto& row : a) {
    row.erase(row.begin(), row.begin() + std::ptrdiff_t(n));
  }
  return a;
}

jet_quaternion element_at(const jets& x, std::size_t first, over what) {
  jet_quaternion q;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = what == over::poses ? with_epsilon(x[first + i], x[first + i + 4]) : x[first + i];
  }
  return q;
}
/// A pure quaternion.
jet_quaternion increment_at(const jets& x, std::size_t first, over what) {
  jet_quaternion q{0, 0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    q[i + 1] = what == over::poses ? with_epsilon(x[first + i], x[first + i + 3]) : x[first + i];
  }
  return q;
}

/// P2
jet_quaternion cumulative(const std::vector<double>& knots, const jet_quaternion& first,
                          const std::vector<jet_quaternion>& increments, const jet& u) {
  // P1 from order 1, where only the function of the span itself is not zero.
  const std::size_t k = knots.size() / 2;
  std::vector<jet> b(k, jet(0));
  b[k - 1] = jet(1);
  for (std::size_t r = 2; r <= k; ++r) {
    for (std::size_t i = k - r; i < k; ++i) {
      jet sum(0);
      if (i + r > k) {
        sum = b[i] * (u - jet(real(knots[i]))) * jet(real(1 / (real(knots[i + r - 1]) - knots[i])));
      }
      if (i + 1 < k) {
        sum = sum + b[i + 1] * (jet(real(knots[i + r])) - u) *
                        jet(real(1 / (real(knots[i + r]) - knots[i + 1])));
      }
      b[i] = sum;
    }
  }
  jet_quaternion q = first;
  for (std::size_t i = 1; i < k; ++i) {
    jet sum(0);
    for (std::size_t j = i; j < k; ++j) {
      sum = sum + b[j];
    }
    q = q * exp(increments[i - 1] * sum);
  }
  return q;
}

/// Q exp(x_1 t + x_2 t² + …)
jet_quaternion piece(const jet_quaternion& start, const std::vector<jet_quaternion>& x,
                     const jet& t) {
  jet_quaternion sum{0, 0, 0, 0};
  for (std::size_t m = x.size(); m-- > 0;) {
    sum = (sum + x[m]) * t;
  }
  return start * exp(sum);
}

jets motion(const jet_quaternion& q, over what) {
  jets result;
  append_real_and_dual(result, q, 0, what);
  append_real_and_dual(result, spatial_rate(q), 1, what);
  append_real_and_dual(result, body_rate(q), 1, what);
  if (what == over::poses) {
    jet_quaternion p, d;
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = without_epsilon(q[i]);
      d[i] = epsilon_part(q[i]);
    }
    const jet_quaternion t = derivative(d * conj(p) * jet(2));
    result.insert(result.end(), t.begin() + 1, t.end());
  }
  return result;
}

std::vector<jet_quaternion> increments_from(const jets& x, std::size_t first, over what) {
  std::vector<jet_quaternion> result;
  for (; first < x.size(); first += what == over::poses ? 6 : 3) {
    result.push_back(increment_at(x, first, what));
  }
  return result;
}

} // namespace

oracle_function cumulative_motion(std::vector<double> knots, over what) {
  return [=](const jets& x) {
    const auto increments = increments_from(x, what == over::poses ? 9 : 5, what);
    return motion(cumulative(knots, element_at(x, 1, what), increments, x[0]), what);
  };
}
oracle_function piece_motion(double from, over what) {
  return [=](const jets& x) {
    const auto coefficients = increments_from(x, what == over::poses ? 9 : 5, what);
    return motion(piece(element_at(x, 1, what), coefficients, x[0] - jet(real(from))), what);
  };
}

interpolation::interpolation(int order, ends e, over what, std::vector<double> u,
                             std::vector<double> start)
    : order_(order), ends_(e), what_(what), u_(std::move(u)) {
  jets x;
  for (const double each : start) {
    x.emplace_back(real(each));
  }
  if (order_ > 0) { // in powers of t divided by the length of the piece
    for (std::size_t i = 0; i < x.size(); i += numbers()) {
      const std::size_t n = i / numbers(), pieces = std::size_t(order_) - 1;
      const real h = real(u_[n / pieces + 1]) - u_[n / pieces];
      solution_.push_back(increment_at(x, i, what_) * jet(real(pow(h, int(n % pieces) + 1))));
    }
    return;
  }
  const std::size_t size = what_ == over::poses ? 8 : 4;
  for (std::size_t i = 0; i < x.size(); i += size) {
    guess_.push_back(unit(element_at(x, i, what_)));
    solution_.push_back({0, 0, 0, 0});
  }
  knots_ = u_;
  if (ends_ == ends::not_a_knot) {
    knots_.erase(knots_.end() - 2);
    knots_.erase(knots_.begin() + 1);
  }
  const double first = u_.front(), last = u_.back();
  const std::size_t n = u_.size() - 1;
  for (std::size_t i = 1; i < 4; ++i) { // beyond the ends: periodic or repeated knots
    const bool is_periodic = ends_ == ends::periodic;
    knots_.insert(knots_.begin(), is_periodic ? first - (last - u_[n - i]) : first);
    knots_.push_back(is_periodic ? last + (u_[i] - first) : last);
  }
}

jet_quaternion interpolation::at(const jets& x, const std::vector<jet_quaternion>& unknowns,
                                 std::size_t span, const jet& u) const {
  const std::size_t size = what_ == over::poses ? 8 : 4;
  if (order_ > 0) {
    const std::size_t pieces = std::size_t(order_) - 1;
    const auto first = unknowns.begin() + std::ptrdiff_t(span * pieces);
    const jet from{real(u_[span])}, length{real(real(u_[span + 1]) - u_[span])};
    return piece(unit(element_at(x, span * size, what_)), {first, first + std::ptrdiff_t(pieces)},
                 (u - from) / length);
  }
  std::vector<jet_quaternion> controls, increments;
  for (std::size_t i = span; i < span + 4; ++i) {
    controls.push_back(guess_[i] * exp(unknowns[i]));
    if (i > span) {
      increments.push_back(log(conj(controls[i - 1 - span]) * controls[i - span]));
    }
  }
  const auto first = knots_.begin() + std::ptrdiff_t(span);
  return cumulative({first, first + 8}, controls[0], increments, u);
}

/// Error at the i-th row, for either sign of its quaternion.
jet_quaternion interpolation::miss(const jets& x, std::size_t i, const jet_quaternion& q) const {
  const std::size_t size = what_ == over::poses ? 8 : 4;
  const bool is_closing = ends_ == ends::periodic && i + 1 == u_.size();
  const jet_quaternion row = unit(element_at(x, is_closing ? 0 : i * size, what_));
  const jet_quaternion between = conj(row) * at_zero(q, 0);
  return log(between * jet(between[0].c[0] < 0 ? -1 : 1));
}

jets interpolation::residuals(const jets& x, const std::vector<jet_quaternion>& unknowns) const {
  return order_ > 0 ? residuals_of_pieces(x, unknowns) : residuals_of_cubic(x, unknowns);
}

jets interpolation::residuals_of_cubic(const jets& x,
                                       const std::vector<jet_quaternion>& unknowns) const {
  const std::size_t size = what_ == over::poses ? 8 : 4, rows = u_.size();
  const std::size_t spans = knots_.size() - 7;
  jets result;
  const auto require_zero = [&](const jet_quaternion& q) {
    result.insert(result.end(), q.begin() + 1, q.end());
  };
  std::vector<jet_quaternion> at_ends;
  for (std::size_t i = 0; i < rows; ++i) {
    std::size_t span = 0;
    while (span + 1 < spans && knots_[span + 4] <= u_[i]) {
      ++span;
    }
    const jet_quaternion q = at(x, unknowns, span, jet(real(u_[i])) + t_variable());
    require_zero(miss(x, i, q));
    if (i == 0 || i + 1 == rows) {
      at_ends.push_back(q);
    }
  }
  const std::size_t first_rate = rows * size;
  const std::size_t each = numbers();
  for (std::size_t end = 0; end < 2; ++end) {
    const jet_quaternion& q = at_ends[end];
    switch (ends_) {
    case ends::natural:
      require_zero(at_zero(body_rate(q), 1));
      break;
    case ends::clamped:
      require_zero(at_zero(spatial_rate(q), 0) - increment_at(x, first_rate + end * each, what_));
      break;
    case ends::accelerated:
      require_zero(at_zero(spatial_rate(q), 1) - increment_at(x, first_rate + end * each, what_));
      break;
    case ends::periodic:
      require_zero(at_zero(body_rate(at_ends[0]), int(end)) -
                   at_zero(body_rate(at_ends[1]), int(end)));
      break;
    default: // fewer knots, no end conditions
      break;
    }
  }
  return result;
}

jets interpolation::residuals_of_pieces(const jets& x,
                                        const std::vector<jet_quaternion>& unknowns) const {
  const std::size_t size = what_ == over::poses ? 8 : 4, pieces = u_.size() - 1;
  const int highest = order_ - 2;
  jets result;
  const auto require_zero = [&](const jet_quaternion& q) {
    result.insert(result.end(), q.begin() + 1, q.end());
  };
  std::vector<jet_quaternion> starts, ends_of;
  for (std::size_t i = 0; i < pieces; ++i) {
    starts.push_back(at(x, unknowns, i, jet(real(u_[i])) + t_variable()));
    ends_of.push_back(at(x, unknowns, i, jet(real(u_[i + 1])) + t_variable()));
    require_zero(miss(x, i + 1, ends_of[i]));
  }
  // Requires equal derivatives of the body rate on both sides of a knot.
  const auto require_join = [&](std::size_t before, std::size_t after, int derivative) {
    require_zero(at_zero(body_rate(ends_of[before]), derivative) -
                 at_zero(body_rate(starts[after]), derivative));
  };
  for (std::size_t i = 0; i < pieces; ++i) {
    for (int d = 0; d < highest && (i + 1 < pieces || ends_ == ends::periodic); ++d) {
      require_join(i, (i + 1) % pieces, d);
    }
  }
  const std::size_t first_rate = u_.size() * size, each = numbers();
  for (std::size_t end = 0; end < 2 && ends_ != ends::periodic; ++end) {
    const jet_quaternion& q = end == 0 ? starts.front() : ends_of.back();
    const auto require_rate = [&](int derivative, std::size_t which) {
      require_zero(at_zero(spatial_rate(q), derivative) -
                   increment_at(x, first_rate + (2 * which + end) * each, what_));
    };
    const auto require_join_at = [&](std::size_t joint) {
      const std::size_t after = end == 0 ? joint : pieces - joint;
      require_join(after - 1, after, highest);
    };
    if (ends_ == ends::natural) {
      require_zero(at_zero(body_rate(q), 1));
      if (order_ == 6) {
        require_zero(at_zero(body_rate(q), 3));
      }
      continue;
    }
    if (ends_ == ends::clamped || ends_ == ends::fully_clamped) {
      require_rate(0, 0);
    } else if (ends_ == ends::accelerated) {
      require_rate(1, 0);
    } else {
      require_join_at(1);
    }
    if (ends_ == ends::fully_clamped) {
      require_rate(1, 1);
    } else if (order_ == 6) {
      require_join_at(ends_ == ends::not_a_knot ? 2 : 1);
    }
  }
  return result;
}

void interpolation::solve(const jets& x) {
  if (inverse_.empty()) {
    // Jacobian by differences of real parts, exact to 40 digits and without ε.
    jets real_x;
    for (const jet& each : x) {
      real_x.push_back(accuracy::without_epsilon(each));
    }
    const auto guess = guess_;
    auto real_unknowns = solution_;
    for (auto* list : {&guess_, &real_unknowns}) {
      for (jet_quaternion& q : *list) {
        for (jet& each : q) {
          each = accuracy::without_epsilon(each);
        }
      }
    }
    const real step("1e-40");
    const jets before = residuals(real_x, real_unknowns);
    std::vector<std::vector<real>> jacobian(before.size(),
                                            std::vector<real>(before.size(), real(0)));
    for (std::size_t column = 0; column < before.size(); ++column) {
      jet& unknown = real_unknowns[column / 3][column % 3 + 1];
      const jet kept = unknown;
      unknown = unknown + jet(step);
      const jets after = residuals(real_x, real_unknowns);
      unknown = kept;
      for (std::size_t i = 0; i < before.size(); ++i) {
        jacobian[i][column] = (after[i].c[0] - before[i].c[0]) / step;
      }
    }
    inverse_ = inverse(std::move(jacobian));
    guess_ = guess;
  }
  const std::size_t epsilon = jet_shape::current->find({0, 0, 0, 1});
  real largest = 0;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const jets misses = residuals(x, solution_);
    largest = 0;
    for (const std::size_t monomial : {std::size_t(0), epsilon}) {
      real size = 0, change = 0;
      for (std::size_t i = 0; i < misses.size(); ++i) {
        real sum = 0;
        for (std::size_t j = 0; j < misses.size(); ++j) {
          sum += inverse_[i][j] * misses[j].c[monomial];
        }
        real& unknown = solution_[i / 3][i % 3 + 1].c[monomial];
        unknown -= sum;
        size = std::max(size, real(abs(unknown)));
        change = std::max(change, real(abs(sum)));
      }
      largest = std::max(largest, real(change / (size + 1)));
    }
    if (largest < real("1e-60")) {
      return;
    }
  }
  throw std::runtime_error("the oracle's equations are not solved: the last step was " +
                           largest.str(3));
}

jets interpolation::operator()(const jets& x) {
  solve(x);
  const std::size_t size = what_ == over::poses ? 8 : 4;
  const std::size_t rates = ends_ == ends::fully_clamped                           ? 4
                            : ends_ == ends::clamped || ends_ == ends::accelerated ? 2
                                                                                   : 0;
  jets result;
  for (std::size_t i = u_.size() * size + rates * numbers(); i < x.size(); ++i) {
    const double u = double(x[i].c[0]);
    const std::vector<double>& breaks = u_;
    std::size_t span = 0;
    if (order_ > 0) {
      while (span + 2 < breaks.size() && breaks[span + 1] <= u) {
        ++span;
      }
    } else {
      while (span + 8 < knots_.size() && knots_[span + 4] <= u) {
        ++span;
      }
    }
    const jets motion_at_u = motion(at(x, solution_, span, x[i]), what_);
    result.insert(result.end(), motion_at_u.begin(), motion_at_u.end());
  }
  return result;
}

least_squares_fit::least_squares_fit(over what, std::vector<double> knots, std::vector<double> u,
                                     double length, std::vector<double> start)
    : what_(what), knots_(std::move(knots)), u_(std::move(u)), length_(length),
      start_(std::move(start)), unknowns_(start_.size() / size() * numbers(), real(0)) {}

std::size_t least_squares_fit::find_span(double u) const {
  std::size_t span = 0;
  while (span + 8 < knots_.size() && knots_[span + 4] <= u) {
    ++span;
  }
  return span;
}

jet_quaternion least_squares_fit::at(const reals& unknowns, std::size_t span, const jet& u) const {
  std::vector<jet_quaternion> controls, increments;
  for (std::size_t i = span; i < span + 4; ++i) {
    jets c, x;
    for (std::size_t k = 0; k < size(); ++k) {
      c.emplace_back(real(start_[i * size() + k]));
    }
    for (std::size_t k = 0; k < numbers(); ++k) {
      x.emplace_back(unknowns[i * numbers() + k]);
    }
    controls.push_back(unit(element_at(c, 0, what_)) * exp(increment_at(x, 0, what_)));
    if (i > span) {
      increments.push_back(log(conj(controls[i - 1 - span]) * controls[i - span]));
    }
  }
  const auto first = knots_.begin() + std::ptrdiff_t(span);
  return cumulative({first, first + 8}, controls[0], increments, u);
}

real least_squares_fit::cost(const reals& rows, const reals& unknowns, std::size_t i) const {
  const jets x(rows.begin() + std::ptrdiff_t(i * size()),
               rows.begin() + std::ptrdiff_t((i + 1) * size()));
  const jet_quaternion s = at(unknowns, find_span(u_[i]), jet(real(u_[i])));
  const jet_quaternion between = conj(s) * unit(element_at(x, 0, what_));
  const jet_quaternion r = log(between * jet(between[0].c[0] < 0 ? -1 : 1)) * jet(2);
  real sum = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    const real linear = epsilon_part(r[k]).c[0] / length_;
    sum += (r[k].c[0] * r[k].c[0] + linear * linear) / 2;
  }
  return sum;
}

void least_squares_fit::solve(const reals& rows) {
  const jet_shape* const shape = jet_shape::current;
  static const jet_shape numbers_alone({{0, 0}}, false);
  jet_shape::current = &numbers_alone;
  const std::size_t n = unknowns_.size(), local = 4 * numbers();
  // Index of the first unknown that row i depends on.
  const auto first = [&](std::size_t i) { return find_span(u_[i]) * numbers(); };
  // Translations are scaled by the characteristic length.
  const auto scale = [&](std::size_t k) { return real(k % numbers() < 3 ? real(1) : length_); };
  if (inverse_.empty()) {
    const real step("1e-22");
    std::vector<reals> hessian(n, reals(n, real(0)));
    for (std::size_t i = 0; i < u_.size(); ++i) {
      for (std::size_t a = first(i); a < first(i) + local; ++a) {
        for (std::size_t b = first(i); b <= a; ++b) {
          real second = 0;
          for (const int sign : {1, -1}) {
            for (const int other : {1, -1}) {
              reals x = unknowns_;
              x[a] += sign * step * scale(a);
              x[b] += other * step * scale(b);
              second += sign * other * cost(rows, x, i);
            }
          }
          second /= 4 * step * step;
          hessian[a][b] += second;
          hessian[b][a] += a == b ? real(0) : second;
        }
      }
    }
    inverse_ = inverse(std::move(hessian));
  }
  real largest = 1;
  for (int iteration = 0; iteration < 12 && largest > real("1e-50"); ++iteration) {
    const real step("1e-30");
    reals gradient(n, real(0));
    for (std::size_t i = 0; i < u_.size(); ++i) {
      for (std::size_t a = first(i); a < first(i) + local; ++a) {
        for (const int sign : {1, -1}) {
          reals x = unknowns_;
          x[a] += sign * step * scale(a);
          gradient[a] += sign * cost(rows, x, i) / (2 * step);
        }
      }
    }
    largest = 0;
    for (std::size_t k = 0; k < n; ++k) {
      real sum = 0;
      for (std::size_t j = 0; j < n; ++j) {
        sum += inverse_[k][j] * gradient[j];
      }
      unknowns_[k] -= sum * scale(k);
      largest = std::max(largest, real(abs(sum)));
    }
  }
  jet_shape::current = shape;
  if (largest > real("1e-50")) {
    throw std::runtime_error(
        "duet_test: least_squares_fit: the oracle did not converge, last step " + largest.str(3));
  }
}

jets least_squares_fit::operator()(const jets& x) {
  reals rows;
  const std::size_t first_parameter = u_.size() * size();
  for (std::size_t i = 0; i < first_parameter; ++i) {
    rows.push_back(x[i].c[0]);
  }
  solve(rows);
  jets result;
  for (std::size_t i = first_parameter; i < x.size(); ++i) {
    const jets motion_at_u = motion(at(unknowns_, find_span(double(x[i].c[0])), x[i]), what_);
    result.insert(result.end(), motion_at_u.begin(), motion_at_u.end());
  }
  return result;
}

} // namespace duet_test::accuracy::oracle
