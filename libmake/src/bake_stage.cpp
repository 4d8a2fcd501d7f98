// SPDX-License-Identifier: Apache-2.0
// Bakes the maps of an asset: one pass for all properties of the surface, and one of a quarter of
// the size for occlusion, bent normals and thickness. Properties that are the same everywhere
// become factors. Tests: tests/make/asset_maps_test.cpp.
#include "bake_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "asset_ids.h"
#include "part_groups.h"
#include "relief/mesh/normal_map.h"

namespace relief::make {
namespace {

// The materials of the source.

/// Returns the materials that triangles of a mesh have, each once.
std::vector<const HighMaterial*> used_materials(const Mesh& mesh,
                                                std::span<const HighMaterial> materials,
                                                const std::optional<HighMaterial>& otherwise) {
    static const HighMaterial white;
    const HighMaterial* other = otherwise ? &*otherwise : &white;
    if (mesh.material_ranges.empty()) return {other};
    std::vector<const HighMaterial*> used;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.triangle_count == 0) continue;
        const bool is_known = range.material && *range.material < materials.size();
        const HighMaterial* material = is_known ? &materials[*range.material] : other;
        if (std::ranges::find(used, material) == used.end()) used.push_back(material);
    }
    return used;
}

float opacity_of(const HighMaterial& material) {
    const float opacity = material.opacity.value_or(1.0F);
    if (!material.opacity || !material.alpha_cutoff) return opacity;
    return opacity >= *material.alpha_cutoff ? 1.0F : 0.0F;
}

bool has_occlusion(const HighMaterial& material) {
    return material.occlusion_texture && material.occlusion_strength > 0.0F;
}

/// Returns whether materials differ in a property, or have a texture of it.
template <typename HasTexture, typename Property>
bool varies(const std::vector<const HighMaterial*>& materials, const HasTexture& has_texture,
            const Property& property) {
    return std::ranges::any_of(materials, [&](const HighMaterial* material) {
        return has_texture(*material) || property(*material) != property(*materials.front());
    });
}

VaryingProperties varying_of(const std::vector<const HighMaterial*>& used, bool has_colors) {
    VaryingProperties result;
    result.color =
        has_colors ||
        varies(
            used, [](const HighMaterial& material) { return material.color_texture.has_value(); },
            [](const HighMaterial& material) {
                return glm::vec4(material.color, opacity_of(material));
            });
    result.surface = varies(
        used, [](const HighMaterial& material) { return material.surface_texture.has_value(); },
        [](const HighMaterial& material) {
            return glm::vec2(material.roughness, material.metallic);
        });
    result.occlusion = std::ranges::any_of(
        used, [](const HighMaterial* material) { return has_occlusion(*material); });
    result.emission = varies(
        used,
        [](const HighMaterial& material) {
            return material.emission_texture && material.emission != glm::vec3(0.0F);
        },
        [](const HighMaterial& material) { return material.emission; });
    return result;
}

}  // namespace

VaryingProperties varying_properties(const Mesh& mesh, const AssetSource& source) {
    return varying_of(used_materials(mesh, source.materials, source.otherwise),
                      !mesh.colors.empty());
}

namespace {

// Maps.

Image empty_map(const glm::ivec2& size, int channels, int bits, ColorSpace color_space) {
    Image image;
    image.width = size.x;
    image.height = size.y;
    image.channels = channels;
    image.color_space = color_space;
    if (bits == 8) {
        image.samples = std::vector<std::uint8_t>();
    } else {
        image.samples = std::vector<std::uint16_t>();
    }
    std::visit([&](auto& samples) { samples.reserve(image.sample_count()); }, image.samples);
    return image;
}

void append(Image& image, std::span<const std::byte> codes) {
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            const std::size_t before = samples.size();
            samples.resize(before + codes.size() / sizeof(Sample));
            std::memcpy(&samples[before], codes.data(), codes.size());
        },
        image.samples);
}

/// Codes rows of a normal map.
void append_normals(Image& map, const BakedRows& rows, Report& report) {
    NormalMapFormat format;
    format.bits = map.bits();
    const ImageView normals(rows.normals.data(), map.width, rows.row_count, 3);
    const Image codes = encode_normal_map(normals, format, report);
    std::visit([&](const auto& samples) { append(map, std::as_bytes(std::span(samples))); },
               codes.samples);
}

/// A layer that is collected from rows, and the range of its codes.
class LayerMap {
  public:
    LayerMap(const LayerCoding& coding, const glm::ivec2& size, bool has_opacity = false)
        : coding_(coding),
          has_opacity_(has_opacity),
          image_(empty_map(size, static_cast<int>(coding.channels()) + (has_opacity ? 1 : 0),
                           coding.bits, coding.color_space())) {
        min_.fill(255);
    }

    void add(const BakedRows& rows, Report& report) {
        const std::span<const float> values = layer_values(coding_.kind, rows);
        const std::size_t first =
            static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(rows.first_row);
        const std::vector<std::byte> codes =
            encode_layer(values, rows.states, coding_, has_opacity_, first, report,
                         has_opacity_ ? rows.opacity : std::span<float>());
        append(image_, codes);
        if (coding_.bits == 8 && coding_.kind != LayerKind::id) measure(values, codes, rows.states);
    }

    /// Returns whether a channel of a map of 8 bits, but not of ids, has one code in all texels of
    /// charts.
    [[nodiscard]] bool is_uniform(std::size_t channel) const {
        return min_[channel] >= max_[channel];
    }
    [[nodiscard]] bool is_uniform() const {
        return is_uniform(0) && is_uniform(1) && is_uniform(2);
    }
    [[nodiscard]] std::uint8_t min_code(std::size_t channel) const { return min_[channel]; }

    /// Returns the value of the first texel of a chart.
    [[nodiscard]] const glm::vec3& first_value() const { return first_value_; }

    [[nodiscard]] const LayerCoding& coding() const { return coding_; }
    [[nodiscard]] Image& image() { return image_; }

  private:
    void measure(std::span<const float> values, std::span<const std::byte> codes,
                 std::span<const TexelState> states) {
        // Images have at most four, which GCC 13 does not see.
        const std::size_t channels =
            std::min(static_cast<std::size_t>(image_.channels), min_.size());
        const std::size_t of_layer = coding_.channels();
        for (std::size_t i = 0; i < states.size(); ++i) {
            if (states[i] != TexelState::baked && states[i] != TexelState::padded) continue;
            for (std::size_t channel = 0; channel < channels; ++channel) {
                const auto code = static_cast<std::uint8_t>(codes[channels * i + channel]);
                min_[channel] = std::min(min_[channel], code);
                max_[channel] = std::max(max_[channel], code);
            }
            if (has_first_) continue;
            has_first_ = true;
            for (std::size_t channel = 0; channel < of_layer; ++channel)
                first_value_[static_cast<int>(channel)] = values[of_layer * i + channel];
        }
    }

    LayerCoding coding_;
    bool has_opacity_;
    Image image_;
    std::array<std::uint8_t, 4> min_{}, max_{};
    bool has_first_ = false;
    glm::vec3 first_value_{0.0F};
};

/// Returns an image with only its first channels.
Image first_channels(const Image& image, int count) {
    Image result = empty_map({image.width, image.height}, count, 8,
                             count == 1 ? ColorSpace::data : image.color_space);
    auto& samples = std::get<std::vector<std::uint8_t>>(result.samples);
    const std::span<const std::uint8_t> from = image.as<std::uint8_t>();
    const auto stride = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (i % stride < static_cast<std::size_t>(count)) samples.push_back(from[i]);
    }
    return result;
}

/// Lowers the red of a map to another map, which may be smaller and is interpolated.
void darken_red(Image& map, const Image& other) {
    const std::span<std::uint8_t> samples = map.as<std::uint8_t>();
    const std::span<const std::uint8_t> occlusion = other.as<std::uint8_t>();
    const auto channels = static_cast<std::size_t>(map.channels);
    /// The two nearest texels along an axis, and the share of the second one in 1/256.
    struct Place {
        std::size_t first = 0, second = 0;
        unsigned share = 0;
    };
    const auto place_of = [](int at, int size, int other_size) {
        // In 1/256 of a texel of the other map, whose centers are at 128.
        const std::int64_t center = (std::int64_t{2} * at + 1) * 128 * other_size / size - 128;
        const std::int64_t first = std::max<std::int64_t>(center, 0);
        const auto last = static_cast<std::size_t>(other_size - 1);
        const auto begin = std::min(static_cast<std::size_t>(first / 256), last);
        return Place{begin, std::min(begin + 1, last), static_cast<unsigned>(first % 256)};
    };
    const auto width = static_cast<std::size_t>(other.width);
    std::size_t texel = 0;
    for (int y = 0; y < map.height; ++y) {
        const Place row = place_of(y, map.height, other.height);
        for (int x = 0; x < map.width; ++x, ++texel) {
            const Place column = place_of(x, map.width, other.width);
            const auto in_row = [&](std::size_t at) {
                return occlusion[at * width + column.first] * (256 - column.share) +
                       occlusion[at * width + column.second] * column.share;
            };
            const unsigned value =
                in_row(row.first) * (256 - row.share) + in_row(row.second) * row.share;
            const auto code = static_cast<std::uint8_t>((value + 0x8000) >> 16);
            std::uint8_t& red = samples[channels * texel];
            red = std::min(red, code);
        }
    }
}

// The stage.

/// Occlusion, bent normals and thickness vary slowly, and their rays cost most.
constexpr int hemisphere_reduction = 4;

constexpr int default_hemisphere_rays = 32;

bool has_hemispheres(LayerKind kind) {
    return kind == LayerKind::bent_normal || kind == LayerKind::thickness;
}

/// Returns the options of the layers for which rays are cast into hemispheres.
BakeLayers hemispheres_of(const BakeLayers& layers) {
    BakeLayers result;
    result.normals = false;
    result.occlusion = layers.occlusion;
    result.bent_normals = layers.bent_normals;
    result.thickness = layers.thickness;
    return result;
}

class MapBaker {
  public:
    MapBaker(const AssetSource& source, const detail::BakedSource& baked,
             const AssetOptions& options, Asset& asset, Report& report)
        : source_(source),
          baked_(baked),
          high_(baked.high),
          options_(options),
          drawn_(drawn_materials(high_, source, baked.alpha, baked.low_alpha, report)),
          used_(used_materials(high_, drawn_.materials, source.otherwise)),
          varying_(varying_of(used_, !high_.colors.empty())),
          asset_(asset) {}

    void bake(Report& report);

  private:
    [[nodiscard]] BakeOptions bake_options() const;
    [[nodiscard]] bool is_transparent() const;
    [[nodiscard]] bool find_groups();
    [[nodiscard]] Baker baker_of_groups(BakeOptions options, Report& report);
    [[nodiscard]] glm::ivec2 hemisphere_size() const;
    void set_factors();
    void set_draw_modes();
    void add_layers(const Baker& baker, const LayerBounds& bounds);
    void bake_surface(const Baker& baker, const LayerBounds& bounds, Report& report);
    [[nodiscard]] std::optional<Image> bake_hemispheres(const Baker& baker, Report& report);
    void store_colors(LayerMap& map, Report& report);
    void store_surface(LayerMap& map, std::optional<Image> occlusion);
    void store_emission(LayerMap& map, double strength);

    const AssetSource& source_;
    const detail::BakedSource& baked_;
    const Mesh& high_;
    detail::RayGroups groups_;  ///< If not all rays hit all of the dense mesh.
    detail::BakedParts parts_;  ///< Of these groups.
    const AssetOptions& options_;
    detail::DrawnMaterials drawn_;
    std::vector<const HighMaterial*> used_;  ///< Of them.
    VaryingProperties varying_;
    Asset& asset_;
    /// The layers of the first pass, absent if they are not needed.
    std::unique_ptr<LayerMap> colors_, surface_, emission_;
    std::vector<LayerMap> further_;
};

BakeOptions MapBaker::bake_options() const {
    BakeOptions baking;
    baking.map.width = options_.size.x;
    baking.map.height = options_.size.y;
    baking.map.samples = options_.samples;
    baking.map.padding = options_.padding;
    BakeLayers& layers = baking.map.layers;
    layers.colors = varying_.color;
    layers.opacity = varying_.color && is_transparent();
    layers.surface = varying_.surface || varying_.occlusion;
    layers.emission = varying_.emission;
    const auto has = [&](LayerKind kind) {
        return std::ranges::find(options_.layers, kind) != options_.layers.end();
    };
    layers.heights = has(LayerKind::height);
    layers.curvature = has(LayerKind::curvature);
    layers.positions = has(LayerKind::position);
    layers.position_from_mesh[3] = glm::dvec4(source_.origin, 1.0);
    layers.ids = has(LayerKind::id);
    const int rays =
        options_.occlusion_rays > 0 ? options_.occlusion_rays : default_hemisphere_rays;
    if (options_.occlusion) layers.occlusion = {.rays = options_.occlusion_rays};
    if (has(LayerKind::bent_normal)) layers.bent_normals = {.rays = rays};
    if (has(LayerKind::thickness)) layers.thickness = {.rays = rays};
    baking.map_count = layers.occlusion || layers.bent_normals || layers.thickness ? 2 : 1;
    baking.materials.push_back({&high_, drawn_.materials, {}, source_.otherwise});
    if (layers.ids)
        baking.ids.push_back(
            {&high_, detail::asset_ids(high_, baked_.high_parts, source_.material_names)});
    return baking;
}

/// Returns the range of a further layer, which holds all of its values.
double range_of(LayerKind kind, const LayerBounds& bounds) {
    const double range = kind == LayerKind::height      ? bounds.height
                         : kind == LayerKind::curvature ? bounds.curvature
                         : kind == LayerKind::thickness ? bounds.thickness
                                                        : bounds.position;
    return range > 0.0 ? range : 1.0;
}

/// Sets an emission, which may be brighter than 1.
void set_emission(GltfMaterial& material, const glm::vec3& emission) {
    material.emission_strength = std::max({emission.r, emission.g, emission.b, 1.0F});
    material.emission_factor = emission / material.emission_strength;
}

/// Sets the factors of properties without maps. Where a map exists, they are 1.
void MapBaker::set_factors() {
    GltfMaterial& material = asset_.material;
    material = source_.shared;
    MetallicRoughness& surface = *material.metallic_roughness;
    const HighMaterial& first = *used_.front();
    const DrawMode& mode = drawn_.modes.front();
    material.alpha_mode = mode.alpha_mode;
    material.alpha_cutoff = mode.alpha_cutoff;
    material.double_sided = mode.double_sided;
    surface.base_color = glm::vec3(1.0F);
    material.opacity = 1.0F;
    if (!varying_.color) {
        surface.base_color = first.color;
        material.opacity = opacity_of(first);
    }
    surface.roughness = varying_.surface ? 1.0F : first.roughness;
    surface.metallic = varying_.surface ? 1.0F : first.metallic;
    set_emission(material, varying_.emission ? glm::vec3(0.0F) : first.emission);
}

/// Adds the further layers.
void MapBaker::add_layers(const Baker& baker, const LayerBounds& bounds) {
    for (const LayerKind kind : options_.layers) {
        LayerCoding coding{kind, kind == LayerKind::id ? 8 : 16, range_of(kind, bounds)};
        if (kind == LayerKind::id) coding.ids = baker.ids();
        further_.emplace_back(coding, has_hemispheres(kind) ? hemisphere_size() : options_.size);
    }
}

glm::ivec2 MapBaker::hemisphere_size() const {
    return glm::max(options_.size / hemisphere_reduction, glm::ivec2(1));
}

/// Bakes all layers without rays into hemispheres.
void MapBaker::bake_surface(const Baker& baker, const LayerBounds& bounds, Report& report) {
    BakeMapOptions map = baker.options().map;
    map.layers.occlusion.reset();
    map.layers.bent_normals.reset();
    map.layers.thickness.reset();
    map.measures_missed = true;
    const glm::ivec2& size = options_.size;
    std::vector<LayerMap*> maps;
    const auto add = [&](std::unique_ptr<LayerMap>& target, LayerKind kind, double range,
                         bool has_opacity) {
        target = std::make_unique<LayerMap>(LayerCoding{kind, 8, range}, size, has_opacity);
        maps.push_back(target.get());
    };
    if (map.layers.colors) add(colors_, LayerKind::color, 1.0, map.layers.opacity);
    if (map.layers.surface) add(surface_, LayerKind::surface, 1.0, false);
    if (map.layers.emission)
        add(emission_, LayerKind::emission, std::max(1.0, bounds.emission), false);
    for (LayerMap& layer : further_) {
        if (!has_hemispheres(layer.coding().kind)) maps.push_back(&layer);
    }
    asset_.normal_map = empty_map(size, 3, options_.normal_bits, ColorSpace::data);
    if (options_.keep_baked_normals)
        asset_.baked_normals = empty_map(size, 3, 16, ColorSpace::data);
    Report same;  // Normals that are not finite are counted once.
    const auto take = [&](const BakedRows& rows) {
        append_normals(asset_.normal_map, rows, report);
        if (asset_.baked_normals) append_normals(*asset_.baked_normals, rows, same);
        for (LayerMap* layer : maps)
            layer->add(rows, report);
    };
    asset_.bake = baker.bake(map, take, report, options_.execution);
}

/// Returns a finding about a map of the reduced size.
Finding of_reduced_map(Finding finding) {
    finding.element = "texel of the quarter-size map";
    return finding;
}

/// Bakes occlusion, bent normals and thickness. \return the occlusion, if it is requested
std::optional<Image> MapBaker::bake_hemispheres(const Baker& baker, Report& report) {
    BakeMapOptions map = baker.options().map;
    const glm::ivec2 size = hemisphere_size();
    map.width = size.x;
    map.height = size.y;
    map.samples = 1;
    map.padding = (options_.padding + hemisphere_reduction - 1) / hemisphere_reduction;
    map.layers = hemispheres_of(map.layers);
    std::optional<LayerMap> occlusion;
    std::vector<LayerMap*> maps;
    if (options_.occlusion) {
        occlusion.emplace(LayerCoding{LayerKind::occlusion, 8, 1.0}, size);
        maps.push_back(&*occlusion);
    }
    for (LayerMap& layer : further_) {
        if (has_hemispheres(layer.coding().kind)) maps.push_back(&layer);
    }
    if (maps.empty()) return std::nullopt;
    Report all;
    const auto take = [&](const BakedRows& rows) {
        for (LayerMap* layer : maps)
            layer->add(rows, report);
    };
    const BakeResult result = baker.bake(map, take, all, options_.execution);
    asset_.bake.occlusion_rays = result.occlusion_rays;
    asset_.bake.thickness_rays = result.thickness_rays;
    asset_.bake.open_thickness_rays = result.open_thickness_rays;
    // Its other findings are those of the other maps, at another size.
    for (const Finding& finding : all.findings()) {
        if (finding.kind == "texel without an open ray" ||
            finding.kind == "bent normal behind the surface" ||
            finding.kind == "texel without a surface behind it")
            report.add(of_reduced_map(finding));
    }
    if (!occlusion) return std::nullopt;
    return std::move(occlusion->image());
}

constexpr std::size_t alpha_channel = 3;

void MapBaker::store_colors(LayerMap& map, Report& report) {
    GltfMaterial& material = asset_.material;
    Image& image = map.image();
    if (image.channels == 4 && map.min_code(alpha_channel) == 255) {
        report.add("transparent source that is opaque everywhere", "source", 0, "is opaque");
        image = first_channels(image, 3);
    }
    if (image.channels == 3 && map.is_uniform()) {
        material.metallic_roughness->base_color = map.first_value();
    } else {
        asset_.color_map = std::move(image);
    }
}

/// \param occlusion  by the rays
void MapBaker::store_surface(LayerMap& map, std::optional<Image> occlusion) {
    MetallicRoughness& factors = *asset_.material.metallic_roughness;
    const bool is_uniform = map.is_uniform(1) && map.is_uniform(2);
    const bool has_occlusion = map.min_code(0) < 255;
    if (is_uniform) {
        factors.roughness = map.first_value().g;
        factors.metallic = map.first_value().b;
    }
    Image& image = map.image();
    if (is_uniform && !has_occlusion) {
        asset_.occlusion_map = std::move(occlusion);
        return;
    }
    if (occlusion) darken_red(image, *occlusion);
    if (is_uniform) {
        asset_.occlusion_map = first_channels(image, 1);
    } else {
        asset_.surface_has_occlusion = has_occlusion || occlusion;
        asset_.surface_map = std::move(image);
    }
}

void MapBaker::store_emission(LayerMap& map, double strength) {
    if (map.is_uniform()) {
        set_emission(asset_.material, map.first_value());
        return;
    }
    asset_.material.emission_strength = static_cast<float>(strength);
    asset_.material.emission_factor = glm::vec3(1.0F);
    asset_.emission_map = std::move(map.image());
}

bool MapBaker::is_transparent() const {
    return std::ranges::any_of(
        drawn_.modes, [](const DrawMode& mode) { return mode.alpha_mode != AlphaMode::opaque; });
}

/// Finds groups of triangles whose rays hit only triangles of the same group. \return false if
/// all rays hit all of the dense mesh
bool MapBaker::find_groups() {
    const bool has_parts = asset_.parts.is_matched;
    const std::vector<AlphaMode> high_alpha = detail::alpha_modes_of(high_, baked_.alpha);
    groups_ = detail::ray_groups(
        has_parts ? baked_.high_parts : NamedParts{},
        has_parts ? baked_.low_parts : decltype(baked_.low_parts){}, high_alpha,
        options_.match == PartMatching::all ? decltype(baked_.low_alpha){} : baked_.low_alpha);
    return groups_.names.size() > 1;
}

/// Returns a baker for which each group of the asset sees only its group of the source.
Baker MapBaker::baker_of_groups(BakeOptions options, Report& report) {
    parts_ = detail::divided(high_, groups_.of_high, groups_.of_low, groups_.names);
    options.materials.clear();
    for (const Mesh& mesh : parts_.meshes)
        options.materials.push_back({&mesh, drawn_.materials, {}, source_.otherwise});
    if (options.map.layers.ids) {
        std::vector<std::vector<NamedTriangles>> ids =
            detail::divided(options.ids.front().triangles, groups_.of_high, groups_.names.size());
        options.ids.clear();
        for (std::size_t i = 0; i < ids.size(); ++i)
            options.ids.push_back({&parts_.meshes[i], std::move(ids[i])});
    }
    options.parts_occlude = true;
    // The decimation may have left little of a small part.
    options.allow_size_mismatch = true;
    return {parts_.parts, asset_.mesh, options, report};
}

/// Gives the triangles of the asset their materials.
void MapBaker::set_draw_modes() {
    GltfMaterial& material = asset_.material;
    const bool is_opaque = !asset_.color_map && material.opacity >= 1.0F;
    if (is_opaque || (asset_.color_map && asset_.color_map->channels == 3)) {
        material.alpha_mode = AlphaMode::opaque;
        for (DrawMode& mode : drawn_.modes)
            mode.alpha_mode = AlphaMode::opaque;
        material.double_sided = std::ranges::any_of(
            drawn_.modes, [](const DrawMode& mode) { return mode.double_sided; });
        return;
    }
    if (drawn_.modes.size() < 2) return;
    asset_.draw_modes = drawn_.modes;
    asset_.mesh.material_ranges = detail::ranges_of(baked_.low_alpha, drawn_.modes);
}

void MapBaker::bake(Report& report) {
    const Baker baker = find_groups()
                            ? baker_of_groups(bake_options(), report)
                            : Baker(std::span(&high_, 1), asset_.mesh, bake_options(), report);
    asset_.agreement = baker.agreement();
    set_factors();
    const LayerBounds bounds = baker.bounds(baker.options().map.layers);
    add_layers(baker, bounds);
    bake_surface(baker, bounds, report);
    if (asset_.bake.texels_baked == 0)
        throw InvalidInput("no texel of the maps was baked: no ray hits the source");
    std::optional<Image> occlusion = bake_hemispheres(baker, report);
    if (colors_) store_colors(*colors_, report);
    if (surface_) {
        store_surface(*surface_, std::move(occlusion));
    } else {
        asset_.occlusion_map = std::move(occlusion);
    }
    if (emission_) store_emission(*emission_, emission_->coding().range);
    for (LayerMap& layer : further_)
        asset_.layers.push_back({layer.coding(), std::move(layer.image())});
    set_draw_modes();
}

}  // namespace

void detail::bake_maps(const AssetSource& source, const BakedSource& baked,
                       const AssetOptions& options, Asset& asset, Report& report) {
    MapBaker(source, baked, options, asset, report).bake(report);
}

}  // namespace relief::make
