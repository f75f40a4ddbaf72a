// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "everything.hpp"
