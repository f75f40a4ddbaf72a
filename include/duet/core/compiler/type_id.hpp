// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <type_traits>

/// \file
/// Types as data: an address for each type, by which a constant expression finds the type again.

namespace duet::detail {

/// An object whose address identifies a type.
template <class T>
inline constexpr char type_id = 0;

#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wunknown-warning-option"
#pragma GCC diagnostic ignored "-Wnon-template-friend"
#endif
template <const char* Id>
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
template <const char* Id>
using type_of_id = std::remove_pointer_t<decltype(find_type(type_key<Id>{}))>;

} // namespace duet::detail
