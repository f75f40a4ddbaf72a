// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/printable.hpp>

#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

/// \file
/// Output and errors of all programs.

namespace example {

/// \throws std::runtime_error if not all of the standard output could be written
inline void flush_output() {
  std::cout.flush();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout) {
    throw std::runtime_error("standard output: not all of it could be written");
  }
}

/// Calls `body` and returns the exit status: that of `body`, or 1 with one line on standard error
/// if it throws or its standard output could not be written.
template <class Body>
int run_program(const std::string& name, const Body& body) {
  try {
    const int status = body();
    flush_output();
    return status;
  } catch (const std::exception& error) {
    std::fflush(stdout);
    std::cerr << duet::printable(name + ": " + error.what()) + "\n" << std::flush;
    return 1;
  }
}

} // namespace example
