// SPDX-License-Identifier: Apache-2.0
// The stages from a dense mesh to the maps of an asset. Tests: tests/make/asset_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <utility>

#include "relief/make/asset.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"

namespace relief::make {
namespace {

constexpr int min_size = 16;
constexpr int max_size = 16384;
/// Smaller ones have the highlights of a mirror, which a light does not hit.
constexpr float min_roughness = 0.03F;

void check(const AssetOptions& options) {
    if (options.triangles < 1)
        throw InvalidInput("the number of triangles must be at least 1, but is 0");
    const glm::ivec2& size = options.size;
    if (std::min(size.x, size.y) < min_size || std::max(size.x, size.y) > max_size) {
        throw InvalidInput(fmt::format("the size of maps is {} x {}, but must be {} to {}", size.x,
                                       size.y, min_size, max_size));
    }
}

/// Runs stages and collects their reports.
class Maker {
  public:
    Maker(const AssetSource& source, const AssetOptions& options)
        : source_(source), options_(options) {}

    Asset run();

  private:
    void run_stage(const std::string& name, void (Maker::*work)(Report&));
    void repair(Report& report);
    void decimate(Report& report);
    void unwrap_mesh(Report& report);
    void compute_frames(Report& report);
    void bake(Report& report);
    [[nodiscard]] bool has_many_colors() const;
    [[nodiscard]] const HighMaterial* only_material() const;
    [[nodiscard]] BakeOptions bake_options() const;
    void bake_maps(const Baker& baker, Report& report);
    void bake_occlusion(const Baker& baker, Report& report);

    const AssetSource& source_;
    const AssetOptions& options_;
    Mesh high_;
    Asset asset_;
};

/// Returns whether a triangle has an area in double precision.
bool is_usable(const Mesh& mesh, const glm::uvec3& triangle) {
    const glm::dvec3 a(mesh.positions[triangle.x]);
    const glm::dvec3 b(mesh.positions[triangle.y]);
    const glm::dvec3 c(mesh.positions[triangle.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::dot(normal, normal);
    return std::isfinite(length) && length > 0.0;
}

void Maker::repair(Report& report) {
    validate(source_.mesh);
    Mesh mesh =
        options_.repair ? repaired(source_.mesh, *options_.repair, report).mesh : source_.mesh;
    std::vector<std::uint32_t> usable;
    usable.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (is_usable(mesh, mesh.triangles[i])) {
            usable.push_back(static_cast<std::uint32_t>(i));
        } else {
            report.add("triangle without area or with a position that is not finite", "triangle", i,
                       "is removed");
        }
    }
    if (usable.empty()) throw InvalidInput("has no triangle with an area and finite positions");
    high_ = usable.size() == mesh.triangles.size() ? std::move(mesh) : part_of(mesh, usable);
    if (high_.normals.empty()) {
        FrameOptions frames;
        frames.normals = NormalWeight::angle;
        frames.crease_angle = options_.crease_angle;
        frames.tangents = TangentMethod::keep;
        high_ = with_frames(std::move(high_), frames, report).mesh;
    }
    asset_.source_triangles = high_.triangles.size();
}

void Maker::decimate(Report& report) {
    Mesh surface;
    surface.positions = high_.positions;
    surface.triangles = high_.triangles;
    if (options_.keep_texcoords) {
        surface.texcoords = high_.texcoords;
        if (surface.texcoords.empty())
            throw InvalidInput("has no texture coordinates that can be kept");
    }
    if (surface.triangles.size() < options_.triangles) {
        report.add("source with fewer triangles than requested", "source", 0,
                   "keeps all its triangles");
    }
    DecimateOptions limits;
    limits.triangles = options_.triangles;
    limits.fit_positions = true;
    limits.frames.normals = NormalWeight::angle;
    limits.frames.tangents = TangentMethod::none;
    asset_.mesh = decimated(surface, limits, report).mesh;
    if (asset_.mesh.triangles.empty()) throw InvalidInput("no triangle is left after decimation");
}

void Maker::unwrap_mesh(Report& report) {
    UnwrapOptions unwrapping;
    unwrapping.size = options_.size;
    unwrapping.padding = options_.padding;
    unwrapping.split_hard = options_.crease_angle;
    unwrapping.execution = options_.execution;
    const Unwrapped unwrapped = unwrap(asset_.mesh, unwrapping, report);
    asset_.atlas = unwrapped.stats;
    asset_.mesh = with_texcoords(asset_.mesh, unwrapped).mesh;
}

void Maker::compute_frames(Report& report) {
    FrameOptions frames;
    frames.normals = NormalWeight::angle;
    frames.crease_angle = options_.crease_angle;
    frames.tangents = TangentMethod::mikktspace;
    asset_.mesh = with_frames(std::move(asset_.mesh), frames, report).mesh;
    asset_.mesh.name = source_.name;
}

/// Returns the material of all triangles; null if there are several.
const HighMaterial* Maker::only_material() const {
    static const HighMaterial white;
    const HighMaterial* other = source_.otherwise ? &*source_.otherwise : &white;
    if (high_.material_ranges.empty()) return other;
    const auto material_of = [&](const MaterialRange& range) {
        const bool is_known = range.material && *range.material < source_.materials.size();
        return is_known ? &source_.materials[*range.material] : other;
    };
    const HighMaterial* first = material_of(high_.material_ranges.front());
    const bool is_same = std::ranges::all_of(
        high_.material_ranges, [&](const auto& range) { return material_of(range) == first; });
    return is_same ? first : nullptr;
}

bool Maker::has_many_colors() const {
    if (!high_.colors.empty()) return true;
    const HighMaterial* material = only_material();
    return material == nullptr || material->color_texture ||
           material->opacity.value_or(1.0F) < 1.0F;
}

BakeOptions Maker::bake_options() const {
    BakeOptions baking;
    baking.map.width = options_.size.x;
    baking.map.height = options_.size.y;
    baking.map.samples = options_.samples;
    baking.map.padding = options_.padding;
    baking.map.layers.colors = has_many_colors();
    baking.map.layers.opacity = baking.map.layers.colors && source_.alpha_mode != AlphaMode::opaque;
    if (options_.occlusion) baking.map.layers.occlusion = {.rays = options_.occlusion_rays};
    baking.map_count = options_.occlusion ? 2 : 1;
    baking.materials.push_back({&high_, source_.materials, {}, source_.otherwise});
    return baking;
}

/// An image of 8 bits to which rows are appended.
Image empty_map(const glm::ivec2& size, int channels, ColorSpace color_space) {
    Image image;
    image.width = size.x;
    image.height = size.y;
    image.channels = channels;
    image.color_space = color_space;
    std::vector<std::uint8_t> samples;
    samples.reserve(image.sample_count());
    image.samples = std::move(samples);
    return image;
}

void append(Image& image, std::span<const std::byte> codes) {
    auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    const std::size_t before = samples.size();
    samples.resize(before + codes.size());
    std::memcpy(&samples[before], codes.data(), codes.size());
}

void append_layer(Image& image, LayerKind kind, const BakedRows& rows, bool has_alpha,
                  Report& report) {
    const std::size_t first =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(rows.first_row);
    const LayerCoding coding{kind, 8, 1.0};
    append(image, encode_layer(layer_values(kind, rows), rows.states, coding, has_alpha, first,
                               report, has_alpha ? rows.opacity : std::span<float>()));
}

void Maker::bake_maps(const Baker& baker, Report& report) {
    BakeMapOptions map = baker.options().map;
    map.layers.occlusion.reset();
    map.measures_missed = true;
    asset_.normal_map = empty_map(options_.size, 3, ColorSpace::data);
    if (map.layers.colors)
        asset_.color_map = empty_map(options_.size, map.layers.opacity ? 4 : 3, ColorSpace::srgb);
    NormalMapFormat format;
    format.bits = 8;
    const auto take = [&](const BakedRows& rows) {
        const ImageView normals(rows.normals.data(), options_.size.x, rows.row_count, 3);
        const Image codes = encode_normal_map(normals, format, report);
        append(asset_.normal_map, std::as_bytes(codes.as<std::uint8_t>()));
        if (asset_.color_map)
            append_layer(*asset_.color_map, LayerKind::color, rows, map.layers.opacity, report);
    };
    asset_.bake = baker.bake(map, take, report, options_.execution);
}

void Maker::bake_occlusion(const Baker& baker, Report& report) {
    BakeMapOptions map = baker.options().map;
    const OcclusionOptions rays = *map.layers.occlusion;
    // Occlusion varies slowly, and its rays cost most.
    constexpr int reduction = 4;
    const glm::ivec2 size = glm::max(options_.size / reduction, glm::ivec2(1));
    map.width = size.x;
    map.height = size.y;
    map.samples = 1;
    map.padding = (options_.padding + reduction - 1) / reduction;
    map.layers = {};
    map.layers.normals = false;
    map.layers.occlusion = rays;
    asset_.occlusion_map = empty_map(size, 1, ColorSpace::data);
    Report same;  // Its findings are those of the other maps, at another size.
    const auto take = [&](const BakedRows& rows) {
        append_layer(*asset_.occlusion_map, LayerKind::occlusion, rows, false, report);
    };
    asset_.bake.occlusion_rays = baker.bake(map, take, same, options_.execution).occlusion_rays;
}

void Maker::bake(Report& report) {
    const Baker baker(std::span(&high_, 1), asset_.mesh, bake_options(), report);
    asset_.agreement = baker.agreement();
    bake_maps(baker, report);
    if (asset_.bake.texels_baked == 0)
        throw InvalidInput("no texel of the maps was baked: no ray hits the source");
    if (options_.occlusion) bake_occlusion(baker, report);
    if (const HighMaterial* material = only_material(); material && !asset_.color_map)
        asset_.color = material->color;
    if (asset_.color_map && asset_.color_map->channels == 4) {
        asset_.alpha_mode = source_.alpha_mode;
        asset_.alpha_cutoff = source_.alpha_cutoff;
    }
}

void Maker::run_stage(const std::string& name, void (Maker::*work)(Report&)) {
    StageReport& stage = asset_.reports.emplace_back(StageReport{name, {}});
    if (options_.run_stage) {
        options_.run_stage(name, [&] { (this->*work)(stage.report); });
    } else {
        (this->*work)(stage.report);
    }
    if (options_.take_mesh && name != "bake")
        options_.take_mesh(name, name == "repair" ? high_ : asset_.mesh);
}

Asset Maker::run() {
    check(options_);
    const ExecutionScope scope(options_.execution);
    asset_.name = source_.name;
    asset_.origin = source_.origin;
    asset_.roughness = std::clamp(source_.roughness, min_roughness, 1.0F);
    run_stage("repair", &Maker::repair);
    run_stage("decimate", &Maker::decimate);
    if (!options_.keep_texcoords) run_stage("unwrap", &Maker::unwrap_mesh);
    run_stage("frames", &Maker::compute_frames);
    run_stage("bake", &Maker::bake);
    return std::move(asset_);
}

}  // namespace

std::vector<std::string> stages_of(const AssetOptions& options) {
    std::vector<std::string> stages = {"repair", "decimate", "unwrap", "frames", "bake"};
    if (options.keep_texcoords) std::erase(stages, "unwrap");
    return stages;
}

Asset make_asset(const AssetSource& source, const AssetOptions& options) {
    return Maker(source, options).run();
}

}  // namespace relief::make
