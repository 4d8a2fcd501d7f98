// SPDX-License-Identifier: Apache-2.0
// Writes the meshes of the conformance kit into a folder: relief-make-conformance-kit FOLDER. The
// same files come out of every run. Exit 0 done, 1 failed, 2 wrong usage.
// Tests: tests/tools/conformance_kit_test.cpp.
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "kit_files.h"

namespace {

void write_all(const std::filesystem::path& folder) {
    namespace kit = relief::conformance;
    std::filesystem::create_directories(folder);
    const auto meshes = kit::kit_meshes();
    for (const kit::KitMesh& mesh : meshes) {
        kit::write_glb(folder / (mesh.name + ".glb"), mesh);
        if (!mesh.quads.empty()) kit::write_obj(folder / (mesh.name + ".obj"), mesh);
    }
    kit::write_list(folder / "kit.json", meshes);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2 || arguments[1][0] == '-') {
        fmt::print(stderr, "usage: relief-make-conformance-kit FOLDER\n");
        return 2;
    }
    try {
        write_all(arguments[1]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "relief-make-conformance-kit: error: {}\n", error.what());
        return 1;
    }
    return 0;
}
