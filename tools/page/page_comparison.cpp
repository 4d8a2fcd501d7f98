// SPDX-License-Identifier: Apache-2.0
#include "page_comparison.h"

#include <fmt/format.h>

#include <utility>

#include "common/html.h"
#include "page_writer.h"

namespace relief::tools {
using namespace relief::shade;

std::string comparison_page(const Context& context, const Camera& camera, const PageSide& left,
                            const std::vector<PageSide>& right, const glm::ivec2& size,
                            const std::string& title) {
    const FrameSettings frame{.width = size.x, .height = size.y};
    FrameSettings single = frame;
    single.samples = 1;
    std::vector<SceneGraph> graphs(1 + right.size());
    graphs[0].scene = *left.scene;
    for (std::size_t i = 0; i < right.size(); ++i)
        graphs[i + 1].scene = *right[i].scene;
    PageSettings settings;
    settings.title = title;
    settings.size = size;
    settings.split = {0.5F, left.name, right.size() == 1 ? right[0].name : ""};
    PageRecorder recorder(context);
    const auto record = [&](std::size_t scene, PagePictureName name) {
        const SceneGraph& graph = graphs[scene];
        recorder.add(graph, plan_effects(graph.scene, single), frame);
        name.view = "picture";
        name.scene = scene;
        settings.names.push_back(std::move(name));
    };
    for (const SceneGraph& graph : graphs)
        settings.scenes.push_back({&graph, camera});
    for (std::size_t i = 0; i < right.size(); ++i) {
        record(0, {"", right[i].name});
        record(i + 1, {"", right[i].name, {}, 2 * i});
    }
    const PageDescription& page = recorder.description();
    return page_html(page, settings, quantized(page));
}

std::string embedded_page(const std::string& page, const std::string& label) {
    return fmt::format("<iframe title=\"{}\" loading=\"lazy\" srcdoc=\"{}\"></iframe>\n",
                       html_escaped(label), html_escaped(page));
}

}  // namespace relief::tools
