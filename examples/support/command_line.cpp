// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "command_line.hpp"

#include <boost/program_options.hpp>

#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace example {
namespace {

namespace po = boost::program_options;

/// Messages of Boost replace `%value%` by the value again and again: if the value contains
/// `%value%` itself, the replacement never ends.
void require_no_placeholders(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string text(argv[i]);
    for (std::size_t at = 0; (at = text.find('%', at)) != std::string::npos;) {
      const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", at + 1);
      if (end != std::string::npos && end > at + 1 && text[end] == '%') {
        throw std::runtime_error("'" + text + "': an argument must not contain " +
                                 text.substr(at, end + 1 - at));
      }
      ++at;
    }
  }
}

} // namespace

struct option_list::data {
  po::options_description description;
};

option_list::option_list(const std::string& title)
    : data_(std::make_shared<data>(data{po::options_description(title)})) {}

template <class T>
option_list& option_list::value(const char* name, const char* placeholder, const char* help) {
  data_->description.add_options()(name, po::value<T>()->value_name(placeholder), help);
  return *this;
}

option_list& option_list::flag(const char* name, const char* help) {
  data_->description.add_options()(name, help);
  return *this;
}

struct command_line::data {
  po::variables_map values;
};

std::optional<command_line> command_line::parse(int argc, char** argv, const option_list& known,
                                                const std::string& positional) {
  require_no_placeholders(argc, argv);
  const po::options_description& description = known.data_->description;
  po::positional_options_description bare;
  if (!positional.empty()) {
    bare.add(positional.c_str(), 1);
  }
  const auto parsed = std::make_shared<data>();
  po::store(
      po::command_line_parser(argc, argv)
          .options(description)
          .style(po::command_line_style::default_style & ~po::command_line_style::allow_guessing)
          .positional(bare)
          .run(),
      parsed->values);
  command_line result;
  result.data_ = parsed;
  if (result.has("help")) {
    std::cout << description;
    return std::nullopt;
  }
  return result;
}

bool command_line::has(const std::string& name) const { return data_->values.count(name) != 0; }

template <class T>
std::optional<T> command_line::get(const std::string& name) const {
  return has(name) ? std::optional<T>(data_->values[name].as<T>()) : std::nullopt;
}

std::optional<std::string> command_line::text(const std::string& name) const {
  return get<std::string>(name);
}

template option_list& option_list::value<int>(const char*, const char*, const char*);
template option_list& option_list::value<long long>(const char*, const char*, const char*);
template option_list& option_list::value<std::uint64_t>(const char*, const char*, const char*);
template option_list& option_list::value<double>(const char*, const char*, const char*);
template option_list& option_list::value<std::string>(const char*, const char*, const char*);
template option_list& option_list::value<std::vector<std::string>>(const char*, const char*,
                                                                   const char*);
template std::optional<int> command_line::get(const std::string&) const;
template std::optional<long long> command_line::get(const std::string&) const;
template std::optional<std::uint64_t> command_line::get(const std::string&) const;
template std::optional<double> command_line::get(const std::string&) const;
template std::optional<std::string> command_line::get(const std::string&) const;
template std::optional<std::vector<std::string>> command_line::get(const std::string&) const;

} // namespace example
