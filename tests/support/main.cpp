// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "support/skip.hpp"

#include <iostream>

namespace {
bool skipped = false;
}

void duet_test::skip(const std::string& reason) {
  std::cout << "SKIPPED: " << reason << std::endl;
  skipped = true;
}

int main(int argc, char** argv) {
  const int failed = doctest::Context(argc, argv).run();
  constexpr int tell_ctest_it_was_skipped = 77;
  return failed == 0 && skipped ? tell_ctest_it_was_skipped : failed;
}
