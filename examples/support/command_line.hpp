// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <memory>
#include <optional>
#include <string>

/// \file
/// Command lines, by Boost.Program_options, whose headers are read once, for command_line.cpp.

namespace example {

/// The options that a program knows. What is given with one is a `T`: an int, a long long, a
/// std::uint64_t, a double, a std::string or, where the option may be repeated, a
/// std::vector<std::string>.
class option_list {
public:
  /// \param title  what --help prints before the options
  explicit option_list(const std::string& title);

  template <class T>
  option_list& value(const char* name, const char* placeholder, const char* help);
  option_list& flag(const char* name, const char* help);

private:
  friend class command_line;
  struct data;
  std::shared_ptr<data> data_;
};

/// What was given.
class command_line {
public:
  /// Nothing where only help was asked for, which has then been printed.
  /// \param positional  the option that a bare argument stands for, none if empty
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
