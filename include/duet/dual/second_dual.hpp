// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>

/// \file
/// Numbers that carry a gradient and a symmetric matrix of second derivatives.

namespace duet::detail {

/// Maximum number of packets for which all loops are unrolled.
inline constexpr int triangle_unroll_limit = 32;

/// The rows of the lower triangle of an N × N matrix, each in as many packets as it needs; the
/// contents of the last packet of a row beyond the diagonal are ignored.
template <class T, int N>
class lower_triangle {
  static constexpr int width = packing<T, N>::width;
  using packet = typename packing<T, N>::packet;
  using row_type = partials<T, N>;

  /// Number of packets in all rows before one; row i has ⌊i / width⌋ + 1. Unsigned: the rounding of
  /// a signed division costs clang's Hessian of 3 a sixth.
  static constexpr int packets_before(int row) {
    const unsigned i = unsigned(row), full = i / width;
    return int((full + 1) * (2 * i - width * full) / 2);
  }

public:
  static constexpr int packet_count = packets_before(N);

  lower_triangle() {
    unrolled<packet_count>([&](int k) DUET_INLINE_LAMBDA { packets_[k] = packet{}; });
  }
  DUET_ALWAYS_INLINE lower_triangle(const lower_triangle& other) { assign(other); }
  DUET_ALWAYS_INLINE lower_triangle& operator=(const lower_triangle& other) {
    assign(other);
    return *this;
  }

  [[nodiscard]] T get(int i, int j) const { return i < j ? get(j, i) : element(i, j); }
  /// j ≤ i
  void set(int i, int j, const T& x) {
    if constexpr (width > 1) {
      packets_[packets_before(i) + j / width][j % width] = x;
    } else {
      packets_[packets_before(i) + j] = x;
    }
  }
  [[nodiscard]] const packet& packet_at(int k) const { return packets_[k]; }

  /// result = f(triangles…), packet by packet.
  template <class F, class... Triangles>
  [[nodiscard]] DUET_ALWAYS_INLINE static lower_triangle map(F&& f, const Triangles&... t) {
    lower_triangle result(uninitialised{});
    unrolled<packet_count>([&](int k)
                               DUET_INLINE_LAMBDA { result.packets_[k] = f(t.packets_[k]...); });
    return result;
  }

  /// result_ij = start_ij + a_i b_j
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static lower_triangle
  with_outer_products(F&& start, const row_type& a, const row_type& b) {
    lower_triangle result(uninitialised{});
    for_each_packet([&](int k, int row, int p) DUET_INLINE_LAMBDA {
      result.packets_[k] = start(k) + b.packet_at(p) * a.get(row);
    });
    return result;
  }
  /// result_ij = start_ij + a_i b_j + c_i d_j
  template <class F>
  [[nodiscard]] DUET_ALWAYS_INLINE static lower_triangle
  with_outer_products(F&& start, const row_type& a, const row_type& b, const row_type& c,
                      const row_type& d) {
    lower_triangle result(uninitialised{});
    for_each_packet([&](int k, int row, int p) DUET_INLINE_LAMBDA {
      result.packets_[k] = start(k) + b.packet_at(p) * a.get(row) + d.packet_at(p) * c.get(row);
    });
    return result;
  }

private:
  struct uninitialised {};
  DUET_ALWAYS_INLINE explicit lower_triangle(uninitialised) {}

  /// f(number, row, number in the row) for every packet.
  template <class F>
  DUET_ALWAYS_INLINE static void for_each_packet(F&& f) {
    if constexpr (packet_count <= triangle_unroll_limit) {
      unrolled<N>([&](int row) DUET_INLINE_LAMBDA {
        unrolled<(N + width - 1) / width>([&](int p) DUET_INLINE_LAMBDA {
          if (p <= row / width) {
            f(packets_before(row) + p, row, p);
          }
        });
      });
    } else {
      int k = 0;
      for (int row = 0; row < N; ++row) {
        for (int p = 0; p <= row / width; ++p) {
          f(k++, row, p);
        }
      }
    }
  }

  [[nodiscard]] T element(int i, int j) const {
    if constexpr (width > 1) {
      return packets_[packets_before(i) + j / width][j % width];
    } else {
      return packets_[packets_before(i) + j];
    }
  }
  DUET_ALWAYS_INLINE void assign(const lower_triangle& other) {
    unrolled<packet_count>([&](int k) DUET_INLINE_LAMBDA { packets_[k] = other.packets_[k]; });
  }

  packet packets_[std::size_t(packet_count)];
};

} // namespace duet::detail

namespace duet {
namespace detail {

/// Tag of the ε with respect to which slopes are differentiated.
struct curvature_tag {};

/// False if the value of x, a built-in number, has lost digits or vanished by underflow, or is
/// zero.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE auto is_normal(const T& x) {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    using std::abs;
    return abs(innermost(x)) >= std::numeric_limits<lane_type_t<T>>::min();
  } else {
    return true;
  }
}

/// False if the second derivative of a function at x may have lost digits by underflow. One that is
/// 0 below |x| = 2^100 is exact.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE auto has_all_digits(const T& curvature, const T& x) {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    using std::abs;
    constexpr auto limit = lane_type_t<T>(0x1p100);
    return is_normal(curvature) || (innermost(curvature) == 0 && abs(innermost(x)) < limit);
  } else {
    return true;
  }
}

} // namespace detail

DUET_ABI_BEGIN

/// x₀ + gᵀε + ½ εᵀHε, where products of three ε vanish: a value, its gradient and its Hessian with
/// respect to N variables.
///
/// Equivalent to a dual of N partials over a dual of N partials, except that each second derivative
/// is stored and computed once: `hessian` uses it.
template <class T, int N, class Tag = derivative_tag<>>
class second_order_dual : public detail::infinitesimal_operators<second_order_dual<T, N, Tag>, T> {
  static_assert(Scalar<T>,
                "duet: second_order_dual<T, N> needs a real number or a scalar of duet as T");
  static_assert(N >= 1, "duet: second_order_dual<T, N> needs at least one variable");
  static_assert(
      !detail::contains_tag<T, Tag>(),
      "duet: this differentiation happens inside another one with the same tag, and their "
      "infinitesimals could not be distinguished; give it a separate tag: hessian<struct "
      "my_tag>(f, x)");

public:
  using value_type = T;
  using gradient_type = detail::partials<T, N>;
  using hessian_type = detail::lower_triangle<T, N>;

  /// Zero.
  second_order_dual() : value_(T(0)) {}
  /// A constant.
  template <ConstantOf<second_order_dual> U>
  DUET_ALWAYS_INLINE second_order_dual(const U& constant) : value_(static_cast<T>(constant)) {}
  DUET_ALWAYS_INLINE second_order_dual(const T& value, const gradient_type& gradient,
                                       const hessian_type& hessian)
      : value_(value), gradient_(gradient), hessian_(hessian) {}
  /// Conversion from another scalar; implicit if no precision or level is lost.
  template <class U>
    requires(!std::same_as<U, T> && std::constructible_from<T, U>)
  explicit(!std::convertible_to<U, T> || !std::same_as<promote_t<T, U>, T>)
      second_order_dual(const second_order_dual<U, N, Tag>& other)
      : second_order_dual(other.zip([](const U& x) { return static_cast<T>(x); })) {}

  /// The i-th variable of a function of N: value + εᵢ.
  [[nodiscard]] static second_order_dual variable(const T& value, int i = 0) {
    second_order_dual result(value);
    result.gradient_.set(i, T(1));
    return result;
  }

  [[nodiscard]] const T& value() const { return value_; }           ///< the part without ε
  [[nodiscard]] T partial(int i) const { return gradient_.get(i); } ///< ∂/∂xᵢ, i from 0
  [[nodiscard]] T second_partial(int i, int j) const { return hessian_.get(i, j); } ///< ∂²/∂xᵢ∂xⱼ

  // For those who extend duet: the members that `Level` requires.

  static constexpr int part_count = 1 + N + N * (N + 1) / 2;
  /// The value, the gradient, then the Hessian row by row, symmetric entries repeated.
  [[nodiscard]] T part(int k) const {
    return k == 0   ? value_
           : k <= N ? partial(k - 1)
                    : second_partial((k - N - 1) / N, (k - N - 1) % N);
  }
  /// Number with another value and the same derivatives.
  [[nodiscard]] second_order_dual with_value(const T& value) const {
    return {value, gradient_, hessian_};
  }
  /// f of the value and of every derivative: the same level over the result type of f.
  template <class F, class... Others>
  [[nodiscard]] DUET_ALWAYS_INLINE auto zip(F&& f, const Others&... other) const {
    const auto value = f(value_, other.value()...);
    using U = std::remove_const_t<decltype(value)>;
    detail::partials<U, N> gradient;
    detail::lower_triangle<U, N> hessian;
    for (int i = 0; i < N; ++i) {
      gradient.set(i, f(partial(i), other.partial(i)...));
      for (int j = 0; j <= i; ++j) {
        hessian.set(i, j, f(second_partial(i, j), other.second_partial(i, j)...));
      }
    }
    return second_order_dual<U, N, Tag>(value, gradient, hessian);
  }
  /// slope · x. (Slopes that are not finite do not occur here: see `composed`.)
  [[nodiscard]] static second_order_dual zero_preserving_product(const second_order_dual& slope,
                                                                 const second_order_dual& x) {
    return product(slope, x);
  }
  /// The function of a rule, see rules/elementary.hpp. Its second derivatives are those of the
  /// rule's slopes, by dual numbers.
  template <class Rule>
  [[nodiscard]] DUET_ALWAYS_INLINE static second_order_dual lift(const Rule& rule,
                                                                 const second_order_dual& x) {
    using D = dual<T, 1, detail::curvature_tag>;
    const T y = rule.value(x.value_);
    const T slope = rule.slope(x.value_, y);
    const D moving_slope = rule.slope(D::variable(x.value_), D(y, slope));
    const T curvature = moving_slope.epsilon();
    if (all(detail::is_all_finite(slope) && detail::is_all_finite(curvature) &&
            detail::has_all_digits(curvature, x.value_))) [[likely]] {
      return x.composed_of_finite(y, slope, curvature);
    }
    return x.composed_along_gradient(rule, T(y), T(slope));
  }
  template <class Rule, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static second_order_dual
  lift(const Rule& rule, const second_order_dual& x, const Rest&... rest) {
    constexpr std::size_t count = 1 + sizeof...(rest);
    using D = dual<T, int(count), detail::curvature_tag>;
    const T value = rule.value(x.value_, rest.value_...);
    const std::array<T, count> slopes = rule.slopes(value, x.value_, rest.value_...);
    const std::array<const second_order_dual*, count> arguments = {&x, &rest...};
    D moving_value(value);
    std::array<D, count> moving;
    for (std::size_t a = 0; a < count; ++a) {
      moving_value.set_partial(int(a), slopes[a]);
      moving[a] = D::variable(arguments[a]->value_, int(a));
    }
    const auto moving_slopes = std::apply(
        [&](const auto&... argument) { return rule.slopes(moving_value, argument...); }, moving);
    std::array<std::array<T, count>, count> curvatures;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        curvatures[a][b] = moving_slopes[a].partial(int(b));
      }
    }
    return composed<count>(value, arguments, slopes, curvatures);
  }
  /// Sine and cosine of x from those of its value, circular (Sign −1) or hyperbolic (1).
  template <int Sign>
  [[nodiscard]] DUET_ALWAYS_INLINE static detail::sine_cosine<second_order_dual>
  lift_pair(const detail::sine_cosine<T>& y, const second_order_dual& x) {
    const T minus = Sign < 0 ? T(-y.sine) : y.sine;
    const T bent = Sign < 0 ? T(-y.cosine) : y.cosine;
    return {x.composed(y.sine, y.cosine, minus), x.composed(y.cosine, minus, bent)};
  }
  /// Writes value[gradient; rows of the lower half of the Hessian].
  template <class Out>
  void write(Out& out) const {
    out << value_ << "[";
    for (int i = 0; i < N; ++i) {
      out << (i == 0 ? "" : ", ") << partial(i);
    }
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j <= i; ++j) {
        out << (j == 0 ? "; " : ", ") << second_partial(i, j);
      }
    }
    out << "]";
  }
  /// True if the predicate holds for the value and for every derivative.
  template <class Predicate>
  [[nodiscard]] auto all_of(Predicate&& predicate) const {
    auto result = predicate(value_);
    for (int i = 0; i < N; ++i) {
      result = result && predicate(partial(i));
      for (int j = 0; j <= i; ++j) {
        result = result && predicate(second_partial(i, j));
      }
    }
    return result;
  }

  // The kernels behind the operators of detail::infinitesimal_operators.

  [[nodiscard]] DUET_ALWAYS_INLINE second_order_dual negated() const {
    return each([](const auto& p) DUET_INLINE_LAMBDA { return -p; }, *this);
  }
  [[nodiscard]] DUET_ALWAYS_INLINE second_order_dual plus(const T& c) const {
    return {T(value_ + c), gradient_, hessian_};
  }
  [[nodiscard]] DUET_ALWAYS_INLINE second_order_dual times(const T& c) const {
    return each([&](const auto& p) DUET_INLINE_LAMBDA { return p * c; }, *this);
  }
  [[nodiscard]] DUET_ALWAYS_INLINE second_order_dual divided_by(const T& c) const {
    return composed(T(value_ / c), T(T(1) / c), T(0));
  }
  /// c / *this
  [[nodiscard]] DUET_ALWAYS_INLINE second_order_dual dividing(const T& c) const {
    const T inverse = T(1) / value_;
    const T slope = -(c * inverse) * inverse;
    const T curvature = detail::integer<T>(-2) * slope * inverse;
    if (!all(detail::is_all_finite(curvature) && detail::is_normal(curvature))) [[unlikely]] {
      return quotient_by_value(second_order_dual(c), *this, T(c / value_), T(inverse));
    }
    return composed_of_finite(T(c / value_), slope, curvature);
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static second_order_dual sum(const second_order_dual& a,
                                                                const second_order_dual& b) {
    return each([](const auto& p, const auto& q) DUET_INLINE_LAMBDA { return p + q; }, a, b);
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static second_order_dual difference(const second_order_dual& a,
                                                                       const second_order_dual& b) {
    return each([](const auto& p, const auto& q) DUET_INLINE_LAMBDA { return p - q; }, a, b);
  }
  /// H = a H_b + b H_a + g_a g_bᵀ + g_b g_aᵀ
  [[nodiscard]] static second_order_dual product(const second_order_dual& a,
                                                 const second_order_dual& b) {
    const auto f = [&](const auto& p, const auto& q)
                       DUET_INLINE_LAMBDA { return p * b.value_ + q * a.value_; };
    return {T(a.value_ * b.value_), gradient_type::map(f, a.gradient_, b.gradient_),
            hessian_type::with_outer_products(
                [&](int k) DUET_INLINE_LAMBDA {
                  return f(a.hessian_.packet_at(k), b.hessian_.packet_at(k));
                },
                a.gradient_, b.gradient_, b.gradient_, a.gradient_)};
  }
  /// a b⁻¹, whose value is the exact quotient.
  [[nodiscard]] static second_order_dual quotient(const second_order_dual& a,
                                                  const second_order_dual& b) {
    const T inverse = T(1) / b.value_;
    const T slope = -inverse * inverse;
    const T curvature = detail::integer<T>(-2) * slope * inverse;
    const T value = a.value_ / b.value_;
    if (!all(detail::is_all_finite(curvature) && detail::is_normal(curvature))) [[unlikely]] {
      return quotient_by_value(a, b, T(value), T(inverse));
    }
    second_order_dual result = product(a, b.composed(inverse, slope, curvature));
    result.value_ = value;
    return result;
  }

  /// A function of this number, given its value y and its first and second derivative:
  /// H = f′ H + f″ g gᵀ.
  [[nodiscard]] DUET_ALWAYS_INLINE second_order_dual composed(const T& y, const T& slope,
                                                              const T& curvature) const {
    if (all(detail::is_all_finite(slope) && detail::is_all_finite(curvature))) [[likely]] {
      return composed_of_finite(y, slope, curvature);
    }
    return composed<1>(y, {this}, {slope}, {{{curvature}}});
  }

  /// A function of K numbers, given its value y, its slopes s_a and second derivatives c_ab, where
  /// zeros survive: g = Σ s_a g_a, H = Σ s_a H_a + Σ c_ab g_a g_bᵀ.
  template <std::size_t K>
  [[nodiscard]] DUET_OUT_OF_LINE static second_order_dual
  composed(const T& y, const std::array<const second_order_dual*, K>& x,
           const std::array<T, K>& slopes, const std::array<std::array<T, K>, K>& curvatures) {
    second_order_dual result(y);
    for (int i = 0; i < N; ++i) {
      T first(0);
      for (std::size_t a = 0; a < K; ++a) {
        first = first + detail::guarded_product(slopes[a], x[a]->partial(i));
      }
      result.gradient_.set(i, first);
      for (int j = 0; j <= i; ++j) {
        T second(0);
        for (std::size_t a = 0; a < K; ++a) {
          second = second + detail::guarded_product(slopes[a], x[a]->second_partial(i, j));
          for (std::size_t b = 0; b < K; ++b) {
            second = second + detail::guarded_product(curvatures[a][b],
                                                      T(x[a]->partial(i) * x[b]->partial(j)));
          }
        }
        result.hessian_.set(i, j, second);
      }
    }
    return result;
  }

private:
  /// `composed` for finite slopes.
  [[nodiscard]] DUET_ALWAYS_INLINE second_order_dual composed_of_finite(const T& y, const T& slope,
                                                                        const T& curvature) const {
    const auto scaled = [](const T& c) DUET_INLINE_LAMBDA {
      return [&c](const auto& p)
                 DUET_INLINE_LAMBDA { return std::remove_cvref_t<decltype(p)>(p * c); };
    };
    const auto bent = gradient_type::map(scaled(curvature), gradient_);
    return {y, gradient_type::map(scaled(slope), gradient_),
            hessian_type::with_outer_products(
                [&](int k) DUET_INLINE_LAMBDA { return scaled(slope)(hessian_.packet_at(k)); },
                gradient_, bent)};
  }
  /// q = a/b by g = (g_a − q g_b)/b and H = (H_a − q H_b − g g_bᵀ − g_b gᵀ)/b: powers of 1/b
  /// overflow or vanish long before q does.
  [[nodiscard]] DUET_OUT_OF_LINE static second_order_dual
  quotient_by_value(const second_order_dual& a, const second_order_dual& b, const T& q,
                    const T& inverse) {
    second_order_dual result(q);
    for (int i = 0; i < N; ++i) {
      const T g = a.partial(i) - detail::guarded_product(q, b.partial(i));
      result.gradient_.set(i, detail::guarded_product(inverse, g));
      for (int j = 0; j <= i; ++j) {
        const T h = a.second_partial(i, j) - detail::guarded_product(q, b.second_partial(i, j)) -
                    detail::guarded_product(result.partial(i), b.partial(j)) -
                    detail::guarded_product(result.partial(j), b.partial(i));
        result.hessian_.set(i, j, detail::guarded_product(inverse, h));
      }
    }
    return result;
  }
  /// The function of a rule, by derivatives of its slope along the gradient, as nested dual numbers
  /// do: f″ underflows or overflows long before f″ g does.
  template <class Rule>
  [[nodiscard]] DUET_OUT_OF_LINE second_order_dual composed_along_gradient(const Rule& rule,
                                                                           const T& y,
                                                                           const T& slope) const {
    using D = dual<T, 1, detail::curvature_tag>;
    const auto along = [](const T& value, const T& derivative) {
      D result(value);
      result.set_partial(0, derivative);
      return result;
    };
    second_order_dual result(y);
    for (int i = 0; i < N; ++i) {
      const T first = detail::guarded_product(slope, partial(i));
      const T moving = T(rule.slope(along(value_, partial(i)), along(y, first)).partial(0));
      result.gradient_.set(i, first);
      for (int j = 0; j <= i; ++j) {
        result.hessian_.set(i, j,
                            T(detail::guarded_product(slope, second_partial(i, j)) +
                              detail::guarded_product(moving, partial(j))));
      }
    }
    return result;
  }

  template <class F, class... X>
  [[nodiscard]] DUET_ALWAYS_INLINE static second_order_dual each(const F& f, const X&... x) {
    return {T(f(x.value_...)), gradient_type::map(f, x.gradient_...),
            hessian_type::map(f, x.hessian_...)};
  }

  T value_;
  gradient_type gradient_;
  hessian_type hessian_;
};

DUET_ABI_END

template <class T, int N, class Tag>
struct scalar_traits<second_order_dual<T, N, Tag>> : detail::level_traits<T, Tag, 2> {
  template <class U>
  using over = second_order_dual<U, N, Tag>;
};

} // namespace duet
