// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <concepts>
#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>

/// \file
/// Results as text, field by field.

namespace duet {
namespace detail {

/// Placeholder for a visitor of the fields of a result.
struct any_field {
  void operator()(std::string_view, const auto&) const {}
};

} // namespace detail

/// A result with accessible fields: `x.for_each_field(f)` calls f(name, field) for each.
template <class X>
concept Result = requires(const X& x) {
  x.for_each_field(detail::any_field{});
};

namespace detail {

/// A class with a separate `to_text` in its namespace, as rotations and poses have.
template <class X>
concept TextOfItsOwn = std::is_class_v<X> && requires(const X& x) {
  { to_text(x) } -> std::convertible_to<std::string>;
};

template <class X>
[[nodiscard]] std::string field_text(const X& x);

/// The first and the last of more than eight numbers, or of more than two of other things.
template <class X>
[[nodiscard]] std::string list_text(const X& x) {
  constexpr std::size_t max_shown = std::is_arithmetic_v<std::decay_t<decltype(x[0])>> ? 8 : 2;
  std::string text = "(";
  const auto size = std::size_t(x.size());
  for (std::size_t i = 0; i < size; ++i) {
    if (size > max_shown && i == max_shown / 2) {
      i = size - max_shown / 2;
      text += ", ... ";
    } else if (i > 0) {
      text += ", ";
    }
    text += field_text(x[i]);
  }
  return text + ")" + (size > max_shown ? message(" of ", size) : "");
}

/// (x, y, z) of a column, [a, b; c, d] of another matrix of Eigen.
template <class M>
[[nodiscard]] std::string matrix_text(const M& m, bool is_column) {
  std::string text(is_column ? "(" : "[");
  for (std::ptrdiff_t i = 0; i < m.rows(); ++i) {
    for (std::ptrdiff_t j = 0; j < m.cols(); ++j) {
      text += i == 0 && j == 0 ? "" : j == 0 && !is_column ? "; " : ", ";
      text += field_text(m(i, j));
    }
  }
  return text + (is_column ? ")" : "]");
}

/// A number, vector, matrix, rotation, list of these …; empty for types without text.
template <class X>
std::string field_text(const X& x) {
  if constexpr (std::same_as<X, bool>) {
    return x ? "yes" : "no";
  } else if constexpr (Result<X>) {
    std::string text;
    x.for_each_field([&text](std::string_view name, const auto& field) {
      text += (text.empty() ? "" : ", ") + std::string(name) + " " + field_text(field);
    });
    return "{" + text + "}";
  } else if constexpr (std::is_enum_v<X> || TextOfItsOwn<X>) {
    return std::string(to_text(x));
  } else if constexpr (requires {
                         X::ColsAtCompileTime;
                         x(0, 0);
                       }) {
    return matrix_text(x, X::ColsAtCompileTime == 1);
  } else if constexpr (requires { x.isCompressed(); }) { // a sparse matrix
    return message(x.rows(), " x ", x.cols(), ", ", x.nonZeros(), " entries");
  } else if constexpr (requires(std::ostream & out) { out << x; }) {
    return message(x);
  } else if constexpr (requires {
                         x.size();
                         x[0];
                       }) {
    return list_text(x);
  } else {
    return {};
  }
}

template <Result X>
void append_fields(std::string& text, const std::string& prefix, const X& x) {
  x.for_each_field([&]<class Field>(std::string_view name, const Field& field) {
    const std::string full = prefix + std::string(name);
    if constexpr (Result<Field>) {
      append_fields(text, full + ".", field);
    } else {
      text += full + ": " + field_text(field) + "\n";
    }
  });
}

} // namespace detail

/// The fields of a result, `name: value` on a line each: numbers to six digits, vectors as (x, y,
/// z), rotations as (w, x, y, z), poses as (w, x, y, z) at (x, y, z), matrices as [a, b; c, d],
/// long lists by their first and last entries.
///
/// Example: `std::cout << to_text(gradient(f, x));`
template <Result X>
[[nodiscard]] std::string to_text(const X& x) {
  std::string text;
  detail::append_fields(text, "", x);
  return text;
}

/// A vector of Eigen as (x, y, z), a matrix as [a, b; c, d].
template <class M>
  requires requires(const M& m) {
    M::ColsAtCompileTime;
    m(0, 0);
  }
[[nodiscard]] std::string to_text(const M& m) { return detail::field_text(m); }

} // namespace duet
