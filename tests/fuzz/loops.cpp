// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "fuzz/seeded_loop.hpp"

#include <duet/io/loop_file.hpp>

// Files of loops: numbers that are read are finite, errors are messages of one line.

namespace test_fuzz_loops {

std::vector<std::string> seeds() {
  return {"# closes the frame\nhinge coupler .5 0 0  rocker 0.4 0 0 # in front\r\n",
          "rod base 1 0 0  plate 0.1 0 -2e-3  length 0.8\nball a 0 0 1 b 0 0 0\n",
          "slider a 1 2 3 rpy 0.1 0.2 0.3  b 0 0 0 axis 0 0 2\nweld a 0 0 0 b 0 0 0"};
}

void target(const std::string& input) {
  const std::string path = "fuzz_loops.txt";
  std::ofstream(path, std::ios::binary) << input;
  try {
    for (const duet::loop_constraint& loop : duet::read_loops(path).loops) {
      for (const duet::constraint_frame* end : {&loop.first, &loop.second}) {
        const auto& [r, t] = end->offset;
        duet_fuzz::require(std::all_of(t.begin(), t.end(), [](double x) { return x - x == 0; }),
                           "finite places");
        duet_fuzz::require(std::abs(squared_norm(r) - 1) < 1e-12, "rotations");
        duet_fuzz::require(!end->link.empty(), "links");
      }
      duet_fuzz::require((loop.length > 0) == (loop.kind == duet::constraint_kind::distance),
                         "rods alone have lengths");
    }
  } catch (const duet::file_error& error) {
    duet_fuzz::require_message(error.what(), "duet: " + path + ":");
  }
  std::remove(path.c_str());
}

TEST_CASE("loop files: mutated ones are read correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 2000);
}

} // namespace test_fuzz_loops
