# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""duet as a package of Conan 2, of the sources that this recipe is in."""

from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir


class DuetRecipe(ConanFile):
    name = "duet"
    version = "1.0.0"
    description = "Rotations, rigid motions and their exact derivatives, by dual numbers"
    license = "MIT"
    topics = ("automatic-differentiation", "quaternions", "dual-quaternions", "splines", "robotics")
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"compiled": [True, False]}
    # Of Boost duet needs headers alone.
    default_options = {"compiled": False, "boost/*:header_only": True}

    def export_sources(self):
        top = Path(self.recipe_folder).parent.parent
        for pattern in ("CMakeLists.txt", "LICENSE", "CHANGELOG.md", "cmake/*", "include/*", "src/*"):
            copy(self, pattern, src=str(top), dst=self.export_sources_folder)

    def configure(self):
        if not self.options.compiled:
            self.package_type = "header-library"

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("eigen/[>=3.4 <6]", transitive_headers=True)
        self.requires("boost/[>=1.74 <2]", transitive_headers=True)
        self.requires("expat/[>=2.5 <3]", transitive_headers=True, transitive_libs=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["DUET_BUILD_TESTS"] = False
        toolchain.cache_variables["DUET_BUILD_EXAMPLES"] = False
        toolchain.cache_variables["DUET_BUILD_COMPILED"] = bool(self.options.compiled)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=str(Path(self.package_folder) / "licenses"))
        rmdir(self, str(Path(self.package_folder) / "share" / "licenses"))

    def package_id(self):
        if not self.info.options.compiled:
            self.info.clear()

    def package_info(self):
        # CMake finds duet's own package, with its targets and components, not one that Conan makes up.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.set_property("pkg_config_name", "duet")
        self.cpp_info.bindirs = []
        if self.options.compiled:
            self.cpp_info.builddirs = ["lib/cmake/duet"]
            self.cpp_info.libs = ["duet_compiled"]
            self.cpp_info.defines = ["DUET_COMPILED"]
        else:
            self.cpp_info.builddirs = ["share/cmake/duet"]
            self.cpp_info.libdirs = []
        if self.settings.get_safe("os") in ("Linux", "FreeBSD"):
            self.cpp_info.system_libs = ["pthread"]
