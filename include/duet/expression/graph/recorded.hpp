// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/expression/graph/functions_of_one.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>

/// \file
/// A scalar that records what is computed with it as nodes of a graph. Any function that is generic
/// over scalars becomes a formula when it is called with such numbers. For those who extend duet;
/// users call `trace`.

namespace duet {

class recorded;
class recorded_condition;

} // namespace duet

template <>
class std::numeric_limits<duet::recorded> : public std::numeric_limits<double> {};

/// Constants such as π are those of double.
template <>
struct duet::lane_traits<duet::recorded> {
  static constexpr bool is_batch = false;
  static constexpr int lanes = 1;
  using type = double;
};

template <>
inline constexpr bool duet::detail::is_recording<duet::recorded> = true;

namespace duet {

/// A real number that records its operations: a constant, or a node of a graph, which must outlive
/// it. Operations on constants alone are computed at once.
class recorded {
public:
  /// The constant 0.
  recorded() = default;
  template <Arithmetic U>
  explicit(false) recorded(const U& x) : number_(static_cast<double>(x)) {}
  recorded(expression::graph& g, int node) : graph_(&g), node_(node) {
    if (g.is_number(node)) {
      *this = recorded(g[node].number);
    }
  }

  /// True if nothing is recorded of it.
  [[nodiscard]] bool is_constant() const { return graph_ == nullptr; }
  /// The number of a constant.
  [[nodiscard]] double number() const { return number_; }
  /// The graph that it is recorded in; null for a constant.
  [[nodiscard]] expression::graph* home() const { return graph_; }
  /// Its position in a graph, where a constant is inserted.
  [[nodiscard]] int node_in(expression::graph& g) const {
    if (is_constant()) {
      return g.number(number_);
    }
    detail::require(graph_ == &g, "duet: a number was recorded in another formula");
    return node_;
  }

  /// A constant as an ordinary number.
  /// \throws invalid_input for what is recorded
  template <Arithmetic U>
  [[nodiscard]] explicit operator U() const {
    if (!is_constant()) {
      detail::raise(invalid_input("duet: trace: the function needs the number " +
                                  expression::detail::short_text(*graph_, node_) +
                                  ", which is not known yet"));
    }
    return static_cast<U>(number_);
  }

  [[nodiscard]] friend recorded operator+(const recorded& a) { return a; }
  [[nodiscard]] friend recorded operator-(const recorded& a) {
    return a.is_constant() ? recorded(-a.number_) : of(expression::operation::negative, a);
  }
  [[nodiscard]] friend recorded operator+(const recorded& a, const recorded& b) {
    return are_constant(a, b) ? recorded(a.number_ + b.number_)
                              : of(expression::operation::sum, a, b);
  }
  [[nodiscard]] friend recorded operator-(const recorded& a, const recorded& b) {
    return are_constant(a, b) ? recorded(a.number_ - b.number_)
                              : of(expression::operation::difference, a, b);
  }
  [[nodiscard]] friend recorded operator*(const recorded& a, const recorded& b) {
    return are_constant(a, b) ? recorded(a.number_ * b.number_)
                              : of(expression::operation::product, a, b);
  }
  [[nodiscard]] friend recorded operator/(const recorded& a, const recorded& b) {
    return are_constant(a, b) ? recorded(a.number_ / b.number_)
                              : of(expression::operation::quotient, a, b);
  }
  recorded& operator+=(const recorded& b) { return *this = *this + b; }
  recorded& operator-=(const recorded& b) { return *this = *this - b; }
  recorded& operator*=(const recorded& b) { return *this = *this * b; }
  recorded& operator/=(const recorded& b) { return *this = *this / b; }

  /// A constant as a number, what is recorded as its formula.
  friend std::ostream& operator<<(std::ostream& out, const recorded& x) {
    return x.is_constant() ? out << x.number_
                           : out << expression::detail::short_text(*x.graph_, x.node_);
  }

  /// True if nothing is recorded of any of the numbers.
  [[nodiscard]] static bool are_constant(const std::same_as<recorded> auto&... x) {
    return (x.is_constant() && ...);
  }
  /// The operation applied to numbers, of which one at least is recorded; a number or condition.
  template <class Result = recorded>
  [[nodiscard]] static Result of(expression::operation what,
                                 const std::same_as<recorded> auto&... x) {
    return with_index<Result>(what, 0, x...);
  }
  /// The operation with an index, as a power, applied likewise.
  template <class Result = recorded>
  [[nodiscard]] static Result with_index(expression::operation what, int index,
                                         const std::same_as<recorded> auto&... x) {
    expression::graph* g = nullptr;
    static_cast<void>(((g = x.graph_, g != nullptr) || ...));
    std::array<int, 3> nodes{-1, -1, -1};
    int count = 0;
    ((nodes[std::size_t(count++)] = x.node_in(*g)), ...);
    return {*g, g->apply(what, nodes[0], nodes[1], nodes[2], index)};
  }

private:
  expression::graph* graph_ = nullptr;
  int node_ = -1;
  double number_ = 0;
};

/// A condition on recorded numbers, for `select`: known, or a node. As a `bool` it must be known.
class recorded_condition {
public:
  explicit(false) recorded_condition(bool x = false) : value_(x) {}
  recorded_condition(expression::graph& g, int node) : graph_(&g), node_(node) {}

  /// True for a condition on constants.
  [[nodiscard]] bool is_known() const { return graph_ == nullptr; }
  /// The graph that it is recorded in; null for a known one.
  [[nodiscard]] expression::graph* home() const { return graph_; }
  /// Its position in the graph.
  [[nodiscard]] int node() const { return node_; }

  /// \throws invalid_input if it is not known: a branch cannot be recorded
  explicit(false) operator bool() const {
    if (!is_known()) {
      detail::raise(invalid_input("duet: trace: the function branches on " +
                                  expression::detail::short_text(*graph_, node_) +
                                  ", which is not known yet; write duet::select(condition, f, g)"));
    }
    return value_;
  }

  [[nodiscard]] friend recorded_condition operator!(const recorded_condition& a) {
    return a.is_known()
               ? recorded_condition(!a.value_)
               : recorded_condition(*a.graph_, a.graph_->apply(expression::operation::no, a.node_));
  }
  [[nodiscard]] friend recorded_condition operator&&(const recorded_condition& a,
                                                     const recorded_condition& b) {
    if (a.is_known() || b.is_known()) {
      const recorded_condition& known = a.is_known() ? a : b;
      return known.value_ ? (a.is_known() ? b : a) : recorded_condition(false);
    }
    return {*a.graph_, a.graph_->apply(expression::operation::both, a.node_, b.node_)};
  }
  [[nodiscard]] friend recorded_condition operator||(const recorded_condition& a,
                                                     const recorded_condition& b) {
    if (a.is_known() || b.is_known()) {
      const recorded_condition& known = a.is_known() ? a : b;
      return known.value_ ? recorded_condition(true) : (a.is_known() ? b : a);
    }
    return {*a.graph_, a.graph_->apply(expression::operation::either, a.node_, b.node_)};
  }
  [[nodiscard]] friend recorded_condition operator&&(bool a, const recorded_condition& b) {
    return recorded_condition(a) && b;
  }
  [[nodiscard]] friend recorded_condition operator&&(const recorded_condition& a, bool b) {
    return a && recorded_condition(b);
  }
  [[nodiscard]] friend recorded_condition operator||(bool a, const recorded_condition& b) {
    return recorded_condition(a) || b;
  }
  [[nodiscard]] friend recorded_condition operator||(const recorded_condition& a, bool b) {
    return a || recorded_condition(b);
  }
  [[nodiscard]] friend recorded_condition operator==(const recorded_condition& a,
                                                     const recorded_condition& b) {
    return (a && b) || (!a && !b);
  }

private:
  expression::graph* graph_ = nullptr;
  int node_ = -1;
  bool value_ = false;
};

#define DUET_RECORDED_COMPARISON(sign, name)                                                       \
  [[nodiscard]] inline recorded_condition operator sign(const recorded& a, const recorded& b) {    \
    return recorded::are_constant(a, b)                                                            \
               ? recorded_condition(a.number() sign b.number())                                    \
               : recorded::of<recorded_condition>(expression::operation::name, a, b);              \
  }
DUET_RECORDED_COMPARISON(<, less)
DUET_RECORDED_COMPARISON(<=, less_equal)
DUET_RECORDED_COMPARISON(==, equal)
#undef DUET_RECORDED_COMPARISON
[[nodiscard]] inline recorded_condition operator>(const recorded& a, const recorded& b) {
  return b < a;
}
[[nodiscard]] inline recorded_condition operator>=(const recorded& a, const recorded& b) {
  return b <= a;
}
[[nodiscard]] inline recorded_condition operator!=(const recorded& a, const recorded& b) {
  return !(a == b);
}

/// b where the condition holds, otherwise c, of every scalar in them.
template <class X>
[[nodiscard]] X blended(const recorded_condition& condition, const X& b, const X& c) {
  if constexpr (std::same_as<X, recorded>) {
    expression::graph& g = *condition.home();
    const int first = b.node_in(g);
    return {g, g.apply(expression::operation::select, condition.node(), first, c.node_in(g))};
  } else if constexpr (std::same_as<X, recorded_condition>) {
    return (condition && b) || (!condition && c);
  } else {
    const auto of_parts = [&](const auto& p, const auto& q) { return blended(condition, p, q); };
    if constexpr (Infinitesimal<X>) {
      return b.zip(of_parts, c);
    } else {
      return map_scalars(of_parts, b, c);
    }
  }
}

/// The choice, recorded with both results unless the condition is known.
template <std::invocable F, std::invocable G>
[[nodiscard]] auto select(const recorded_condition& condition, F&& f, G&& g) {
  using result = std::common_type_t<std::invoke_result_t<F>, std::invoke_result_t<G>>;
  if (condition.is_known()) {
    return bool(condition) ? static_cast<result>(f()) : static_cast<result>(g());
  }
  const result b = f(), c = g();
  return blended(condition, b, c);
}

/// The condition as a `bool`, as for a batch.
///
/// \throws invalid_input for a condition that is not known
[[nodiscard]] inline bool any(const recorded_condition& c) { return bool(c); }
[[nodiscard]] inline bool all(const recorded_condition& c) { return bool(c); }

// The functions of <cmath>.

#define DUET_RECORDED_FUNCTION(name)                                                               \
  [[nodiscard]] inline recorded name(const recorded& x) {                                          \
    return x.is_constant() ? recorded(std::name(x.number()))                                       \
                           : recorded::of(expression::operation::name, x);                         \
  }
DUET_EACH_FUNCTION(DUET_RECORDED_FUNCTION)
DUET_EACH_ROUNDING(DUET_RECORDED_FUNCTION)
#undef DUET_RECORDED_FUNCTION

/// |x|
[[nodiscard]] inline recorded fabs(const recorded& x) { return abs(x); }

#define DUET_RECORDED_FUNCTION(name)                                                               \
  [[nodiscard]] inline recorded name(const recorded& a, const recorded& b) {                       \
    return recorded::are_constant(a, b) ? recorded(std::name(a.number(), b.number()))              \
                                        : recorded::of(expression::operation::name, a, b);         \
  }
DUET_RECORDED_FUNCTION(atan2)
DUET_RECORDED_FUNCTION(hypot)
DUET_RECORDED_FUNCTION(fmod)
DUET_RECORDED_FUNCTION(remainder)
#undef DUET_RECORDED_FUNCTION

/// √(x² + y² + z²)
[[nodiscard]] inline recorded hypot(const recorded& x, const recorded& y, const recorded& z) {
  return hypot(hypot(x, y), z);
}
/// x^p; of a whole p from −16 to 16 by an operation of its own, within 4 ulp.
[[nodiscard]] inline recorded pow(const recorded& x, const recorded& p) {
  if (recorded::are_constant(x, p)) {
    return std::pow(x.number(), p.number());
  }
  if (p.is_constant() && std::abs(p.number()) <= 16 && std::trunc(p.number()) == p.number()) {
    const int n = int(p.number());
    return n == 0 ? recorded(1) : recorded::with_index(expression::operation::power, n, x);
  }
  return recorded::of(expression::operation::pow, x, p);
}
[[nodiscard]] inline recorded fma(const recorded& x, const recorded& y, const recorded& z) {
  return recorded::are_constant(x, y, z) ? recorded(std::fma(x.number(), y.number(), z.number()))
                                         : recorded::of(expression::operation::fma, x, y, z);
}
/// a + t (b − a) from the nearer end.
[[nodiscard]] inline recorded lerp(const recorded& a, const recorded& b, const recorded& t) {
  return select(
      t < 0.5, [&] { return a + t * (b - a); }, [&] { return b - (1 - t) * (b - a); });
}
[[nodiscard]] inline recorded midpoint(const recorded& a, const recorded& b) {
  return 0.5 * a + 0.5 * b;
}
/// x 2^exponent
[[nodiscard]] inline recorded ldexp(const recorded& x, int exponent) {
  return x * std::ldexp(1.0, exponent);
}
[[nodiscard]] inline recorded max(const recorded& a, const recorded& b) {
  return select(
      a < b, [&] { return b; }, [&] { return a; });
}
[[nodiscard]] inline recorded min(const recorded& a, const recorded& b) {
  return select(
      b < a, [&] { return b; }, [&] { return a; });
}
[[nodiscard]] inline recorded fmax(const recorded& a, const recorded& b) { return max(a, b); }
[[nodiscard]] inline recorded fmin(const recorded& a, const recorded& b) { return min(a, b); }

/// Classification, recorded.
[[nodiscard]] inline recorded_condition isfinite(const recorded& x) {
  return x.is_constant() ? recorded_condition(std::isfinite(x.number()))
                         : recorded::of<recorded_condition>(expression::operation::is_finite, x);
}
[[nodiscard]] inline recorded_condition isnan(const recorded& x) {
  return x.is_constant() ? recorded_condition(std::isnan(x.number()))
                         : recorded::of<recorded_condition>(expression::operation::is_nan, x);
}
[[nodiscard]] inline recorded_condition isinf(const recorded& x) {
  return !isfinite(x) && !isnan(x);
}
[[nodiscard]] inline recorded_condition signbit(const recorded& x) {
  return x.is_constant() ? recorded_condition(std::signbit(x.number()))
                         : recorded::of<recorded_condition>(expression::operation::is_negative, x);
}
/// |magnitude| with the sign of `sign`.
[[nodiscard]] inline recorded copysign(const recorded& magnitude, const recorded& sign) {
  return select(
      signbit(sign), [&] { return -abs(magnitude); }, [&] { return abs(magnitude); });
}

/// c_index(s) as one expression::operation: duet calls this for recorded numbers.
[[nodiscard]] inline recorded recorded_stumpff(const recorded& s, int index) {
  return recorded::with_index(expression::operation::stumpff, index, s);
}
/// atan2(√s, w)/√s as one expression::operation, likewise.
[[nodiscard]] inline recorded recorded_arc_ratio(const recorded& s, const recorded& w) {
  if (recorded::are_constant(s, w)) {
    const double root = std::sqrt(s.number());
    return root == 0 && w.number() > 0 ? 1 / w.number() : std::atan2(root, w.number()) / root;
  }
  return recorded::of(expression::operation::arc_ratio, s, w);
}

} // namespace duet

namespace Eigen {

template <>
struct NumTraits<duet::recorded> : NumTraits<double> {
  using Real = duet::recorded;
  using NonInteger = duet::recorded;
  using Nested = duet::recorded;
  using Literal = double;
  static constexpr int RequireInitialization = 1;
  static constexpr int ReadCost = 4, AddCost = 8, MulCost = 8;
};

template <class Operation>
struct ScalarBinaryOpTraits<duet::recorded, double, Operation> {
  using ReturnType = duet::recorded;
};
template <class Operation>
struct ScalarBinaryOpTraits<double, duet::recorded, Operation> {
  using ReturnType = duet::recorded;
};

} // namespace Eigen
