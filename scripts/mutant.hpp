// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#pragma once

#include <cstdio>
#include <cstdlib>
#include <type_traits>

/// Signs that decide when they run, for scripts/mutations: `a + b` becomes `a + sign<17>() + b`, `x
/// += y` becomes `x += sign<17>() *= y`, `-x` becomes `sign<17>() * x`, which leaves the precedence
/// of all operators as it was. In constant expressions, and where the other sign has a result of
/// another type, the original holds.
namespace duet_mutant {

/// Reads from DUET_MUTANT which sign is changed, and appends to the file DUET_MUTANTS_MET which
/// ones were run.
struct run_of_test {
  static constexpr int capacity = 10000;
  bool is_met[capacity] = {};
  int changed = std::getenv("DUET_MUTANT") ? std::atoi(std::getenv("DUET_MUTANT")) : -1;

  ~run_of_test() {
    if (const char* path = std::getenv("DUET_MUTANTS_MET")) {
      std::FILE* file = std::fopen(path, "a");
      for (int k = 0; k < capacity; ++k) {
        if (is_met[k]) {
          std::fprintf(file, "%d ", k);
        }
      }
      std::fclose(file);
    }
  }
};

inline run_of_test run;

template <int K>
constexpr bool is_changed() {
  return !__builtin_is_constant_evaluated() && ((run.is_met[K] = true)) && run.changed == K;
}

/// Where a sign cannot change it fails to compile, if that is asked for.
#ifdef DUET_MUTANT_CHECK
template <class>
constexpr bool is_compiled = false;
#else
template <class>
constexpr bool is_compiled = true;
#endif

template <class T>
concept number = std::is_arithmetic_v<T>;

template <int K>
struct sign {};

template <int K, class A>
struct left {
  A a;
};

/// An operand, with the other sign if that is changed.
template <int K, bool IsNegative>
struct with_sign {
  template <class X>
  constexpr auto operator()(const X& x) const {
    if constexpr (number<X>) {
      return is_changed<K>() != IsNegative ? -x : +x;
    } else if constexpr (requires { requires std::is_same_v<decltype(-x), X>; }) {
      return is_changed<K>() != IsNegative ? -x : x;
    } else if constexpr (requires { x.unaryExpr(*this); }) {
      return x.unaryExpr(*this);
    } else {
      static_assert(is_compiled<X>);
      if constexpr (IsNegative) {
        return -x;
      } else {
        return x;
      }
    }
  }
};

// Numbers are taken by value, as constants need no capture so.
#define DUET_MUTANT_BEFORE_OPERAND(operator_, is_negative)                                         \
  template <int K, number X>                                                                       \
  constexpr auto operator operator_(sign<K>, X x) {                                                \
    return with_sign<K, is_negative>()(x);                                                         \
  }                                                                                                \
  template <int K, class X>                                                                        \
    requires(!number<X>)                                                                           \
  constexpr auto operator operator_(sign<K>, const X& x) { return with_sign<K, is_negative>()(x); }
DUET_MUTANT_BEFORE_OPERAND(*, true)
DUET_MUTANT_BEFORE_OPERAND(*=, false)

#define DUET_MUTANT_BETWEEN_OPERANDS(name, operator_, other, is_sum)                               \
  template <int K, class A, class B>                                                               \
  constexpr auto name(const A& a, const B& b) {                                                    \
    if constexpr (requires {                                                                       \
                    requires std::is_same_v<decltype(a operator_ b), decltype(a other b)>;         \
                  }) {                                                                             \
      return is_changed<K>() ? a other b : a operator_ b;                                          \
    } else if constexpr (is_sum && requires { b.unaryExpr(with_sign<K, false>()); }) {             \
      return a operator_ b.unaryExpr(with_sign<K, false>());                                       \
    } else {                                                                                       \
      static_assert(is_compiled<A>);                                                               \
      return a operator_ b;                                                                        \
    }                                                                                              \
  }                                                                                                \
  template <int K, number A>                                                                       \
  constexpr left<K, A> operator operator_(A a, sign<K>) {                                          \
    return {a};                                                                                    \
  }                                                                                                \
  template <int K, class A>                                                                        \
    requires(!number<A>)                                                                           \
  constexpr left<K, const A&> operator operator_(const A& a, sign<K>) { return {a}; }              \
  template <int K, class A, number B>                                                              \
  constexpr auto operator operator_(left<K, A> l, B b) {                                           \
    return name<K>(l.a, b);                                                                        \
  }                                                                                                \
  template <int K, class A, class B>                                                               \
    requires(!number<B>)                                                                           \
  constexpr auto operator operator_(left<K, A> l, const B& b) { return name<K>(l.a, b); }
DUET_MUTANT_BETWEEN_OPERANDS(sum, +, -, true)
DUET_MUTANT_BETWEEN_OPERANDS(difference, -, +, true)
DUET_MUTANT_BETWEEN_OPERANDS(less, <, >, false)
DUET_MUTANT_BETWEEN_OPERANDS(greater, >, <, false)

} // namespace duet_mutant
