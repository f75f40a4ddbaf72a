# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""A program that finds the package, is compiled with it and runs."""

import os

from conan import ConanFile
from conan.tools.build import can_run
from conan.tools.cmake import CMake, cmake_layout


class DuetTest(ConanFile):
    settings = "os", "arch", "compiler", "build_type"
    generators = "CMakeDeps", "CMakeToolchain"

    def requirements(self):
        self.requires(self.tested_reference_str)

    def layout(self):
        cmake_layout(self)

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def test(self):
        if can_run(self):
            for program in ("headers", "files", "planning"):
                path = os.path.join(self.cpp.build.bindir, program)
                if os.path.exists(os.path.join(self.build_folder, path)):
                    self.run(path, env="conanrun")
