// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "everything.hpp"

#include <cstdlib>

int version_of_other_file();

int main() { return version_of_other_file() == DUET_VERSION ? EXIT_SUCCESS : EXIT_FAILURE; }
