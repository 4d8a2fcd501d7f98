// SPDX-License-Identifier: Apache-2.0
// Every part of the shaders compiles: as GLSL 330 core in OpenGL and in glslangValidator, and as
// GLSL ES 3.00 in glslangValidator, which also links random programs of that version.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "effects/shader_source.h"
#include "render/program_cache.h"
#include "shade/effects/feature_sets.h"
#include "support/gl_environment.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

struct SampleProgram {
    std::string name;
    ShaderSource vertex;
    ShaderSource fragment;
};

/// The lines of files that programs contain.
class CoveredLines {
  public:
    /// Returns true if the source has a line that no source before it has.
    bool add(const ShaderSource& source) {
        bool is_new = false;
        for (const SourceLine& origin : source.lines) {
            if (origin.file < 0) continue;
            const std::string& file = source.files[static_cast<std::size_t>(origin.file)];
            is_new |= lines_[file].insert(origin.line).second;
        }
        return is_new;
    }

    [[nodiscard]] bool holds(const ShaderPart& part) const {
        const auto lines = lines_.find(std::string(part.file));
        if (lines == lines_.end()) return false;
        const auto line = lines->second.lower_bound(part.first_line);
        return line != lines->second.end() &&
               *line < part.first_line + static_cast<int>(part.lines.size());
    }

  private:
    std::map<std::string, std::set<int>> lines_;
};

/// Programs that contain all parts and all neutral code.
class Samples {
  public:
    explicit Samples(GlslVersion version) : version_(version) {
        Features ambient_alone;  // Rare among random sets.
        ambient_alone.metallic_roughness = ambient_alone.ambient = true;
        add_surface(canonical(ambient_alone));
        std::size_t at = 0;
        test::for_random_features(1000, [&](const Features& random) {
            Features f = random;
            // Every other set draws the picture, the others all views in turn.
            const auto views = static_cast<std::size_t>(DebugView::nothing_to_show) + 1;
            if (++at % 2 == 0) f.view = static_cast<DebugView>(at / 2 % views);
            add_surface(canonical(f));
        });
        add_passes();
    }

    [[nodiscard]] const std::vector<SampleProgram>& programs() const { return programs_; }

    [[nodiscard]] bool holds(const ShaderPart& part) const { return covered_.holds(part); }

  private:
    void add_surface(const Features& f) {
        const SurfaceProgram program = surface_program(f, version_);
        const bool vertex_adds = covered_.add(program.vertex);
        const bool fragment_adds = covered_.add(program.fragment);
        if (!vertex_adds && !fragment_adds) return;
        programs_.push_back({describe(f), program.vertex, program.fragment});
    }

    void add_pass(const std::string& name, const ShaderSteps& steps) {
        const SurfaceProgram program = pass_program(name, steps, version_);
        programs_.push_back({name, program.vertex, program.fragment});
        covered_.add(programs_.back().vertex);
        covered_.add(programs_.back().fragment);
    }

    void add_passes() {
        const Scene scene;
        for (const char* sky : {"skybox.glsl#sharp", "skybox.glsl#blurred"}) {
            ShaderSteps steps = output_steps(OutputCoding::srgb, scene);
            choose_part(steps, sky);
            add_pass("skybox", steps);
        }
        for (const char* samples :
             {"picture.glsl#one_sample", "picture.glsl#four_samples", "picture.glsl#four_texels"}) {
            // GLSL ES 3.00 has no textures of several samples.
            if (version_ == GlslVersion::es_300 &&
                samples == std::string_view("picture.glsl#four_samples"))
                continue;
            add_pass("picture", finishing_steps(OutputCoding::linear, scene, samples));
        }
        ShaderSteps shown;  // Those of pages with several samples.
        choose_part(shown, "output.glsl#shown");
        choose_part(shown, "skybox.glsl#sharp");
        add_pass("skybox", shown);
        ShaderSteps codes;
        choose_part(codes, "output.glsl#codes");
        choose_part(codes, "picture.glsl#one_sample");
        add_pass("picture", codes);
        ShaderSteps lines = pose_steps(true, true);
        choose_part(lines, "overlay.glsl#one_color");
        add_pass("overlay", lines);
        ShaderSteps discs = pose_steps(false, false);
        choose_part(discs, "overlay.glsl#vertex_color");
        choose_part(discs, "overlay.glsl#disc");
        add_pass("overlay", discs);
    }

    GlslVersion version_;
    CoveredLines covered_;
    std::vector<SampleProgram> programs_;
};

/// Returns the parts that the samples of a version lack.
std::vector<std::string> missing_parts(const Samples& samples) {
    std::vector<std::string> missing;
    for (const ShaderPart& part : embedded_parts()) {
        if (!samples.holds(part)) missing.push_back(part.address);
    }
    return missing;
}

TEST_LABELS(not_sanitized);
TEST(ShaderLanguage, HasAProgramWithEveryPart) {
    EXPECT_THAT(
        missing_parts(Samples(GlslVersion::core_330)),
        testing::UnorderedElementsAre("version.glsl#es_precision", "version.glsl#es_buffers"));
    EXPECT_THAT(
        missing_parts(Samples(GlslVersion::es_300)),
        testing::UnorderedElementsAre("picture.glsl#four_samples", "version.glsl#<buffers>"));
}

bool has_glslang() {
    return std::system("glslangValidator --version > /dev/null 2>&1") == 0;
}

/// WebGL 2 guarantees so many textures in a stage.
constexpr std::ptrdiff_t max_webgl_samplers = 16;

std::ptrdiff_t sampler_count(const ShaderSource& source) {
    const std::regex declaration("(^|\n)uniform sampler");
    return std::distance(std::sregex_iterator(source.text.begin(), source.text.end(), declaration),
                         std::sregex_iterator());
}

/// Returns the declarations "in vec3 normal_world;" or "out ..." of a stage without the first word,
/// apart from those of names that it does not use.
std::set<std::string> used_declarations(const ShaderSource& source, const std::string& direction) {
    const std::string code = std::regex_replace(source.text, std::regex("//[^\n]*"), "");
    const std::regex line("\n" + direction + " (\\w+ (\\w+));");
    std::set<std::string> found;
    for (std::sregex_iterator at(code.begin(), code.end(), line), end; at != end; ++at) {
        const std::regex name("\\b" + (*at)[2].str() + "\\b");
        const auto uses = std::distance(std::sregex_iterator(code.begin(), code.end(), name),
                                        std::sregex_iterator());
        if (uses > 1) found.insert((*at)[1]);
    }
    return found;
}

/// Every fifth set is a view of a term or of data; the others are pictures.
std::vector<Features> random_canonical_sets(std::size_t count) {
    std::vector<Features> sets;
    std::set<Features> known;
    test::for_random_features(10 * count, [&](const Features& random) {
        Features f = random;
        const std::size_t at = known.size();
        const auto views = static_cast<std::size_t>(DebugView::nothing_to_show) + 1;
        if (at % 5 == 0) f.view = static_cast<DebugView>(at / 5 % views);
        f = canonical(f);
        if (sets.size() < count && known.insert(f).second) sets.push_back(f);
    });
    return sets;
}

// Compiling alone finds no varying of different types in the stages, and glslangValidator links a
// varying that is read and never written.
TEST_LABELS(not_sanitized);
TEST(ShaderLanguage, LinksRandomProgramsAsGlslEs) {
    if (!has_glslang()) GTEST_SKIP() << "needs glslangValidator (Debian: glslang-tools)";
    const std::vector<Features> sets = random_canonical_sets(300);
    ASSERT_EQ(sets.size(), 300U);
    const test::TemporaryDirectory folder;
    for (std::size_t i = 0; i < sets.size(); ++i) {
        const SurfaceProgram program = surface_program(sets[i], GlslVersion::es_300);
        EXPECT_THAT(used_declarations(program.vertex, "out"),
                    testing::IsSupersetOf(used_declarations(program.fragment, "in")))
            << describe(sets[i]);
        EXPECT_LE(sampler_count(program.vertex), max_webgl_samplers) << describe(sets[i]);
        EXPECT_LE(sampler_count(program.fragment), max_webgl_samplers) << describe(sets[i]);
        std::ofstream(folder / (std::to_string(i) + ".vert")) << program.vertex.text;
        std::ofstream(folder / (std::to_string(i) + ".frag")) << program.fragment.text;
    }
    // glslangValidator links all of its files to one program.
    const int status = std::system(
        ("cd '" + folder.path().string() +
         "' && for f in *.frag; do glslangValidator -l ${f%.frag}.vert $f || r=1; done > log 2>&1;"
         " exit ${r-0}")
            .c_str());
    std::ifstream log(folder / "log");
    EXPECT_EQ(status, 0) << std::string{std::istreambuf_iterator<char>(log), {}};
}

class Validated : public testing::TestWithParam<GlslVersion> {};
INSTANTIATE_TEST_SUITE_P(As, Validated, testing::Values(GlslVersion::core_330, GlslVersion::es_300),
                         [](const auto& version) {
                             return version.param == GlslVersion::core_330 ? "Core330" : "Es300";
                         });

TEST_LABELS(not_sanitized);
TEST_P(Validated, ByGlslang) {
    if (!has_glslang()) GTEST_SKIP() << "needs glslangValidator (Debian: glslang-tools)";
    const test::TemporaryDirectory folder;
    const Samples samples(GetParam());
    std::string command = "cd '" + folder.path().string() + "' && glslangValidator";
    std::size_t count = 0;
    for (const SampleProgram& program : samples.programs()) {
        const std::string name = std::to_string(count++);
        std::ofstream(folder / (name + ".vert")) << program.vertex.text;
        std::ofstream(folder / (name + ".frag")) << program.fragment.text;
        command += " " + name + ".vert " + name + ".frag";
    }
    const int status = std::system((command + " > log 2>&1").c_str());
    std::ifstream log(folder / "log");
    EXPECT_EQ(status, 0) << std::string{std::istreambuf_iterator<char>(log), {}};
}

class SamplePrograms : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(SamplePrograms);

TEST_LABELS(not_sanitized);
TEST_P(SamplePrograms, Link) {
    const Samples samples(GlslVersion::core_330);
    for (const SampleProgram& program : samples.programs()) {
        EXPECT_NO_THROW((void)link(api(), program.name, program.vertex, program.fragment))
            << program.name;
    }
}

}  // namespace
}  // namespace relief
