// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/owning_result.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Formulas from functions: `trace` calls a function that is generic over scalars with recorded
/// numbers.

namespace duet::expression {

namespace detail {

template <class Node>
struct symbol_facts;
template <kind K, char... Letters>
struct symbol_facts<symbol_node<K, Letters...>> {
  static std::string name() { return {Letters...}; }
};

/// Type of the object over S that stands for a symbol of a kind.
template <kind K, class S>
struct object_of_kind {
  using type = Eigen::Matrix<S, rows_of(K), columns_of(K)>;
  static constexpr shape what = shape::matrix;
  static constexpr int rows = rows_of(K), columns = columns_of(K);
};
template <class S>
struct object_of_kind<kind::scalar, S> {
  using type = S;
  static constexpr shape what = shape::scalar;
  static constexpr int rows = 1, columns = 1;
};
template <class S>
struct object_of_kind<kind::quaternion, S> {
  using type = quaternion<S>;
  static constexpr shape what = shape::quaternion;
  static constexpr int rows = 4, columns = 1;
};
template <class S>
struct object_of_kind<kind::dual_vector, S> {
  using type = vector3<screw_dual<S>>;
  static constexpr shape what = shape::dual_vector;
  static constexpr int rows = 6, columns = 1;
};
template <class S>
struct object_of_kind<kind::pose, S> {
  using type = dual_quaternion<S>;
  static constexpr shape what = shape::pose;
  static constexpr int rows = 8, columns = 1;
};

// The numbers of an object, in the order of `shape`.

/// f(s) of every scalar of an object.
template <class X, class F>
void for_each_component(X& x, const F& f) {
  using plain = std::remove_const_t<X>;
  if constexpr (is_quaternion<plain>) {
    std::array components{x.w(), x.x(), x.y(), x.z()};
    for (auto& s : components) {
      f(s);
    }
    if constexpr (!std::is_const_v<X>) {
      x = plain(components[0], components[1], components[2], components[3]);
    }
  } else if constexpr (duet::detail::EigenMatrix<plain>) {
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      for (Eigen::Index i = 0; i < x.rows(); ++i) {
        f(x(i, j));
      }
    }
  } else {
    f(x);
  }
}

/// f(x) of every number; of rigid motions real parts first.
template <class X, class F>
void for_each_number(X& x, const F& f) {
  using plain = std::remove_const_t<X>;
  if constexpr (is_screw_dual<typename structure<plain>::scalar>) {
    constexpr bool is_const = std::is_const_v<X>;
    for (const bool is_dual : {false, true}) {
      auto each = [&](auto& component) {
        auto number = is_dual ? component.epsilon() : component.value();
        f(number);
        if constexpr (!is_const) {
          component = is_dual
                          ? std::remove_cvref_t<decltype(component)>(component.value(), number)
                          : std::remove_cvref_t<decltype(component)>(number, component.epsilon());
        }
      };
      for_each_component(x, each);
    }
  } else {
    for_each_component(x, f);
  }
}
/// An object of a named value's nodes.
template <class X>
[[nodiscard]] X recorded_object(graph& g, const named_value& value) {
  X x{};
  std::size_t i = 0;
  for_each_number(x, [&](recorded& s) { s = recorded(g, value.nodes[i++]); });
  return x;
}

template <class X>
inline constexpr bool is_fielded = requires(const X& x) {
  x.for_each_field([](const char*, const auto&) {});
};
template <class X>
inline constexpr bool is_tuple = false;
template <class... X>
inline constexpr bool is_tuple<std::tuple<X...>> = true;
template <class A, class B>
inline constexpr bool is_tuple<std::pair<A, B>> = true;
template <class X>
inline constexpr bool is_list = false;
template <class T, class A>
inline constexpr bool is_list<std::vector<T, A>> = true;
template <class T, std::size_t N>
inline constexpr bool is_list<std::array<T, N>> = true;

template <class X>
[[nodiscard]] constexpr shape shape_of(const X&) {
  if constexpr (is_quaternion<X>) {
    return is_screw_dual<typename structure<X>::scalar> ? shape::pose : shape::quaternion;
  } else if constexpr (duet::detail::EigenMatrix<X>) {
    return is_screw_dual<typename X::Scalar> ? shape::dual_vector : shape::matrix;
  } else {
    return shape::scalar;
  }
}

/// Adds what a function returned to the outputs: of a tuple, list or struct its elements.
template <class X>
void add_outputs(formula_graph& f, const std::string& name, const X& x) {
  const auto numbered = [&](int i) { return (name.empty() ? "y" : name) + std::to_string(i); };
  if constexpr (is_fielded<X>) {
    x.for_each_field([&](const char* field, const auto& part) {
      add_outputs(f, name.empty() ? std::string(field) : name + "_" + field, part);
    });
  } else if constexpr (is_tuple<X>) {
    int i = 0;
    std::apply([&](const auto&... part) { (add_outputs(f, numbered(++i), part), ...); }, x);
  } else if constexpr (is_list<X>) {
    int i = 0;
    for (const auto& part : x) {
      add_outputs(f, numbered(++i), part);
    }
  } else {
    named_value y{.name = name.empty() ? "y" : name, .kind = shape_of(x)};
    for_each_number(x,
                    [&](const auto& s) { y.nodes.push_back(recorded(s).node_in(f.operations())); });
    y.rows = int(y.nodes.size());
    if constexpr (duet::detail::EigenMatrix<X>) {
      y.columns = y.kind == shape::matrix ? int(x.cols()) : 1;
      y.rows /= y.columns == 0 ? 1 : y.columns;
    }
    f.add_output(std::move(y));
  }
}

template <class Node>
using recorded_symbol = typename object_of_kind<Node::kind_of, recorded>::type;

/// Adds symbols as inputs, and gives the objects that stand for them.
template <class... Nodes>
[[nodiscard]] std::tuple<recorded_symbol<Nodes>...> add_inputs(formula_graph& f) {
  const auto add = [&]<class Node>(std::type_identity<Node>) {
    using facts = object_of_kind<Node::kind_of, recorded>;
    const named_value x = f.add_input({.name = symbol_facts<Node>::name(),
                                       .kind = facts::what,
                                       .rows = facts::rows,
                                       .columns = facts::columns});
    return recorded_object<typename facts::type>(f.operations(), x);
  };
  return std::tuple<recorded_symbol<Nodes>...>{add(std::type_identity<Nodes>{})...};
}

/// x over S, whose numbers are the next of some in the order of the outputs.
template <class S, class X>
[[nodiscard]] auto object_over(const X& x, const S*& next) {
  if constexpr (is_tuple<X>) {
    return std::apply(
        [&](const auto&... part) {
          return std::tuple<decltype(object_over<S>(part, next))...>{object_over<S>(part, next)...};
        },
        x);
  } else if constexpr (is_list<X>) {
    std::vector<decltype(object_over<S>(x[0], next))> result;
    for (const auto& part : x) {
      result.push_back(object_over<S>(part, next));
    }
    return result;
  } else if constexpr (is_screw_dual<typename structure<X>::scalar>) {
    constexpr int size = is_quaternion<X> ? 4 : 3;
    const S* const numbers = next;
    next += 2 * size;
    int i = 0;
    return map_scalars(
        [&](const auto&) {
          const int k = i++;
          return screw_dual<S>(numbers[k], numbers[k + size]);
        },
        x);
  } else {
    return map_scalars([&](const auto&) { return *next++; }, x);
  }
}

} // namespace detail

/// A function that was traced: a formula as data that remembers what the function returns.
template <class Result, class... Nodes>
class traced_formula : public formula_graph {
public:
  traced_formula(formula_graph f, Result result)
      : formula_graph(std::move(f)), result_(std::move(result)) {}

  /// The value where symbols have values: `f(u = 0.3, w = w0)`, over any scalars; of a pair or
  /// tuple a tuple, of a list a vector.
  template <class... Arguments>
    requires(sizeof...(Arguments) == sizeof...(Nodes) && Structured<Result> &&
             (detail::is_argument<Arguments> && ...) &&
             ((detail::times_bound<Nodes, Arguments...> == 1) && ...))
  [[nodiscard]] auto operator()(const Arguments&... arguments) const {
    using S = detail::common_scalar_t<detail::scalar_of_t<typename Arguments::value_type>...>;
    std::vector<S> inputs;
    const auto add = [&]<class Node>(std::type_identity<Node>, const auto& argument) {
      if constexpr (std::is_same_v<Node,
                                   typename std::remove_cvref_t<decltype(argument)>::symbol_type>) {
        detail::for_each_number(argument.value, [&](const auto& s) { inputs.push_back(S(s)); });
      }
    };
    const auto add_symbol = [&](auto node) { (add(node, arguments), ...); };
    (add_symbol(std::type_identity<Nodes>{}), ...);
    const std::vector<S> values = evaluate(*this, inputs);
    const S* next = values.data();
    return detail::object_over<S>(result_, next);
  }

private:
  Result result_;
};

/// The function as a formula: it is called once, with recorded numbers for the symbols,
/// which are its arguments in their order. It must be generic over scalars, and must branch on
/// values by `duet::select` only. Squares in it are taken as neither overflowing nor vanishing:
/// duet's functions of rotations leave out their rescaling.
///
/// \throws invalid_input naming the condition where the function branches on a value
template <class F, Symbol... S>
  requires(sizeof...(S) > 0)
[[nodiscard]] auto trace(F&& f, const S&...) {
  formula_graph g;
  auto arguments = detail::add_inputs<typename S::node_type...>(g);
  auto result = std::apply(f, arguments);
  duet::detail::require_owning_result<decltype(result)>();
  detail::add_outputs(g, "", result);
  using traced = traced_formula<decltype(result), typename S::node_type...>;
  return traced(std::move(g), std::move(result));
}

/// The function of a column of any size as a formula with the input `x`, for more numbers than a
/// symbol has. It is called once, with an `Eigen::Matrix<recorded, Eigen::Dynamic, 1>`, and must be
/// generic over scalars; it may branch on values by `duet::select` only.
///
/// \param size  number of components, at least 1
/// \throws invalid_input for a size below 1, and where the function branches on a value
template <class F>
[[nodiscard]] formula_graph trace(F&& f, int size) {
  duet::detail::require(size > 0, "duet: trace: the column has ", size,
                        " numbers (expected at least 1)");
  formula_graph g;
  const auto result = f(detail::add_column<Eigen::Matrix<recorded, Eigen::Dynamic, 1>>(g, size));
  duet::detail::require_owning_result<decltype(result)>();
  detail::add_outputs(g, "", result);
  return g;
}

namespace detail {

/// A formula that is called by name, over the symbols that it holds.
template <class F, class... Items>
[[nodiscard]] formula_graph graph_of_items(const F& f, const held<Items...>*) {
  formula_graph g;
  const auto symbol_argument = [&]<class Item>(std::type_identity<Item>) {
    if constexpr (is_symbol<Item>) {
      auto objects = add_inputs<Item>(g);
      using object = std::tuple_element_t<0, decltype(objects)>;
      return std::tuple<argument<Item, object>>{{std::get<0>(objects)}};
    } else {
      return std::tuple<>{};
    }
  };
  // In braces, which are evaluated in their order: that of the inputs.
  std::tuple<decltype(symbol_argument(std::type_identity<Items>{}))...> parts{
      symbol_argument(std::type_identity<Items>{})...};
  const auto arguments =
      std::apply([](const auto&... part) { return std::tuple_cat(part...); }, parts);
  add_outputs(g, "", std::apply(f, arguments));
  return g;
}

template <class F>
struct held_by;
template <class Node, class Held>
struct held_by<formula<Node, Held>> {
  using type = Held;
};
template <class Made, class F>
struct held_by<called_by_name<Made, F>> : held_by<F> {};

} // namespace detail

/// A formula, or what `gradient`, `hessian`, `jacobian` or `motion` make of one.
template <class F>
concept TypedFormula = requires {
  typename detail::held_by<F>::type;
};

/// A formula as data: of a typed formula, or of its gradient, Jacobian and so on, with the outputs
/// `value`, `gradient` … . Inputs are the symbols in the order in which they were written.
template <TypedFormula F>
[[nodiscard]] formula_graph graph_of(const F& f) {
  return detail::graph_of_items(f, static_cast<const typename detail::held_by<F>::type*>(nullptr));
}
/// A formula that is data already.
[[nodiscard]] inline const formula_graph& graph_of(const formula_graph& f) { return f; }

} // namespace duet::expression
