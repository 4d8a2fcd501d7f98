// SPDX-License-Identifier: Apache-2.0
// The Khronos validator over processed real models and made documents: nothing new may be wrong.
// Needs node and the folder of the npm package gltf-validator in $RELIEF_GLTF_VALIDATOR.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "gltf_semantics.h"
#include "relief/mesh/error.h"
#include "relief/mesh/gltf_document.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

/// What a command prints, and its exit status.
std::pair<std::string, int> output_of(const std::string& command) {
    std::string text;
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr)
        text += part.data();
    return {text, ::pclose(pipe)};
}

std::string quoted_for_shell(const std::filesystem::path& path) {
    std::string text = "'";
    for (const char c : path.string())
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
    return text;
}

class GltfValidator : public testing::Test {
  protected:
    void SetUp() override {
        const char* module = std::getenv("RELIEF_GLTF_VALIDATOR");
        if (module == nullptr) GTEST_SKIP() << "needs $RELIEF_GLTF_VALIDATOR and node";
        command_ =
            fmt::format("node {} --module {}",
                        quoted_for_shell(test::source_directory() / "scripts/validate-gltf.mjs"),
                        quoted_for_shell(module));
        if (output_of("node --version").second != 0) GTEST_SKIP() << "needs node";
    }
    std::string command_;
    test::TemporaryDirectory folder_;
    Report report_;
};

TEST_F(GltfValidator, ProcessedModelsHaveNoNewErrorsOrWarnings) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    std::string pairs;
    int count = 0;
    for (const auto& file : test::gltf_files_below(models)) {
        try {
            GltfDocument document = GltfDocument::read(file, report_);
            for (const GltfPrimitiveId id : document.triangle_primitives()) {
                const Mesh mesh = document.mesh(id);
                FrameOptions options;
                options.normals = count % 2 == 0 ? NormalMode::angle : NormalMode::flat;
                options.tangents =
                    mesh.texcoords.empty() ? TangentMode::none : TangentMode::mikktspace;
                document.set_frames(id, with_frames(mesh, options, report_), options, report_);
            }
            const auto out = folder_ / fmt::format("{}.glb", count++);
            document.write(out);
            pairs +=
                fmt::format(" --baseline {} {}", quoted_for_shell(file), quoted_for_shell(out));
        } catch (const FileError&) {
            continue;  // gltf_document_test.cpp knows which these are.
        }
    }
    const auto [text, status] = output_of(command_ + pairs);
    EXPECT_EQ(status, 0) << text;
    EXPECT_EQ(count, 102);
}

TEST_F(GltfValidator, MadeDocumentsAreValid) {
    RELIEF_NEEDS_SHARED(objects, "data/models/obj");
    std::string files;
    int count = 0;
    for (const char* name : {"fuze/fuze.obj", "spot/spot_quadrangulated.obj", "pirate.obj",
                             "teapot.obj", "tinyobj/cornell_box.obj"}) {
        MeshFile file = read_mesh(objects / name, report_);
        FrameOptions options;
        options.tangents =
            file.mesh.texcoords.empty() ? TangentMode::none : TangentMode::mikktspace;
        file.mesh = with_frames(std::move(file.mesh), options, report_).mesh;
        const auto out = folder_ / fmt::format("{}.glb", count++);
        GltfDocument::from_mesh(file).write(out);
        files += fmt::format(" {}", quoted_for_shell(out));
    }
    const auto [text, status] = output_of(command_ + files);
    EXPECT_EQ(status, 0) << text;
}

}  // namespace
}  // namespace relief
