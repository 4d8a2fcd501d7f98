// SPDX-License-Identifier: Apache-2.0
// The bytes of the results of all algorithms for hard meshes and a hard height map: equal for every
// compiler, optimization, vector width, C library and number of threads. The committed hashes are
// those of GCC 12 with -O3. A change of an algorithm changes its hash; a difference between builds
// is an error.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "hard_cases/mesh_case.h"
#include "mesh/bake/bake_support.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/curvature.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/hard_meshes.h"
#include "support/sanitized.h"

namespace relief::test {
namespace {

/// FNV-1a of 64 bits. All NaN count as one value, because processors differ in their signs.
class Hash {
  public:
    template <typename Value>
    void add(const Value& value) {
        if constexpr (std::is_same_v<Value, float>) {
            add_bits(std::isnan(value) ? 0x7FC00000U : std::bit_cast<std::uint32_t>(value));
        } else if constexpr (std::is_same_v<Value, double>) {
            add_bits(std::isnan(value) ? 0x7FF8000000000000U : std::bit_cast<std::uint64_t>(value));
        } else {
            add_bits(value);
        }
    }
    template <int Length, typename Component>
    void add(const glm::vec<Length, Component>& vector) {
        for (int i = 0; i < Length; ++i)
            add(vector[i]);
    }
    template <typename Value>
    void add_all(const std::vector<Value>& values) {
        add(static_cast<std::uint64_t>(values.size()));
        for (const Value& value : values)
            add(value);
    }
    void add(const Mesh& mesh) {
        add_all(mesh.positions);
        add_all(mesh.normals);
        add_all(mesh.tangents);
        add_all(mesh.texcoords);
        add_all(mesh.triangles);
    }
    void add(const Image& image) {
        std::visit([&](const auto& samples) { add_all(samples); }, image.samples);
    }
    void add(const Report& report) {
        for (const Finding& finding : report.findings()) {
            for (const char letter : to_string(finding))
                add(static_cast<std::uint8_t>(letter));
        }
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

  private:
    template <typename Bits>
    void add_bits(Bits bits) {
        for (std::size_t i = 0; i < sizeof bits; ++i) {
            value_ ^= static_cast<std::uint64_t>(bits) >> (8 * i) & 0xFF;
            value_ *= 0x100000001B3;
        }
    }
    std::uint64_t value_ = 0xCBF29CE484222325;
};

/// Calls `change` for every hard mesh, and hashes its result and its findings, or its refusal.
template <typename Change>
void hash_meshes(Hash& hash, const Change& change) {
    static const std::vector<NamedMesh> meshes = [] {
        std::vector<NamedMesh> all = hard_meshes();
        all.push_back({"textured torus", textured_torus()});
        return all;
    }();
    for (const NamedMesh& one : meshes) {
        Report report;
        try {
            hash.add(change(one.mesh, report));
        } catch (const InvalidInput& error) {
            for (const char* letter = error.what(); *letter != '\0'; ++letter)
                hash.add(static_cast<std::uint8_t>(*letter));
        }
        hash.add(report);
    }
}

void hash_normals(Hash& hash) {
    for (const EnumName<NormalMode>& mode : enum_names<NormalMode>) {
        FrameOptions options;
        options.normals = mode.value;
        options.tangents = TangentMethod::none;
        if (mode.value.weight()) options.crease_angle = 0.7;
        hash_meshes(hash, [&](const Mesh& mesh, Report& report) {
            return with_frames(mesh, options, report).mesh;
        });
    }
}

void hash_tangents(Hash& hash) {
    for (const EnumName<TangentMethod>& method : enum_names<TangentMethod>) {
        if (method.value == TangentMethod::triangle) continue;  // Not of with_frames().
        FrameOptions options;
        options.normals = NormalWeight::angle;
        options.tangents = method.value;
        hash_meshes(hash, [&](const Mesh& mesh, Report& report) {
            return with_frames(mesh, options, report).mesh;
        });
    }
}

void hash_encoded_frames(Hash& hash) {
    FrameOptions options;
    options.normals = NormalWeight::angle;
    options.tangents = TangentMethod::mikktspace;
    const Mesh mesh = with_frames(textured_torus(), options).mesh;
    for (const FrameEncoding encoding : all_frame_encodings) {
        for (const FrameRounding rounding : {FrameRounding::nearest, FrameRounding::best}) {
            const std::vector<std::uint32_t> words =
                encode_frames(mesh.normals, mesh.tangents, encoding, rounding);
            hash.add_all(words);
            hash.add_all(decode_frames(words, encoding).tangents);
        }
    }
}

void hash_conditions(Hash& hash) {
    hash_meshes(hash, [](const Mesh& mesh, Report& report) {
        report.merge(to_report(diagnose(mesh)));
        return 0U;
    });
}

void hash_curvatures(Hash& hash) {
    hash_meshes(hash, [](const Mesh& mesh, Report& report) {
        Hash of_mesh;
        of_mesh.add_all(mean_curvatures(mesh.positions, mesh.triangles, report));
        return of_mesh.value();
    });
}

void hash_decimation(Hash& hash) {
    hash_meshes(hash, [](const Mesh& mesh, Report& report) {
        DecimateOptions options;
        options.triangles = mesh.triangles.size() / 2 + 1;
        return decimated(mesh, options, report).mesh;
    });
}

void hash_subdivision(Hash& hash) {
    hash_meshes(hash, [](const Mesh& mesh, Report& report) {
        return subdivided(mesh, 1, FrameOptions{}, report);
    });
}

void hash_distances(Hash& hash) {
    const SurfaceDistance distance = surface_distance(
        textured_torus(), subdivided(textured_torus(), 1, FrameOptions{}, IgnoredReport()));
    for (const DistanceStats& one : {distance.from_a, distance.from_b}) {
        for (const double value : {one.mean, one.rms, one.max, one.mean_degrees, one.max_degrees})
            hash.add(value);
    }
}

/// Waves, steps, noise, and a few heights that are not finite.
Image hard_heights(bool is_finite) {
    constexpr int side = 96;
    Image image = make_image(side, side, 1, 32, ColorSpace::data);
    std::uint32_t state = 1;
    const std::span<float> heights = image.as<float>();
    for (std::size_t i = 0; i < heights.size(); ++i) {
        state = state * 1664525U + 1013904223U;
        const auto x = static_cast<float>(i % side);
        const auto y = static_cast<float>(i / side);
        const float wave = (x - 40.0F) * (x - 40.0F) * 1e-4F + x * y * 3e-5F;
        const float step = i % side > 60 ? 0.25F : 0.0F;
        heights[i] = wave + step + static_cast<float>(state >> 8) * 0x1p-30F;
        if (!is_finite && state % 911 == 0) heights[i] = state % 2 == 0 ? not_a_number : infinite;
    }
    return image;
}

void hash_bump(Hash& hash) {
    for (const EnumName<Kernel>& kernel : enum_names<Kernel>) {
        for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32}) {
            for (const int bits : {8, 16, 32}) {
                BumpOptions options;
                options.kernel = kernel.value;
                options.wrap = Wraps(Wrap::clamp, Wrap::repeat);
                options.arithmetic = arithmetic;
                NormalMapFormat format;
                format.bits = bits;
                format.dither = bits == 32 ? Dither::none : Dither::blue_noise;
                Report report;
                hash.add(normal_map_from_height(hard_heights(false), options, format, report));
                hash.add(report);
            }
        }
    }
}

void hash_kernel_choice(Hash& hash) {
    const BumpOptions options = resolve_options(hard_heights(true), BumpOptions{});
    hash.add(static_cast<std::uint32_t>(*options.kernel));
    hash.add(static_cast<std::uint32_t>(options.gaussian_radius));
    hash.add(destaircase(hard_heights(true)).heights);
}

void hash_normal_maps(Hash& hash) {
    BumpOptions bump;
    bump.kernel = Kernel::scharr3;
    bump.wrap = Wraps(Wrap::repeat);
    const Image normals = normals_from_height(hard_heights(true), bump);
    for (const ResizeDomain domain : {ResizeDomain::slopes, ResizeDomain::vectors}) {
        ResizeOptions options;
        options.domain = domain;
        hash.add(resize_normals(normals, 61, 130, options));
    }
    std::vector<Image> levels = normal_mip_levels(normals);
    for (Image& level : levels) {
        const Image lengths = split_lengths(level);
        hash.add(level);
        hash.add(roughness_from_lengths(lengths, 0.3));
    }
    IntegrationOptions integration;
    integration.kernel = Kernel::scharr3;
    integration.wrap = Wraps(Wrap::repeat);
    hash.add(heights_from_normals(normals, integration).heights);
}

void hash_bake(Hash& hash) {
    FrameOptions frames;
    frames.normals = NormalWeight::angle;
    frames.tangents = TangentMethod::mikktspace;
    const Mesh low = with_frames(textured_torus(), frames).mesh;
    const Mesh high = with_frames(subdivided(low, 1, frames, IgnoredReport()), frames).mesh;
    BakeOptions options = sized(48, 40);
    options.map.samples = 4;
    options.map.padding = 2;
    const BakedImage image = bake({high}, low, options);
    hash.add_all(image.normals);
    hash.add_all(image.heights);
}

/// Occlusion, curvature, positions and both directions of rays.
void hash_bake_layers(Hash& hash) {
    FrameOptions frames;
    frames.normals = NormalWeight::area;
    frames.tangents = TangentMethod::mikktspace;
    const Mesh low = with_frames(textured_torus(), frames).mesh;
    const Mesh high = with_frames(subdivided(low, 1, frames, IgnoredReport()), frames).mesh;
    BakeOptions options = sized(24, 20);
    options.map.layers.occlusion = OcclusionOptions{};
    options.map.layers.curvature = true;
    options.map.layers.positions = true;
    for (const RayDirections directions : {RayDirections::averaged, RayDirections::shading}) {
        options.directions = directions;
        const BakedImage image = bake({high}, low, options);
        hash.add_all(image.normals);
        hash.add_all(image.occlusion);
        hash.add_all(image.curvature);
        hash.add_all(image.positions);
    }
}

/// Bent normals, thickness and ids.
void hash_bake_rays(Hash& hash) {
    const Mesh low = with_frames(textured_torus(), {.tangents = TangentMethod::mikktspace}).mesh;
    std::vector<Mesh> high = {subdivided(low, 1, {}, IgnoredReport())};
    const auto half = static_cast<std::uint32_t>(high[0].triangles.size() / 2);
    high[0].material_ranges = {{0, half, 1}, {half, half, 0}};
    BakeOptions options = sized(24, 20);
    options.map.samples = 4;
    options.map.padding = 3;
    options.map.layers = {.normals = false,
                          .bent_normals = OcclusionOptions{.rays = 16, .distance = {}},
                          .thickness = ThicknessOptions{.rays = 16, .distance = {}},
                          .ids = true};
    const BakedImage image = bake(high, low, options);
    hash.add_all(image.bent_normals);
    hash.add_all(image.thickness);
    hash.add_all(image.ids);
}

/// Arbitrary codes, also those without direction: decoding, blending, lengths and exact resizing.
void hash_converted_maps(Hash& hash) {
    Image codes = make_image(53, 31, 4, 8, ColorSpace::data);
    std::uint32_t state = 5;
    for (std::uint8_t& code : codes.as<std::uint8_t>()) {
        state = state * 1664525U + 1013904223U;
        code = static_cast<std::uint8_t>(state >> 24);
    }
    Report report;
    const LengthRange lengths = measure_lengths(codes, FlatCode::half, report);
    for (const double length : {lengths.min, lengths.mean, lengths.max})
        hash.add(length);
    const Image base = decode_normal_map(codes, Green::down, FlatCode::middle, report);
    const Image detail = decode_xy_map(codes, {3, 1}, Green::up, FlatCode::half, report);
    for (const NormalBlend blend : all_normal_blends) {
        Image blended = base;
        blend_normals(blended, detail, blend, report);
        scale_slopes(blended, 1.7, report);
        hash.add(encode_normal_map(blended, {16, Green::up, FlatCode::middle}, report));
    }
    for (const ResizeFilter filter :
         {ResizeFilter::box, ResizeFilter::triangle, ResizeFilter::cubic, ResizeFilter::lanczos}) {
        ResizeOptions options;
        options.filter = filter;
        options.wrap = Wraps(Wrap::mirror, Wrap::clamp);
        hash.add(resize_normals(base, 20, 47, options, report));
        hash.add(resize_samples(channel_of(codes, 3), 20, 47, options));
    }
    codes.color_space = ColorSpace::srgb;
    for (const Image& level : mip_levels(codes))
        hash.add(level);
    hash.add(to_srgb(to_linear(codes), 16));
    hash.add(report);
}

struct Algorithm {
    const char* name;
    void (*add)(Hash& hash);
    std::uint64_t expected;
};

class SameBytes : public testing::TestWithParam<Algorithm> {
  protected:
    ~SameBytes() override { unsetenv("RELIEF_VECTOR_BITS"); }
};

TEST_P(SameBytes, ForAnyThreadsAndVectors) {
    struct Run {
        unsigned threads;
        const char* vector_bits;
    };
    for (const Run& run : {Run{1, "512"}, Run{2, "256"}, Run{7, "128"}}) {
        if (is_sanitized && run.threads == 2) continue;
        setenv("RELIEF_VECTOR_BITS", run.vector_bits, 1);
        const ExecutionScope scope({run.threads, nullptr});
        Hash hash;
        GetParam().add(hash);
        EXPECT_EQ(hash.value(), GetParam().expected)
            << run.threads << " threads, " << run.vector_bits << " bits: 0x" << std::hex
            << hash.value();
    }
}

INSTANTIATE_TEST_SUITE_P(
    Algorithms, SameBytes,
    testing::Values(Algorithm{"normals", hash_normals, 0xDCA6EE3708D391F0},
                    Algorithm{"tangents", hash_tangents, 0xAA40CAA2FD4E463C},
                    Algorithm{"encoded_frames", hash_encoded_frames, 0x6A0C3590A8A6CEAE},
                    Algorithm{"conditions", hash_conditions, 0x117C61CB4F3729CC},
                    Algorithm{"curvatures", hash_curvatures, 0x2F11732DAF8C0C23},
                    Algorithm{"decimation", hash_decimation, 0x578DDEB8CAEFDBC3},
                    Algorithm{"subdivision", hash_subdivision, 0x3ADF25FDEA6AA6E9},
                    Algorithm{"distances", hash_distances, 0xA63F82052F540DC0},
                    Algorithm{"bump", hash_bump, 0x7507D5E8682965A0},
                    Algorithm{"kernel_choice", hash_kernel_choice, 0x5926B9DCF1140153},
                    Algorithm{"normal_maps", hash_normal_maps, 0xC4E3E1A0C4839E9C},
                    Algorithm{"converted_maps", hash_converted_maps, 0xC277AA09C6E1A1AE},
                    Algorithm{"bake", hash_bake, 0x6BFF5036ED217037},
                    Algorithm{"bake_layers", hash_bake_layers, 0x4F4E3DDD159F9354},
                    Algorithm{"bake_rays", hash_bake_rays, 0xFBEB13D155D79167}),
    [](const testing::TestParamInfo<Algorithm>& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace relief::test
