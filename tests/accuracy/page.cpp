// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/probe.hpp"
#include "support/test.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>

// docs/reference/accuracy.md: compares a few inputs of every row with its table. The target
// duet_accuracy_page writes the table from many inputs.

namespace test_accuracy_page {
namespace {

using namespace duet_test::accuracy;

rows all_rows(extent e) {
  rows result;
  std::vector families{rotation_rows, pose_rows, curve_rows, mixed_rows};
#ifdef DUET_ACCURACY_IS_WRITTEN // half a minute to compile, two seconds an input
  families.insert(families.begin() + 3, {interpolation_rows, fit_rows});
#endif
  for (const auto family : families) {
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

#ifndef DUET_ACCURACY_IS_WRITTEN
TEST_CASE("accuracy: every function is as accurate as docs/reference/accuracy.md states") {
  std::map<std::string, row> bounds;
  for (const row& r : rows_of(page())) {
    bounds[r.name] = r;
  }
  const rows measured = all_rows(extent::test);
  for (const row& r : measured) {
    INFO(text_of(r));
    REQUIRE_MESSAGE(bounds.count(r.name) == 1,
                    "docs/reference/accuracy.md has no row of this name");
    const row bound = bounds[r.name];
    CHECK(r.inputs > 0);
    CHECK(r.orders == bound.orders);
    for (std::size_t k = 0; k < 5; ++k) {
      CHECK(r.worst[k] <= bound.worst[k]);
    }
    bounds.erase(r.name);
  }
  for (const auto& each : bounds) { // rows that only the program that writes the page computes
    CHECK_MESSAGE((each.first.starts_with("through poses, ") || each.first.starts_with("fit to ")),
                  each.first);
  }
}

#else
double worst_of(const row& r) { return *std::max_element(r.worst.begin(), r.worst.end()); }

/// | build | worst | where | rows with errors above 4 and above twice those of the page |
std::string comparison_of(const rows& measured, const std::map<std::string, row>& page) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  const row& worst =
      *std::max_element(measured.begin(), measured.end(),
                        [](const row& a, const row& b) { return worst_of(a) < worst_of(b); });
  text << "| " << DUET_ACCURACY_IS_WRITTEN << " | " << worst_of(worst) << " | " << worst.name
       << ": " << worst.worst_where << " |";
  const char* separator = " ";
  for (const row& r : measured) {
    const auto before = page.find(r.name);
    const double bound = before == page.end() ? 0 : worst_of(before->second);
    if (worst_of(r) > 2 * bound && worst_of(r) > 4) {
      text << separator << r.name << " " << worst_of(r) << " (" << bound << ")";
      separator = ", ";
    }
  }
  text << (*separator == ' ' ? " none |" : " |");
  return text.str();
}

// DUET_ACCURACY=merge writes the larger of the error on the page, as measured with another
// compiler, and the error measured now. DUET_ACCURACY=compare writes nothing and prints one line
// that compares this build with the page.
TEST_CASE("accuracy: writes docs/reference/accuracy.md") {
  const std::string before = page();
  std::map<std::string, row> old;
  for (const row& r : rows_of(before)) {
    old[r.name] = r;
  }
  rows measured = all_rows(extent::page);
  const char* const variable = std::getenv("DUET_ACCURACY");
  const std::string mode = variable != nullptr ? variable : "";
  if (mode == "compare") {
    std::puts(comparison_of(measured, old).c_str());
    return;
  }
  for (row& r : measured) {
    if (const row& o = old[r.name]; mode == "merge") {
      r.worst_where = worst_of(o) > worst_of(r) ? o.worst_where : r.worst_where;
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
#endif

} // namespace
} // namespace test_accuracy_page
