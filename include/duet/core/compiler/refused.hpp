// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// Overloads for mistakes: compilers choose them where no other fits, and say at the very line what
/// helps, before anything else. (A failed static_assert in a header is reported after the path by
/// which the header was included.)

/// Stands before a declaration whose use is the mistake. It has no body, and a result of the type
/// that is expected, as far as that is known: else compilers say first that nothing can be done
/// with it, as in `std::cout << f(x)` or `const auto [y, dy] = f(x)`.
/// In plain C++20 it is said as a warning, and then what has no body does not link.
#ifdef DUET_PORTABLE
#define DUET_REFUSED(sentence) [[deprecated("duet: " sentence)]]
#else
#define DUET_REFUSED(sentence) __attribute__((unavailable("duet: " sentence)))
#endif
