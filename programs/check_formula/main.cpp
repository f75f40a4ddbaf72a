// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The program duet-check-formula: is a formula the derivative of another, or does it equal it?

#include "check_formula.hpp"

#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/core/version.hpp>

#include <boost/program_options.hpp>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace po = boost::program_options;
using namespace check_formula;
using texts = std::vector<std::string>;

constexpr int all_agree = 0, some_disagree = 1, bad_input = 2;

[[nodiscard]] po::options_description known_options() {
  po::options_description known(
      "usage: duet-check-formula CLAIM --derivative-of FORMULA --wrt NAME [option ...]\n"
      "       duet-check-formula CLAIM --equals FORMULA [option ...]\n"
      "       duet-check-formula --file FILE [--json]\n\n"
      "Checks a formula at special and random inputs in 50 digits.\n"
      "Exit status: 0 all claims agree, 1 some disagree, 2 invalid input or no value.\n\n"
      "Options");
  known.add_options()("derivative-of", po::value<std::string>()->value_name("FORMULA"),
                      "the claim is its derivative")(
      "wrt", po::value<std::string>()->value_name("NAME"),
      "with respect to this scalar, or as the gradient with respect to this vector")(
      "equals", po::value<std::string>()->value_name("FORMULA"), "the claim equals it")(
      "vector", po::value<texts>()->value_name("NAMES"), "inputs that are vectors, as v,w")(
      "rotation", po::value<texts>()->value_name("NAMES"), "inputs that are unit quaternions")(
      "range", po::value<texts>()->value_name("X=LOW:HIGH"),
      "range of an input, of a vector's numbers (default: all)")(
      "file", po::value<std::string>()->value_name("FILE"),
      "claims, one a line, as on this command line; # begins a comment")(
      "json", "print each judgement as a line of JSON")("help", "print this")("version",
                                                                              "print the version");
  return known;
}

/// The options of a command line, or of a line of a file, without the name of the program.
[[nodiscard]] po::variables_map parsed(const texts& arguments) {
  for (const std::string& each : arguments) { // in Boost's messages %...% would be replaced
    if (each.find('%') != std::string::npos) {
      throw std::runtime_error("'" + each + "': % has no meaning here");
    }
  }
  po::options_description known = known_options();
  known.add_options()("claim", po::value<std::string>());
  po::positional_options_description bare;
  bare.add("claim", 1);
  using namespace po::command_line_style;
  po::variables_map result;
  po::store(po::command_line_parser(arguments)
                .options(known)
                .style(allow_long | long_allow_adjacent | long_allow_next) // -x is a formula
                .positional(bare)
                .run(),
            result);
  return result;
}

[[nodiscard]] texts split(const std::string& list, char separator) {
  texts result(1);
  for (const char c : list) {
    if (c == separator) {
      result.emplace_back();
    } else {
      result.back() += c;
    }
  }
  return result;
}

/// The names that an option lists.
[[nodiscard]] texts names(const po::variables_map& options, const char* option) {
  texts result;
  if (options.count(option) != 0) {
    for (const std::string& list : options[option].as<texts>()) {
      for (const std::string& name : split(list, ',')) {
        if (name.empty()) {
          throw std::runtime_error("--" + std::string(option) + " is '" + list +
                                   "' (expected names separated by commas)");
        }
        result.push_back(name);
      }
    }
  }
  return result;
}

[[nodiscard]] claim claim_of(const po::variables_map& options) {
  const auto text = [&](const char* option) {
    return options.count(option) != 0
               ? std::optional<std::string>(options[option].as<std::string>())
               : std::nullopt;
  };
  if (!text("claim")) {
    throw std::runtime_error("there is no claim (expected a formula; see --help)");
  }
  if (text("derivative-of").has_value() == text("equals").has_value()) {
    throw std::runtime_error("expected either --derivative-of or --equals; see --help");
  }
  if (text("derivative-of").has_value() != text("wrt").has_value()) {
    throw std::runtime_error("--derivative-of and --wrt belong together; see --help");
  }
  claim c{.text = *text("claim"),
          .reference = *text(text("equals") ? "equals" : "derivative-of"),
          .wrt = text("wrt"),
          .vectors = names(options, "vector"),
          .rotations = names(options, "rotation")};
  if (options.count("range") != 0) {
    for (const std::string& each : options["range"].as<texts>()) {
      const texts parts = split(each, '=');
      const texts ends = split(parts.back(), ':');
      const auto low = duet::parse_number(ends.front()), high = duet::parse_number(ends.back());
      if (parts.size() != 2 || ends.size() != 2 || !low || !high || !(*low < *high) ||
          !(*high - *low < 1e300)) {
        throw std::runtime_error("--range is '" + each + "' (expected name=low:high)");
      }
      c.ranges[parts[0]] = {*low, *high};
    }
  }
  return c;
}

[[nodiscard]] std::string input_text(const input_texts& input) {
  std::string text;
  for (const auto& [name, value] : input) {
    text += (text.empty() ? "" : ", ") + name + " = " + value;
  }
  return text;
}

void print(const claim& c, const judgement& j) {
  const std::string relation =
      c.wrt ? "the derivative of " + c.reference + " with respect to " + *c.wrt : c.reference;
  std::cout << outcome_text(j) << ": " << duet::printable(c.text) << (c.wrt ? " as " : " = ")
            << duet::printable(relation) << "\n";
  if (j.simplest) {
    std::cout << "  simplest input:  " << input_text(j.simplest->input) << "\n"
              << "    claimed:       " << j.simplest->claimed << "\n"
              << (c.wrt ? "    derivative:    " : "    other side:    ") << j.simplest->expected
              << "\n";
  }
  if (j.outcome == verdict::disagrees && c.wrt) {
    std::cout << "  the derivative:  " << j.right << "\n";
    if (!j.right_latex.empty()) {
      std::cout << "    in LaTeX:      " << j.right_latex << "\n";
    }
  }
  std::cout << "  inputs:          " << j.agree << " agree, " << j.disagree << " disagree";
  if (j.undecided > 0) {
    std::cout << ", " << j.undecided << " hidden by round-off";
  }
  if (j.neither > 0) {
    std::cout << ", " << j.neither << " without a value";
  }
  std::cout << "\n";
  if (j.is_proved) {
    std::cout << "  proof:           equal by algebra wherever they have values\n";
  }
  if (j.first_one_sided) {
    const bool is_claim = !j.first_one_sided->claimed.empty();
    std::cout << "  one-sided:       " << j.one_sided << ", such as "
              << input_text(j.first_one_sided->input) << ", where the "
              << (is_claim ? (c.wrt ? "derivative" : "other side") : "claim") << " has no value\n";
  }
  if (!j.loss.empty()) {
    std::cout << "  double:          the claim loses more than half of the digits at "
              << input_text(j.loss) << "\n";
  }
}

void complain(const std::string& problem) {
  std::cout.flush();
  std::cerr << duet::printable("duet-check-formula: " + problem) + "\n";
}

/// The exit status of a claim, which is printed.
[[nodiscard]] int check(const po::variables_map& options, bool as_json, const std::string& where) {
  try {
    const claim c = claim_of(options);
    const judgement j = judge(c);
    if (as_json) {
      std::cout << to_json(c, j) << "\n";
    } else {
      print(c, j);
    }
    if (j.outcome == verdict::no_value) {
      complain(where + "there is no input at which both sides have a value (try --range)");
    }
    return j.outcome == verdict::agrees      ? all_agree
           : j.outcome == verdict::disagrees ? some_disagree
                                             : bad_input;
  } catch (const std::exception& error) {
    complain(where + error.what());
    return bad_input;
  }
}

[[nodiscard]] int check_file(const std::string& name, bool as_json) {
  std::ifstream file(name);
  if (!file) {
    throw std::runtime_error(name + ": cannot be opened");
  }
  int status = all_agree, number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') {
      continue;
    }
    const std::string where = name + ":" + std::to_string(number) + ": ";
    try {
      if (line.back() == '\r') {
        line.pop_back();
      }
      const po::variables_map options = parsed(po::split_unix(line));
      if (options.count("file") != 0) {
        throw std::runtime_error("--file in a file");
      }
      status = std::max(status, check(options, as_json || options.count("json") != 0, where));
    } catch (const std::exception& error) {
      complain(where + error.what());
      status = bad_input;
    }
  }
  return status;
}

[[nodiscard]] int run(int argc, char** argv) {
  const po::variables_map options = parsed(texts(argv + std::min(argc, 1), argv + argc));
  if (options.count("help") != 0) {
    std::cout << known_options();
    return all_agree;
  }
  if (options.count("version") != 0) {
    std::cout << "duet-check-formula " DUET_VERSION_STRING "\n";
    return all_agree;
  }
  const bool as_json = options.count("json") != 0;
  return options.count("file") != 0 ? check_file(options["file"].as<std::string>(), as_json)
                                    : check(options, as_json, "");
}

} // namespace

int main(int argc, char** argv) {
  int status = bad_input;
  try {
    status = run(argc, argv);
  } catch (const std::exception& error) {
    complain(error.what());
  }
  std::cout.flush();
  if (!std::cout) {
    complain("standard output: not all of it could be written");
    status = bad_input;
  }
  return status;
}
