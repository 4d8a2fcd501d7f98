// SPDX-License-Identifier: Apache-2.0
// The packages that scripts/package makes: Debian's, their source package, and the archive, which
// action.yml uses. The recipe of vcpkg.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "relief/version.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Returns the version as Debian writes it.
std::string debian_version() {
    std::string version = RELIEF_VERSION;
    std::replace(version.begin(), version.end(), '-', '~');
    return version;
}

std::string text_of_source(const std::string& file) {
    return read_bytes(source_directory() / file);
}

/// Returns the names of a field's packages, without versions.
std::set<std::string> names_in_field(const std::string& control, const std::string& field) {
    const std::size_t begin = control.find("\n" + field + ":") + field.size() + 2;
    static const std::regex end("\n[^ #]");
    std::smatch match;
    const std::string rest = control.substr(begin);
    std::istringstream lines(std::regex_search(rest, match, end) ? match.prefix().str() : rest);
    std::set<std::string> names;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name;
        if (!line.starts_with("#") && words >> name) names.insert(name.substr(0, name.find(',')));
    }
    return names;
}

TEST(DebianSources, HaveTheVersionOfTheSources) {
    EXPECT_THAT(text_of_source("debian/changelog"),
                testing::StartsWith("relief (" + debian_version() + ") "));
}

TEST(DebianSources, NeedWhatTheInstallScriptInstalls) {
    std::set<std::string> needed =
        names_in_field(text_of_source("debian/control"), "Build-Depends");
    for (const char* tool : {"debhelper-compat", "dh-python"})
        EXPECT_EQ(needed.erase(tool), 1) << tool;
    const ProgramResult result =
        run_program({source_directory() / "scripts/dev/install-dependencies", "--list", "--python"},
                    source_directory());
    ASSERT_EQ(result.exit_code, 0) << result.error;
    std::istringstream lines(result.out);
    std::set<std::string> installed;
    for (std::string name; std::getline(lines, name);)
        installed.insert(name);
    EXPECT_EQ(installed.erase("libosmesa6"), 1);
    EXPECT_EQ(needed, installed);
}

/// The packages of the build folder, hardly compressed.
class MadePackages : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        if (!is_possible()) return;
        folder = std::make_unique<TemporaryDirectory>();
        run("env DPKG_DEB_COMPRESSOR_TYPE=none XZ_OPT=-0 DEBEMAIL=packager@debian.org '" +
            (source_directory() / "scripts/package").string() +
            "' --build '" RELIEF_BUILD_FOLDER "' packages");
    }
    static void TearDownTestSuite() { folder.reset(); }
    void SetUp() override {
        if (!is_possible())
            GTEST_SKIP() << "the Python module is not built, or debhelper or patchelf is missing";
    }

    static bool is_possible() {
        static const bool result =
            std::filesystem::exists(RELIEF_BUILD_FOLDER "/lib/python3/dist-packages/relief") &&
            std::filesystem::exists("/usr/bin/dh_python3") &&
            std::filesystem::exists("/usr/bin/patchelf");
        return result;
    }

    /// Runs a line in a shell that finds no tools of this build.
    static ProgramResult run_unchecked(const std::string& line) {
        return run_program({"/usr/bin/env", "-i", "PATH=/usr/bin:/bin", "LANG=C.UTF-8",
                            "HOME=" + folder->path().string(), "bash", "-c", line},
                           folder->path());
    }
    static std::string run(const std::string& line) {
        const ProgramResult result = run_unchecked(line);
        EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.out << result.error;
        return result.out;
    }
    static std::string field(const std::string& package, const std::string& name) {
        return run("dpkg-deb --field packages/" + package + "_*.deb " + name);
    }
    /// Returns the path of the archive.
    static std::string archive() {
        const std::string name = run("ls packages/relief-*.tar.xz");
        return (*folder / name.substr(0, name.find('\n'))).string();
    }

    static std::unique_ptr<TemporaryDirectory> folder;
};
std::unique_ptr<TemporaryDirectory> MadePackages::folder;

TEST_LABELS(slow);
TEST_F(MadePackages, NeedOnlyWhatTheyUse) {
    const std::string same_version = "(= " + debian_version() + ")";
    for (const std::string package :
         {"relief", "relief-image-formats", "librelief-dev", "python3-relief"}) {
        EXPECT_EQ(field(package, "Version"), debian_version() + "\n") << package;
        EXPECT_EQ(field(package, "Maintainer"), "The relief authors <packager@debian.org>\n");
    }
    EXPECT_THAT(field("relief", "Depends"),
                testing::AllOf(HasSubstr("libembree"), Not(HasSubstr("openimageio"))));
    EXPECT_THAT(field("relief", "Recommends"), HasSubstr("relief-image-formats " + same_version));
    EXPECT_THAT(field("relief-image-formats", "Depends"), HasSubstr("libopenimageio"));
    EXPECT_THAT(field("librelief-dev", "Depends"),
                testing::AllOf(HasSubstr("libembree-dev"), Not(HasSubstr("relief"))));
    EXPECT_THAT(field("python3-relief", "Depends"),
                testing::AllOf(HasSubstr("relief " + same_version), HasSubstr("python3 (<< 3."),
                               HasSubstr("python3-numpy")));
    const std::string documents = run("dpkg-deb --contents packages/relief_*.deb");
    for (const char* file : {"doc/relief/copyright", "doc/relief/changelog.gz",
                             "doc/relief/CHANGELOG.md", "man/man1/relief-mesh.1.gz",
                             "doc/relief/third-party-notices.txt", "doc/relief/relief.spdx.json"})
        EXPECT_THAT(documents, HasSubstr(std::string("/usr/share/") + file + "\n"));
    EXPECT_THAT(
        run("dpkg-deb --contents packages/librelief-dev_*.deb"),
        testing::AllOf(HasSubstr("/usr/include/relief/relief.h\n"), HasSubstr("/librelief_c.a\n"),
                       HasSubstr("/examples/c_interface.c\n")));
    EXPECT_EQ(run("cd packages && sha256sum --quiet --check SHA256SUMS"), "");
}

TEST_LABELS(slow);
TEST_F(MadePackages, SourcesCanBeUnpacked) {
    if (!std::filesystem::exists(source_directory() / ".git")) GTEST_SKIP() << "not a git checkout";
    run("dpkg-source --extract packages/relief_*.dsc sources");
    for (const char* file : {"debian/rules", "CMakeLists.txt", "scripts/package"})
        EXPECT_TRUE(std::filesystem::exists(*folder / "sources" / file)) << file;
    // Build dependencies are installed here.
    run("cd sources && dpkg-checkbuilddeps");
}

// The tools find no library of this build, and all but those of every system come from the archive.
TEST_LABELS(slow);
TEST_F(MadePackages, ArchiveCarriesItsLibraries) {
    EXPECT_THAT(archive(), HasSubstr("relief-" RELIEF_VERSION "-linux-"));
    run("mkdir archive && tar -C archive --strip-components=1 -xf '" + archive() + "'");
    EXPECT_THAT(run("ldd archive/bin/* | sed -n 's|.* => \\(/[^ ]*\\).*|\\1|p' | grep -v /archive/ "
                    "| grep -E 'embree|tbb|fmt|OpenMesh' || true"),
                "");
    EXPECT_THAT(run("ls archive/share/doc/relief/licenses"), HasSubstr("libembree3-3\n"));
    EXPECT_THAT(run("cd archive/share/relief && ../../bin/relief-mesh process data/vase.obj "
                    "vase.glb --tangents mikktspace --quiet && ../../bin/relief-view vase.glb "
                    "--output vase.png --size 64x64 && ls vase.png"),
                HasSubstr("vase.png\n"));
    EXPECT_EQ(run("PYTHONPATH=archive/lib/python3/dist-packages /usr/bin/python3 -c '"
                  "import relief; print(relief.__version__)'"),
              RELIEF_VERSION "\n");
}

/// Writes a program that runs the steps of action.yml as a workflow does, with its inputs as
/// arguments.
void write_workflow(const std::filesystem::path& file) {
    std::ofstream(file) << R"(import os, re, subprocess, sys, yaml
folder = sys.argv[1]
action = yaml.safe_load(open(folder + "/action.yml"))
values = {"inputs." + name: of.get("default", "") for name, of in action["inputs"].items()}
values |= {"github.action_path": folder, "github.server_url": "https://example.org",
           "github.action_repository": "a/relief", "github.action_ref": "main"}
values |= dict(each.split("=", 1) for each in sys.argv[2:])
assert action["runs"]["using"] == "composite"
for step in action["runs"]["steps"]:
    filled = lambda text: re.sub(r"\$\{\{ *([\w.]+) *\}\}", lambda found: values[found[1]], text)
    environment = {name: filled(text) for name, text in step["env"].items()}
    result = subprocess.run([step["shell"], "-e", "-c", filled(step["run"])], env=os.environ | environment)
    if result.returncode != 0:
        sys.exit(result.returncode)
)";
}

TEST_LABELS(slow);
TEST_F(MadePackages, ActionChecksModelsWithTheArchive) {
    if (run_unchecked("/usr/bin/python3 -c 'import yaml'").exit_code != 0)
        GTEST_SKIP() << "python3-yaml is missing";
    write_workflow(*folder / "workflow.py");
    const std::string data = (source_directory() / "data").string();
    const std::string action =
        "/usr/bin/python3 workflow.py '" + source_directory().string() + "' ";
    const std::string package = "inputs.package='" + archive() + "' ";
    EXPECT_THAT(
        run(action + package + "inputs.models='" + data + "/urn-*.obj' inputs.maps='" + data +
            "/scenes/bricks-normal.png'"),
        testing::AllOf(HasSubstr("urn-low.obj: Wavefront OBJ"), HasSubstr("bricks-normal.png")));
    const ProgramResult failed = run_unchecked(action + package + "inputs.models='missing-*.glb'");
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_THAT(failed.error, HasSubstr("missing-*.glb: no such file"));
    EXPECT_THAT(run_unchecked(action + package + "inputs.sha256=" + std::string(64, '0')).error,
                HasSubstr("its SHA-256 is not 000"));
    EXPECT_THAT(run_unchecked(action + "inputs.models=a.glb").error,
                HasSubstr("'main' is not the tag of a release"));
}

// vcpkg itself is not needed: vcpkg_functions.cmake has the functions that the recipe calls.
TEST_LABELS(slow);
TEST(VcpkgPort, InstallsWhatFindPackageFinds) {
    const TemporaryDirectory folder;
    const std::string prefix = (folder / "packages").string();
    const std::string source = source_directory().string();
    const auto run = [&](const std::string& line) {
        const ProgramResult result = run_program({"/bin/sh", "-c", line}, folder.path());
        EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.out << result.error;
        return result.out;
    };
    run("cmake -DCURRENT_PORT_DIR='" + source +
        "/packaging/vcpkg/relief' -DCURRENT_PACKAGES_DIR='" + prefix +
        "' -DCURRENT_BUILDTREES_DIR=\"$PWD/trees\" -DBUILD='" RELIEF_BUILD_FOLDER
        "' '-DFEATURES=core;bake;c;topology' -P '" +
        source + "/tests/install/vcpkg_functions.cmake'");
    EXPECT_EQ(run("sed -n 's/^RELIEF_COMPONENTS:[A-Z]*=//p' trees/CMakeCache.txt"),
              "mesh;atlas;bake;c;topology\n");
    EXPECT_EQ(run("cd packages && ls && ls share"), "include\nlib\nshare\nrelief\n");
    EXPECT_TRUE(std::filesystem::exists(prefix + "/share/relief/copyright"));
    std::filesystem::create_directory(folder / "engine");
    std::ofstream(folder / "engine/CMakeLists.txt")
        << "cmake_minimum_required(VERSION 3.25)\nproject(engine LANGUAGES CXX)\n"
        << "find_package(relief REQUIRED COMPONENTS mesh)\nadd_executable(engine " << source
        << "/examples/normals_and_tangents.cpp)\n"
        << "target_link_libraries(engine PRIVATE relief::mesh)\n";
    run("cmake -G Ninja -S engine -B build -DCMAKE_CXX_COMPILER='" RELIEF_COMPILER
        "' -DCMAKE_PREFIX_PATH='" +
        prefix + "' && cmake --build build");
    EXPECT_THAT(run("build/engine && grep relief_DIR build/CMakeCache.txt"),
                testing::AllOf(HasSubstr("normal"), HasSubstr(prefix + "/share/relief")));
}

/// Returns true if a file of the library, apart from readers and writers, includes such a header.
bool library_includes(const std::string& begin) {
    for (const char* folder : {"libmesh/include", "libmesh/src"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(source_directory() / folder)) {
            const std::string path = entry.path().generic_string();
            if (entry.is_regular_file() && path.find("/src/io/") == std::string::npos &&
                read_bytes(entry.path()).find("#include <" + begin) != std::string::npos)
                return true;
        }
    }
    return false;
}

TEST(VcpkgPort, NeedsTheLibrariesThatTheSourcesInclude) {
    const std::string port = text_of_source("packaging/vcpkg/relief/vcpkg.json");
    const std::pair<const char*, const char*> libraries[] = {
        {"eigen3", "Eigen/"},           {"embree", "embree"},      {"fmt", "fmt/"}, {"glm", "glm/"},
        {"nlohmann-json", "nlohmann/"}, {"openmesh", "OpenMesh/"}, {"tbb", "tbb/"}};
    for (const auto& [name, header] : libraries) {
        EXPECT_EQ(port.find('"' + std::string(name) + '"') != std::string::npos,
                  library_includes(header))
            << name;
    }
}

TEST(VcpkgPort, HasTheVersionOfTheSources) {
    EXPECT_THAT(text_of_source("packaging/vcpkg/relief/vcpkg.json"),
                HasSubstr("\"version\": \"" RELIEF_VERSION "\""));
}

}  // namespace
}  // namespace relief::test
