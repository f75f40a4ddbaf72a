// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "style.hpp"

#include <duet/core/text/file.hpp>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#if __has_include(<sys/wait.h>)
#include <sys/wait.h>
#endif

/// \file
/// Pictures by gnuplot.

namespace example {

/// The text in single quotes; a quote inside becomes `apostrophe`.
[[nodiscard]] inline std::string quoted(const std::string& text, const char* apostrophe) {
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? std::string(apostrophe) : std::string(1, c);
  }
  return result + "'";
}
[[nodiscard]] inline std::string quoted_for_shell(const std::string& text) {
  return quoted(text, "'\\''");
}

/// Runs a shell command and returns its exit status. Ctrl-C, which only the command receives while
/// it runs, ends this program, too.
inline int run_command(const std::string& command) {
  int status = std::system(command.c_str());
#ifdef WIFSIGNALED
  status = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  if (status == 128 + SIGINT) {
    std::raise(SIGINT);
  }
#endif
  return status;
}

/// Draws folder/name.svg and folder/name.png, both or neither; false if gnuplot is not installed.
/// The script remains in folder/name.gnuplot, where it can be changed and run.
/// \param height  height of the picture in pixels, at a width of `picture_width`
/// \throws std::runtime_error if gnuplot fails, duet::file_error
inline bool draw(const std::string& folder, const std::string& name, int height,
                 const std::string& script) {
  // Run by hand, the script writes to these names; here they are replaced by temporary files.
  const auto output = [&](const std::string& kind) {
    const std::string variable = kind + "_file";
    return "if (!exists('" + variable + "')) " + variable + " = '" + name + "." + kind +
           "'\nset output " + variable + "\n" + picture_style + script + "set output\n";
  };
  const auto size = [&](int scale) {
    return std::to_string(scale * picture_width) + "," + std::to_string(scale * height);
  };
  const std::string path = folder + "/" + name;
  duet::write_file(path + ".gnuplot",
                   "set terminal svg size " + size(1) +
                       " font 'sans-serif,14' background rgb 'white'\n" + output("svg") +
                       "set terminal pngcairo size " + size(2) +
                       " font 'sans-serif,10.5' fontscale 2 linewidth 2 pointscale 2 "
                       "background rgb 'white'\n" +
                       output("png"));
  duet::file_draft svg(path + ".svg"), png(path + ".png");
  const auto absolute = [](const std::string& relative) {
    return std::filesystem::absolute(relative).string();
  };
  const std::string variables = "svg_file=" + quoted(absolute(svg.name()), "''") +
                                "; png_file=" + quoted(absolute(png.name()), "''");
  // The user's start files and the terminal named by the environment are ignored.
  const int status =
      run_command("cd " + quoted_for_shell(absolute(folder)) + " && GNUTERM=svg gnuplot -d -e " +
                  quoted_for_shell(variables) + " '" + name + ".gnuplot' >/dev/null 2>&1");
  if (status == 127) { // the shell did not find gnuplot
    return false;
  }
  if (status != 0) {
    throw std::runtime_error("gnuplot fails to draw " + path + ".gnuplot");
  }
  svg.commit();
  png.commit();
  return true;
}

} // namespace example
