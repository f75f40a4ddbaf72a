// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"

#include <duet/io/mesh_file.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

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
void check_vertices(const triangle_mesh& m, const std::vector<point>& expected) {
  REQUIRE(m.vertices.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      CAPTURE(i);
      CAPTURE(k);
      CHECK(std::abs(m.vertices[i][k] - expected[i][k]) < 1e-12);
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

} // namespace

TEST_CASE("COLLADA: all types of faces are split into triangles") {
  check_vertices(read(of_mesh(sources + triangle)), {p[0], p[1], p[2]});
  check_vertices(read(of_mesh(sources + "<lines count=\"1\">" + input + "<p>0 1</p></lines>" +
                              "<polylist count=\"2\">" + input +
                              "<input semantic=\"NORMAL\" source=\"#n\" offset=\"2\"/>"
                              "<vcount>4 3</vcount><p>0 9 9 1 9 9 2 9 9 3 9 9 4 9 9 1 9 9 2 9 9</p>"
                              "</polylist><extra/>")),
                 {p[0], p[1], p[2], p[0], p[2], p[3], p[4], p[1], p[2]});
  check_vertices(read(of_mesh(sources + "<polygons count=\"2\">" + input +
                              "<p>3 2 1</p><p>0 1 2 3</p></polygons>")),
                 {p[3], p[2], p[1], p[0], p[1], p[2], p[0], p[2], p[3]});
  check_vertices(
      read(of_mesh(sources + "<trifans>" + input + "<p>4 0 1 2</p><p>0 1 2</p></trifans>")),
      {p[4], p[0], p[1], p[4], p[1], p[2], p[0], p[1], p[2]});
  check_vertices(
      read(of_mesh(sources + "<tristrips count=\"1\">" + input + "<p>0 1 2 3 4</p></tristrips>")),
      {p[0], p[1], p[2], p[1], p[3], p[2], p[2], p[3], p[4]});
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
  check_vertices(read(of_mesh(interleaved + "<triangles>" + input + "<p>0 1 0</p></triangles>")),
                 {{2, 3, 1}, {5, 6, 4}, {2, 3, 1}});
  // The last position may end with the last number.
  const std::string whole = changed(changed(interleaved, " 6 9 9", " 6"), "\"12\"", "\"10\"");
  CHECK(read(of_mesh(whole + "<triangles>" + input + "<p>0 1 0</p></triangles>")).vertices[1] ==
        point{5, 6, 4});
  CHECK(error_of(of_mesh(changed(changed(whole, " 6", ""), "\"10\"", "\"9\"") + triangle)) ==
        "3: <accessor>: 2 positions reach beyond the 9 numbers of line 3");
  const std::string far =
      changed(interleaved, "count=\"2\" offset=\"1\"", "count=\"3\" offset=\"1\"");
  CHECK(error_of(of_mesh(far + triangle)) ==
        "3: <accessor>: 3 positions reach beyond the 12 numbers of line 3");
  CHECK(error_of(of_mesh(changed(interleaved, "stride=\"5\"", "stride=\"3\"") + triangle)) ==
        "3: <accessor>: stride=\"3\" for 4 parameters");
  CHECK(error_of(of_mesh(changed(interleaved, "\"Y\"", "\"T\"") + triangle)) ==
        "3: <accessor>: no <param name=\"Y\"> for positions");
}

TEST_CASE("COLLADA: nodes transform their geometry, and lengths are metres") {
  // The outermost transform is applied last: 2 (T R S x), R a quarter turn about z.
  const auto moved = [](const point& x) {
    return point{2 * (1 - 5 * x[1]), 2 * (2 + 3 * x[0]), 2 * (3 + 7 * x[2])};
  };
  const std::string before = "<translate>1 2 3</translate><rotate sid=\"r\">0 0 2 90</rotate>"
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
  CHECK(error_of(changed(two, "<scene><instance_visual_scene url=\"#w\"/></scene>", "")) ==
        "2: <COLLADA>: no element <scene>");
}

TEST_CASE("COLLADA: errors of faces name line, element and value") {
  const auto of_faces = [](const std::string& faces) { return error_of(of_mesh(sources + faces)); };
  const auto of_triangle = [&](const std::string& from, const std::string& to) {
    return of_faces(changed(triangle, from, to));
  };
  CHECK(of_triangle("0 1 2", "0 1 5") == "8: <p>: number 2 names none of the 5 positions");
  CHECK(of_triangle("0 1 2", "0 1 -1") == "8: <p>: number 2 names none of the 5 positions");
  CHECK(of_triangle("0 1 2", "0 1.5 1") == "8: <p>: number 1 names none of the 5 positions");
  CHECK(of_triangle("0 1 2", "0 1e300 1") == "8: <p>: number 1 names none of the 5 positions");
  CHECK(of_triangle("0 1 2", "0 O 1") == "8: <p>: number 1, \"O\", is no number");
  CHECK(of_triangle("0 1 2", "0 1") == "8: <triangles>: has 2 corners, no multiple of 3");
  CHECK(of_triangle("count=\"1\"", "count=\"2\"") ==
        "8: <triangles>: count=\"2\", but there are 1");
  CHECK(of_triangle("<p>0 1 2</p>", "") == "8: <triangles>: count=\"1\", but there are 0");
  CHECK(of_triangle("<p>0 1 2</p>", "<p>0 1 2</p>\n<p>0 1 2</p>") ==
        "9: <p>: is there twice, first in line 8");
  CHECK(of_triangle("offset=\"0\"", "") == "8: <input>: no attribute \"offset\"");
  CHECK(of_triangle("offset=\"0\"", "offset=\"-1\"") ==
        "8: <input>: offset=\"-1\" is no whole number from 0 to 1e9");
  CHECK(of_triangle("offset=\"0\"", "offset=\"1\"") ==
        "8: <p>: has 3 numbers, which are no corners of 2");
  CHECK(of_triangle("VERTEX", "NORMAL") == "8: <triangles>: no <input semantic=\"VERTEX\">");
  CHECK(of_triangle("#v", "#u") == "8: <input>: source=\"#u\": there is no <vertices id=\"u\">");
  CHECK(of_triangle("#v", "v") == "8: <input>: source=\"v\" is not #id: other files are not read");
  CHECK(of_triangle(input, input + "\n" + input) ==
        "9: <input>: semantic=\"VERTEX\" is there twice, first in line 8");
  CHECK(of_triangle("triangles", "tringles").find("mismatched tag") != std::string::npos);
  CHECK(of_faces("<tringles/>") == "8: <tringles>: is not known in <mesh>");
  CHECK(of_faces("<polylist count=\"1\">" + input +
                 "<vcount>3 3</vcount><p>0 1 2 3</p></polylist>") ==
        "8: <vcount>: face 1 has 3 corners, and 1 are left");
  CHECK(of_faces("<polylist count=\"1\">" + input + "<vcount>2</vcount><p>0 1</p></polylist>") ==
        "8: <vcount>: face 0 has 2 corners, and 2 are left");
  CHECK(
      of_faces("<polylist count=\"1\">" + input + "<vcount>3</vcount><p>0 1 2 3</p></polylist>") ==
      "8: <vcount>: the faces have 3 corners, but there are 4");
  CHECK(of_faces("<polylist count=\"1\">" + input + "<p>0 1 2 3</p></polylist>") ==
        "8: <polylist>: no element <vcount>");
  CHECK(of_faces("<polygons>" + input + "<p>0 1</p></polygons>") == "8: <p>: a face has 2 corners");
  CHECK(of_faces("<polygons>" + input + "<ph><p>0 1 2</p><h>0 1 2</h></ph></polygons>") ==
        "8: <ph>: polygons with holes are not supported");
}

TEST_CASE("COLLADA: errors of numbers and references name line, element and value") {
  const std::string good = of_mesh(sources + triangle);
  const auto with = [&](const std::string& from, const std::string& to) {
    return error_of(changed(good, from, to));
  };
  CHECK(with("1 1 0", "1 nan 0") == "3: <float_array id=\"a\">: number 7, \"nan\", is not finite");
  CHECK(with("1 1 0", "1 1,5 0") == "3: <float_array id=\"a\">: number 7, \"1,5\", is no number");
  CHECK(with("1 1 0", "1 1") ==
        "3: <float_array id=\"a\">: count=\"15\", but there are 14 numbers");
  CHECK(with("source=\"#a\" count=\"5\"", "source=\"#a\"") ==
        "6: <accessor>: no attribute \"count\"");
  CHECK(with("source=\"#a\" count=\"5\"", "source=\"#a\" count=\"1e9\"") ==
        "6: <accessor>: 1000000000 positions reach beyond the 15 numbers of line 3");
  CHECK(with("source=\"#a\" count=\"5\"", "source=\"#a\" count=\"1e10\"") ==
        "6: <accessor>: count=\"1e10\" is no whole number from 0 to 1e9");
  CHECK(with("POSITION", "NORMAL") == "7: <vertices id=\"v\">: no <input semantic=\"POSITION\">");
  CHECK(with("<geometry id=\"g\">", "<geometry>") ==
        "11: <instance_geometry>: url=\"#g\": there is no <geometry id=\"g\">");
  CHECK(with("<technique_common>", "<technique_common/><technique_common>") ==
        "6: <technique_common>: is there twice, first in line 6");
  CHECK(with("<vertices id", "<source id=\"s\"/>\n<vertices id") ==
        "7: <source id=\"s\">: the id is there twice, first in line 3");
  CHECK(error_of(changed(changed(good, "<mesh>", "<spline>"), "</mesh>", "</spline>")) ==
        "2: <geometry id=\"g\">: no element <mesh>");
  CHECK(error_of(of_mesh(sources + triangle + "</mesh><mesh>")) ==
        "9: <mesh>: is there twice, first in line 2");
  CHECK(error_of("<robot name=\"r\"/>") == "1: the root is <robot>, not <COLLADA>");
  CHECK(error_of("<COLLADA>") == "1: no element found, in <COLLADA> of line 1");
  CHECK(error_of("") == "1: no element found");
}

TEST_CASE("COLLADA: errors of nodes, units and directions name line, element and value") {
  CHECK(error_of(of_node("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0</matrix>")) ==
        "11: <matrix>: has 15 numbers in place of 16");
  CHECK(error_of(of_node("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1</matrix>")) ==
        "11: <matrix>: its last row is not 0 0 0 1");
  CHECK(error_of(of_node("<translate>1 2</translate>")) ==
        "11: <translate>: has 2 numbers in place of 3");
  CHECK(error_of(of_node("<rotate>0 0 0 1</rotate>")) ==
        "11: <rotate>: turns about an axis of no length");
  CHECK(error_of(of_node("<lookat>0 0 0 1 0 0 0 0 1</lookat>")) ==
        "11: <lookat>: is not supported");
  CHECK(error_of(of_node("<skew>45 1 0 0 0 1 0</skew>")) == "11: <skew>: is not supported");
  CHECK(error_of(of_node("<translation>1 2 3</translation>")) ==
        "11: <translation>: is not known in <node>");
  CHECK(error_of(of_node("<instance_controller url=\"#skin\"/>")) ==
        "11: <instance_controller>: skins and morphs are not supported");
  CHECK(error_of(of_node("<scale>1e200 1 1</scale><scale>1e200 1 1</scale>")) ==
        "11: <instance_geometry>: a corner is not finite where it is placed");
  CHECK(error_of(of_node("<asset><unit meter=\".1\"/></asset>")) ==
        "11: <unit>: a unit of <node> alone is not supported");
  CHECK(error_of(with_asset("<unit meter=\"0,01\"/>")) ==
        "2: <unit>: meter=\"0,01\" is no number above 0");
  CHECK(error_of(with_asset("<unit meter=\"0\"/>")) ==
        "2: <unit>: meter=\"0\" is no number above 0");
  CHECK(error_of(with_asset("<unit meter=\"inf\"/>")) ==
        "2: <unit>: meter=\"inf\" is no number above 0");
  CHECK(error_of(with_asset("<up_axis>Z</up_axis>")) ==
        "2: <up_axis>: \"Z\" is none of X_UP, Y_UP and Z_UP");
}

TEST_CASE("COLLADA: cyclic and excessive instances are rejected") {
  const std::string own = "<node id=\"n\"><instance_node url=\"#n\"/></node>";
  CHECK(error_of(document(sources + triangle, own)) ==
        "11: <node id=\"n\">: nodes are nested more than 100 deep, or in a circle");
  std::string nodes = "<node id=\"n0\">" + shown + "</node>\n";
  for (int i = 1; i <= 60; ++i) { // 2^60 triangles
    const std::string one = "<instance_node url=\"#n" + std::to_string(i - 1) + "\"/>";
    nodes += "<node id=\"n" + std::to_string(i) + "\">" + one + one + "</node>\n";
  }
  CHECK(error_of(document(sources + triangle, nodes))
            .ends_with("<instance_node>: the scene has more than 5 million triangles"));
  // Without triangles the instances add nothing.
  CHECK(error_of(document(sources, nodes)) == " the file contains no triangles");
}

} // namespace test_io_collada
