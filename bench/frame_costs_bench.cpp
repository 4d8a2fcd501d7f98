// SPDX-License-Identifier: Apache-2.0
// The costs of tangent frames: computing them, by method; storing them, by encoding; and drawing
// with stored frames or with frames from derivatives. `relief-frame-costs-bench [TRIANGLES
// [ROUNDS]]` prints tables in Markdown. The methods of each table are interleaved.
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench_support.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"
#include "relief/shade/renderer.h"
#include "shade/typical_scenes.h"

namespace relief::bench {
using namespace relief::shade;

namespace {

double median(const Contender& contender, std::size_t elements) {
    return time_statistics(contender.nanoseconds).median / static_cast<double>(elements);
}

using TangentFunction = decltype(&mikktspace_tangents);

struct Method {
    const char* name;
    TangentFunction function;
};
constexpr std::array methods = {Method{"mikktspace", mikktspace_tangents},
                                Method{"area-weighted", area_weighted_tangents},
                                Method{"lengyel", lengyel_tangents}};

std::vector<glm::vec4> tangents_of(const Mesh& mesh, TangentFunction function) {
    Report report;
    return function(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
}

void compare_methods(const Mesh& mesh, std::size_t rounds) {
    std::vector<Contender> all;
    for (const unsigned threads : {1U, 2U}) {
        for (const Method& method : methods) {
            all.push_back({method.name, [&mesh, method, threads] {
                               set_thread_limit(threads);
                               tangents_of(mesh, method.function);
                           }});
        }
    }
    measure(all, rounds);
    set_thread_limit(0);
    fmt::print(
        "Computing, {} triangles, {} vertices\n\n| | ns/triangle, 1 thread | ns/triangle, 2 "
        "threads | times mikktspace | vertices added by splits |\n|---|---|---|---|---|\n",
        mesh.triangles.size(), mesh.positions.size());
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const VertexSplit split = split_where_corners_differ(
            mesh.positions.size(), mesh.triangles, tangents_of(mesh, methods[i].function));
        const double alone = median(all[i], mesh.triangles.size());
        fmt::print("| {} | {:.0f} | {:.0f} | {:.2f} | {} |\n", methods[i].name, alone,
                   median(all[i + methods.size()], mesh.triangles.size()),
                   alone / median(all[0], mesh.triangles.size()),
                   split.source_vertex.size() - mesh.positions.size());
    }
}

/// A frame per vertex, with one tangent.
struct VertexFrames {
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
};

VertexFrames vertex_frames(const Mesh& mesh) {
    const std::vector<glm::vec4> corners = tangents_of(mesh, mikktspace_tangents);
    VertexFrames frames{mesh.normals, std::vector<glm::vec4>(mesh.normals.size(), {1, 0, 0, 1})};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            frames.tangents[mesh.triangles[t][corner]] =
                corners[3 * t + static_cast<std::size_t>(corner)];
        }
    }
    return frames;
}

void compare_encodings(const Mesh& mesh, std::size_t rounds) {
    const VertexFrames frames = vertex_frames(mesh);
    std::vector<std::vector<std::uint32_t>> codes;
    std::vector<Contender> all;
    Report report;
    for (const FrameEncoding encoding : all_frame_encodings) {
        codes.push_back(encode_frames(frames.normals, frames.tangents, encoding,
                                      FrameRounding::nearest, report));
    }
    for (std::size_t i = 0; i < all_frame_encodings.size(); ++i) {
        const FrameEncoding encoding = all_frame_encodings[i];
        for (const FrameRounding rounding : {FrameRounding::nearest, FrameRounding::best}) {
            all.push_back(
                {std::string(enum_name(encoding)), [&frames, &report, encoding, rounding] {
                     encode_frames(frames.normals, frames.tangents, encoding, rounding, report);
                 }});
        }
        all.push_back({std::string(enum_name(encoding)), [&codes, &report, encoding, i] {
                           decode_frames(codes[i], encoding, report);
                       }});
    }
    set_thread_limit(1);
    measure(all, rounds);
    set_thread_limit(0);
    fmt::print(
        "\nStoring, {} frames, one thread\n\n| | bytes | encode nearest, ns/frame | encode "
        "best | decode |\n|---|---|---|---|---|\n",
        frames.normals.size());
    for (std::size_t i = 0; i < all_frame_encodings.size(); ++i) {
        const auto taken = [&](std::size_t what) {
            return median(all[3 * i + what], frames.normals.size());
        };
        fmt::print("| `{}` | {} | {:.0f} | {:.0f} | {:.0f} |\n", enum_name(all_frame_encodings[i]),
                   4 * words_per_frame(all_frame_encodings[i]), taken(0), taken(1), taken(2));
    }
}

void compare_drawing(std::size_t rounds) {
    const Context context(Backend::osmesa);
    fmt::print(
        "\nDrawing a sphere of 99,856 triangles, 1280 x 720, {}\n\n| scene | stored, ms | "
        "derivatives, ms | derivatives / stored |\n|---|---|---|---|\n",
        context.renderer_name());
    const FrameSettings settings{1280, 720, 1, OutputCoding::srgb};
    for (TypicalScene& typical : typical_scenes()) {
        if (!typical.scene.materials[0].normal_map) continue;
        Report report;
        std::array<std::unique_ptr<Renderer>, 2> renderers;
        for (const TangentFrame frame : {TangentFrame::stored, TangentFrame::derivatives}) {
            typical.scene.materials[0].tangent_frame = frame;
            const FramePlan plan = plan_effects(typical.scene, settings);
            renderers[frame == TangentFrame::stored ? 0 : 1] =
                std::make_unique<Renderer>(context, typical.scene, plan, settings, report);
        }
        const std::array<Renderer*, 2> in_turns{renderers[0].get(), renderers[1].get()};
        const std::vector<FrameSeries> series =
            time_frames(in_turns, *typical.scene.camera, {rounds, 3});
        std::vector<double> ratios;
        for (std::size_t i = 0; i < series[0].draw.size(); ++i)
            ratios.push_back(series[1].draw[i] / series[0].draw[i]);
        fmt::print("| {} | {:.1f} | {:.1f} | {:.2f} |\n", typical.name,
                   time_statistics(series[0].draw).median, time_statistics(series[1].draw).median,
                   time_statistics(ratios).median);
    }
}

int run(int argc, char** argv) {
    const std::size_t triangles = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1'000'000;
    const std::size_t rounds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 9;
    const Mesh mesh = bumpy_sphere(triangles);
    compare_methods(mesh, rounds);
    compare_encodings(mesh, rounds);
    compare_drawing(2 * rounds + 1);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    return relief::bench::run(argc, argv);
}
