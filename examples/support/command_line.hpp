// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <memory>
#include <optional>
#include <string>

/// \file
/// Command lines by Boost.Program_options, whose headers are compiled once, in command_line.cpp.

namespace example {

/// The options of a program. The value of an option is a `T`: an int, a long long, a std::uint64_t,
/// a double, a std::string or, if the option may be repeated, a std::vector<std::string>.
class option_list {
public:
  /// \param title  text that --help prints before the options
  explicit option_list(const std::string& title);

  template <class T>
  option_list& value(const char* name, const char* placeholder, const char* help);
  option_list& flag(const char* name, const char* help);

private:
  friend class command_line;
  struct data;
  std::shared_ptr<data> data_;
};

/// The options of a command line with their values.
class command_line {
public:
  /// Returns nothing if only help was requested, which has then been printed.
  /// \param positional  the option whose value an argument without a name is; empty for none
  /// \throws std::exception with a one-line message
  [[nodiscard]] static std::optional<command_line>
  parse(int argc, char** argv, const option_list& known, const std::string& positional = {});

  [[nodiscard]] bool has(const std::string& name) const;

  template <class T>
  [[nodiscard]] std::optional<T> get(const std::string& name) const;
  [[nodiscard]] std::optional<std::string> text(const std::string& name) const;

private:
  struct data;
  std::shared_ptr<const data> data_;
};

} // namespace example
