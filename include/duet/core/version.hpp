// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// Version of duet, for `#if` and for messages. docs/reference/versioning.md states its guarantees.

#define DUET_VERSION_MAJOR 1
#define DUET_VERSION_MINOR 0
#define DUET_VERSION_PATCH 0

/// Compare as a number: `#if DUET_VERSION >= 10200` means 1.2.0 or later.
#define DUET_VERSION (DUET_VERSION_MAJOR * 10000 + DUET_VERSION_MINOR * 100 + DUET_VERSION_PATCH)
#define DUET_VERSION_STRING "1.0.0"
