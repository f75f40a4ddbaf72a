// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/csv.hpp>

#include <cstdlib>
#include <string>

/// \file
/// Pictures by gnuplot.

namespace example {

/// Draws folder/name.svg and folder/name.png; false where gnuplot is absent or fails.
inline bool draw(const std::string& folder, const std::string& name, const std::string& size,
                 const std::string& script) {
  duet::write_file(folder + "/" + name + ".gnuplot",
                   "set terminal svg size " + size + " background rgb 'white'\nset output '" +
                       name + ".svg'\n" + script + "set output\nset terminal pngcairo size " +
                       size + "\nset output '" + name + ".png'\n" + script);
  std::string quoted = "'";
  for (const char c : folder) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  const std::string command =
      "cd " + quoted + "' && gnuplot '" + name + ".gnuplot' >/dev/null 2>&1";
  return std::system(command.c_str()) == 0;
}

} // namespace example
