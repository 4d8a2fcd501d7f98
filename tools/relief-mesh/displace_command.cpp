// SPDX-License-Identifier: Apache-2.0
// `relief-mesh displace IN OUT --heights MAP` makes the surface that a height map describes.
// Tests: tests/tools/displace_test.cpp.
#include "relief/mesh/displace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "reshape.h"

namespace relief::tools {
namespace {

struct DisplaceCommand {
    ReshapeRequest request;
    std::optional<std::filesystem::path> heights;
    std::optional<double> height;
    double zero = 0.0;
    HeightChannel channel = HeightChannel::mean;
    bool destaircase = false;
    WrapsOrAuto wrap;
    std::optional<double> max_error;
    double pixels = 2000.0;
    std::size_t max_triangles = DisplaceOptions().max_triangles;
};

/// The error of a model that is seen at --pixels, in pixels.
constexpr double error_in_pixels = 0.5;

/// The heights of a file, ready for use.
struct UsableHeights {
    Image image;
    Wraps wrap;
};

UsableHeights read_heights(const DisplaceCommand& command) {
    const std::filesystem::path& file = *command.heights;
    return about(file, [&] {
        HeightMap map = height_map(read_image(file, ImageUse::data), command.channel);
        const Wraps wrap = command.wrap.value_or(
            command.wrap.is_settled() ? Wraps() : detect_tiling(map.heights).wraps());
        if (!command.destaircase) return UsableHeights{std::move(map.heights), wrap};
        return UsableHeights{relief::destaircase(map.heights, {wrap, 0.0}).heights, wrap};
    });
}

/// Returns the largest diagonal of a bounding box, in the unit of the scene.
double size_of(std::span<const TriangleInput> meshes) {
    double size = 0.0;
    for (const TriangleInput& input : meshes) {
        const Bounds bounds = bounds_of(input.mesh);
        if (bounds.empty()) continue;
        size = std::max(size, input.scale * static_cast<double>(glm::length(
                                                glm::dvec3(bounds.max) - glm::dvec3(bounds.min))));
    }
    return size;
}

/// The errors of all meshes, in the unit of the scene.
struct Reached {
    double limit = 0.0;
    double max_error = 0.0;
    std::size_t above_limit = 0;
    bool is_complete = true;
};

void add_to(Summary& summary, const Reached& reached, const Wraps& wrap) {
    const std::string rest =
        reached.above_limit == 0
            ? ""
            : fmt::format("; {} above it: {}", counted(reached.above_limit, "triangle"),
                          reached.is_complete ? "they have the size of half a texel"
                                              : "--max-triangles ended the division");
    summary.add("error",
                fmt::format("at most {:.3g} from the surface of the heights; the limit is {:.3g} "
                            "(unit of the scene){}",
                            reached.max_error, reached.limit, rest),
                {{"error",
                  {{"max", reached.max_error},
                   {"limit", reached.limit},
                   {"triangles_above", reached.above_limit},
                   {"is_complete", reached.is_complete}}},
                 {"wrap", name_of(wrap)}});
}

ExitCode displace(const CLI::App& app, const DisplaceCommand& command) {
    if (!command.heights) throw UsageError("--heights is missing", "give the height map");
    if (!command.height)
        throw UsageError("--height is missing", "give the length by which white moves the surface");
    const UsableHeights heights = read_heights(command);
    const SummarizedChange change = [&](std::span<const TriangleInput> meshes,
                                        std::span<Report> reports, Report& whole,
                                        Summary& summary) {
        Reached reached;
        const double size = size_of(meshes);
        reached.limit = command.max_error.value_or(error_in_pixels * size / command.pixels);
        std::vector<FramedMesh> results;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            const double scale = meshes[i].scale;
            DisplaceOptions options;
            options.height = *command.height / scale;
            options.zero = command.zero;
            options.wrap = heights.wrap;
            options.max_error = reached.limit / scale;
            options.max_triangles = command.max_triangles;
            DisplacedMesh one = displaced(meshes[i].mesh, heights.image, options, reports[i]);
            reached.max_error = std::max(reached.max_error, scale * one.max_error);
            reached.above_limit += one.above_limit;
            reached.is_complete = reached.is_complete && one.is_complete;
            results.push_back({std::move(one.mesh), {}});
        }
        if (std::abs(*command.height) > size)
            whole.add("height above the size of the model", "model", 0,
                      "is used as it is: --height is a length in the unit of the scene");
        add_to(summary, reached, heights.wrap);
        return results;
    };
    Json options = {{"heights", command.heights->string()},
                    {"height", *command.height},
                    {"zero", command.zero},
                    {"channel", enum_name(command.channel)},
                    {"destaircase", command.destaircase},
                    {"max_triangles", command.max_triangles}};
    if (command.max_error)
        options["max_error"] = *command.max_error;
    else
        options["pixels"] = command.pixels;
    return reshape(app, command.request, change, Measuring::none, options);
}

void add_displace_options(CLI::App& app, DisplaceCommand& command) {
    command.request.normals = NormalMode::automatic;
    add_reshape_options(app, command.request, "");
    const std::string heights = "Heights";
    add_path(app, "--heights", command.heights,
             "The height map; it is looked up at the texture coordinates of the model.")
        .group(heights);
    add_number(app, "--height", "H", command.height, {-1e30, 1e30, ""},
               "The length by which the value 1.0 (white) moves the surface along its normal, in "
               "the unit of the scene; negative lengths move it inwards.")
        .group(heights);
    add_number(app, "--zero", "V", command.zero, {-1e6, 1e6, ""},
               "The value that does not move the surface, where 1.0 is white. Default: 0.")
        .group(heights);
    add_choice(app, "--channel", command.channel, enum_choices<HeightChannel>(),
               "The height of a color texel, as in relief-bake bump. Default: mean.")
        .group(heights);
    add_switch(app, "--destaircase", command.destaircase,
               "Estimate the heights before they were rounded to 8 or fewer bits, so that slopes "
               "have no terraces.")
        .group(heights);
    add_wrap(app, command.wrap,
             "Texture coordinates outside of 0 to 1: repeat, clamp or mirror, or two of them for u "
             "and v. auto repeats a map that continues across its seam, and clamps others. "
             "Default: auto.")
        .group(heights);
    const std::string size = "Triangles";
    add_number(
        app, "--max-error", "E", command.max_error, {1e-30, 1e30, ""},
        "Maximum distance: divide triangles while the surface of the heights is farther than "
        "E from them, at the centers of texels and the middles of edges, in the unit of the "
        "scene.")
        .group(size);
    add_number(app, "--pixels", "N", command.pixels, {1.0, 1e6, ""},
               "The same with an error of half a pixel for a model that is N pixels large. "
               "Default: 2000.")
        .group(size);
    add_value(app, "--max-triangles", "N",
              "End before a mesh has more triangles. Default: 20000000.",
              [&command](const std::string& subject, const std::string& text) {
                  command.max_triangles =
                      static_cast<std::size_t>(parse_integer(subject, text, 1, 1'000'000'000));
              })
        .group(size);
    set_examples(app, {"relief-mesh displace data/vase.obj out/vase-relief.glb --heights "
                       "data/bricks-height.png --height 0.05",
                       "relief-mesh displace data/vase.obj out/vase-fine.ply --heights "
                       "data/bricks-height.png --height -0.05 --zero 0.5 --max-error 0.001",
                       "relief-mesh displace data/vase.obj out/vase-small.obj --heights "
                       "data/bricks-height.png --height 0.05 --pixels 300 --max-triangles 50000"});
}

}  // namespace

Command add_displace_command(CLI::App& tool) {
    return add_command<DisplaceCommand>(
        tool, "displace",
        "Moves the surface by a height map, with as many triangles as an error asks for.",
        add_displace_options, displace);
}

}  // namespace relief::tools
