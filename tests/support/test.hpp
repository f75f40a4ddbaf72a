// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// doctest and the headers of the standard library that most tests use.

/// An expression throws invalid_input with this message.
#define DUET_CHECK_REFUSED(message, ...)                                                           \
  CHECK_THROWS_WITH_AS(static_cast<void>(__VA_ARGS__), message, duet::invalid_input)
