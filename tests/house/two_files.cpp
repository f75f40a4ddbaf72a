// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "everything.hpp"

#include <doctest/doctest.h>

int version_of_other_file();

TEST_CASE("duet.hpp: two translation units that include it link") {
  CHECK(version_of_other_file() == DUET_VERSION);
}
