// SPDX-License-Identifier: Apache-2.0
// Texture coordinates for spheres with waves of growing size, with the time of each stage, the
// slope and the memory: `relief-unwrap-bench [TRIANGLES...]`. `relief-unwrap-bench files FILE...`
// does so for models (.obj, .ply, .stl, .off), and `relief-unwrap-bench hard` for inputs that other
// programs find hard. `relief-unwrap-bench reference LIBRARY [FILE...]`
// compares with another library behind the function of bench/peers, in interleaved rounds; both
// results are judged by measure_texcoords(). All times are processor times, so that other programs
// do not add to them.
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench_support.h"
#include "experiment_parts.h"
#include "mesh/atlas/hard_unwrap_meshes.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/texcoord_quality.h"
#include "relief/mesh/unwrap.h"

namespace relief::bench {
using accuracy::detail::peak_bytes_of;
using accuracy::detail::processor_seconds_of;

namespace {

constexpr int map_side = 2048;
constexpr int padding = 4;

/// Processor time of this process with all its threads, in seconds.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Input {
    std::string name;
    Mesh mesh;
};

Input sphere(std::size_t triangles, double noise) {
    const auto cells =
        static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 12.0)));
    return {noise > 0.0 ? "sphere with waves, noisy" : "sphere with waves",
            accuracy::detail::wavy_sphere(cells, noise)};
}

/// Reads positions and triangles of a model.
Input model(const std::string& file) {
    Mesh mesh;
    Mesh read = read_mesh(file).mesh;
    mesh.positions = std::move(read.positions);
    mesh.triangles = std::move(read.triangles);
    return {file.substr(file.rfind('/') + 1), std::move(mesh)};
}

/// Seconds of each stage of an operation, in their order.
class StageTimes {
  public:
    Progress progress{[this](const Progress::State& state) { change(state.stage); }};

    void change(const std::string& stage) {
        if (stage == "unwrapping") return;  // The whole operation.
        const double now = processor_seconds();
        if (!current_.empty()) {
            if (!seconds.contains(current_)) order.push_back(current_);
            seconds[current_] += now - since_;
        }
        current_ = stage;
        since_ = now;
    }
    std::vector<std::string> order;
    std::map<std::string, double> seconds;

  private:
    std::string current_;
    double since_ = 0.0;
};

struct Run {
    Unwrapped result;
    double processor = 0.0;  ///< Seconds.
    double wall = 0.0;
    double peak = 0.0;  ///< Bytes in addition to the memory before; 0: unknown.
    StageTimes stages;
};

void run_unwrap(const Mesh& mesh, unsigned threads, Run& run) {
    UnwrapOptions options;
    options.size = glm::ivec2(map_side);
    options.padding = padding;
    options.execution = {.threads = threads, .progress = &run.stages.progress};
    const auto peak = peak_bytes_of([&] {
        run.processor = processor_seconds_of(
            [&] { run.wall = seconds_of([&] { run.result = unwrap(mesh, options); }); });
    });
    run.stages.change("");
    run.peak = static_cast<double>(peak.value_or(0));
}

std::string row_of(const AtlasStats& stats) {
    return fmt::format(
        "{} ({}) | {:.1f} | {:.1f} | {} | {:.2f} to {:.2f} | {:.3f} | {:.1f}", stats.charts,
        stats.small_charts, stats.relative_seam_length, 100.0 * stats.used,
        stats.padding_share ? fmt::format("{:.1f}", 100.0 * *stats.padding_share) : "–",
        stats.min_density, stats.max_density, stats.stretch, stats.max_anisotropy);
}

constexpr const char* columns =
    "charts (small) | seams | used, % | padding, % | density | L2 | largest";

/// Prints a row for each input, and the slope of the time of spheres.
void print_table(const std::vector<std::function<Input()>>& inputs) {
    fmt::print(
        "{} x {} texels, padding {}; processor seconds, and wall seconds on two threads\n\n"
        "| mesh | triangles | one thread | two threads | wall | bytes a triangle | {} | stages, "
        "one "
        "thread |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        map_side, map_side, padding, columns);
    std::map<std::string, std::vector<accuracy::CurvePoint>> times;
    for (const auto& make : inputs) {
        const Input input = make();
        const auto count = static_cast<double>(input.mesh.triangles.size());
        Run one;
        Run two;
        run_unwrap(input.mesh, 1, one);
        run_unwrap(input.mesh, 2, two);
        std::string stages;
        for (const std::string& stage : one.stages.order)
            stages += fmt::format("{}{} {:.3f}", stages.empty() ? "" : ", ", stage,
                                  one.stages.seconds.at(stage));
        fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {} | {} |\n", input.name,
                   input.mesh.triangles.size(), one.processor, two.processor, two.wall,
                   one.peak / count, row_of(one.result.stats), stages);
        std::fflush(stdout);
        times[input.name].push_back({count, one.processor});
    }
    for (const auto& [name, points] : times)
        if (const auto slope = accuracy::fitted_order(points))
            fmt::print("\n{}: the time grows with the number of triangles to the {:.2f}.\n", name,
                       *slope);
}

/// The function of bench/peers.
using PeerUnwrap = int (*)(const float*, std::uint32_t, const std::uint32_t*, std::uint32_t,
                           std::uint32_t, std::uint32_t, int, float*, std::uint32_t*,
                           std::uint32_t*);

/// Prints how `corner_texcoords` are judged.
void print_judgment(const std::string& who, const std::string& seconds, const Mesh& mesh,
                    const Unwrapped& unwrapped, const std::string& size) {
    const TexcoordQuality quality =
        measure_texcoords(with_texcoords(mesh, unwrapped).mesh, glm::ivec2(map_side));
    fmt::print("| {} | {} | {} | {} | {} | {} | {} |\n", who, seconds, row_of(quality.stats),
               quality.overlapping, quality.inverted, quality.mirrored_charts, size);
}

void compare(const Input& input, PeerUnwrap peer, std::size_t rounds) {
    const Mesh& mesh = input.mesh;
    Unwrapped own;
    Unwrapped other;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<double> own_seconds;
    std::vector<double> other_seconds;
    std::vector<double> ratios;
    for (std::size_t round = 0; round < rounds; ++round) {
        Run run;
        run_unwrap(mesh, 1, run);
        own_seconds.push_back(run.processor);
        own = std::move(run.result);
        other.corner_texcoords.assign(3 * mesh.triangles.size(), glm::vec2(0.0F));
        int error = 0;
        other_seconds.push_back(processor_seconds_of([&] {
            error = peer(&mesh.positions[0].x, static_cast<std::uint32_t>(mesh.positions.size()),
                         &mesh.triangles[0].x, static_cast<std::uint32_t>(mesh.triangles.size()),
                         map_side, padding, 0, &other.corner_texcoords[0].x, &width, &height);
        }));
        if (error != 0) {
            fmt::print("| {}: the library returned {} |\n", input.name, error);
            return;
        }
        ratios.push_back(other_seconds.back() / own_seconds.back());
    }
    // The square map that has room for the result.
    const auto side = static_cast<float>(std::max(width, height));
    for (glm::vec2& texcoord : other.corner_texcoords)
        texcoord /= side;
    other.chart.assign(mesh.triangles.size(), 0U);
    print_judgment(fmt::format("{}, {}: relief", input.name, mesh.triangles.size()),
                   fmt::format("{:.2f}", time_statistics(own_seconds).median), mesh, own,
                   fmt::format("{0} x {0}", map_side));
    print_judgment("library",
                   fmt::format("{:.2f}, {:.0f} times", time_statistics(other_seconds).median,
                               time_statistics(ratios).median),
                   mesh, other, fmt::format("{} x {}", width, height));
    std::fflush(stdout);
}

int run_reference(int argc, char** argv) {
    const char* const library = argv[2];
    void* const handle = dlopen(library, RTLD_NOW);
    void* const symbol = handle != nullptr ? dlsym(handle, "relief_peer_unwrap") : nullptr;
    if (symbol == nullptr) {
        fmt::print(stderr, "{}: {} (compile it with bench/peers/xatlas_unwrap.cpp)\n", library,
                   handle != nullptr ? "has no relief_peer_unwrap" : dlerror());
        return 1;
    }
    const auto peer = reinterpret_cast<PeerUnwrap>(symbol);
    fmt::print(
        "{} x {} texels, padding {}; processor seconds, interleaved\n\n| who | seconds | {} | "
        "overlapping | inverted | mirrored charts | map |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        map_side, map_side, padding, columns);
    if (argc == 3) {
        compare(sphere(10'000, 0.0), peer, 3);
        compare(sphere(100'000, 0.0), peer, 1);
        compare(sphere(100'000, 0.002), peer, 1);
    }
    for (int i = 3; i < argc; ++i)
        compare(model(argv[i]), peer, 1);
    return 0;
}

int run(int argc, char** argv) {
    const std::string first = argc > 1 ? argv[1] : "";
    if (first == "reference" && argc > 2) return run_reference(argc, argv);
    std::vector<std::function<Input()>> inputs;
    if (first == "files") {
        for (int i = 2; i < argc; ++i)
            inputs.emplace_back([file = std::string(argv[i])] { return model(file); });
    } else if (first == "hard") {
        for (auto& [name, mesh] : test::hard_unwrap_meshes())
            inputs.emplace_back([input = Input{name, std::move(mesh)}] { return input; });
    } else {
        std::vector<std::size_t> sizes;
        for (int i = 1; i < argc; ++i)
            sizes.push_back(std::strtoul(argv[i], nullptr, 10));
        if (sizes.empty()) sizes = {100'000, 1'000'000, 4'000'000};
        for (const double noise : {0.0, 0.002})
            for (const std::size_t size : sizes)
                inputs.emplace_back([=] { return sphere(size, noise); });
    }
    print_table(inputs);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    try {
        return relief::bench::run(argc, argv);
    } catch (const relief::Error& error) {
        fmt::print(stderr, "relief-unwrap-bench: error: {}\n", error.what());
        return 1;
    }
}
