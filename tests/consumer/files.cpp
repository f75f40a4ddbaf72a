// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A program that links duet::io: it reads a robot description, and catches errors by their types.

#include <duet/core/text/file_error.hpp>
#include <duet/io/loop_file.hpp>
#include <duet/io/urdf.hpp>

#include <fstream>
#include <iostream>

int main() {
  std::ofstream("consumer.urdf") << R"(<robot name="r"><link name="base"/><link name="tip"/>
    <joint name="q" type="prismatic"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="2"/></joint></robot>)";
  const auto arm = duet::read_urdf("consumer.urdf", "base", "tip");
  int errors = 0;
  try {
    (void)duet::read_urdf_tree("missing.urdf");
  } catch (const duet::file_error& error) {
    std::cout << error.what() << '\n';
    ++errors;
  }
  std::ofstream("consumer.loops") << "revolute\n";
  try {
    (void)duet::read_loops("consumer.loops");
  } catch (const duet::invalid_input& error) {
    std::cout << error.what() << '\n';
    ++errors;
  }
  return arm.size() == 1 && arm.limits(0).upper == 2 && errors == 2 ? 0 : 1;
}
