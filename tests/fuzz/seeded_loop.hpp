// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/core/text/csv.hpp>

#include <cstdio>
#include <fstream>
#include <string_view>

/// \file
/// Tests of parsers with mutated inputs. Each file of this folder has `seeds()`, inputs that are
/// right or nearly so, and `target(input)`, which throws `finding` if a guarantee is broken;
/// libfuzzer.cpp makes a fuzzer of it, and the seeded loop a quick test.

namespace duet_fuzz {

struct finding : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool is_kept, const std::string& promise) {
  if (!is_kept) {
    throw finding("not kept: " + promise);
  }
}

/// Requires a message of one line without terminal commands.
inline void require_message(std::string_view message, std::string_view begin) {
  require(message.starts_with(begin), "begins with '" + std::string(begin) + "'");
  for (const char c : message) {
    require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f,
            "one line without control characters: " + std::string(message));
  }
}

/// A text with a few bytes changed, left out, repeated, or replaced by words that tend to do harm.
inline std::string mutated(std::string text, const std::vector<std::string>& seeds,
                           duet_test::random_source& random) {
  static const std::vector<std::string> words{"nan",
                                              "-inf",
                                              "1e400",
                                              "1e-400",
                                              "-0",
                                              "1e308",
                                              "4e-320",
                                              "1403636580838555648",
                                              "#",
                                              ",",
                                              " ",
                                              "\t",
                                              "\n",
                                              "\r\n",
                                              "\r",
                                              "\"",
                                              "<",
                                              ">",
                                              "/>",
                                              "&#27;",
                                              "\x1b[31m",
                                              "\xef\xbb\xbf",
                                              "--",
                                              "=",
                                              "[ns]",
                                              "qw",
                                              "x",
                                              "0x10",
                                              "9999999999999999999",
                                              std::string(1, '\0'),
                                              "\xff\xfe"};
  const auto below = [&](std::size_t n) {
    return n == 0 ? 0 : std::min(std::size_t(random.unit() * double(n)), n - 1);
  };
  for (std::size_t k = 1 + below(4); k > 0; --k) {
    const std::size_t i = below(text.size() + 1);
    const std::size_t length = below(std::min<std::size_t>(text.size() - i + 1, 40));
    switch (below(6)) {
    case 0:
      text.insert(i, words[below(words.size())]);
      break;
    case 1:
      text.replace(i, length, words[below(words.size())]);
      break;
    case 2:
      text.erase(i, length);
      break;
    case 3:
      text.insert(i, text.substr(i, length));
      break;
    case 4: {
      const std::string& other = seeds[below(seeds.size())];
      const std::size_t j = below(other.size() + 1);
      text.replace(i, length, other.substr(j, below(80)));
      break;
    }
    default:
      if (i < text.size()) {
        text[i] = char(below(256));
      }
    }
  }
  return text;
}

/// Runs the seeds and `count` mutated ones, the same in every run.
template <class Target>
void run_seeded(const std::vector<std::string>& seeds, const Target& target, int count) {
  duet_test::random_source random(1);
  const auto run = [&](const std::string& input) {
    try {
      target(input);
    } catch (const std::exception& error) {
      throw finding(std::string(error.what()) + "\nwith the input\n" + input);
    }
  };
  for (const std::string& seed : seeds) {
    run(seed);
  }
  for (int i = 0; i < count; ++i) {
    run(mutated(seeds[std::size_t(i) % seeds.size()], seeds, random));
  }
}

} // namespace duet_fuzz
