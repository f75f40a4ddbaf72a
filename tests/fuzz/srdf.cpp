// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "fuzz/seeded_loop.hpp"

#include <duet/io/srdf.hpp>

// Pairs of links: the names that are read occur in the file, errors are messages of one line.

namespace test_fuzz_srdf {

std::vector<std::string> seeds() {
  const std::string pair = "<disable_collisions link1=\"a\" link2=\"b\" reason=\"Adjacent\"/>\n";
  return {"<?xml version=\"1.0\" ?>\n<!-- arm -->\n<robot name=\"panda\">\n"
          "  <group name=\"arm\"><chain base_link=\"a\" tip_link=\"c\"/></group>\n  " +
              pair + "  <disable_collisions link1='b' link2='c&amp;d'></disable_collisions>\n" +
              "</robot>\n",
          "<robot>" + pair + pair + "</robot>",
          "<robot>" + pair + "<enable_collisions link1=\"a\" link2=\"b\"/></robot>",
          "<robot><disable_collisions link1=\"a\" link3=\"b\"/></robot>",
          "<robot><disable_default_collisions link=\"a\"/>" + pair + "</robot>"};
}

void target(const std::string& input) {
  const std::string path = "fuzz_srdf.srdf";
  std::ofstream(path, std::ios::binary) << input;
  try {
    const auto pairs = duet::read_disabled_collisions(path);
    // `<disable_collisions link1="a" link2="b"/>` is the shortest text of a pair.
    duet_fuzz::require(pairs.size() * 41 <= input.size(), "pairs of the file");
    for (const duet::link_pair& each : pairs) {
      duet_fuzz::require(!each.first.empty() && !each.second.empty() && each.first != each.second,
                         "pairs of two links");
    }
  } catch (const duet::file_error& error) {
    duet_fuzz::require_message(error.what(), "duet: " + path + ":");
  }
  std::remove(path.c_str());
}

TEST_CASE("SRDF files: mutated ones are read correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 2000);
}

} // namespace test_fuzz_srdf
