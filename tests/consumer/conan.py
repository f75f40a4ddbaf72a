# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Conan's recipe and the test of its package, run as Conan 2 runs them, by stand-ins for what they import of it:
without Conan, which cannot be had everywhere.

usage: conan.py <top of the project> <folder for what it makes> <CMake's generator> <compiler> <version>
                <build folder of the project>
"""

import fnmatch
import importlib.util
import os
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path
from types import ModuleType, SimpleNamespace

TOP, FOLDER = Path(sys.argv[1]), Path(sys.argv[2])
GENERATOR, COMPILER, VERSION, LIBRARIES = sys.argv[3:]
BUILD_IS_RUN = True  # not for the libraries, which take long to compile: they are those of the folder LIBRARIES


def check(is_so, what):
    if not is_so:
        sys.exit(f"conan: not so: {what}")


class Options(SimpleNamespace):
    def get_safe(self, name):
        return getattr(self, name, None)

    def rm_safe(self, name):
        vars(self).pop(name, None)


class Properties:
    """What a package or a component of it says of itself."""

    def __init__(self):
        self.bindirs, self.libdirs, self.includedirs = ["bin"], ["lib"], ["include"]
        self.libs, self.defines, self.builddirs, self.system_libs, self.requires = [], [], [], [], []
        self.properties, self.components = {}, defaultdict(Properties)
        self.set_property = self.properties.__setitem__


class ConanFile:
    """What a recipe finds in itself."""

    def __init__(self, folder, **options):
        self.folder = folder
        self.recipe_folder = str(folder / "recipe")
        self.export_sources_folder = self.source_folder = str(folder / "source")
        self.build_folder = str(folder / "build")
        self.package_folder = str(folder / "package")
        self.options = Options(**options)
        self.info = SimpleNamespace(options=self.options, clear=lambda: setattr(self, "is_same_for_all", True))
        self.is_same_for_all = False
        self.settings = SimpleNamespace(get_safe=lambda name: {"os": "Linux"}.get(name))
        self.cpp_info = Properties()
        self.cpp = SimpleNamespace(build=SimpleNamespace(bindir="."))
        self.required, self.cache, self.generated, self.least_standard = [], {}, [], None

    def requires(self, reference, transitive_headers=False, transitive_libs=False):
        self.required.append((reference, transitive_headers, transitive_libs))

    def run(self, command, env):
        check(env == "conanrun", "programs run in the environment of the package")
        subprocess.run(command, shell=True, check=True, cwd=self.build_folder)


class CMakeDeps:
    def __init__(self, recipe):
        self.generate = lambda: recipe.generated.append("CMakeDeps")


class CMakeToolchain:
    def __init__(self, recipe):
        self.cache_variables = recipe.cache
        self.generate = lambda: recipe.generated.append("CMakeToolchain")


class CMake:
    def __init__(self, recipe):
        self.recipe = recipe

    def cmake(self, *arguments):
        subprocess.run(["cmake", *arguments], check=True, stdout=subprocess.DEVNULL)

    def configure(self):
        cache = {name: "ON" if value is True else "OFF" if value is False else value
                 for name, value in self.recipe.cache.items()}
        self.cmake("-S", self.recipe.source_folder, "-B", self.recipe.build_folder, "-G", GENERATOR,
                   f"-DCMAKE_CXX_COMPILER={COMPILER}", *(f"-D{name}={value}" for name, value in cache.items()))

    def build(self):
        if BUILD_IS_RUN:
            self.cmake("--build", self.recipe.build_folder)

    def install(self):
        folder = self.recipe.build_folder if BUILD_IS_RUN else LIBRARIES
        self.cmake("--install", folder, "--prefix", self.recipe.package_folder,
                   "--component", "Unspecified")


def copy(recipe, pattern, src, dst):
    names = [str(path.relative_to(src)) for path in Path(src).rglob("*") if path.is_file()]
    names = fnmatch.filter(names, pattern)
    check(names, f"there is {pattern} in {src}")
    for name in names:
        (Path(dst) / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(Path(src) / name, Path(dst) / name)


def module(name, **contents):
    sys.modules[name] = ModuleType(name)
    vars(sys.modules[name]).update(contents)


module("conan", ConanFile=ConanFile)
module("conan.errors", ConanInvalidConfiguration=type("ConanInvalidConfiguration", (Exception,), {}))
module("conan.tools")
module("conan.tools.build", can_run=lambda recipe: True,
       check_min_cppstd=lambda recipe, standard: setattr(recipe, "least_standard", standard))
module("conan.tools.cmake", CMake=CMake, CMakeDeps=CMakeDeps, CMakeToolchain=CMakeToolchain,
       cmake_layout=lambda recipe: setattr(recipe, "has_layout", True))
module("conan.tools.files", copy=copy, rmdir=lambda recipe, path: shutil.rmtree(path, ignore_errors=True))


def recipe_class(path):
    spec = importlib.util.spec_from_file_location("recipe", path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return next(c for c in vars(loaded).values() if isinstance(c, type) and issubclass(c, ConanFile) and c is not ConanFile)


sys.dont_write_bytecode = True
shutil.rmtree(FOLDER, ignore_errors=True)
DuetRecipe = recipe_class(TOP / "packaging/conan/conanfile.py")
check(DuetRecipe.version == VERSION, f"the recipe is of version {VERSION}")
for option in ("io", "robotics"):
    check(DuetRecipe.options[option] == [True, False] and DuetRecipe.default_options[option] is True,
          f"{option} is built by default")


def recipe_with(folder, **options):
    recipe = DuetRecipe(FOLDER / folder, shared=False, fPIC=True, **options)
    recipe.recipe_folder = str(TOP / "packaging/conan")
    return recipe


made = {}
for has_libraries in (False, True):
    BUILD_IS_RUN = not has_libraries
    made[has_libraries] = recipe = recipe_with("libraries" if has_libraries else "headers",
                                               io=has_libraries, robotics=has_libraries)
    for step in ("export_sources", "configure", "layout", "requirements", "validate", "generate", "build", "package",
                 "package_id", "package_info"):
        getattr(recipe, step)()
    check(sorted(recipe.required) == [
        ("boost/[>=1.74 <2]", True, False), ("eigen/[>=3.4 <6]", True, False),
        *[("expat/[>=2.5 <3]", False, False)] * has_libraries], "what it requires")
    check(recipe.least_standard == 20 and recipe.generated == ["CMakeDeps", "CMakeToolchain"], "C++20, by CMake")
    check(recipe.is_same_for_all == (not has_libraries), "headers are the same for all settings, libraries are not")
    cache = (Path(recipe.build_folder) / "CMakeCache.txt").read_text()
    for option in ("DUET_BUILD_IO", "DUET_BUILD_ROBOTICS"):
        check(f"{option}:BOOL={'ON' if has_libraries else 'OFF'}" in cache, "CMake is told of the libraries")
    package, info = Path(recipe.package_folder), recipe.cpp_info.components
    check((package / "include/duet/duet.hpp").exists() and (package / "licenses/LICENSE").exists(), "headers and licence")
    check((package / info["duet"].builddirs[0] / "duetConfig.cmake").exists(), "CMake's package is where it is said to be")
    check(info["duet"].libs == [] and info["duet"].libdirs == [], "headers have no library")
    check(package.joinpath("include").is_dir() and sorted(os.listdir(package)) ==
          ["include", *["lib"] * has_libraries, "licenses", *["share"] * (not has_libraries)], "nothing else is packed")
    for name in info:
        for library in info[name].libs:
            check((package / f"lib/lib{library}.a").exists(), f"{library} is packed")

    BUILD_IS_RUN = True
    test = recipe_class(TOP / "packaging/conan/test_package/conanfile.py")(FOLDER / f"test_{recipe.package_type}")
    test.source_folder = str(TOP / "packaging/conan/test_package")
    test.tested_reference_str = f"duet/{VERSION}"
    test.cache["duet_DIR"] = str(package / info["duet"].builddirs[0])
    for step in ("requirements", "layout", "build", "test"):
        getattr(test, step)()
    check(test.required == [(f"duet/{VERSION}", False, False)], "what is tested")

check(made[False].package_type == "header-library", "without libraries it has headers alone")
info = made[True].cpp_info.components
check(made[True].package_type == "library" and info["io"].libs == ["duet_io"] and
      info["robotics"].libs == ["duet_robotics"] and info["robotics"].requires == ["io"], "the libraries")
try:
    recipe_with("refused", io=False, robotics=True).validate()
    check(False, "robotics without io is refused")
except sys.modules["conan.errors"].ConanInvalidConfiguration as error:
    check("duet: " in str(error), "why")
