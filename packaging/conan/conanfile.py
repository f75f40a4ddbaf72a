# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""duet as a package of Conan 2, of the sources that this recipe is in."""

from pathlib import Path

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir


class DuetRecipe(ConanFile):
    name = "duet"
    version = "1.0.0"
    description = "Rotations, rigid motions and their exact derivatives, by dual numbers"
    license = "MIT"
    topics = ("automatic-differentiation", "quaternions", "dual-quaternions", "splines", "robotics")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"io": [True, False], "robotics": [True, False], "shared": [True, False], "fPIC": [True, False]}
    # Of Boost duet needs headers alone.
    default_options = {"io": True, "robotics": True, "shared": False, "fPIC": True, "boost/*:header_only": True}

    def export_sources(self):
        top = Path(self.recipe_folder).parent.parent
        for pattern in ("CMakeLists.txt", "LICENSE", "CHANGELOG.md", "cmake/*", "include/*", "src/*"):
            copy(self, pattern, src=str(top), dst=self.export_sources_folder)

    def configure(self):
        if not self.options.io:
            self.package_type = "header-library"
            self.options.rm_safe("shared")
        if self.package_type == "header-library" or self.options.shared:
            self.options.rm_safe("fPIC")

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("eigen/[>=3.4 <6]", transitive_headers=True)
        self.requires("boost/[>=1.74 <2]", transitive_headers=True)
        if self.options.io:
            self.requires("expat/[>=2.5 <3]")

    def validate(self):
        check_min_cppstd(self, 20)
        if self.options.robotics and not self.options.io:
            raise ConanInvalidConfiguration("duet: the option robotics=True needs io=True")

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["DUET_BUILD_TESTS"] = False
        toolchain.cache_variables["DUET_BUILD_EXAMPLES"] = False
        toolchain.cache_variables["DUET_BUILD_PROGRAMS"] = False
        toolchain.cache_variables["CMAKE_DISABLE_FIND_PACKAGE_assimp"] = True
        toolchain.cache_variables["DUET_BUILD_IO"] = bool(self.options.io)
        toolchain.cache_variables["DUET_BUILD_ROBOTICS"] = bool(self.options.robotics)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=str(Path(self.package_folder) / "licenses"))
        share = Path(self.package_folder) / "share"  # beside the licence it has CMake's files, if there is no library
        rmdir(self, str(share if self.options.io else share / "licenses"))

    def package_id(self):
        if not self.info.options.io:
            self.info.clear()

    def package_info(self):
        # CMake finds duet's own package, with its targets and components, not one that Conan makes up.
        self.cpp_info.set_property("cmake_find_mode", "none")
        headers = self.cpp_info.components["duet"]
        headers.set_property("pkg_config_name", "duet")
        headers.requires = ["eigen::eigen", "boost::headers"]
        headers.bindirs = []
        headers.libdirs = []
        headers.builddirs = ["lib/cmake/duet" if self.options.io else "share/cmake/duet"]
        if self.settings.get_safe("os") in ("Linux", "FreeBSD"):
            headers.system_libs = ["pthread"]
        for name, requires in (("io", ["duet", "expat::expat"]), ("robotics", ["io"])):
            if self.options.get_safe(name):
                library = self.cpp_info.components[name]
                library.set_property("pkg_config_name", f"duet-{name}")
                library.libs = [f"duet_{name}"]
                library.requires = requires
