// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <type_traits>

/// \file
/// References to callable objects: code that takes them is compiled once for all.

namespace duet::detail {

/// Reference to a callable object with these arguments and this result, which must live as long.
template <class Signature>
class function_reference;

template <class Result, class... X>
class function_reference<Result(X...)> {
public:
  template <class F>
    requires(!std::is_same_v<F, function_reference>)
  function_reference(const F& f)
      : object_(&f), call_([](const void* object, X... x) -> Result {
          return (*static_cast<const F*>(object))(static_cast<X&&>(x)...);
        }) {}

  Result operator()(X... x) const { return call_(object_, static_cast<X&&>(x)...); }

private:
  const void* object_;
  Result (*call_)(const void*, X...);
};

} // namespace duet::detail
