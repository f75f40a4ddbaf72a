// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "everything.hpp"

int version_of_other_file();
int version_of_other_file() { return DUET_VERSION; }
