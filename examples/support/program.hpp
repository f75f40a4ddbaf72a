// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>

#include <csignal>
#include <cstdio>
#include <exception>
#include <initializer_list>
#include <iostream>
#include <stdexcept>
#include <string>

/// \file
/// Signals, output and errors of all programs.

namespace example {

/// Signals that end the program, such as Ctrl-C, first remove its temporary files. Ignored signals,
/// as under nohup, remain ignored.
inline void remove_drafts_on_signals() {
  for (const int number : {
#ifdef SIGHUP
           SIGHUP, SIGPIPE,
#endif
           SIGINT, SIGTERM}) {
    const auto before = std::signal(number, [](int caught) {
      duet::remove_drafts();
      std::signal(caught, SIG_DFL);
      std::raise(caught);
    });
    if (before == SIG_IGN) {
      std::signal(number, SIG_IGN);
    }
  }
}

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
  remove_drafts_on_signals();
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
