// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <boost/program_options.hpp>

#include <cstddef>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

/// \file
/// Command lines, by Boost.Program_options.

namespace example {

namespace po = boost::program_options;

/// What was given; nothing where only help was asked for, which has then been printed.
/// \throws std::exception with a one-line message
class command_line {
public:
  /// \param positional  the option that a bare argument stands for, none if empty
  [[nodiscard]] static std::optional<command_line> parse(int argc, char** argv,
                                                         const po::options_description& description,
                                                         const std::string& positional = {}) {
    require_no_placeholders(argc, argv);
    po::positional_options_description bare;
    if (!positional.empty()) {
      bare.add(positional.c_str(), 1);
    }
    command_line result;
    po::store(
        po::command_line_parser(argc, argv)
            .options(description)
            .style(po::command_line_style::default_style & ~po::command_line_style::allow_guessing)
            .positional(bare)
            .run(),
        result.given_);
    if (result.has("help")) {
      std::cout << description;
      return std::nullopt;
    }
    return result;
  }

  [[nodiscard]] bool has(const std::string& name) const { return given_.count(name) != 0; }

  template <class T>
  [[nodiscard]] std::optional<T> get(const std::string& name) const {
    return has(name) ? std::optional<T>(given_[name].template as<T>()) : std::nullopt;
  }
  [[nodiscard]] std::optional<std::string> text(const std::string& name) const {
    return get<std::string>(name);
  }

private:
  /// Messages of Boost replace `%value%` by the value for as long as there is one: where that holds
  /// `%value%` itself, for ever.
  static void require_no_placeholders(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
      const std::string text(argv[i]);
      for (std::size_t at = 0; (at = text.find('%', at)) != std::string::npos;) {
        const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", at + 1);
        if (end != std::string::npos && end > at + 1 && text[end] == '%') {
          throw std::runtime_error("'" + text + "': no argument may hold " +
                                   text.substr(at, end + 1 - at));
        }
        ++at;
      }
    }
  }

  po::variables_map given_;
};

} // namespace example
