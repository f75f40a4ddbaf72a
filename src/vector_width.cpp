// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/compiled.hpp>

const char duet::detail::library_for_this_vector_width = 0;
