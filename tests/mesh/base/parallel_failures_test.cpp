// SPDX-License-Identifier: Apache-2.0
// A failure or cancellation in any piece of any operation reaches the caller, no incomplete result
// is returned, and the next run gives the usual bytes. Pieces fail through the hook of
// base/parallel.h. Loops within tasks of oneTBB are whole, too.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/compare.h"
#include "relief/mesh/curvature.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "support/images.h"
#include "support/invariants.h"
#include "support/sanitized.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

TEST(Parallel, ACallersTasksThatAreCancelledEndNoLoop) {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "oneTBB's inline functions and its library are not both instrumented";
#endif
    for (int i = 0; i < 50; ++i) {
        tbb::task_group_context context;
        tbb::parallel_for(
            tbb::blocked_range<int>(0, 4, 1),
            [&](const auto&) {
                std::atomic<std::size_t> done = 0;
                parallel_for(1000, 1, [&](std::size_t first, std::size_t last) {
                    done += last - first;
                    context.cancel_group_execution();
                });
                EXPECT_EQ(done, 1000U);
            },
            context);
    }
}

/// This is not an Error, so no function takes it for invalid input.
struct Injected {};

/// The event at one piece of a run, identified by the order in time.
struct Injection {
    std::atomic<std::size_t> pieces = 0;  ///< The number of pieces that have started.
    std::size_t at = 0;
    Progress* cancelled = nullptr;  ///< If it is null, the piece throws.
    std::atomic<bool> is_done = false;
};

Injection* current_injection = nullptr;

void inject() {
    Injection& injection = *current_injection;
    if (injection.pieces.fetch_add(1) != injection.at) return;
    injection.is_done = true;
    if (injection.cancelled == nullptr) throw Injected();
    injection.cancelled->cancel();
}

/// Injects during its lifetime.
class InjectionScope {
  public:
    explicit InjectionScope(Injection& injection) {
        current_injection = &injection;
        before_each_piece = inject;
    }
    ~InjectionScope() { before_each_piece = nullptr; }
    InjectionScope(const InjectionScope&) = delete;
    InjectionScope& operator=(const InjectionScope&) = delete;
};

template <typename Element>
void append(std::string& bytes, const std::vector<Element>& elements) {
    bytes.append(reinterpret_cast<const char*>(elements.data()), elements.size() * sizeof(Element));
}

void append(std::string& bytes, const Image& image) {
    bytes += fmt::format("{}x{}x{}", image.width, image.height, image.channels);
    std::visit([&](const auto& samples) { append(bytes, samples); }, image.samples);
}

void append(std::string& bytes, const Mesh& mesh) {
    append(bytes, mesh.positions);
    append(bytes, mesh.normals);
    append(bytes, mesh.tangents);
    append(bytes, mesh.texcoords);
    append(bytes, mesh.triangles);
}

void append(std::string& bytes, const Report& report) {
    for (const Finding& finding : report.findings())
        bytes += to_string(finding);
}

template <typename... Parts>
std::string bytes_of(const Parts&... parts) {
    std::string bytes;
    (append(bytes, parts), ...);
    return bytes;
}

/// Codes that do not compress well.
Image noisy_codes(int width, int height, int channels, unsigned seed) {
    Image image = make_image(width, height, channels, 8, ColorSpace::data);
    std::minstd_rand random(seed);
    for (std::uint8_t& sample : std::get<std::vector<std::uint8_t>>(image.samples))
        sample = static_cast<std::uint8_t>(random() >> 8);
    return image;
}

/// Options with a given kernel: choosing one is an operation of its own.
BumpOptions sobel3() {
    BumpOptions options;
    options.kernel = Kernel::sobel3;
    return options;
}

/// The input of the operations, created once.
struct Inputs {
    Inputs() {
        heights = test::rough(300, 280);
        Report report;
        BumpOptions bump = sobel3();
        bump.strength = 4.0;
        normals = normals_from_height(heights, bump, report);
        normal_map = normal_map_from_height(heights, bump, {.bits = 8}, report);
        for (unsigned i = 0; i < 4; ++i) {
            images.push_back(folder / fmt::format("image{}.png", i));
            write_image(images.back(), noisy_codes(700, 800, 3, i + 1));
        }
        write_image(folder / "heights.png", noisy_codes(1100, 900, 1, 7));
        sphere = make_sphere(160, 160);
        MeshFile file;
        file.mesh = make_torus(0.4F, 300, 300);
        write_mesh(folder / "torus.obj", file);
        GltfDocument::from_mesh(file).write(folder / "torus.glb");
    }

    test::TemporaryDirectory folder;
    Image heights;
    Image normals;
    Image normal_map;
    std::vector<std::filesystem::path> images;
    Mesh sphere;
};

const Inputs& inputs() {
    static const Inputs all;
    return all;
}

std::string run_bake() {
    const Mesh high = make_sphere(48, 48);
    const Mesh low = make_sphere(12, 12);
    BakeOptions options;
    options.map.width = options.map.height = 96;
    options.map.samples = 4;
    options.map.padding = 4;
    options.map.layers.heights = true;
    std::vector<float> normals, heights;
    Report report;
    bake_normals(
        {&high, 1}, low, options,
        [&](const BakedRows& rows) {
            normals.insert(normals.end(), rows.normals.begin(), rows.normals.end());
            heights.insert(heights.end(), rows.heights.begin(), rows.heights.end());
        },
        report);
    return bytes_of(normals, heights, report);
}

std::string run_frames(NormalMode normals, TangentMethod tangents) {
    FrameOptions options;
    options.normals = normals;
    options.tangents = tangents;
    options.crease_angle = 0.5;
    Report report;
    return bytes_of(with_frames(inputs().sphere, options, report).mesh, report);
}

/// Decodes the textures of a scene like a renderer: nested loops.
std::string run_decode_images() {
    std::vector<Image> decoded(inputs().images.size());
    parallel_for(decoded.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            decoded[i] = read_image(inputs().images[i], ImageUse::color);
    });
    std::string bytes;
    for (const Image& image : decoded)
        append(bytes, image);
    return bytes;
}

std::string run_read_mesh(const char* name) {
    Report report;
    return bytes_of(read_mesh(inputs().folder / name, report).mesh, report);
}

std::string run_read_gltf(const std::filesystem::path& file) {
    Report report;
    const GltfDocument document = GltfDocument::read(file, report);
    std::string bytes;
    for (const GltfPrimitiveId id : document.triangle_primitives())
        append(bytes, document.mesh(id));
    return bytes;
}

/// An operation that returns its result as bytes.
struct Operation {
    const char* name;
    std::function<std::string()> run;

    friend void PrintTo(const Operation& operation, std::ostream* stream) {
        *stream << operation.name;
    }
};

std::vector<Operation> operations() {
    return {
        {"WritePng",
         [] {
             const std::filesystem::path file = inputs().folder / "written.png";
             write_image(file, noisy_codes(900, 900, 3, 99));
             return test::read_bytes(file);
         }},
        {"DecodeImages", run_decode_images},
        {"NormalsFromHeight",
         [] {
             Report report;
             return bytes_of(normals_from_height(inputs().heights, sobel3(), report));
         }},
        {"WriteBumpFile",
         [] {
             const HeightMapFile source(inputs().folder / "heights.png");
             const std::filesystem::path file = inputs().folder / "bump.png";
             Report report;
             write_bump_file(source, sobel3(), file, BumpFileFormat{}, report);
             return test::read_bytes(file);
         }},
        {"HeightsFromNormals",
         [] {
             IntegrationOptions options;
             options.wrap = Wrap::clamp;
             Report report;
             return bytes_of(heights_from_normals(inputs().normals, options, report).heights,
                             report);
         }},
        {"ChooseKernel",
         [] {
             const Image part = part_of(inputs().heights, {0, 0, 200, 128});
             const KernelChoice choice = choose_kernel(part, BumpOptions{});
             return fmt::format("{} {}", static_cast<int>(choice.kernel), choice.rms_degrees);
         }},
        {"CheckNormalMap",
         [] {
             const NormalMapCheck check = check_normal_map(inputs().normal_map);
             return bytes_of(check.bits, to_report(check)) +
                    fmt::format("{} {}", check.tiling.seam_x, check.tiling.seam_y);
         }},
        {"Bake", run_bake},
        {"MikkTSpace", [] { return run_frames(NormalMode::automatic, TangentMethod::mikktspace); }},
        {"AreaWeighted",
         [] { return run_frames(NormalWeight::angle, TangentMethod::area_weighted); }},
        {"Lengyel", [] { return run_frames(NormalWeight::area, TangentMethod::lengyel); }},
        {"Curvature",
         [] {
             Report report;
             return bytes_of(
                 mean_curvatures(inputs().sphere.positions, inputs().sphere.triangles, report),
                 report);
         }},
        {"Diagnose", [] { return bytes_of(to_report(diagnose(inputs().sphere))); }},
        {"Compare",
         [] {
             const CornerMatch match = match_corners(inputs().sphere, inputs().sphere);
             return bytes_of(match.corners);
         }},
        {"ReadObj", [] { return run_read_mesh("torus.obj"); }},
        {"ReadGltf", [] { return run_read_gltf(inputs().folder / "torus.glb"); }},
    };
}

class ParallelFailures : public testing::TestWithParam<Operation> {};

/// The numbers of the pieces that fail: the first ones, and others in uniform steps up to the last
/// one. The runs under sanitizers take fewer, because one is 10 to 50 times as slow there.
std::set<std::size_t> sampled_pieces(std::size_t count) {
    constexpr std::size_t max_pieces = test::is_sanitized ? 3 : 8;
    std::set<std::size_t> pieces;
    for (std::size_t i = 0; i < max_pieces; ++i)
        pieces.insert(i < max_pieces / 2 ? i : i * (count - 1) / (max_pieces - 1));
    while (!pieces.empty() && *pieces.rbegin() >= count)
        pieces.erase(std::prev(pieces.end()));
    return pieces;
}

void expect_failures_arrive(const std::function<std::string()>& run, std::size_t min_pieces) {
    Injection none;
    none.at = std::numeric_limits<std::size_t>::max();
    std::string expected;
    {
        const InjectionScope scope(none);
        expected = run();
    }
    ASSERT_FALSE(expected.empty());
    ASSERT_GE(none.pieces, min_pieces);
    std::size_t failed = 0;
    for (const std::size_t piece : sampled_pieces(none.pieces)) {
        Injection injection;
        injection.at = piece;
        const InjectionScope scope(injection);
        try {
            // The number of pieces that oneTBB makes of a loop depends on timing, so there may be
            // fewer.
            EXPECT_EQ(run() == expected, true) << "piece " << piece;
            EXPECT_FALSE(injection.is_done) << "the failure of piece " << piece << " is lost";
        } catch (const Injected&) {
            ++failed;
        }
    }
    EXPECT_GE(failed, 1U);
    EXPECT_EQ(run() == expected, true) << "after the failures";
}

TEST_P(ParallelFailures, ReachTheCallerWithoutLeaks) {
    expect_failures_arrive(GetParam().run, 2);
}

TEST_P(ParallelFailures, CancellationReachesTheCallerWithoutLeaks) {
    const std::function<std::string()>& run = GetParam().run;
    const std::string expected = run();
    Injection none;
    none.at = std::numeric_limits<std::size_t>::max();
    {
        Progress progress;
        const ProgressScope progress_scope(progress);
        const InjectionScope scope(none);
        EXPECT_EQ(run() == expected, true) << "as somebody waits";
    }
    for (const std::size_t piece : sampled_pieces(none.pieces)) {
        Progress progress;
        const ProgressScope progress_scope(progress);
        Injection injection;
        injection.at = piece;
        injection.cancelled = &progress;
        const InjectionScope scope(injection);
        try {
            EXPECT_EQ(run() == expected, true) << "piece " << piece;
        } catch (const Cancelled&) {
            EXPECT_TRUE(injection.is_done);
        }
    }
    EXPECT_EQ(run() == expected, true) << "after the cancellations";
}

INSTANTIATE_TEST_SUITE_P(Operations, ParallelFailures, testing::ValuesIn(operations()),
                         [](const auto& operation) { return operation.param.name; });

class FailuresInCompressedModels : public testing::TestWithParam<const char*> {};

TEST_P(FailuresInCompressedModels, ReachTheCaller) {
    RELIEF_NEEDS_SHARED(file, GetParam());
    expect_failures_arrive([&] { return run_read_gltf(file); }, 1);
}

INSTANTIATE_TEST_SUITE_P(Models, FailuresInCompressedModels,
                         testing::Values("data/models/gltf/Duck/glTF-Draco/Duck.gltf",
                                         "data/models/gltf-ext/misc/DenseSphere.glb",
                                         "data/models/gltf-ext/meshopt/pirate.glb"));

}  // namespace
}  // namespace relief
