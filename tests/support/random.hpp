// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/random_source.hpp>

namespace duet_test {

using duet::random_source;

} // namespace duet_test
