// SPDX-License-Identifier: Apache-2.0
// Every glTF file that a command writes with exit code 0 is accepted by `relief-mesh check`, and
// has no errors and no new warnings of the Khronos validator (if RELIEF_GLTF_VALIDATOR names the
// folder of the npm package gltf-validator, and there is node). Without success, the old file
// stays.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/labels.h"
#include "support/sanitized.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using test::ProgramResult;
using test::Workplace;

/// A command that writes models. {0} is the input, {1} the output.
struct WritingCommand {
    const char* line;
    /// True if the old output is replaced. Otherwise it must be a copy of the input, or absent.
    bool replaces = true;
};

constexpr std::array commands = {
    WritingCommand{"relief-mesh process '{0}' {1}"},
    WritingCommand{"relief-mesh process '{0}' {1} --normals keep"},
    WritingCommand{"relief-mesh decimate '{0}' {1} --ratio 50%"},
    WritingCommand{"relief-mesh subdivide '{0}' {1} --levels 1"},
    WritingCommand{"relief-mesh repair '{0}' {1}"},
    WritingCommand{"relief-mesh material '{0}' {1} --normal data/scenes/bricks-normal.png"},
    WritingCommand{"relief-mesh lods '{0}' {1} --levels 1 --switch distance"},
    WritingCommand{
        "relief-bake mesh '{0}' '{0}' out/map.png --size 16 --padding 1 --write-into {1}", false},
};

/// Commands that write a model of new triangles or coordinates, which take longer.
constexpr std::array rebuilding_commands = {
    WritingCommand{"relief-mesh unwrap '{0}' {1} --size 64x64"},
    WritingCommand{"relief-mesh displace '{0}' {1} --heights data/bricks-height.png --height 0.01 "
                   "--max-triangles 3000"},
    WritingCommand{"relief-mesh remesh '{0}' {1} --resolution 16 --shell"},
    WritingCommand{"relief make '{0}' {1} --size 32 --triangles 100"},
};

std::vector<fs::path> models_below(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        for (const char* known : {".gltf", ".glb", ".obj", ".ply", ".stl", ".off"}) {
            if (extension == known) files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool is_gltf(const fs::path& file) {
    return file.extension() == ".gltf" || file.extension() == ".glb";
}

class ValidOutputs : public testing::Test {
  protected:
    void run_all(const std::vector<fs::path>& models) {
        for (const fs::path& model : models) {
            for (const WritingCommand& command : commands)
                run(command, model);
            for (const WritingCommand& command : rebuilding_commands)
                run(command, model);
        }
        validate();
    }

    /// Runs one command for each model, in turn, in a fraction of the time.
    void run_one_each(const std::vector<fs::path>& models) {
        for (std::size_t i = 0; i < models.size(); ++i)
            run(commands[i % std::size(commands)], models[i]);
        validate();
    }

    int written_ = 0;

  private:
    void run(const WritingCommand& command, const fs::path& model) {
        const std::string out = fmt::format("out/{}.glb", written_);
        if (command.replaces)
            workplace_.write(out, "old");
        else
            fs::remove(workplace_ / out);
        const std::string line = fmt::format(fmt::runtime(command.line), model.string(), out);
        const ProgramResult result = workplace_.run(line);
        if (result.exit_code != 0) {
            EXPECT_EQ(result.exit_code, 1) << line << "\n" << result.error;
            if (command.replaces)
                EXPECT_EQ(workplace_.read(out), "old") << line;
            else
                EXPECT_FALSE(fs::exists(workplace_ / out)) << line;
            return;
        }
        const ProgramResult check = workplace_.run("relief-mesh check " + out);
        EXPECT_EQ(check.exit_code, 0) << line << "\n" << check.error;
        const std::string baseline =
            is_gltf(model) ? fmt::format("--baseline '{}' ", model.string()) : std::string();
        pairs_ += fmt::format(" {}'{}'", baseline, (workplace_ / out).string());
        ++written_;
    }

    void validate() {
        const char* module = std::getenv("RELIEF_GLTF_VALIDATOR");
        if (module == nullptr) return;
        const ProgramResult result = workplace_.run(
            fmt::format("node scripts/dev/validate-gltf.mjs --module '{}'{}", module, pairs_));
        EXPECT_EQ(result.exit_code, 0) << result.out << result.error;
    }

    const Workplace workplace_;
    std::string pairs_;
};

TEST_F(ValidOutputs, FromBrokenAndHostileModels) {
    RELIEF_NEEDS_SHARED(broken, "data/broken/gltf");
    RELIEF_NEEDS_SHARED(hostile, "data/hostile");
    RELIEF_NEEDS_SHARED(more_hostile, "data/hostile2");
    std::vector<fs::path> models;
    for (const fs::path& folder : {broken, hostile, more_hostile}) {
        for (fs::path& file : models_below(folder))
            models.push_back(std::move(file));
    }
    if (test::is_sanitized)
        run_one_each(models);
    else
        run_all(models);
    EXPECT_GT(written_, test::is_sanitized ? 0 : 50);
}

TEST_LABELS(slow);
TEST_F(ValidOutputs, FromRealModels) {
    RELIEF_NEEDS_SHARED(folder, "data/models");
    run_one_each(models_below(folder));
    EXPECT_GT(written_, 140);
}

}  // namespace
}  // namespace relief::tools
