// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/io/mesh_file.hpp>

#include <cstdio>
#include <fstream>

namespace test_io_collada {
namespace {

using namespace duet;
using point = std::array<double, 3>;

const std::string path = "test_io_collada.dae";

triangle_mesh read(const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return read_mesh(path);
}
/// Error message, without the name of the file.
std::string error_of(const std::string& text) {
  const std::string message = duet_test::message_of<file_error>([&] { (void)read(text); });
  const std::string begin = "duet: " + path + ":";
  return message.starts_with(begin) ? message.substr(begin.size()) : message;
}
/// Assimp stores floats.
void check_vertices(const triangle_mesh& m, const std::vector<point>& expected) {
  REQUIRE(m.vertices.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      CAPTURE(i);
      CAPTURE(k);
      CHECK(std::abs(m.vertices[i][k] - expected[i][k]) < 1e-6);
    }
  }
}

/// Sum of six times the signed volumes of the tetrahedra over the origin: its sign is the
/// orientation of the triangles.
double six_volumes(const triangle_mesh& m) {
  double sum = 0;
  for (std::size_t i = 0; i < m.vertices.size(); i += 3) {
    const auto &a = m.vertices[i], &b = m.vertices[i + 1], &c = m.vertices[i + 2];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum;
}

/// The five positions p0 to p4 of the faces in these tests.
const std::array<point, 5> p = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}}};
const std::string sources =
    "<source id=\"s\"><float_array id=\"a\" count=\"15\">0 0 0\n1 0 0\n1 1 0\n0 1 0\t0 0 1e0"
    "</float_array><technique_common><accessor source=\"#a\" count=\"5\" stride=\"3\">"
    "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
    "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n"
    "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/></vertices>\n";
const std::string input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
const std::string triangle = "<triangles count=\"1\">" + input + "<p>0 1 2</p></triangles>\n";

std::string document(const std::string& mesh, const std::string& nodes,
                     const std::string& asset = "") {
  return "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\">" +
         asset + "<library_geometries><geometry id=\"g\"><mesh>\n" + mesh +
         "</mesh></geometry></library_geometries>\n<library_visual_scenes>"
         "<visual_scene id=\"w\">\n" +
         nodes +
         "</visual_scene></library_visual_scenes>\n"
         "<scene><instance_visual_scene url=\"#w\"/></scene></COLLADA>\n";
}
const std::string shown = "<instance_geometry url=\"#g\"/>";
std::string of_mesh(const std::string& mesh) {
  return document(mesh, "<node>" + shown + "</node>\n");
}
std::string of_node(const std::string& inside) {
  return document(sources + triangle, "<node>" + inside + shown + "</node>\n");
}
std::string with_asset(const std::string& inside) {
  return document(sources + triangle, "<node>" + shown + "</node>\n",
                  "<asset>" + inside + "</asset>");
}
/// A document with one occurrence of a text replaced.
std::string changed(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != std::string::npos);
  return text.replace(text.find(from), from.size(), to);
}

TEST_CASE("COLLADA: all types of faces are split into triangles") {
  check_vertices(read(of_mesh(sources + triangle)), {p[0], p[1], p[2]});
  check_vertices(read(of_mesh(sources + "<lines count=\"1\">" + input + "<p>0 1</p></lines>" +
                              "<polylist count=\"2\">" + input +
                              "<input semantic=\"NORMAL\" source=\"#s\" offset=\"2\"/>"
                              "<vcount>4 3</vcount><p>0 9 1 1 9 1 2 9 1 3 9 1 4 9 1 1 9 1 2 9 1</p>"
                              "</polylist><extra/>")),
                 {p[0], p[1], p[2], p[0], p[2], p[3], p[4], p[1], p[2]});
  check_vertices(read(of_mesh(sources + "<polygons count=\"2\">" + input +
                              "<p>3 2 1</p><p>0 1 2 3</p></polygons>")),
                 {p[3], p[2], p[1], p[0], p[1], p[2], p[0], p[2], p[3]});
  check_vertices(read(of_mesh(sources + "<trifans count=\"2\">" + input +
                              "<p>4 0 1 2</p><p>0 1 2</p></trifans>")),
                 {p[4], p[0], p[1], p[4], p[1], p[2], p[0], p[1], p[2]});
  check_vertices(
      read(of_mesh(sources + "<tristrips count=\"1\">" + input + "<p>0 1 2 3 4</p></tristrips>")),
      {p[0], p[1], p[2], p[2], p[1], p[3], p[2], p[3], p[4]});
  // Vertices whose first number is the index of a normal.
  check_vertices(read(of_mesh(sources + "<triangles count=\"1\">" +
                              changed(input, "offset=\"0\"", "offset=\"1\"") +
                              "<p>7 3 7 2 7 1</p></triangles>")),
                 {p[3], p[2], p[1]});
  check_vertices(read(of_mesh(sources + "<triangles count=\"0\"/>" + triangle)),
                 {p[0], p[1], p[2]});
}

TEST_CASE("COLLADA: positions are read by offset, stride and parameter names") {
  const std::string interleaved =
      "<source id=\"s\"><float_array id=\"a\" count=\"12\">7 8 1 2 3 9 9 4 5 6 9 9"
      "</float_array><technique_common><accessor source=\"#a\" count=\"2\" "
      "offset=\"1\" stride=\"5\"><param/><param name=\"Z\"/><param name=\"X\"/>"
      "<param name=\"Y\"/></accessor></technique_common></source>"
      "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/></vertices>";
  check_vertices(
      read(of_mesh(interleaved + "<triangles count=\"1\">" + input + "<p>0 1 0</p></triangles>")),
      {{2, 3, 1}, {5, 6, 4}, {2, 3, 1}});
}

TEST_CASE("COLLADA: nodes transform their geometry, and lengths are metres") {
  // The outermost transform is applied last: 2 (T R S x), R a quarter turn about z.
  const auto moved = [](const point& x) {
    return point{2 * (1 - 5 * x[1]), 2 * (2 + 3 * x[0]), 2 * (3 + 7 * x[2])};
  };
  const std::string before = "<translate>1 2 3</translate><rotate sid=\"r\">0 0 1 90</rotate>"
                             "<scale>3 5 7</scale>";
  const std::vector<point> expected = {moved(p[0]), moved(p[1]), moved(p[2])};
  check_vertices(
      read(document(sources + triangle, "<node><scale>2 2 2</scale>" + before + shown + "</node>")),
      expected);
  check_vertices(
      read(document(sources + triangle,
                    "<node name=\"a\">\n<translate>1 2 3</translate>\n"
                    "<node><rotate>0 0 1 90</rotate><scale>3 5 7</scale>" +
                        shown + "</node></node>\n",
                    "<asset><unit name=\"two\" meter=\"2\"/><up_axis>Y_UP</up_axis></asset>")),
      expected);
  // The same as one matrix, row by row, through an instance of a node of a library.
  check_vertices(
      read(changed(document(sources + triangle,
                            "<node><scale>2 2 2</scale><instance_node url=\"#n\"/></node>"),
                   "<library_visual",
                   "<library_nodes><node id=\"n\"><matrix>0 -5 0 1 3 0 0 2 0 0 7 3 0 0 0 1"
                   "</matrix>" +
                       shown + "</node></library_nodes><library_visual")),
      expected);
  check_vertices(read(of_node("<rotate>0 0 0 0</rotate><rotate>1 0 0 90</rotate>")),
                 {p[0], p[1], {1, 0, 1}});
  for (const char* axis : {"X_UP", "Y_UP", " Z_UP\n"}) { // rotates nothing
    check_vertices(read(with_asset(std::string("<unit/><up_axis>") + axis + "</up_axis>")),
                   {p[0], p[1], p[2]});
  }
  check_vertices(read(with_asset("<unit meter=\"1e-2\"/>")), {p[0], {.01, 0, 0}, {.01, .01, 0}});
}

TEST_CASE("COLLADA: mirrored triangles keep their outward orientation") {
  const std::string faces = sources + "<triangles count=\"4\">" + input +
                            "<p>0 3 1 0 1 4 0 4 3 1 3 4</p></triangles>"; // a corner of a cube
  CHECK(six_volumes(read(document(faces, "<node>" + shown + "</node>"))) == doctest::Approx(1));
  CHECK(six_volumes(read(document(faces, "<node><scale>-1 2 1</scale>" + shown + "</node>"))) ==
        doctest::Approx(2));
  CHECK(six_volumes(read(document(faces, "<node><scale>-1 2 1</scale>" + shown + "</node><node>" +
                                             shown + shown + "</node>"))) == doctest::Approx(4));
}

TEST_CASE("COLLADA: hidden scenes, cameras, lights and lines are skipped") {
  CHECK(error_of(changed(of_mesh(sources + triangle), shown,
                         "<instance_light url=\"#l\"/><instance_camera url=\"#c\"/>")) ==
        " the file contains no triangles");
  const std::string two = changed(of_mesh(sources + triangle), "<visual_scene id=\"w\">",
                                  "<visual_scene id=\"other\"><node>" + shown + shown +
                                      "</node></visual_scene><visual_scene id=\"w\">");
  CHECK(read(two).vertices.size() == 3);
  CHECK(!error_of(changed(two, "<scene><instance_visual_scene url=\"#w\"/></scene>", "")).empty());
}

TEST_CASE("COLLADA: invalid files are rejected with a reason") {
  const std::string good = of_mesh(sources + triangle);
  const auto with = [&](const std::string& from, const std::string& to) {
    return error_of(changed(good, from, to));
  };
  CHECK(with("0 1 2<", "0 1 5<") == " Invalid data index (5/5) in primitive specification");
  CHECK(with("1 1 0", "1 nan 0") == " triangle 0 has a vertex that is not finite");
  CHECK(with("1 1 0", "1 1") == " Expected more values while reading float_array contents.");
  CHECK(error_of(of_node("<scale>1e30 1 1</scale><scale>1e30 1 1</scale>")) ==
        " triangle 0 has a vertex that is not finite");
  CHECK(with("triangles", "tringles").find("mismatched tag") != std::string::npos);
  CHECK(error_of("<COLLADA>") == "1: no element found, in <COLLADA> of line 1");
  CHECK(error_of("") == "1: no element found");
  CHECK(!error_of("<robot name=\"r\"/>").empty());
}

TEST_CASE("COLLADA: transformations that Assimp reads wrong are rejected") {
  CHECK(error_of(of_node("<skew>45 1 0 0 0 1 0</skew>")) == "11: <skew> is not supported");
  CHECK(error_of(of_node("<rotate>0 0 2 90</rotate>")) ==
        "11: <rotate> is not a unit vector and an angle: \"0 0 2 90\"");
  CHECK(error_of(of_node("<rotate>0 0 1</rotate>")) ==
        "11: <rotate> is not a unit vector and an angle: \"0 0 1\"");
}

TEST_CASE("Assimp: other formats are read, and errors are messages of one line") {
  const std::string ply = "test_io_collada.ply";
  const auto write = [&](const std::string& last) {
    std::ofstream(ply) << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                       << last;
  };
  write("4 0 1 2 3\n");
  check_vertices(read_mesh(ply), {p[0], p[1], p[2], p[0], p[2], p[3]});
  std::ofstream(ply) << "no mesh\n";
  const std::string message = duet_test::message_of<file_error>([&] { (void)read_mesh(ply); });
  CHECK(message.starts_with("duet: " + ply + ": "));
  CHECK(message.find('\n') == std::string::npos);
  std::remove(ply.c_str());
}

} // namespace
} // namespace test_io_collada
