// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

/// \file
/// Replaces operator new by one that counts: for one file of a program only.

namespace duet_test {

inline std::size_t allocations = 0;

} // namespace duet_test

void* operator new(std::size_t size) {
  ++duet_test::allocations;
  if (void* block = std::malloc(size)) {
    return block;
  }
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
