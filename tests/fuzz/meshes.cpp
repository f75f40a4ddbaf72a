// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "fuzz/seeded_loop.hpp"

#include <duet/io/mesh_file.hpp>

// Surfaces: the result consists of triangles with finite vertices, no more than the file can
// contain; errors are messages of one line. Files of other formats than STL and OBJ, which Assimp
// reads, are trusted.

namespace test_fuzz_meshes {

std::vector<std::string> seeds() {
  const auto word = [](unsigned x) { // lowest byte first
    return std::string{char(x & 0xffU), char(x >> 8 & 0xffU), char(x >> 16 & 0xffU), char(x >> 24)};
  };
  const auto binary = [&](unsigned last) {
    std::string result = std::string(80, ' ') + word(2);
    for (unsigned i = 0; i < 2; ++i) {
      for (unsigned k = 0; k < 11; ++k) {
        result += word(0x3e800000 + (k << 20)); // 1/4, 9/32 …
      }
      result += word(last) + std::string(2, '\0');
    }
    return result;
  };
  const std::string facet = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1e-1 0 0\n"
                            "  vertex 0 +2 -3.5\n endloop\nendfacet\n";
  const std::string vertices = "# a square\nmtllib a.mtl\no it\nv 0 0 0\nv 1 0 0 1\n"
                               "v 1 1e-3 0 .1 .2 .3\nv 0 -1 0\nvt .5 .5\nvn 0 0 1\n";
  const unsigned no_number = 0x7fc00000;
  return {binary(0x3f800000),
          binary(no_number),
          "solid one\n" + facet + facet + "endsolid one\r\n\nsolid\n" + facet + "endsolid",
          vertices + "s off\nf 1//1 2//1 3/1/1 4\nf -1 -2 -3\n",
          vertices + "g a\nusemtl red\nf 1 2 3\nv 1 2 3\nf 3 4 5 1 2\nl 1 2\n",
          "# C:\\\n" + vertices + "f 1 2\\\n3 \\\r\n  4 \\\n"};
}

void target(const std::string& input) {
  for (const std::string ending : {".stl", ".obj"}) {
    const std::string path = "fuzz_meshes" + ending;
    std::ofstream(path, std::ios::binary) << input;
    try {
      const auto vertices = duet::read_mesh(path).vertices;
      duet_fuzz::require(!vertices.empty() && vertices.size() % 3 == 0, "triangles");
      // A triangle takes at least two bytes, for each further vertex of a face.
      duet_fuzz::require(vertices.size() / 3 <= input.size() / 2, "in proportion to the file");
      for (const auto& x : vertices) {
        for (const double each : x) {
          duet_fuzz::require(std::isfinite(each), "finite vertices");
        }
      }
    } catch (const duet::file_error& error) {
      duet_fuzz::require_message(error.what(), "duet: " + path + ":");
    }
    std::remove(path.c_str());
  }
}

TEST_CASE("mesh files: mutated ones are read correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 2000);
}

} // namespace test_fuzz_meshes
