// SPDX-License-Identifier: Apache-2.0
// The Python package: its wheel runs in a fresh environment with the libraries that it carries, and
// its source archive has all files that the build needs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "relief/version.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

using testing::HasSubstr;

const std::string wheel_build = RELIEF_BUILD_FOLDER;

/// The package that scripts/wheel makes from the build folder.
class PythonWheel : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        if (!is_possible()) return;
        folder = std::make_unique<TemporaryDirectory>();
        run("'" + (source_directory() / "scripts/wheel").string() + "' --build '" + wheel_build +
            "' packages");
    }
    static void TearDownTestSuite() { folder.reset(); }
    void SetUp() override {
        if (!is_possible())
            GTEST_SKIP() << "the Python module is not built, or patchelf is missing";
    }

    static bool is_possible() {
        static const bool result =
            std::filesystem::exists(wheel_build + "/lib/python3/dist-packages/relief") &&
            std::filesystem::exists("/usr/bin/patchelf");
        return result;
    }

    /// Runs a line in a shell without the variables that name folders of relief and of Python.
    static std::string run(const std::string& line) {
        const ProgramResult result = run_program(
            {"/usr/bin/env", "-u", "RELIEF_MODULE_DIR", "-u", "PYTHONPATH", "sh", "-c", line},
            folder->path());
        EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.out << result.error;
        return result.out;
    }

    /// Returns the only file of the package with an extension.
    static std::filesystem::path file_with(const std::string& extension) {
        for (const auto& entry : std::filesystem::directory_iterator(*folder / "packages"))
            if (entry.path().extension() == extension) return entry.path();
        ADD_FAILURE() << "no file " << extension;
        return {};
    }

    static std::unique_ptr<TemporaryDirectory> folder;
};
std::unique_ptr<TemporaryDirectory> PythonWheel::folder;

TEST_LABELS(slow);
TEST_F(PythonWheel, RunsInAFreshEnvironment) {
    EXPECT_THAT(file_with(".whl").filename().string(), HasSubstr("-manylinux_2_"));
    run("/usr/bin/python3 -m venv --system-site-packages environment && "
        "environment/bin/pip install --quiet --no-index --no-deps packages/*.whl");
    EXPECT_THAT(run("environment/bin/relief-mesh --version"),
                testing::StartsWith("relief-mesh " RELIEF_VERSION));
    const std::string data = (source_directory() / "data").string();
    EXPECT_THAT(run("cd environment && bin/python3 -c '\n"
                    "import relief\n"
                    "assert \"environment\" in relief.__file__, relief.__file__\n"
                    "mesh = relief.read_mesh(\"" +
                    data +
                    "/urn-low.obj\")\n"
                    "unwrapped = relief.unwrap(mesh, size=(256, 256))\n"
                    "baked = relief.bake(relief.read_mesh(\"" +
                    data +
                    "/urn-high.ply\"), unwrapped.mesh, (64, 64))\n"
                    "print(baked.report[\"texels_missed\"], relief.Scene(mesh).render(size=(32, "
                    "32)).shape)\n"
                    "relief.run(\"relief-bake\", \"bump\", \"" +
                    data +
                    "/bricks-height.png\", \"map.tif\")\n"
                    "print(relief.read_image(\"map.tif\")[0].dtype)\n'"),
                HasSubstr("0 (32, 32, 3)\nuint16\n"));
}

// Everything but the C and C++ libraries and those of X11 is in the wheel, with its license.
TEST_LABELS(slow);
TEST_F(PythonWheel, CarriesTheLibrariesThatItNeeds) {
    run("mkdir -p unpacked && cd unpacked && /usr/bin/python3 -m zipfile -e ../packages/*.whl .");
    std::istringstream lines(
        run("cd unpacked && find . -name '*.so*' -not -name relief_image.so -o -path '*/bin/*' | "
            "xargs -n 1 readelf -d | sed -n 's/.*NEEDED.*\\[\\(.*\\)\\]/\\1/p' | sort -u"));
    std::set<std::string> outside;
    for (std::string name; std::getline(lines, name);)
        if (!std::filesystem::exists(*folder / "unpacked/relief.libs" / name)) outside.insert(name);
    for (const char* name :
         {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "libstdc++.so.6", "libX11.so.6", "libdl.so.2",
          "libpthread.so.0", "librt.so.1", "ld-linux-x86-64.so.2"})
        outside.erase(name);
    EXPECT_THAT(outside, testing::IsEmpty());
    EXPECT_THAT(run("cd unpacked && ls relief_surface-*/licenses"),
                testing::AllOf(HasSubstr("libembree3-3\n"), HasSubstr("libimgui-dev\n")));
}

// Compiling all would take minutes. Ninja names the first file that is missing.
TEST_LABELS(slow);
TEST_F(PythonWheel, SourceArchiveHasAllFilesOfTheBuild) {
    run("mkdir -p sources && tar -C sources --strip-components=1 -xf '" +
        file_with(".gz").string() + "'");
    const std::string git = "git -C '" + source_directory().string() + "' ";
    if (run(git + "diff --quiet HEAD && " + git + "rev-parse HEAD || true") != "") {
        EXPECT_EQ(run("cat sources/cmake/commit.txt"), run(git + "rev-parse HEAD"));
    }
    run("cmake -G Ninja -S sources -B sources/build/wheel -DCMAKE_BUILD_TYPE=Release "
        "-DRELIEF_TESTS=OFF "
        "-DRELIEF_PYTHON=ON");
    run("cmake --build sources/build/wheel --target relief_python relief_image_module "
        "relief-image-decoder "
        "relief relief-accuracy relief-bake relief-mesh relief-view -- -n");
    for (const char* file :
         {"setup.py", "pyproject.toml", "PKG-INFO", "LICENSE", "python/relief/py.typed"})
        EXPECT_TRUE(std::filesystem::exists(*folder / "sources" / file)) << file;
}

}  // namespace
}  // namespace relief::test
