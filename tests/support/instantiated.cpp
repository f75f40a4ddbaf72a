// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#define DUET_TEST_INSTANTIATED template
#include "support/instantiated.hpp"
