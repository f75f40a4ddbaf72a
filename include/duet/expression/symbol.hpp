// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

/// \file
/// Variables of formulas, by name: `symbol<"u"> u;`. Symbols of equal name and kind are the same
/// variable.

namespace duet::expression {

/// A name as a template argument.
template <std::size_t Size>
struct name {
  char letters[Size]; ///< the name and a zero
  constexpr name(const char (&text)[Size]) { std::copy_n(text, Size, letters); }
};

namespace detail {

template <kind K, name Name, class Letters>
struct symbol_of;
template <kind K, name Name, std::size_t... I>
struct symbol_of<K, Name, std::index_sequence<I...>> {
  static_assert(sizeof...(I) > 0, "duet: a symbol needs a name");
  using node = symbol_node<K, Name.letters[I]...>;
  using type = formula<node, held<node>>;
};

template <kind K, name Name>
using symbol_of_kind =
    typename symbol_of<K, Name, std::make_index_sequence<sizeof(Name.letters) - 1>>::type;

} // namespace detail

/// A scalar variable.
template <name Name>
using symbol = detail::symbol_of_kind<kind::scalar, Name>;
/// Three scalars.
template <name Name>
using vector_symbol = detail::symbol_of_kind<kind::vector, Name>;
/// A rotation, by a unit quaternion.
template <name Name>
using quaternion_symbol = detail::symbol_of_kind<kind::quaternion, Name>;
/// A line, screw or twist n + εm, by a dual vector (N12).
template <name Name>
using dual_vector_symbol = detail::symbol_of_kind<kind::dual_vector, Name>;
/// A rigid motion, by a unit dual quaternion.
template <name Name>
using pose_symbol = detail::symbol_of_kind<kind::pose, Name>;

} // namespace duet::expression
