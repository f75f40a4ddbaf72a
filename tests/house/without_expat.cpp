// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Files of XML are refused if duet::io was built without expat, others are read. See
// without_expat.cmake.

#include <duet/io/mesh_file.hpp>
#include <duet/io/srdf.hpp>
#include <duet/io/urdf.hpp>

#include <cstdio>
#include <fstream>
#include <string>

namespace {

bool is_wrong = false;

template <class Read>
void expect_refusal(const char* path, const Read& read) {
  const std::string expected =
      "duet: " + std::string(path) +
      ": is XML, which cannot be read: the library was built without expat";
  std::string message = "no error";
  try {
    read(path);
  } catch (const duet::file_error& error) {
    message = error.what();
  }
  if (message != expected) {
    std::printf("%s\nexpected: %s\n", message.c_str(), expected.c_str());
    is_wrong = true;
  }
}

} // namespace

int main() {
  expect_refusal("a.urdf", [](const char* path) { (void)duet::read_urdf(path, "a", "b"); });
  expect_refusal("b.urdf", [](const char* path) { (void)duet::read_urdf_tree(path); });
  expect_refusal("c.urdf", [](const char* path) { (void)duet::read_urdf_summary(path); });
  expect_refusal("d.srdf", [](const char* path) { (void)duet::read_disabled_collisions(path); });

  std::ofstream("without_expat.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const duet::triangle_mesh mesh = duet::read_mesh("without_expat.obj");
  return is_wrong || mesh.vertices.size() != 3 ? 1 : 0;
}
