// SPDX-License-Identifier: Apache-2.0
// A page with levels of detail beside the input. Tests: tests/tools/reshaping_test.cpp.
#include "relief/mesh/report.h"
#include "reshape.h"

#ifdef RELIEF_HAS_SHADE

#include <fmt/format.h>

#include <span>
#include <string>

#include "file_replacement.h"
#include "page_comparison.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

std::string level_page(const std::string& title, const std::vector<std::filesystem::path>& levels) {
    constexpr glm::ivec2 size(800, 600);
    SceneOptions options;
    options.up = UpAxis::y;
    std::vector<Scene> scenes;
    std::vector<PageSide> right;
    scenes.reserve(levels.size());
    Camera camera;
    for (const std::filesystem::path& level : levels) {
        Scene& scene = scenes.emplace_back(load_scene(level, options));
        if (scenes.size() == 1) {
            camera = framed(scene, default_azimuth, default_elevation, default_vertical_fov,
                            static_cast<float>(size.x) / static_cast<float>(size.y));
        } else {
            right.push_back({fmt::format("LOD{}", scenes.size() - 1), &scene});
        }
        scene.background = default_background;
        add_default_lights(scene, camera);
    }
    const Context context;
    return comparison_page(context, camera, {"LOD0", &scenes.front()}, right, size, title);
}

}  // namespace

void write_level_page(const std::filesystem::path& page,
                      const std::vector<std::filesystem::path>& levels) {
    try {
        const std::string text = level_page(page.stem().string(), levels);
        relief::detail::replace_file(page, std::as_bytes(std::span(text)));
    } catch (const Error& error) {
        throw Error(fmt::format("no preview: {} (the levels are complete)", error.what()));
    }
}

}  // namespace relief::tools

#else

namespace relief::tools {

void write_level_page(const std::filesystem::path&, const std::vector<std::filesystem::path>&) {
    throw Error("this relief-mesh was built without the renderer");
}

}  // namespace relief::tools

#endif
