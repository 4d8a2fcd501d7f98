# SPDX-License-Identifier: Apache-2.0
"""Builds the Python package: the module, and the tools that relief.run() calls, by CMake.

RELIEF_BUILD_DIR names a build folder of CMake whose results are packed as they are; without it, CMake configures and
builds in setuptools' own folder. CMAKE_ARGS has further options for CMake.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import pybind11
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
TOOLS = ("relief", "relief-accuracy", "relief-bake", "relief-mesh", "relief-view")
TARGETS = ("relief_python", "relief_image_module", "relief-image-decoder", *TOOLS)


def version():
    """The version of relief as Python writes it: 1.1.0-dev is 1.1.0.dev0."""
    text = (ROOT / "libmesh/include/relief/version.h").read_text(encoding="utf-8")
    found = re.search(r'define RELIEF_VERSION "([0-9.]+)(-dev)?[^"]*"', text)
    return found[1] + (".dev0" if found[2] else "")


def numpy_versions():
    """The module reads numpy's structures as its pybind11 knows them: those of numpy 2 since pybind11 2.12."""
    return "numpy>=1.24" if pybind11.version_info >= (2, 12) else "numpy>=1.24,<2"


class BuildWithCMake(build_ext):
    """Installs the results of CMake into the package."""

    def run(self):
        given = os.environ.get("RELIEF_BUILD_DIR")
        self.copy_package(pathlib.Path(given) if given else self.configure_and_build())

    def configure_and_build(self):
        build = pathlib.Path(self.build_temp).resolve() / "cmake"
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        self.run_cmake(
            "-S", ROOT, "-B", build, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_INSTALL_LIBDIR=lib",
            "-DRELIEF_TESTS=OFF", "-DRELIEF_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}",
            f"-Dpybind11_DIR={pybind11.get_cmake_dir()}", *shlex.split(os.environ.get("CMAKE_ARGS", "")))
        self.run_cmake("--build", build, "--parallel", os.cpu_count(), "--target", *TARGETS)
        return build

    def copy_package(self, build):
        """The tree of the build within the package: the tools find their modules by this shape."""
        package = pathlib.Path(self.get_ext_fullpath("relief._relief")).parent
        (package / "bin").mkdir(parents=True, exist_ok=True)
        (package / "lib" / "relief").mkdir(parents=True, exist_ok=True)
        module = pathlib.Path(self.get_ext_filename("_relief")).name
        files = {file: package for file in build.glob(f"lib/**/relief/{module}")}
        if not files:
            raise SystemExit(f"setup.py: error: {build}: has no {module} (build the target relief_python for "
                             f"{sys.executable})")
        files |= {build / "bin" / tool: package / "bin" for tool in TOOLS}
        files |= {file: package / "lib" / "relief" for name in ("relief-image-decoder", "relief_image.so")
                  for file in build.glob(f"lib*/relief/{name}")}
        for file, folder in files.items():
            subprocess.run(["strip", "--strip-unneeded", "-o", folder / file.name, file], check=True)
            (folder / file.name).chmod(0o755)

    @staticmethod
    def run_cmake(*words):
        subprocess.run(["cmake", *map(str, words)], check=True)


setup(
    version=version(),
    install_requires=[numpy_versions()],
    ext_modules=[Extension("relief._relief", [])],
    cmdclass={"build_ext": BuildWithCMake},
)
