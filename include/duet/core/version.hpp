// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// The version of duet, for `#if` and for messages.

#define DUET_VERSION_MAJOR 0
#define DUET_VERSION_MINOR 1
#define DUET_VERSION_PATCH 0

/// Compare as a number: `#if DUET_VERSION >= 100` means 0.1.0 or later.
#define DUET_VERSION (DUET_VERSION_MAJOR * 10000 + DUET_VERSION_MINOR * 100 + DUET_VERSION_PATCH)
#define DUET_VERSION_STRING "0.1.0"
