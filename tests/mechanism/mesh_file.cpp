// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"

#include <duet/core/compiler/bit_cast.hpp>
#include <duet/mechanism/mesh_file.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace test_mechanism_mesh_file {
namespace {

using namespace duet;

const std::string name = "test_mechanism_mesh_file";

std::string bytes(std::uint32_t x) {
  std::string result;
  for (unsigned i = 0; i < 4; ++i) {
    result += char((x >> (8 * i)) & 0xffU);
  }
  return result;
}
std::string bytes(float x) { return bytes(detail::bit_cast<std::uint32_t>(x)); }

/// A binary file whose corner k of triangle i is (i, k, .5), with a header that says solid.
std::string binary(std::uint32_t triangles) {
  std::string result = "solid but binary" + std::string(64, ' ') + bytes(triangles);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    result += bytes(0.F) + bytes(0.F) + bytes(1.F);
    for (int k = 0; k < 3; ++k) {
      result += bytes(float(i)) + bytes(float(k)) + bytes(.5F);
    }
    result += std::string(2, '\0');
  }
  return result;
}

std::string write(const std::string& ending, const std::string& content) {
  std::ofstream(name + ending, std::ios::binary) << content;
  return name + ending;
}

/// What is wrong, behind the file's name.
std::string fault(const std::string& ending, const std::string& content) {
  const std::string path = write(ending, content);
  const std::string message = duet_test::message_of<file_error>([&] { (void)read_mesh(path); });
  const std::string begin = "duet: " + path + ":";
  return message.starts_with(begin) ? message.substr(begin.size()) : message;
}

const std::string facet =
    "  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1e-1 0 0\n"
    "      vertex 0 +2 -3\n    endloop\n  endfacet\n";

} // namespace

TEST_CASE("binary STL, also with a header as text has it, and however it is spelt") {
  for (const char* ending : {".stl", ".STL"}) {
    const auto m = read_mesh(write(ending, binary(3)));
    REQUIRE(m.corners.size() == 9);
    CHECK(m.corners[5] == std::array<double, 3>{1, 2, .5});
    CHECK(m.corners[8] == std::array<double, 3>{2, 2, .5});
  }
  std::string bad = binary(2);
  bad.replace(84 + 50 + 12 + 4, 4, bytes(std::numeric_limits<float>::infinity()));
  CHECK(fault(".stl", bad) == " triangle 1 has a corner that is not finite");
  CHECK(fault(".stl", binary(0)) == " has no triangles");
  // One byte is missing: it is no binary file then, and no text either.
  CHECK(fault(".stl", binary(2).substr(0, 183)) == "1: the file ends before \"endsolid\"");
  CHECK(fault(".stl", std::string(90, 'x')) ==
        " is no STL: neither does it begin with \"solid\", nor has it the length of a binary file "
        "with as many triangles as it says");
  CHECK(fault(".stl", "").find("is no STL") != std::string::npos);
}

TEST_CASE("STL as text: several solids, blank lines, and each line that is another") {
  const auto m = read_mesh(write(".stl", "solid one\n\n" + facet + facet +
                                             "endsolid one\r\nsolid\n" + facet + "endsolid"));
  REQUIRE(m.corners.size() == 9);
  CHECK(m.corners[1] == std::array<double, 3>{.1, 0, 0});
  CHECK(m.corners[8] == std::array<double, 3>{0, 2, -3});
  const auto without = [&](const std::string& text, const std::string& other) {
    std::string result = "solid x\n" + facet + "endsolid x\n";
    return fault(".stl", result.replace(result.find(text), text.size(), other));
  };
  CHECK(without("facet normal 0 0 1", "facet 0 0 1") ==
        "2: \"facet normal x y z\" or \"endsolid\" expected");
  CHECK(without("outer loop", "loop") == "3: \"outer loop\" expected");
  CHECK(without("vertex 0 0 0\n", "") == "6: \"vertex x y z\" expected");
  CHECK(without("vertex 0 0 0", "vertex 0 0 0 0") == "4: \"vertex x y z\" expected");
  CHECK(without("vertex 0 0 0", "vertex 0 O 0") == "4: \"O\" is no number");
  CHECK(without("vertex 0 0 0", "vertex 0 nan 0") == "4: \"nan\" is no number");
  CHECK(without("    endloop\n", "") == "7: \"endloop\" expected");
  CHECK(without("endsolid x\n", "") == "8: the file ends before \"endsolid\"");
  CHECK(without("endsolid x\n", "endsolid x\nfacet") == "10: \"solid\" expected");
}

TEST_CASE("OBJ: triangles, faces of more corners, numbers from the end back") {
  const std::string corners = "# a square\no it\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 .1 .2 .3\nv 0 1 0\n";
  const auto m = read_mesh(
      write(".obj", corners + "vn 0 0 1\ns off\nf 1//1 2//1 3/4/1 4\n#f 9\nf -1 -2 -3\n"));
  REQUIRE(m.corners.size() == 9);
  CHECK(m.corners[4] == std::array<double, 3>{1, 1, 0});
  CHECK(m.corners[5] == std::array<double, 3>{0, 1, 0});
  CHECK(m.corners[6] == std::array<double, 3>{0, 1, 0});
  CHECK(m.corners[8] == std::array<double, 3>{1, 0, 0});
  CHECK(read_mesh(write(".obj", "\xef\xbb\xbf" + corners + "f 1 2 3")).corners.size() == 3);
  CHECK(fault(".obj", corners) == " has no triangles");
  CHECK(fault(".obj", corners + "f 1 2\n") == "7: a face has three corners or more");
  for (const char* bad : {"0", "5", "-5", "1.5", "x", "", "nan", "1e99"}) {
    const std::string text(bad);
    CHECK(fault(".obj", corners + "f 1 2 " + text + "/7\n") ==
          "7: \"" + text + "/7\" is no corner of the 4 vertices before");
  }
  CHECK(fault(".obj", "v 1 2\n") == "1: \"v x y z\" expected");
  CHECK(fault(".obj", "v 1 2 inf\n") == "1: \"inf\" is no number");
  CHECK(fault(".obj", corners + "face 1 2 3\n") == "7: unknown statement \"face\"");
}

TEST_CASE("other files, and none") {
  CHECK(fault(".dae", "<COLLADA/>") == " is neither .stl nor .obj");
  CHECK(duet_test::message_of<file_error>([] { (void)read_mesh("nowhere.stl"); }) ==
        "duet: nowhere.stl: cannot be read");
  CHECK(duet_test::message_of<file_error>([] { (void)read_mesh("."); }) ==
        "duet: .: is a folder, not a file");
}

} // namespace test_mechanism_mesh_file
