// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/io/mesh_file.hpp>

#include <fstream>

namespace test_io_mesh_file {
namespace {

using namespace duet;

const std::string name = "test_io_mesh_file";

std::string bytes(std::uint32_t x) {
  std::string result;
  for (unsigned i = 0; i < 4; ++i) {
    result += char((x >> (8 * i)) & 0xffU);
  }
  return result;
}
std::string bytes(float x) { return bytes(detail::bit_cast<std::uint32_t>(x)); }

/// A binary file whose vertex k of triangle i is (i, k, .5), with a header that begins with
/// "solid".
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

/// Error message, without the name of the file.
std::string error_of(const std::string& ending, const std::string& content) {
  const std::string path = write(ending, content);
  const std::string message = duet_test::message_of<file_error>([&] { (void)read_mesh(path); });
  const std::string begin = "duet: " + path + ":";
  return message.starts_with(begin) ? message.substr(begin.size()) : message;
}

const std::string facet =
    "  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1e-1 0 0\n"
    "      vertex 0 +2 -3\n    endloop\n  endfacet\n";

TEST_CASE("read_mesh: binary STL with a text-like header and padding") {
  for (const char* ending : {".stl", ".STL"}) {
    const auto m = read_mesh(write(ending, binary(3)));
    REQUIRE(m.vertices.size() == 9);
    CHECK(m.vertices[5] == std::array<double, 3>{1, 2, .5});
    CHECK(m.vertices[8] == std::array<double, 3>{2, 2, .5});
  }
  for (const std::string& rest :
       {std::string("\n"), std::string(49, 'x'), std::string(428, '\0')}) {
    CHECK(read_mesh(write(".stl", binary(3) + rest)).vertices.size() == 9);
  }
  // More than padding: the number of triangles is wrong.
  CHECK(error_of(".stl", binary(3) + std::string(50, 'x')) ==
        "1: the file ends before \"endsolid\"");
  std::string bad = binary(2);
  bad.replace(84 + 50 + 12 + 4, 4, bytes(std::numeric_limits<float>::infinity()));
  CHECK(error_of(".stl", bad) == " triangle 1 has a vertex that is not finite");
  CHECK(error_of(".stl", binary(0)) == " the file contains no triangles");
  // With one byte missing it is neither a binary nor a text file.
  CHECK(error_of(".stl", binary(2).substr(0, 183)) == "1: the file ends before \"endsolid\"");
  CHECK(error_of(".stl", std::string(90, 'x')) ==
        " the file is not STL: it neither begins with \"solid\" nor has the length of a binary "
        "file with its number of triangles");
  CHECK(error_of(".stl", "").find("is not STL") != std::string::npos);
}

TEST_CASE("read_mesh: text STL, and an error for every wrong line") {
  const auto m = read_mesh(write(".stl", "solid one\n\n" + facet + facet +
                                             "endsolid one\r\nsolid\n" + facet + "endsolid"));
  REQUIRE(m.vertices.size() == 9);
  CHECK(m.vertices[1] == std::array<double, 3>{.1, 0, 0});
  CHECK(m.vertices[8] == std::array<double, 3>{0, 2, -3});
  const auto without = [&](const std::string& text, const std::string& other) {
    std::string result = "solid x\n" + facet + "endsolid x\n";
    return error_of(".stl", result.replace(result.find(text), text.size(), other));
  };
  const auto expected = [](const std::string& line, const char* form, const char* text) {
    return line + ": \"" + form + "\" expected, not \"" + text + "\"";
  };
  const char* const normal = "facet normal x y z";
  for (const char* bad : {"facet 0 0 1", "facet normal 0 0", "facet normal 0 0 1 2",
                          "facet nrmal 0 0 1", "fact normal 0 0 1", "facet\tnormal 0\f0 1"}) {
    CHECK(without("facet normal 0 0 1", bad) ==
          expected("2", normal, duet::printable(bad).c_str()));
  }
  for (const char* bad : {"loop", "outer", "outer lop", "outr loop", "outer loop loop"}) {
    CHECK(without("outer loop", bad) == expected("3", "outer loop", bad));
  }
  CHECK(without("vertex 0 0 0\n", "") == expected("6", "vertex x y z", "endloop"));
  CHECK(without("vertex 0 0 0", "vertex 0 0 0 0") ==
        expected("4", "vertex x y z", "vertex 0 0 0 0"));
  CHECK(without("vertex 0 0 0", "vertex 0 O 0") == "4: \"O\" is not a number");
  CHECK(without("vertex 0 0 0", "vertex 0 nan 0") == "4: \"nan\" is not finite");
  CHECK(without("facet normal 0 0 1", "facet normal 0 O 1") == "2: \"O\" is not a number");
  CHECK(without("    endloop\n", "") == expected("7", "endloop", "endfacet"));
  CHECK(without("endloop", "endloop 7") == expected("7", "endloop", "endloop 7"));
  CHECK(without("endfacet\n", "endfacet x\n") == expected("8", "endfacet", "endfacet x"));
  CHECK(without("  endfacet\nendsolid x\n", "\n\n") == "7: the file ends before \"endfacet\"");
  CHECK(without("    outer loop\n      vertex 0 0 0\n      vertex 1e-1 0 0\n"
                "      vertex 0 +2 -3\n    endloop\n  endfacet\nendsolid x\n",
                "") == "2: the file ends before \"outer loop\"");
  CHECK(without("endsolid x\n", "") == "8: the file ends before \"endsolid\"");
  CHECK(without("endsolid x\n", "edsolid x\n") == expected("9", normal, "edsolid x"));
  CHECK(without("endsolid x\n", "endsolid x\nfacet") == expected("10", "solid", "facet"));
  // Triangles without area have no normal: some programs write the result of a division by zero.
  for (const char* none : {"nan", "-nan", "-nan(ind)", "inf"}) {
    CHECK(read_mesh(write(".stl", "solid\nfacet normal 0 1 " + std::string(none) +
                                      facet.substr(20) + "endsolid"))
              .vertices.size() == 3);
  }
}

TEST_CASE(
    "read_mesh: OBJ faces with more vertices and negative indices, and errors of references") {
  const std::string vertices = "# a square\no it\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 .1 .2 .3\nv 0 1 0\n";
  const auto m = read_mesh(
      write(".obj", vertices + "vn 0 0 1\ns off\nf 1//1 2//1 3/4/1 4\n#f 9\nf -1 -2 -3\n"));
  REQUIRE(m.vertices.size() == 9);
  CHECK(m.vertices[4] == std::array<double, 3>{1, 1, 0});
  CHECK(m.vertices[5] == std::array<double, 3>{0, 1, 0});
  CHECK(m.vertices[6] == std::array<double, 3>{0, 1, 0});
  CHECK(m.vertices[8] == std::array<double, 3>{1, 0, 0});
  CHECK(read_mesh(write(".obj", "\xef\xbb\xbf" + vertices + "f 1 2 3")).vertices.size() == 3);
  CHECK(error_of(".obj", vertices) == " the file contains no triangles");
  CHECK(error_of(".obj", vertices + "f 1 2\n") ==
        "7: a face of three or more vertices expected, not \"f 1 2\"");
  for (const char* bad : {"0", "5", "-5", "1.5", "x", "", "nan", "1e99"}) {
    const std::string text(bad);
    CHECK(error_of(".obj", vertices + "f 1 2 " + text + "/7\n") ==
          "7: \"" + text + "/7\" is not one of the 4 vertices before it");
  }
  for (const char* bad : {"1/x/2", "1/2/y", "1/1/1/1", "1/0", "1/1.5", "1//nan", "1///"}) {
    const std::string text(bad);
    CHECK(error_of(".obj", vertices + "f 1 2\t" + text + "\n") ==
          "7: \"" + text + "\" is not a vertex reference (expected k, k/t, k//n or k/t/n)");
  }
  CHECK(read_mesh(write(".obj", vertices + "f 1/ 2// -2/-7/+1")).vertices.size() == 3);
  CHECK(error_of(".obj", "v 1 2\n") == "1: \"v x y z\" expected, not \"v 1 2\"");
  CHECK(error_of(".obj", "v 1 2 inf\n") == "1: \"inf\" is not finite");
  CHECK(error_of(".obj", "v 1 2 3 O\n") == "1: \"O\" is not a number");
  CHECK(error_of(".obj", "v 1 2 3 .1 .2 red\n") == "1: \"red\" is not a number");
  CHECK(error_of(".obj", vertices + "face 1 2 3\n") == "7: unknown statement \"face\"");
}

TEST_CASE("read_mesh: OBJ lines joined by a backslash keep their line numbers in errors") {
  const std::string vertices = "v 0 0 \\\n0\nv \\\r\n1 \\\r\n0 0\nv 1 1 0\n"; // 6 lines
  const auto m =
      read_mesh(write(".obj", vertices + "f 1\\\n 2 \\  \n\\\n3\ng a \\\n b\nf 3 2 1 \\"));
  REQUIRE(m.vertices.size() == 6);
  CHECK(m.vertices[1] == std::array<double, 3>{1, 0, 0});
  CHECK(m.vertices[2] == std::array<double, 3>{1, 1, 0});
  CHECK(m.vertices[5] == std::array<double, 3>{0, 0, 0});
  CHECK(error_of(".obj", vertices + "f 1 2 \\\n 3 \\\n 9 \\\n 1\n") ==
        "9: \"9\" is not one of the 3 vertices before it");
  CHECK(error_of(".obj", vertices + "\nv 1 \\\n\n2 3\n") ==
        "8: \"v x y z\" expected, not \"v 1\""); // an empty line ends the statement
  CHECK(error_of(".obj", vertices + "f 1\\\n2\nx\n") ==
        "7: a face of three or more vertices expected, not \"f 1\\\\n2\"");
  CHECK(error_of(".obj", vertices + "f 1 \\ 2 3\n") ==
        "7: \"\\\" is not one of the 3 vertices before it");
  // A comment ends with its line, even if it ends with a backslash, as names of folders do.
  CHECK(read_mesh(write(".obj", "# of C:\\models\\\n" + vertices + "f 1 2 3")).vertices.size() ==
        3);
  CHECK(error_of(".obj", "\\") == " the file contains no triangles");
  // STL has no joined lines.
  CHECK(error_of(".stl", "solid a\nfacet normal 0 0 \\\n1\n") == "2: \"\\\" is not a number");
}

TEST_CASE("read_mesh: unknown formats and missing files are rejected") {
  CHECK(error_of(".xyzzy", "ply\n").starts_with(" the format is unknown (expected .stl"));
  CHECK(duet_test::message_of<file_error>([] { (void)read_mesh("nowhere.stl"); }) ==
        "duet: nowhere.stl: cannot be read");
  CHECK(duet_test::message_of<file_error>([] { (void)read_mesh("."); }) ==
        "duet: .: is a folder, not a file");
}

} // namespace
} // namespace test_io_mesh_file
