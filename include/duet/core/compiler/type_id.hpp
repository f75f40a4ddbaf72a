// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <type_traits>

/// \file
/// Types as data: an address for each type, by which a constant expression finds the type again.

namespace duet::detail {

/// Object that represents a type.
struct type_mark {
  const char* name; ///< name of the type by g++, otherwise null
};
/// A text that names the type, by g++.
template <class T>
[[nodiscard]] constexpr const char* name_for_type() {
#if defined(__GNUC__) && !defined(__clang__)
  return __PRETTY_FUNCTION__;
#else
  return nullptr;
#endif
}
/// An object whose address identifies a type.
template <class T>
inline constexpr type_mark type_id = {name_for_type<T>()};

/// True if both identify one type.
///
/// With -fsanitize=undefined, g++ compares no addresses of inline variables in constant
/// expressions, as they could be null. Names then decide, which two lambdas of one function share
/// if neither is generic.
[[nodiscard]] constexpr bool is_same_type(const type_mark* a, const type_mark* b) {
#if defined(__GNUC__) && !defined(__clang__)
  if (std::is_constant_evaluated() && !__builtin_constant_p(a == b)) {
    return a->name == b->name;
  }
#endif
  return a == b;
}
static_assert(is_same_type(&type_id<int>, &type_id<int>) &&
                  !is_same_type(&type_id<int>, &type_id<char>),
              "duet: the compiler does not tell types apart by addresses");

#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wunknown-warning-option"
#pragma GCC diagnostic ignored "-Wnon-template-friend"
#endif
template <const type_mark* Id>
struct type_key {
  friend constexpr auto find_type(type_key<Id>); // defined by `registered_type`
};
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

/// Once this is complete for a type, `type_of_id` finds the type.
template <class T>
struct registered_type {
  friend constexpr auto find_type(type_key<&type_id<T>>) { return static_cast<T*>(nullptr); }
};

/// The registered type of an address.
template <const type_mark* Id>
using type_of_id = std::remove_pointer_t<decltype(find_type(type_key<Id>{}))>;

} // namespace duet::detail
