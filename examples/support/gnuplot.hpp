// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "style.hpp"

#include <duet/core/text/file.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

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

/// Removes a file and returns its content; empty if it does not exist.
[[nodiscard]] inline std::string removed(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string result{std::istreambuf_iterator<char>(in), {}};
  in.close();
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return result;
}

/// Draws folder/name.svg and folder/name.png if gnuplot draws both without an error; false if
/// gnuplot is not installed. The script remains in folder/name.gnuplot, where it can be changed and
/// run. If the program is killed, temporary files `.duet-….part` may remain.
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
  duet::require_writable(path + ".svg");
  duet::require_writable(path + ".png");
  const auto time = std::chrono::system_clock::now().time_since_epoch().count();
  const std::string temporary = ".duet-" + std::to_string(time) + "-" + name;
  const std::string svg_file = temporary + ".svg.part", png_file = temporary + ".png.part";
  const std::string variables =
      "svg_file=" + quoted(svg_file, "''") + "; png_file=" + quoted(png_file, "''");
  // The user's start files and the terminal named by the environment are ignored. By `umask` nobody
  // else may read the temporary files, as the previous pictures may be private.
  const int status =
      run_command("cd " + quoted_for_shell(std::filesystem::absolute(folder).string()) +
                  " && umask 077 && GNUTERM=svg gnuplot -d -e " + quoted_for_shell(variables) +
                  " '" + name + ".gnuplot' >/dev/null 2>&1");
  const std::string svg = removed(folder + "/" + svg_file), png = removed(folder + "/" + png_file);
  if (status == 127) { // the shell did not find gnuplot
    return false;
  }
  if (status != 0) {
    throw std::runtime_error("gnuplot fails to draw " + path + ".gnuplot");
  }
  duet::write_file(path + ".svg", svg);
  duet::write_file(path + ".png", png);
  return true;
}

} // namespace example
