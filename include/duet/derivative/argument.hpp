// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/owning_result.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Functions and arguments as the drivers take them: traits of functions, arguments of several
/// components, and seeding, which makes components the variables of a differentiation. For those
/// who extend duet.

namespace duet::detail {

/// X, or the vector or matrix that X evaluates to if it is an expression of Eigen.
template <class X>
struct own {
  using type = X;
};
template <class X>
  requires EigenMatrix<X>
struct own<X> {
  using type = typename X::PlainObject;
};
template <class X>
using own_t = typename own<X>::type;

/// The tag of a driver: the caller's, or the differentiated function.
template <class Chosen, class F>
using tag_for = std::conditional_t<std::is_void_v<Chosen>, derivative_tag<std::decay_t<F>>,
                                   derivative_tag<Chosen>>;

/// A parameter that holds real numbers alone.
template <class A>
concept RealParameter = Arithmetic<A> || Real<A> ||(Structured<A>&& requires {
  requires Arithmetic<typename structure<A>::scalar> || Real<typename structure<A>::scalar>;
});

template <class R, class... A>
std::bool_constant<(sizeof...(A) > 0 && (RealParameter<std::decay_t<A>> && ...))>
    has_real_parameters(R (*)(A...));
template <class R, class C, class... A>
std::bool_constant<(sizeof...(A) > 0 && (RealParameter<std::decay_t<A>> && ...))>
    has_real_parameters(R (C::*)(A...));
template <class R, class C, class... A>
std::bool_constant<(sizeof...(A) > 0 && (RealParameter<std::decay_t<A>> && ...))>
has_real_parameters(R (C::*)(A...) const);

/// A function, or an object with one `operator()`, of real numbers, which cannot be differentiated.
template <class F>
concept FunctionOfReals = requires(std::decay_t<F> f) {
  requires decltype(has_real_parameters(f))::value;
}
|| requires { requires decltype(has_real_parameters(&std::decay_t<F>::operator()))::value; };

/// Any other function: accepted by the drivers. (Formulas have separate drivers.)
template <class F>
concept FunctionOfAny = !FunctionOfReals<F> && !is_symbolic<std::remove_cvref_t<F>>;

/// Result of a user's function, as an owning object. (Its type is deduced, so that compilers report
/// the error first, even if only the type is needed.)
template <class X>
[[nodiscard]] constexpr auto result_of_call(X&& x) {
  using result = std::remove_cvref_t<X>;
  require_owning_result<result>();
  static_assert(
      refers_elsewhere<result> || requires { sizeof(structure<result>); },
      "duet: a function must return a scalar, an Eigen vector or matrix, a rotation, a "
      "pose, or an array, standard vector, tuple or pair of these");
  return std::forward<X>(x);
}

} // namespace duet::detail

namespace duet {

/// Callable with a separate function `jacobian`, such as a mechanism, which is not differentiated
/// as a callable. For those who extend duet.
template <class F>
concept HasOwnJacobian = requires {
  typename std::remove_cvref_t<F>::own_jacobian;
};

} // namespace duet

/// Message for a function of real numbers passed to `driver`.
#define DUET_REFUSED_FUNCTION(driver)                                                              \
  DUET_REFUSED(#driver ": the function must take any scalar: [](const auto& x) { ... }")

namespace duet {
namespace detail {

template <class X>
inline constexpr bool is_tuple = false;
template <class... X>
inline constexpr bool is_tuple<std::tuple<X...>> = true;

/// f of each element of an array, a `std::vector` or a tuple, and of the elements of `more` at the
/// same index, in order.
template <class F, class X, class... More>
void for_each_element(const F& f, X& x, More&... more) {
  if constexpr (is_tuple<std::remove_const_t<X>>) {
    const auto visit = [&]<std::size_t K>(std::integral_constant<std::size_t, K>) {
      f(std::get<K>(x), std::get<K>(more)...);
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (visit(std::integral_constant<std::size_t, I>{}), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<X>>{});
  } else {
    for (std::size_t i = 0; i < x.size(); ++i) {
      f(x[i], more[i]...);
    }
  }
}

/// The array, `std::vector` or tuple of f of each element, in order.
template <class F, class T>
[[nodiscard]] auto map_elements(const F& f, const std::vector<T>& x) {
  std::vector<decltype(f(x[0]))> y;
  y.reserve(x.size());
  for (const T& each : x) {
    y.push_back(f(each));
  }
  return y;
}
template <class F, class T, std::size_t N>
[[nodiscard]] auto map_elements(const F& f, const std::array<T, N>& x) {
  return std::apply([&](const auto&... each) { return std::array{f(each)...}; }, x);
}
template <class F, class... X>
[[nodiscard]] auto map_elements(const F& f, const std::tuple<X...>& x) {
  return std::apply([&](const X&... each) { return std::tuple<decltype(f(each))...>{f(each)...}; },
                    x);
}

template <class X>
struct vector_argument;

/// n, or a size known at run time if Eigen considers n too large for the stack.
template <class D>
constexpr int fixed_length(int n) {
  const bool is_large = n > 1 && EIGEN_STACK_ALLOCATION_LIMIT > 0 &&
                        std::size_t(n) * sizeof(D) > std::size_t(EIGEN_STACK_ALLOCATION_LIMIT);
  return is_large ? Eigen::Dynamic : n;
}

/// True for Eigen arguments with rows and columns.
template <class X>
inline constexpr bool is_matrix_argument = false;
template <class X>
  requires EigenMatrix<X>
inline constexpr bool is_matrix_argument<X> =
    X::ColsAtCompileTime != 1 && !bool(X::IsVectorAtCompileTime);
template <class... X>
inline constexpr bool is_matrix_argument<std::tuple<X...>> = (is_matrix_argument<X> || ...);

template <class X>
  requires(EigenMatrix<X> && !is_matrix_argument<X>)
struct vector_argument<X> {
  using scalar = differentiable_t<typename X::Scalar>;
  static constexpr int size_at_compile_time = X::SizeAtCompileTime;
  template <class D>
  using over = Eigen::Matrix<D, fixed_length<D>(X::RowsAtCompileTime),
                             fixed_length<D>(X::ColsAtCompileTime)>;
  static Eigen::Index size(const X& x) { return x.size(); }
  static scalar get(const X& x, Eigen::Index i) { return scalar(x[i]); }
  template <class D>
  static over<D> make(const X& x) {
    return over<D>(x.rows(), x.cols());
  }
};

template <class T, std::size_t N>
  requires(Scalar<T> || Arithmetic<T>)
struct vector_argument<std::array<T, N>> {
  using scalar = differentiable_t<T>;
  static constexpr int size_at_compile_time = int(N);
  template <class D>
  using over = std::array<D, N>;
  static constexpr Eigen::Index size(const std::array<T, N>&) { return Eigen::Index(N); }
  static scalar get(const std::array<T, N>& x, Eigen::Index i) { return scalar(x[std::size_t(i)]); }
  template <class D>
  static over<D> make(const std::array<T, N>&) {
    return {};
  }
};

template <class T>
  requires(Scalar<T> || Arithmetic<T>)
struct vector_argument<std::vector<T>> {
  using scalar = differentiable_t<T>;
  static constexpr int size_at_compile_time = Eigen::Dynamic;
  template <class D>
  using over = std::vector<D>;
  static Eigen::Index size(const std::vector<T>& x) { return Eigen::Index(x.size()); }
  static scalar get(const std::vector<T>& x, Eigen::Index i) { return scalar(x[std::size_t(i)]); }
  template <class D>
  static over<D> make(const std::vector<T>& x) {
    return over<D>(x.size());
  }
};

/// A vector or scalar among several arguments.
template <class X>
struct argument_part;
template <class X>
  requires(!is_tuple<X> && requires { typename vector_argument<X>::scalar; })
struct argument_part<X> : vector_argument<X> {};
template <class X>
  requires(Scalar<X> || Arithmetic<X>)
struct argument_part<X> {
  using scalar = differentiable_t<X>;
  static constexpr int size_at_compile_time = 1;
  template <class D>
  using over = D;
  static constexpr Eigen::Index size(const X&) { return 1; }
  static scalar get(const X& x, Eigen::Index) { return scalar(x); }
  template <class D>
  static over<D> make(const X&) {
    return {};
  }
};

/// The component of a scalar, a vector, or of several arguments one after the other.
template <class X>
[[nodiscard]] DUET_ALWAYS_INLINE auto& component(X& x, Eigen::Index i) {
  if constexpr (Scalar<std::remove_const_t<X>>) {
    return x;
  } else if constexpr (EigenMatrix<X>) {
    return x.coeffRef(i);
  } else {
    return x[std::size_t(i)];
  }
}

/// visit(part, k), where the i-th component of several arguments is the k-th of that part.
template <std::size_t I = 0, class Tuple, class Visit>
decltype(auto) at_component(Tuple& x, Eigen::Index i, const Visit& visit) {
  auto& part = std::get<I>(x);
  if constexpr (I + 1 == std::tuple_size_v<std::remove_const_t<Tuple>>) {
    return visit(part, i);
  } else {
    const Eigen::Index size = argument_part<std::decay_t<decltype(part)>>::size(part);
    return i < size ? visit(part, i) : at_component<I + 1>(x, i - size, visit);
  }
}
template <class... Parts>
[[nodiscard]] auto& component(std::tuple<Parts...>& x, Eigen::Index i) {
  return at_component(
      x, i, [](auto& part, Eigen::Index k) -> auto& { return component(part, k); });
}

/// Several arguments, scalars and vectors: their components one after the other.
template <class... X>
  requires(sizeof...(X) > 0 && (requires { typename argument_part<X>::scalar; } && ...))
struct vector_argument<std::tuple<X...>> {
  using scalar = std::common_type_t<typename argument_part<X>::scalar...>;
  static constexpr int size_at_compile_time =
      ((argument_part<X>::size_at_compile_time == Eigen::Dynamic) || ...)
          ? Eigen::Dynamic
          : (argument_part<X>::size_at_compile_time + ...);
  template <class D>
  using over = std::tuple<typename argument_part<X>::template over<D>...>;
  static Eigen::Index size(const std::tuple<X...>& x) {
    return std::apply([](const X&... part) { return (argument_part<X>::size(part) + ...); }, x);
  }
  static scalar get(const std::tuple<X...>& x, Eigen::Index i) {
    return at_component(x, i, []<class Part>(const Part& part, Eigen::Index k) {
      return scalar(argument_part<Part>::get(part, k));
    });
  }
  template <class D>
  static over<D> make(const std::tuple<X...>& x) {
    return std::apply(
        [](const X&... part) { return over<D>{argument_part<X>::template make<D>(part)...}; }, x);
  }
};

/// Calls f with x, or with the elements of the tuple x if f takes several arguments instead of one
/// tuple.
template <class F, class X>
[[nodiscard]] DUET_ALWAYS_INLINE decltype(auto) call(F&& f, const X& x) {
  constexpr bool takes_several = [] {
    if constexpr (is_tuple<X>) {
      return !std::is_invocable_v<F&, const X&>;
    } else {
      return false; // without a call, so that compilers instantiate f only by f(x)
    }
  }();
  if constexpr (takes_several) {
    return std::apply(f, x);
  } else {
    return f(x);
  }
}

} // namespace detail

/// Variables of a differentiation: an Eigen vector, a `std::array` or `std::vector` of scalars, or
/// a `std::tuple` of these and of scalars, whose components follow one after the other.
template <class X>
concept Variables = requires {
  typename detail::vector_argument<X>::scalar;
};

/// An argument of several components: an Eigen vector, a `std::array` or `std::vector` of scalars.
template <class X>
concept VectorLike = Variables<X> && !detail::is_tuple<X>;

} // namespace duet

/// Rejects variables that `driver` does not support: matrices, several arguments that are not a
/// tuple, and a single number, for which there is `of_one`; then the type of its result.
#define DUET_REFUSES_ARGUMENTS(driver, of_one, ...)                                                \
  template <class Tag = void, detail::FunctionOfAny F, class X>                                    \
    requires(detail::is_matrix_argument<X> && !HasOwnJacobian<F>)                                  \
  DUET_REFUSED("differentiate with respect to a vector, not to a matrix: " #driver                 \
               "(f, x.reshaped())")                                                                \
  __VA_ARGS__ driver(F&&, const X&);                                                               \
  template <class Tag = void, detail::FunctionOfAny F, class A, class B, class... More>            \
    requires(!FrameConstant<B> && !HasOwnJacobian<F>)                                              \
  DUET_REFUSED("pass several arguments as a tuple: " #driver "(f, std::tuple(a, b))")              \
  __VA_ARGS__ driver(F&&, const A&, const B&, const More&...);                                     \
  template <class Tag = void, detail::FunctionOfAny F, class X>                                    \
    requires((Scalar<X> || Arithmetic<X>)&&!HasOwnJacobian<F>)                                     \
  DUET_REFUSED(#driver                                                                             \
               " differentiates with respect to a vector; with respect to one number use " of_one) \
  __VA_ARGS__ driver(F&&, const X&);

/// Rejects matrices for a `driver` with more arguments, `rest` in the message.
#define DUET_REFUSES_MATRICES(driver, rest, ...)                                                   \
  template <class Tag = void, detail::FunctionOfAny F, class X, class... Rest>                     \
    requires(detail::is_matrix_argument<X> && sizeof...(Rest) > 0)                                 \
  DUET_REFUSED("differentiate with respect to a vector, not to a matrix: " #driver                 \
               "(f, x.reshaped(), " rest ")")                                                      \
  __VA_ARGS__ driver(F&&, const X&, Rest&&...);
#define DUET_REFUSES_MATRICES_IN_CHUNKS(driver, rest, ...)                                         \
  template <int Chunk = 0, class Tag = void, detail::FunctionOfAny F, class X, class J>            \
    requires(detail::is_matrix_argument<X>)                                                        \
  DUET_REFUSED("differentiate with respect to a vector, not to a matrix: " #driver                 \
               "(f, x.reshaped(), " rest ")")                                                      \
  __VA_ARGS__ driver(F&&, const X&, J&&);

namespace duet {
namespace detail {

/// Maximum number of components differentiated in a single pass.
inline constexpr int single_pass_limit = 32;
/// Maximum number of components per pass if there are several passes, which are as few as possible.
/// Measured: each pass computes all values again, but longer rows cost more per partial, the sooner
/// the shorter vectors are.
inline constexpr int pass_limit = DUET_BATCH_BYTES < 64 ? 50 : 64;
/// Components per pass over a vector whose size is known only at run time: a short one pays for
/// all.
inline constexpr int chunk = 16;

/// Partials per pass, for passes of equal size.
[[nodiscard]] constexpr int balanced_chunk(int size) {
  const int passes = std::max(1, (size + pass_limit - 1) / pass_limit);
  return std::max(1, (size + passes - 1) / passes);
}

/// Partials per pass over the components of an X; `Chosen` by the caller, or 0 for the default.
template <class X, int Chosen = 0>
inline constexpr int
    partials_per_pass = Chosen > 0 ? Chosen
                        : vector_argument<X>::size_at_compile_time == Eigen::Dynamic
                            ? chunk
                            : balanced_chunk(vector_argument<X>::size_at_compile_time);

/// x over D, every component a constant.
template <class D, class X>
[[nodiscard]] auto constants(const X& x) {
  using argument = vector_argument<X>;
  auto result = argument::template make<D>(x);
  for (Eigen::Index i = 0; i < argument::size(x); ++i) {
    component(result, i) = D(argument::get(x, i));
  }
  return result;
}

/// x, of a size known at compile time, over D, every component a variable.
template <class D, class X>
[[nodiscard]] auto seeded(const X& x) {
  using argument = vector_argument<X>;
  auto result = argument::template make<D>(x);
  unrolled<argument::size_at_compile_time>([&](int i) DUET_INLINE_LAMBDA {
    component(result, i) = D::variable(argument::get(x, i), i);
  });
  return result;
}

/// x + ε v over D.
///
/// \throws invalid_input if the sizes differ; the message names the driver and v
template <class D, class X, class V>
[[nodiscard]] auto moving(const char* driver, const X& x, const char* name, const V& v) {
  using T = typename D::value_type;
  using argument = vector_argument<X>;
  using direction = vector_argument<V>;
  require(argument::size(x) == direction::size(v), "duet: ", driver, ": the point has ",
          argument::size(x), " components, the ", name, " ", direction::size(v));
  auto result = argument::template make<D>(x);
  for (Eigen::Index i = 0; i < argument::size(x); ++i) {
    component(result, i) = D(T(argument::get(x, i)), T(direction::get(v, i)));
  }
  return result;
}

/// x over the duals of one pass over its components, every one a constant.
template <class Tag, int Chosen, class X>
[[nodiscard]] auto constants_of_pass(const X& x) {
  return constants<dual<typename vector_argument<X>::scalar, partials_per_pass<X, Chosen>, Tag>>(x);
}

/// Calls visit(f(x seeded from `first`), first, count) for every pass over the components of x.
/// Between passes only the nonzero partials change.
template <class Tag, int Chosen = 0, class F, class X, class Visit>
void for_each_pass(F&& f, const X& x, Visit&& visit) {
  using argument = vector_argument<X>;
  constexpr int n = partials_per_pass<X, Chosen>;
  using T = typename argument::scalar;
  using D = dual<T, n, Tag>;
  const Eigen::Index size = argument::size(x);
  if constexpr (0 < argument::size_at_compile_time && argument::size_at_compile_time <= n) {
    const auto variables = seeded<D>(x);
    visit(result_of_call(call(f, variables)), 0, size);
  } else {
    auto variables = constants<D>(x);
    for (Eigen::Index first = 0; first < size; first += n) {
      const Eigen::Index count = std::min<Eigen::Index>(n, size - first);
      const auto set_diagonal = [&](const T& slope) {
        for (Eigen::Index i = 0; i < count; ++i) {
          component(variables, first + i).set_partial(int(i), slope);
        }
      };
      set_diagonal(T(1));
      visit(result_of_call(call(f, variables)), first, count);
      set_diagonal(T(0));
    }
  }
}

} // namespace detail
} // namespace duet
