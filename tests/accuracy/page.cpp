// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/probe.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

// docs/accuracy.md: a few inputs of every row are held against its table, which is written anew
// from many of them by the target duet_accuracy_page.

namespace test_accuracy_page {

using namespace duet_test::accuracy;

namespace {

rows all_rows(extent e) {
  rows result;
  for (const auto family : {rotation_rows, pose_rows, mixed_rows}) {
    for (const row& r : family(e)) {
      result.push_back(r);
    }
  }
  return result;
}

const std::string begin_of_table = "|---|---|---|---|---|---|---|---|\n";

std::string page() {
  std::ifstream file(DUET_ACCURACY_PAGE);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// | name | inputs | value | 1st | 2nd | 3rd | 4th | where |
rows rows_of(const std::string& page) {
  rows result;
  std::istringstream lines(page.substr(page.find(begin_of_table) + begin_of_table.size()));
  for (std::string line; std::getline(lines, line) && line.starts_with("| ");) {
    std::istringstream cells(line);
    std::array<std::string, 9> cell;
    for (std::string& c : cell) {
      std::getline(cells, c, '|');
      c.erase(0, c.find_first_not_of(' '));
      c.erase(c.find_last_not_of(' ') + 1);
    }
    row r{cell[1], std::strtol(cell[2].c_str(), nullptr, 10)};
    for (std::size_t k = 0; k < 5; ++k) {
      r.worst[k] = std::strtod(cell[3 + k].c_str(), nullptr);
      r.orders = cell[3 + k].empty() ? r.orders : int(k);
    }
    r.worst_where = cell[8];
    result.push_back(r);
  }
  return result;
}

/// Rounded up to one decimal.
std::string text_of(const row& r) {
  std::ostringstream text;
  text << "| " << r.name << " | " << r.inputs << " |";
  for (int k = 0; k < 5; ++k) {
    char number[32] = "";
    if (k <= r.orders) {
      const double worst = r.worst[std::size_t(k)];
      std::snprintf(number, sizeof number, " %.1f", std::ceil(worst * 10) / 10);
    }
    text << number << " |";
  }
  text << " " << r.worst_where << " |\n";
  return text.str();
}

} // namespace

TEST_CASE("every function is as accurate as docs/accuracy.md says") {
  std::map<std::string, row> bounds;
  for (const row& r : rows_of(page())) {
    bounds[r.name] = r;
  }
  const rows measured = all_rows(extent::test);
  CHECK(measured.size() == bounds.size());
  for (const row& r : measured) {
    INFO(text_of(r));
    REQUIRE_MESSAGE(bounds.count(r.name) == 1, "docs/accuracy.md has no row of that name");
    const row& bound = bounds[r.name];
    CHECK(r.inputs > 0);
    CHECK(r.orders == bound.orders);
    for (std::size_t k = 0; k < 5; ++k) {
      CHECK(r.worst[k] <= bound.worst[k]);
    }
  }
}

// With DUET_ACCURACY=merge the worst of what the page says, as measured with another compiler, and
// what is measured now.
TEST_CASE("docs/accuracy.md is written" * doctest::skip()) {
  const std::string before = page();
  rows measured = all_rows(extent::page);
  const char* const mode = std::getenv("DUET_ACCURACY");
  if (mode != nullptr && std::string(mode) == "merge") {
    std::map<std::string, row> old;
    for (const row& r : rows_of(before)) {
      old[r.name] = r;
    }
    for (row& r : measured) {
      const row& o = old[r.name];
      if (*std::max_element(o.worst.begin(), o.worst.end()) >
          *std::max_element(r.worst.begin(), r.worst.end())) {
        r.worst_where = o.worst_where;
      }
      for (std::size_t k = 0; k < 5; ++k) {
        r.worst[k] = std::max(r.worst[k], o.worst[k]);
      }
    }
  }
  const std::size_t first = before.find(begin_of_table) + begin_of_table.size();
  const std::size_t last = before.find("\n\n", first);
  std::ofstream file(DUET_ACCURACY_PAGE);
  file << before.substr(0, first);
  for (const row& r : measured) {
    file << text_of(r);
  }
  file << (last == std::string::npos ? "" : before.substr(last + 1));
  CHECK(file.good());
}

} // namespace test_accuracy_page
