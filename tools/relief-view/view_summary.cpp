// SPDX-License-Identifier: Apache-2.0
#include "view_summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/text.h"
#include "compare_options.h"
#include "relief/mesh/timing.h"
#include "sequence_options.h"

namespace relief::tools {
namespace {

std::string lights_in_words(const Scene& scene) {
    std::string text;
    const auto add = [&](std::size_t count, const std::string& kind) {
        if (count != 0) text += (text.empty() ? "" : ", ") + counted(count, kind + " light");
    };
    add(scene.directional_lights.size(), "directional");
    add(scene.point_lights.size(), "point");
    add(scene.spot_lights.size(), "spot");
    if (text.empty()) text = "no light";
    if (scene.ambient != glm::vec3(0.0F)) text += " and ambient light";
    return text;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        count += scene.meshes[instance.mesh]->triangles.size();
    return count;
}

/// "24, each 12.3 ms to draw and 0.9 ms to read back (median)"
std::string frames_in_words(const SequenceTimes& times) {
    return fmt::format("{}, each {:.3g} ms to draw and {:.3g} ms to read back (median)",
                       times.draw.size(), spread_of(times.draw).median,
                       spread_of(times.read_back).median);
}

/// "out/spin-0001.png to out/spin-0024.png", or the one file and its size.
std::string written(const ViewOptions& options) {
    const std::filesystem::path& output = *options.output;
    const bool numbered = (options.turntable || options.frames) && extension_of(output) != ".apng";
    if (!numbered) return file_and_size(output);
    return fmt::format("{} to {}", numbered_file(output, 1).string(),
                       numbered_file(output, picture_count(options)).string());
}

}  // namespace

void print_summary(const ViewOptions& options, const ComposedScene& composed, const Drawn& drawn,
                   const Findings& findings, const Stages& stages) {
    const Scene& scene = composed.scene();
    print_entry("read", fmt::format("{}: {}, {}", options.model.string(),
                                    counted(scene.instances.size(), "mesh", "meshes"),
                                    counted(triangle_count(scene), "triangle")));
    print_entry("light", lights_in_words(scene));
    print_entry("notes", composed.notes);
    print_entry("findings", findings.empty() ? std::vector<std::string>{"none"} : findings.lines());
    print_entry(
        "drew",
        fmt::format("{} x {}, {}, {}, {}, by {}: {}", options.size.x, options.size.y,
                    counted(static_cast<std::size_t>(options.samples), "sample"),
                    counted(drawn.frame.programs, "program"),
                    counted(drawn.frame.textures, "texture"), drawn.backend, drawn.renderer));
    print_entry("time", durations(stages.finished()));
    if (drawn.times.draw.size() > 1) print_entry("frames", frames_in_words(drawn.times));
    if (options.output) print_entry("wrote", written(options));
    if (drawn.comparison) print_entry("compared", in_words(*drawn.comparison));
    if (drawn.sides)
        print_entry("compared", fmt::format("with {}: {}", side_in_words(options.compare),
                                            in_words(*drawn.sides)));
}

nlohmann::ordered_json summary_json(const ViewOptions& options, const ComposedScene& composed,
                                    const Findings& findings, const Stages& stages) {
    return {{"tool", "relief-view"},
            {"version", version()},
            {"model", options.model.string()},
            {"instances", composed.scene().instances.size()},
            {"triangles", triangle_count(composed.scene())},
            {"notes", composed.notes},
            {"findings", findings.json()},
            {"milliseconds", durations_json(stages.finished())}};
}

nlohmann::ordered_json picture_json(const ViewOptions& options, const Drawn& drawn) {
    const FrameTimes& times = drawn.frame.times;
    using Json = nlohmann::ordered_json;
    return {{"output", options.output ? Json(options.output->string()) : Json(nullptr)},
            {"width", options.size.x},
            {"height", options.size.y},
            {"samples", options.samples},
            {"backend", drawn.backend},
            {"renderer", drawn.renderer},
            {"programs", drawn.frame.programs},
            {"textures", drawn.frame.textures},
            {"frame_milliseconds",
             {{"decode_images", times.decode_images},
              {"prepare", times.prepare},
              {"link", times.link},
              {"draw", times.draw},
              {"read_back", times.read_back}}},
            {"frames",
             {{"count", drawn.times.draw.size()},
              {"median_draw_milliseconds", spread_of(drawn.times.draw).median},
              {"median_read_back_milliseconds", spread_of(drawn.times.read_back).median}}}};
}

}  // namespace relief::tools
