// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>

#include <Eigen/Core>

#include <concepts>
#include <cstdint>
#include <type_traits>

/// \file
/// Values bound to the symbols of a formula, and compile-time errors for missing, unknown and
/// repeated ones.

namespace duet::expression::detail {

/// Value bound to a symbol.
template <class Symbol, class T>
struct argument {
  using symbol_type = Symbol;
  using value_type = T;
  T value;
};

template <class T>
inline constexpr bool is_screw_dual = false;
template <class T>
inline constexpr bool is_screw_dual<screw_dual<T>> = true;

/// Scalar type of an argument; of dual vectors and poses, that of the real and dual parts.
template <class T>
struct scalar_of {
  using type = T;
};
template <class T>
struct scalar_of<screw_dual<T>> {
  using type = T;
};
template <class T>
using scalar_of_t = typename scalar_of<typename structure<T>::scalar>::type;

/// Common type of some scalars; double if there are none.
template <class... T>
struct common_scalar : std::common_type<T...> {};
template <>
struct common_scalar<> {
  using type = double;
};
template <class... T>
using common_scalar_t = typename common_scalar<T...>::type;

/// Constant converted to the precision of the arguments.
template <class Real, class T>
[[nodiscard]] constexpr auto constant_over(const T& x) {
  const auto of_part = [](const auto& part) { return constant_over<Real>(part); };
  if constexpr (std::floating_point<T>) {
    return static_cast<Real>(x);
  } else if constexpr (Infinitesimal<T> && duet::detail::contains_tag<T, screw_tag>()) {
    return x.zip(of_part);
  } else if constexpr (Scalar<T> || !Structured<T>) {
    return x;
  } else {
    return map_scalars(of_part, x);
  }
}

/// Item of a formula that requires the sines and cosines of the C library.
struct library_sines {};

/// Values bound to the symbols of a formula, and its constants.
template <class Held, class... Arguments>
struct bindings : Held, Arguments... {
  static constexpr bool has_library_sines = std::is_base_of_v<holding<library_sines>, Held>;
  /// Floating-point type of the numbers in the formula, by that of the arguments.
  using real = common_scalar_t<real_type_t<scalar_of_t<typename Arguments::value_type>>...>;
  using scalar = common_scalar_t<real, scalar_of_t<typename Arguments::value_type>...>;
};

template <class Symbol, class T>
[[nodiscard]] constexpr const T& value_in(const argument<Symbol, T>& x) {
  return x.value;
}
template <class Node, class T>
[[nodiscard]] constexpr const T& value_in(const holding<held_constant<Node, T>>& x) {
  return x.value;
}

/// Bindings of which only the type of numbers is needed.
template <class Real>
struct numbers_as {
  using real = Real;
};

/// Value of a node that is neither an operation nor bound, such as a number.
template <class Node, class Bindings>
struct leaf;

template <std::uint64_t Bits, class Bindings>
struct leaf<number_node<Bits>, Bindings> {
  static constexpr auto value(const Bindings&) {
    return static_cast<typename Bindings::real>(number_node<Bits>::value);
  }
};
template <kind K, class Bindings>
struct leaf<zero_node<K>, Bindings> {
  static constexpr auto value(const Bindings&) {
    using real = typename Bindings::real;
    constexpr bool is_of_motion = K == kind::dual_vector || K == kind::pose;
    using T = std::conditional_t<is_of_motion, screw_dual<real>, real>;
    if constexpr (K == kind::quaternion || K == kind::pose) {
      return quaternion<T>();
    } else {
      using matrix = Eigen::Matrix<T, K == kind::dual_vector ? 3 : rows_of(K), columns_of(K)>;
      return matrix(matrix::Zero());
    }
  }
};

template <class T>
inline constexpr bool is_argument = false;
template <class Symbol, class T>
inline constexpr bool is_argument<argument<Symbol, T>> = true;

template <class Symbol, class... Arguments>
inline constexpr int times_bound = (0 + ... +
                                    int(std::is_same_v<Symbol, typename Arguments::symbol_type>));

template <class Item, class... Arguments>
inline constexpr bool has_value = true; // a constant
template <kind K, char... Letters, class... Arguments>
inline constexpr bool has_value<symbol_node<K, Letters...>, Arguments...> =
    times_bound<symbol_node<K, Letters...>, Arguments...> > 0;

template <class... Arguments, class... Items>
[[nodiscard]] constexpr bool has_all_values(const held<Items...>*) {
  return (has_value<Items, Arguments...> && ...);
}

/// Error in the arguments of a call.
enum class binding_error { none, unnamed, unknown, repeated, missing };

template <class Held, class... Arguments>
[[nodiscard]] constexpr binding_error find_binding_error() {
  if constexpr (!(is_argument<Arguments> && ...)) {
    return binding_error::unnamed;
  } else if constexpr (!(std::is_base_of_v<holding<typename Arguments::symbol_type>, Held> &&
                         ...)) {
    return binding_error::unknown;
  } else if constexpr (((times_bound<typename Arguments::symbol_type, Arguments...> > 1) || ...)) {
    return binding_error::repeated;
  } else {
    return has_all_values<Arguments...>(static_cast<const Held*>(nullptr)) ? binding_error::none
                                                                           : binding_error::missing;
  }
}
template <class Held, class... Arguments>
inline constexpr binding_error binding_error_of_call = find_binding_error<Held, Arguments...>();

/// Rejected calls of a formula or of a function made from it. A valid call binds one value to each
/// symbol that the formula was written with, and none to others. (The parameters differ in type
/// from those of valid calls: clang 14 does not distinguish functions from a `using` declaration by
/// constraints.)
template <class Held, class Result>
struct refused_calls {
  template <class... Arguments>
    requires(binding_error_of_call<Held, std::remove_cvref_t<Arguments>...> ==
             binding_error::unnamed)
  DUET_REFUSED("formulas are called by name, as f(u = 0.3)")
  Result operator()(Arguments&&...) const;
  template <class... Arguments>
    requires(binding_error_of_call<Held, std::remove_cvref_t<Arguments>...> ==
             binding_error::unknown)
  DUET_REFUSED("a value is given for a symbol that the formula does not have")
  Result operator()(Arguments&&...) const;
  template <class... Arguments>
    requires(binding_error_of_call<Held, std::remove_cvref_t<Arguments>...> ==
             binding_error::repeated)
  DUET_REFUSED("two values are given for one symbol")
  Result operator()(Arguments&&...) const;
  template <class... Arguments>
    requires(binding_error_of_call<Held, std::remove_cvref_t<Arguments>...> ==
             binding_error::missing)
  DUET_REFUSED("a symbol of the formula has no value; say f(u = 0.3, ...) with all of them")
  Result operator()(Arguments&&...) const;
};

/// Type of an ordinary value of a kind, over double.
template <kind K>
struct kind_value {
  using type = decltype(leaf<zero_node<K>, numbers_as<double>>::value({}));
};
template <>
struct kind_value<kind::scalar> {
  using type = double;
};
template <>
struct kind_value<kind::condition> {
  using type = bool;
};
template <kind K>
using value_of_kind = typename kind_value<K>::type;

/// Function made from a formula and called as the formula is, such as a gradient: it returns
/// `Made::of<Node>(bindings)`. `Made::result` has the members of the result.
template <class Made, class F>
class called_by_name : refused_calls<typename F::held_type, typename Made::result> {
public:
  constexpr explicit called_by_name(const F& f) : f_(f) {}

  /// The formula.
  [[nodiscard]] constexpr const F& formula() const { return f_; }

  template <class... Arguments>
    requires(binding_error_of_call<typename F::held_type, Arguments...> == binding_error::none)
  [[nodiscard]] DUET_ALWAYS_INLINE auto operator()(const Arguments&... arguments) const {
    using values = bindings<typename F::held_type, Arguments...>;
    return Made::template of<typename F::node_type>(values{f_.held(), arguments...});
  }
  using refused_calls<typename F::held_type, typename Made::result>::operator();

private:
  F f_;
};

} // namespace duet::expression::detail
