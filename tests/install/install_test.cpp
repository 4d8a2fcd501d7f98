// SPDX-License-Identifier: Apache-2.0
// The installed library: examples build against a moved tree and print correct numbers, and
// programs need only the third parties of their components.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "relief/version.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

using testing::HasSubstr;

const std::string build_folder = RELIEF_BUILD_FOLDER;
const std::string compiler = RELIEF_COMPILER;
const std::string abi_version =
    std::to_string(RELIEF_VERSION_MAJOR) + "." + std::to_string(RELIEF_VERSION_MINOR);

/// Runs a line in a shell without the variables that name folders of relief.
ProgramResult run_clean(const std::string& line, const std::filesystem::path& folder) {
    return run_program(
        {"/usr/bin/env", "-u", "RELIEF_MODULE_DIR", "-u", "RELIEF_SHADER_DIR", "sh", "-c", line},
        folder);
}

void expect_success(const std::string& line, const std::filesystem::path& folder) {
    const ProgramResult result = run_clean(line, folder);
    ASSERT_EQ(result.exit_code, 0) << line << "\n" << result.out << result.error;
}

/// Configures a project in folder/build.
void configure(const std::string& source, const std::string& options,
               const std::filesystem::path& folder) {
    expect_success("cmake -G Ninja -S '" + source + "' -B build -DCMAKE_CXX_COMPILER='" + compiler +
                       "' " + options,
                   folder);
}

/// Returns the shared libraries that a file names, without those of the compiler and the C library.
std::set<std::string> needed_libraries(const std::filesystem::path& file) {
    const std::string table =
        run_clean("readelf -d '" + file.string() + "'", file.parent_path()).out;
    static const std::regex entry(R"(NEEDED.*\[(lib\w+)[^\]]*\])");
    std::set<std::string> names;
    for (std::sregex_iterator at(table.begin(), table.end(), entry), end; at != end; ++at)
        names.insert((*at)[1]);
    for (const char* name : {"libstdc", "libm", "libgcc_s", "libc", "libpthread", "libdl"})
        names.erase(name);
    return names;
}

/// Returns the numbers in the line that begins with `start`.
std::vector<double> numbers_after(const std::string& output, const std::string& start) {
    std::istringstream lines(output);
    std::vector<double> numbers;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(start)) continue;
        static const std::regex number(R"(-?\d+(\.\d+)?)");
        const std::string rest = line.substr(start.size());
        for (std::sregex_iterator at(rest.begin(), rest.end(), number), end; at != end; ++at)
            numbers.push_back(std::stod(at->str()));
    }
    return numbers;
}

/// Returns the first commands of README.md, which begin by making the output folder.
std::string first_commands() {
    const std::string readme = read_bytes(source_directory() / "README.md");
    const std::string start = "```sh\n";
    const std::size_t begin = readme.find(start + "mkdir ");
    if (begin == std::string::npos) return "";
    const std::size_t first = begin + start.size();
    return readme.substr(first, readme.find("```", first) - first);
}

/// The installed tree, moved after the installation, and the examples built against it.
class Installed : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder = std::make_unique<TemporaryDirectory>();
        expect_success("cmake --install '" + build_folder + "' --prefix '" +
                           (*folder / "first").string() + "'",
                       folder->path());
        if (HasFailure()) return;
        std::filesystem::rename(*folder / "first", tree());
        configure((source_directory() / "examples").string(),
                  "-DCMAKE_PREFIX_PATH='" + tree().string() + "'", folder->path());
        if (!HasFailure()) expect_success("cmake --build build", folder->path());
    }
    static void TearDownTestSuite() { folder.reset(); }

    static std::filesystem::path tree() { return *folder / "moved"; }
    static std::string output_of(const std::string& example) {
        const ProgramResult result = run_clean("build/" + example, folder->path());
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return result.out;
    }

    static std::unique_ptr<TemporaryDirectory> folder;
};
std::unique_ptr<TemporaryDirectory> Installed::folder;

TEST_LABELS(slow);
TEST_F(Installed, NormalsAndTangentsFollowTheWave) {
    const std::string output = output_of("normals_and_tangents");
    // The wave's slope is -0.2 pi; between vertices at a distance of 1/32 it is 0.6 % less.
    const double slope = 3.2 * std::sin(2.0 * M_PI / 32.0);
    const double length = std::sqrt(1.0 + slope * slope);
    const std::vector<double> normal = numbers_after(output, "normal");
    const std::vector<double> tangent = numbers_after(output, "tangent");
    ASSERT_EQ(normal.size(), 3) << output;
    ASSERT_EQ(tangent.size(), 4) << output;
    EXPECT_NEAR(normal[0], slope / length, 2e-4);
    EXPECT_NEAR(normal[1], 0.0, 2e-4);
    EXPECT_NEAR(normal[2], 1.0 / length, 2e-4);
    EXPECT_NEAR(tangent[0], 1.0 / length, 2e-4);
    EXPECT_NEAR(tangent[2], -slope / length, 2e-4);
    EXPECT_EQ(tangent[3], 1.0);
}

TEST_LABELS(slow);
TEST_F(Installed, PythonFindsImagesAndTools) {
    const std::filesystem::path modules = tree() / "lib/python3/dist-packages";
    if (!std::filesystem::exists(modules / "relief"))
        GTEST_SKIP() << "The Python module is not built.";
    std::ofstream(*folder / "use.py")
        << "import numpy, relief\n"
           "relief.write_image('a.exr', numpy.full((2, 3), 0.25, 'float32'))  # by OpenImageIO\n"
           "print('mean', relief.read_image('a.exr')[0].mean())\n"
           "print('tool', relief.run('relief-bake', '--version').split()[1], "
           "relief.__version__)\n";
    const std::string line = "PYTHONPATH='" + modules.string() + "' /usr/bin/python3 use.py";
    const ProgramResult result = run_clean(line, folder->path());
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.out, "mean 0.25\ntool " RELIEF_VERSION " " RELIEF_VERSION "\n");
}

TEST_LABELS(slow);
TEST_F(Installed, TheHeightMapBecomesItsSlope) {
    const std::string output = output_of("height_map_to_normal_map");
    // (-1, 0, 2) / sqrt(5) as codes: 255 (n + 1) / 2, rounded up at the half.
    EXPECT_EQ(numbers_after(output, "texel"), (std::vector<double>{70, 128, 242})) << output;
    EXPECT_NEAR(numbers_after(output, "slope").at(0), 0.5, 0.01);
    EXPECT_LT(numbers_after(output, "error").at(0), 0.4);  // half a code of 8 bits, twice
    EXPECT_EQ(numbers_after(output, "findings"), std::vector<double>{0});
}

TEST_LABELS(slow);
TEST_F(Installed, TheBakeHasTheSlopesOfTheWave) {
    const std::string output = output_of("bake_in_memory");
    const std::vector<double> counts = numbers_after(output, "baked");
    EXPECT_EQ(counts, (std::vector<double>{128 * 128, 0, 128 * 128})) << output;
    const std::vector<double> slopes = numbers_after(output, "steepest slope");
    ASSERT_EQ(slopes.size(), 2);
    EXPECT_NEAR(slopes[1], 0.08 * M_PI, 1e-4);
    EXPECT_NEAR(slopes[0] / slopes[1], 1.0, 0.02);  // Texels average over one 32nd of a wave.
}

TEST_LABELS(slow);
TEST_F(Installed, CProgramsHaveTheSameResults) {
    const std::string output = output_of("c_interface");
    for (const std::string line : {"normal", "tangent"})
        EXPECT_EQ(numbers_after(output, line),
                  numbers_after(output_of("normals_and_tangents"), line));
    EXPECT_EQ(numbers_after(output, "texel"), (std::vector<double>{70, 128, 242, 255}));
    EXPECT_EQ(numbers_after(output, "baked"), (std::vector<double>{64 * 64, 64 * 64}));
    const std::vector<double> slopes = numbers_after(output, "steepest slope");
    ASSERT_EQ(slopes.size(), 2);
    EXPECT_NEAR(slopes[0] / slopes[1], 1.0, 0.02);
    EXPECT_THAT(output, testing::Not(HasSubstr("finding")));

    const std::string example = (source_directory() / "examples/c_interface.c").string();
    expect_success("PKG_CONFIG_PATH='" + tree().string() +
                       "/lib/pkgconfig' && export PKG_CONFIG_PATH && cc -std=c99 -Wall -Wextra "
                       "-pedantic -Werror '" +
                       example + "' -o c_by_pkg_config $(pkg-config --cflags --libs relief-c)",
                   folder->path());
    EXPECT_EQ(run_clean("./c_by_pkg_config", folder->path()).out, output);

    // A project without C++.
    const std::filesystem::path project = *folder / "engine";
    std::filesystem::create_directory(project);
    std::ofstream(project / "CMakeLists.txt")
        << "cmake_minimum_required(VERSION 3.25)\nproject(engine LANGUAGES C)\n"
        << "find_package(relief REQUIRED COMPONENTS c)\nadd_executable(engine " << example
        << ")\ntarget_link_libraries(engine PRIVATE relief::c m)\n";
    expect_success("cmake -G Ninja -S . -B build -DCMAKE_PREFIX_PATH='" + tree().string() +
                       "' && cmake --build build",
                   project);
    EXPECT_EQ(run_clean("build/engine", project).out, output);
}

TEST_LABELS(slow);
TEST_F(Installed, TheCheckFindsGreenDown) {
    const std::string output = output_of("check_normal_map");
    EXPECT_THAT(output, HasSubstr("tangent-space normals: yes\n"));
    EXPECT_THAT(output, HasSubstr("green: down\n"));
    EXPECT_GT(numbers_after(output, "confidence:").at(0), 0.99);
    EXPECT_NEAR(numbers_after(output, "mean length:").at(0), 1.0, 0.01);
}

TEST_LABELS(slow);
TEST_F(Installed, TheRenderedSphereFacesTheLight) {
    const std::string output = output_of("render_to_memory");
    for (const double channel : numbers_after(output, "center"))
        EXPECT_NEAR(channel, 0.5, 0.005) << output;  // The facets have an angle of a few degrees.
    const double covered = numbers_after(output, "covered").at(0);
    EXPECT_GT(covered, 0.6);
    EXPECT_LT(covered, M_PI / 4.0);
}

TEST_LABELS(slow);
TEST_F(Installed, ExplanationListsTheInputs) {
    const std::string output = output_of("explain_effects");
    EXPECT_THAT(output, HasSubstr("\non  directional lights: "));
    EXPECT_THAT(output, HasSubstr("\noff emission: "));
    EXPECT_THAT(output, HasSubstr("\noff normal map: "));
}

TEST_LABELS(slow);
TEST_F(Installed, ComponentsNeedOnlyTheirThirdParties) {
    const std::set<std::string> mesh = {"libfmt", "libtbb"};
    EXPECT_EQ(needed_libraries(*folder / "build/normals_and_tangents"), mesh);
    EXPECT_EQ(needed_libraries(*folder / "build/height_map_to_normal_map"), mesh);
    std::set<std::string> bake = mesh;
    bake.insert("lib" RELIEF_EMBREE);
    EXPECT_EQ(needed_libraries(*folder / "build/bake_in_memory"), bake);
}

TEST_LABELS(slow);
TEST_F(Installed, ToolsAndProgramsFindTheModuleInTheMovedTree) {
    const std::string tools = tree().string() + "/bin/";
    for (const std::string tool :
         {"relief", "relief-mesh", "relief-bake", "relief-view", "relief-accuracy"})
        EXPECT_THAT(run_clean(tools + tool + " --version", folder->path()).out,
                    testing::MatchesRegex(tool + " " RELIEF_VERSION
                                                 R"(( \(commit [0-9a-f]+(-modified)?\))?)"
                                                 "\n"));
    const std::string heights = (source_directory() / "data/bricks-height.png").string();
    expect_success(tools + "relief-bake bump '" + heights + "' map.tif --quiet", folder->path());
    EXPECT_THAT(run_clean("build/check_normal_map map.tif", folder->path()).out,
                HasSubstr("green: up\n"));
}

TEST_LABELS(slow);
TEST_F(Installed, SamplesRunTheFirstCommandsOfTheReadme) {
    const TemporaryDirectory empty;
    const std::string commands = first_commands();
    ASSERT_THAT(commands, HasSubstr("relief-view"));
    expect_success("set -e\nPATH='" + tree().string() + "/bin':\"$PATH\"\ncp -r '" +
                       tree().string() + "/share/relief/data' .\n" + commands,
                   empty.path());
    for (const char* file : {"out/bricks-normal.png", "out/vase.glb", "out/vase.png"})
        EXPECT_TRUE(std::filesystem::exists(empty / file)) << file;
}

TEST_LABELS(slow);
TEST_F(Installed, PkgConfigNamesTheSameProgram) {
    const std::string example = (source_directory() / "examples/normals_and_tangents.cpp").string();
    expect_success("PKG_CONFIG_PATH='" + tree().string() +
                       "/lib/pkgconfig' && export PKG_CONFIG_PATH && '" + compiler +
                       "' -std=c++20 '" + example +
                       "' -o by_pkg_config $(pkg-config --cflags --libs relief-mesh)",
                   folder->path());
    EXPECT_EQ(run_clean("./by_pkg_config", folder->path()).out, output_of("normals_and_tangents"));
}

TEST_LABELS(slow);
TEST_F(Installed, HeadersAndShadersAreInTheTree) {
    for (const char* header :
         {"relief/mesh/frames.h", "relief/shade/renderer.h", "relief/accuracy/asset.h",
          "relief/make/asset.h", "relief/version.h", "relief/export.h"})
        EXPECT_TRUE(std::filesystem::exists(tree() / "include" / header)) << header;
    EXPECT_TRUE(std::filesystem::exists(tree() / "share/relief/shaders/phong.glsl"));
}

// A project adds the sources with the mesh component as a shared library. One file is compiled;
// building all takes minutes.
TEST(Packages, HaveTheirFilesOnly) {
    const TemporaryDirectory folder;
    std::map<std::string, std::set<std::string>> files;
    for (const std::string component : {"tools", "formats", "development", "python"}) {
        const std::filesystem::path prefix = folder / component;
        expect_success("cmake --install '" + build_folder + "' --component " + component +
                           " --prefix '" + prefix.string() + "'",
                       folder.path());
        if (!exists(prefix)) continue;  // The Python module is not built everywhere.
        for (const auto& entry : std::filesystem::recursive_directory_iterator(prefix)) {
            if (entry.is_regular_file())
                files[component].insert(entry.path().lexically_relative(prefix).string());
        }
    }
    for (const char* file :
         {"bin/relief", "bin/relief-accuracy", "bin/relief-bake", "bin/relief-mesh",
          "bin/relief-view", "share/bash-completion/completions/relief-mesh",
          "share/man/man1/relief-mesh-decimate.1", "share/relief/data/vase.obj",
          "share/relief/shaders/phong.glsl", "share/applications/relief-view.desktop",
          "share/doc/relief/LICENSE", "share/doc/relief/docs/hard-cases.md",
          "share/doc/relief/docs/images/bake.png", "share/doc/relief/relief.spdx.json",
          "share/doc/relief/third-party-notices.txt",
          "share/icons/hicolor/scalable/apps/relief-view.svg",
          "share/metainfo/relief-view.metainfo.xml", "share/mime/packages/relief.xml",
          "share/thumbnailers/relief-view.thumbnailer"})
        EXPECT_TRUE(files["tools"].contains(file)) << file;
    // OpenImageIO and what it needs are installed only with this package.
    EXPECT_EQ(files["formats"], (std::set<std::string>{"lib/relief/relief-image-decoder",
                                                       "lib/relief/relief_image.so"}));
    EXPECT_TRUE(
        files["development"].contains("share/doc/librelief-dev/examples/bake_in_memory.cpp"));
    for (const char* file :
         {"include/relief/version.h", "include/relief/mesh/normals.h", "lib/librelief_mesh.a",
          "lib/cmake/relief/relief-config.cmake", "lib/pkgconfig/relief-mesh.pc"})
        EXPECT_TRUE(files["development"].contains(file)) << file;
    const std::string readme = read_bytes(source_directory() / "README.md");
    static const std::regex sample(R"(\bdata/[a-z-]+(\.[a-z]+)?(?=[ \n]))");
    for (std::sregex_iterator at(readme.begin(), readme.end(), sample), end; at != end; ++at) {
        const std::string name = "share/relief/" + at->str();
        const auto found = files["tools"].lower_bound(name);
        EXPECT_TRUE(found != files["tools"].end() && found->starts_with(name)) << name;
    }
    for (const std::string& file : files["tools"])
        EXPECT_FALSE(file.ends_with(".a") || file.ends_with(".h") || file.ends_with(".cpp"))
            << file;
    for (const std::string& file : files["python"])
        EXPECT_TRUE(file.starts_with("lib/python3/dist-packages/relief/")) << file;
    for (const std::string& file : files["development"]) {
        EXPECT_TRUE(file.starts_with("include/relief/") || file.starts_with("lib/") ||
                    file.starts_with("share/doc/librelief-dev/examples/"))
            << file;
        // Other computers have the third parties elsewhere.
        if (!file.ends_with(".cmake") && !file.ends_with(".pc")) continue;
        const std::string text = read_bytes(folder / "development" / file);
        static const std::regex absolute_path(R"([";= ]/[a-z]+/[^"; \n]*)");
        std::smatch path;
        EXPECT_FALSE(std::regex_search(text, path, absolute_path)) << file << ": " << path.str();
    }
}

TEST_LABELS(slow);
TEST(AddedFolder, GivesTheMeshComponentAlone) {
    const TemporaryDirectory folder;
    std::filesystem::create_directory(folder / "engine");
    std::ofstream(folder / "engine/CMakeLists.txt")
        << "cmake_minimum_required(VERSION 3.25)\nproject(engine LANGUAGES C CXX)\n"
        << "set(BUILD_SHARED_LIBS ON)\nset(RELIEF_COMPONENTS mesh)\nset(RELIEF_PCH OFF)\n"
        << "set(RELIEF_UNITY OFF)\n"
        << "add_subdirectory(" << source_directory().string() << " relief)\n"
        << "add_executable(engine " << source_directory().string()
        << "/examples/normals_and_tangents.cpp)\n"
        << "target_link_libraries(engine PRIVATE relief::mesh)\n"
        << "if(CMAKE_BUILD_TYPE OR CMAKE_CXX_FLAGS OR CMAKE_RUNTIME_OUTPUT_DIRECTORY)\n"
        << "  message(FATAL_ERROR \"relief changes its parent\")\nendif()\n"
        << "foreach(target relief_files relief-mesh relief_test_support)\n"
        << "  if(TARGET ${target})\n    message(FATAL_ERROR \"${target}\")\n  "
           "endif()\nendforeach()\n";
    configure("engine", "", folder.path());
    if (HasFailure()) return;
    expect_success(
        "cmake --build build -- relief/libmesh/CMakeFiles/relief_mesh.dir/src/base/report.cpp.o",
        folder.path());
    const std::string commands = run_clean("ninja -C build -t commands engine", folder.path()).out;
    EXPECT_THAT(commands, HasSubstr("-Wl,-soname,librelief_mesh.so." + abi_version + " "));
    EXPECT_THAT(commands, testing::Not(HasSubstr("libmesh/src/io/")));
}

// Precompiled headers have other bytes in each folder, and the object is found nevertheless.
TEST(CompilerCache, HasTheObjectsOfAnotherFolder) {
    if (run_clean("ccache --version", ".").exit_code != 0) GTEST_SKIP() << "needs ccache";
    const TemporaryDirectory folder;
    const std::string cache = "CCACHE_DIR='" + (folder / "cache").string() + "' ";
    for (const char* name : {"first", "second_folder"}) {
        const std::filesystem::path project = folder.path() / name;
        std::filesystem::create_directories(project);
        std::ofstream(project / "CMakeLists.txt")
            << "cmake_minimum_required(VERSION 3.22)\nproject(engine CXX)\ninclude(\""
            << (source_directory() / "cmake/compiler_cache.cmake").string()
            << "\")\nadd_library(engine OBJECT engine.cpp)\n"
               "target_precompile_headers(engine PRIVATE engine.h)\n";
        std::ofstream(project / "engine.h") << "#include <vector>\n";
        std::ofstream(project / "engine.cpp")
            << "#include \"engine.h\"\nstd::vector<int> numbers() { return {1, 2}; }\n";
        configure(".", "", project);
        if (HasFailure()) return;
        expect_success(cache + "cmake --build build", project);
        if (HasFailure()) return;
    }
    const std::string statistics = run_clean(cache + "ccache --print-stats", folder.path()).out;
    const auto count = [&](const char* name) { return numbers_after(statistics, name).at(0); };
    EXPECT_EQ(count("direct_cache_hit") + count("preprocessed_cache_hit"), 1.0) << statistics;
    EXPECT_EQ(count("cache_miss"), 1.0) << statistics;
}

// Two of five sources have a structure of one name, so that the five do not compile as a batch, but
// the other three do. Their objects are joined; those of Windows would lose their exception
// handlers, as scripts/dev/try-windows has shown.
TEST(CompileBatch, CompilesHalvesOfABatchWhoseNamesClashExceptForWindows) {
    const TemporaryDirectory folder;
    std::filesystem::create_directories(folder.path() / "Unity");
    std::string batch;
    for (const char* name : {"one", "two", "three", "four", "five"}) {
        const std::filesystem::path source = folder.path() / fmt::format("{}.cpp", name);
        const bool is_clash = name == std::string_view("one") || name == std::string_view("two");
        const std::string type = is_clash ? "Pose" : fmt::format("Pose_{}", name);
        std::ofstream(source) << fmt::format(
            "namespace {{ struct {0} {{ int value; }}; }}\n"
            "int {1}() {{ return {0}{{1}}.value; }}\n",
            type, name);
        batch += "#include \"" + source.string() + "\"\n";
    }
    std::ofstream(folder.path() / "Unity/all.cxx") << batch;
    std::ofstream(folder.path() / "main.cpp")
        << "int one();\nint two();\nint three();\nint four();\nint five();\n"
           "int main() { return one() + two() + three() + four() + five() - 5; }\n";
    const std::string compile = (source_directory() / "cmake/compile-batch").string() + " '" +
                                compiler + "' -O1 -MD -MF all.d -o ./Unity/all.o -c Unity/all.cxx";
    const ProgramResult joined = run_clean(compile, folder.path());
    ASSERT_EQ(joined.exit_code, 0) << joined.error;
    EXPECT_THAT(joined.error, HasSubstr("clash; they were compiled in 3 parts"));
    expect_success("'" + compiler + "' main.cpp Unity/all.o -o main && ./main", folder.path());
    EXPECT_EQ(run_clean("ls Unity", folder.path()).out, "all.cxx\nall.o\n");
    const std::string dependencies = run_clean("cat all.d", folder.path()).out;
    EXPECT_THAT(dependencies, HasSubstr("five.cpp"));
    EXPECT_THAT(dependencies, testing::Not(HasSubstr("all.o.")));
    const ProgramResult windows =
        run_clean(std::regex_replace(compile, std::regex("all\\.o "), "all.obj "), folder.path());
    EXPECT_EQ(windows.exit_code, 1);
    EXPECT_THAT(windows.error, HasSubstr("objects for Windows cannot be joined"));

    std::ofstream(folder.path() / "four.cpp") << "int four() { return unknown; }\n";
    const ProgramResult wrong = run_clean(compile, folder.path());
    EXPECT_EQ(wrong.exit_code, 1);
    EXPECT_THAT(wrong.error, HasSubstr("four.cpp:1:21: error: "));
    EXPECT_THAT(wrong.error, testing::Not(HasSubstr("two.cpp")));
}

// scripts/dev/try-windows builds these targets. Compiling them would take minutes; Ninja names the
// first file that is missing.
TEST_LABELS(slow);
TEST(PortablePreset, HasAllFilesOfItsBuild) {
    const TemporaryDirectory folder;
    const std::string source = source_directory().string();
    expect_success("cmake --preset portable -S '" + source + "' -B build", folder.path());
    if (HasFailure()) return;
    const std::string steps =
        run_clean("cmake --build build -- -n -v portable_tests result_hashes", folder.path()).out;
    EXPECT_THAT(steps, HasSubstr("/tests/mesh/c/c_usage.c"));
    EXPECT_THAT(steps, testing::Not(HasSubstr("/libmesh/src/c/c_bake.cpp")));
}

// A shared library of the objects of the static one, which are position independent.
TEST_LABELS(slow);
TEST(SharedMesh, ExportsTheFunctionsOfPublicHeaders) {
    const TemporaryDirectory folder;
    const std::string library = (folder / "librelief_mesh.so").string();
    expect_success("'" + compiler + "' -shared -Wl,--no-undefined -Wl,--whole-archive '" +
                       build_folder + "/libmesh/librelief_mesh.a' -Wl,--no-whole-archive -o '" +
                       library + "' -lfmt -ltbb",
                   folder.path());
    if (HasFailure()) return;
    EXPECT_EQ(needed_libraries(library), (std::set<std::string>{"libfmt", "libtbb"}));
    const std::string symbols =
        run_clean("nm -DC --defined-only '" + library + "'", folder.path()).out;
    EXPECT_THAT(symbols, HasSubstr("T relief::vertex_normals("));
    EXPECT_THAT(symbols, testing::Not(HasSubstr("relief::detail::sum_contributions(")));
    const std::string source = source_directory().string();
    expect_success(
        "'" + compiler + "' -std=c++20 -I '" + source + "/libmesh/include' '" + source +
            "/examples/normals_and_tangents.cpp' -o engine -L. -lrelief_mesh -Wl,-rpath,.",
        folder.path());
    EXPECT_EQ(numbers_after(run_clean("./engine", folder.path()).out, "vertices"),
              std::vector<double>{33 * 33});
}

// All components as shared libraries, of the objects of the static ones: each finds what it needs
// in the exports of the others.
TEST_LABELS(slow);
TEST(SharedComponents, LinkWithTheExportsOfEachOther) {
    struct Component {
        std::string name, folder, libraries;
    };
    const std::vector<Component> components = {
        {"mesh", "libmesh", ""},
        {"topology", "libmesh", "-lrelief_mesh"},
        {"atlas", "libmesh", "-lrelief_mesh"},
        {"files", "libmesh",
         "-lrelief_mesh $(pkg-config --libs tinyobjloader libdeflate libisal libturbojpeg libzstd "
         "draco) -lmeshoptimizer"},
        {"bake", "libmesh", "-lrelief_mesh -l" RELIEF_EMBREE},
        {"c", "libmesh", "-lrelief_bake -lrelief_atlas -lrelief_mesh"},
        {"shade", "libshade", "-lrelief_files -lrelief_mesh"},
        {"reference", "libshade/src/reference",
         "-lrelief_shade -lrelief_bake -lrelief_files -lrelief_mesh -l" RELIEF_EMBREE},
        {"accuracy", "libaccuracy",
         "-lrelief_reference -lrelief_shade -lrelief_bake -lrelief_files -lrelief_topology "
         "-lrelief_atlas -lrelief_mesh -l" RELIEF_EMBREE},
        {"make", "libmake",
         "-lrelief_bake -lrelief_files -lrelief_topology -lrelief_atlas -lrelief_mesh "
         "-l" RELIEF_EMBREE},
    };
    const TemporaryDirectory folder;
    for (const Component& component : components) {
        const std::string library = "librelief_" + component.name;
        expect_success(
            "'" + compiler +
                "' -shared -Wl,--no-undefined '-Wl,-rpath,$ORIGIN' -Wl,--whole-archive '" +
                build_folder + "/" + component.folder + "/" + library +
                ".a' -Wl,--no-whole-archive -o " + library + ".so -L. " + component.libraries +
                " -lfmt -ltbb",
            folder.path());
        if (HasFailure()) return;
        const std::string foreign =
            run_clean("nm -DC --defined-only " + library +
                          ".so | cut -c20- | grep -vE '^((typeinfo|typeinfo name|vtable|guard "
                          "variable) for )?relief::|std::|relief_[a-z_]+$'",
                      folder.path())
                .out;
        EXPECT_EQ(foreign, "") << component.name;
    }
    const std::string source = source_directory().string();
    expect_success("'" + compiler + "' -std=c++20 -I '" + source + "/libmesh/include' -I '" +
                       source + "/libshade/include' '" + source +
                       "/examples/explain_effects.cpp' -o explain -L. -lrelief_shade "
                       "-lrelief_files -lrelief_mesh -Wl,-rpath,.",
                   folder.path());
    EXPECT_THAT(run_clean("./explain", folder.path()).out, HasSubstr("off normal map: "));
}

// A program may link its own copy of glad with another table of functions.
TEST(StaticShade, DefinesNoNamesOfGlad) {
    const std::string symbols = run_clean("nm --defined-only --extern-only '" + build_folder +
                                              "/libshade/librelief_shade.a'",
                                          source_directory())
                                    .out;
    EXPECT_THAT(symbols, HasSubstr(" T relief_gladLoadGLContext\n"));
    EXPECT_THAT(symbols, testing::Not(HasSubstr(" glad")));
}

// Older standards of C++ get one line that names the remedy.
TEST(Headers, NameTheStandardThatTheyNeed) {
    const std::string include = "-fsyntax-only -x c++ -I '" +
                                (source_directory() / "libmesh/include").string() + "' -include ";
    const ProgramResult older =
        run_clean("'" + compiler + "' -std=c++17 " + include + "relief/mesh/buffers.h /dev/null",
                  source_directory());
    EXPECT_NE(older.exit_code, 0);
    EXPECT_THAT(older.error, HasSubstr("relief needs C++20 (-std=c++20)"));
    expect_success("'" + compiler + "' -std=c++11 -Wall -Wextra -pedantic -Werror " + include +
                       "relief/relief.h /dev/null",
                   source_directory());
}

TEST(Interface, IsTheCommittedOne) {
    const ProgramResult result =
        run_clean("scripts/dev/list-interface '" + build_folder + "'", source_directory());
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.out, read_bytes(source_directory() / "tests/install/interface.txt"))
        << "The public interface has changed. If it is meant to, run\n"
           "scripts/dev/list-interface > tests/install/interface.txt and add the change to "
           "CHANGELOG.md.";
}

}  // namespace
}  // namespace relief::test
