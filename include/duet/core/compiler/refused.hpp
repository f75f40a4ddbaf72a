// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// Overloads that catch mistakes: compilers choose them if no other overload fits, and first print
/// a remedy for the line of the mistake. (A failed static_assert in a header is reported after the
/// path by which the header was included.)

/// Precedes a declaration whose use is a mistake. It has no body, and a result of the expected
/// type, as far as it is known: otherwise compilers first report that the result cannot be used, as
/// in `std::cout << f(x)` or `const auto [y, dy] = f(x)`.
///
/// Plain C++20 gives a warning, and the missing body does not link.
#ifdef DUET_PORTABLE
#define DUET_REFUSED(sentence) [[deprecated("duet: " sentence)]]
#else
#define DUET_REFUSED(sentence) __attribute__((unavailable("duet: " sentence)))
#endif
