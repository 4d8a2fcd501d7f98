// SPDX-License-Identifier: Apache-2.0
// Reads the models of a bake, pairs their parts by name, decodes the textures of the high models,
// and checks whether high and low models belong together. Messages name the likely cause. Tests:
// tests/tools/relief_bake_models_test.cpp, relief_bake_layers_test.cpp.

#include "mesh_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

#include "common/file_jobs.h"
#include "common/map_kind.h"
#include "common/text.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/texture_file.h"

namespace relief::tools {
namespace {

/// \throws FileError if low parts have no counterpart
void require_counterparts(const std::filesystem::path& file, std::vector<std::string> unmatched) {
    constexpr std::size_t max_named = 4;
    if (unmatched.empty()) return;
    const std::size_t count = unmatched.size();
    unmatched.resize(std::min(count, max_named));
    throw failure(file,
                  fmt::format("{} of its parts {} no high part of the same name: {}{}", count,
                              count == 1 ? "has" : "have", fmt::join(unmatched, ", "),
                              count > max_named ? ", ..." : ""),
                  "name them X_low and X_high, or use --match all");
}

// Reading.

MapModel read(const std::filesystem::path& file, Findings& findings) {
    Report report;
    MapModel model = read_map_model(file, ModelSpace::world, report);
    findings.add(file.string(), report);
    return model;
}

MapModel read_with_origin(const glm::dvec3& origin, const std::filesystem::path& file,
                          Findings& findings) {
    MapModel model = read(file, findings);
    move_to(model, origin);
    return model;
}

Mesh join_parts(const std::filesystem::path& file, MapModel model) {
    return about(file, [&] { return joined(std::move(model.parts)); });
}

/// Appends the names of some of a part's triangles.
/// \param first  the number of triangles before
void append_names(const std::vector<NamedTriangles>& of_part,
                  std::span<const std::uint32_t> triangles, std::size_t first,
                  std::vector<NamedTriangles>& names) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto next =
            std::ranges::upper_bound(of_part, triangles[i], {}, &NamedTriangles::first_triangle);
        const std::string& name = std::prev(next)->name;
        if (names.empty() || names.back().name != name)
            names.push_back({static_cast<std::uint32_t>(first + i), name});
    }
}

/// The names of the triangles of the high meshes, which are made in the same order.
class IdNames {
  public:
    IdNames(const MeshBakeRequest& request, const std::vector<MapModel>& models) {
        if (!request.layers.has(LayerKind::id)) return;
        for (std::size_t i = 0; i < models.size(); ++i) {
            std::vector<std::vector<NamedTriangles>>& parts = parts_.emplace_back();
            for (const MapModelPart& part : models[i].parts)
                parts.push_back(id_names(part, models[i].materials, request.high[i]));
        }
    }

    void add_piece(const HighPiece& piece) {
        if (parts_.empty()) return;
        append_names(parts_[piece.model][piece.part], piece.triangles, 0, meshes_.emplace_back());
    }
    void add_joined(std::size_t model, const std::vector<MapModelPart>& parts) {
        if (parts_.empty()) return;
        std::vector<NamedTriangles>& names = meshes_.emplace_back();
        std::size_t first = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            for (const NamedTriangles& named : parts_[model][i]) {
                if (parts[i].mesh.triangles.empty()) continue;
                names.push_back(
                    {static_cast<std::uint32_t>(first + named.first_triangle), named.name});
            }
            first += parts[i].mesh.triangles.size();
        }
    }

    [[nodiscard]] std::vector<HighIds> of_meshes(const std::vector<Mesh>& meshes) {
        std::vector<HighIds> ids;
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            if (!meshes_[i].empty()) ids.push_back({&meshes[i], std::move(meshes_[i])});
        }
        return ids;
    }

  private:
    std::vector<std::vector<std::vector<NamedTriangles>>> parts_;  ///< By model and part.
    std::vector<std::vector<NamedTriangles>> meshes_;
};

/// Takes the triangles of a piece out of its model; the model is not used afterwards.
Mesh take_piece(std::vector<MapModel>& models, const HighPiece& piece) {
    Mesh& mesh = models[piece.model].parts[piece.part].mesh;
    return piece.triangles.size() == mesh.triangles.size() ? std::move(mesh)
                                                           : part_of(mesh, piece.triangles);
}

/// Adds the high meshes, pair by pair if parts are paired by name.
/// \return the index of the file of each mesh
std::vector<std::size_t> add_high(const MeshBakeRequest& request, const MapModel& low,
                                  std::vector<MapModel> high, BakeModels& models,
                                  Findings& findings) {
    std::vector<NamedModel> named;
    for (std::size_t i = 0; i < high.size(); ++i)
        named.push_back({request.high[i], &high[i]});
    ModelPairs paired = pair_models(named, {request.low, &low}, request.match);
    findings.add("", paired.report);
    models.unpaired = std::move(paired.unpaired);
    IdNames names(request, high);
    std::vector<std::size_t> file_of;
    for (ModelPair& pair : paired.pairs) {
        BakePair range{pair.name, models.high.size(), pair.high.size(), 0, std::move(pair.low)};
        for (const HighPiece& piece : pair.high) {
            file_of.push_back(piece.model);
            names.add_piece(piece);
            models.high.push_back(take_piece(high, piece));
            range.high_triangles += models.high.back().triangles.size();
        }
        models.pairs.push_back(std::move(range));
    }
    if (!paired.pairs.empty()) {
        models.ids = names.of_meshes(models.high);
        return file_of;
    }
    for (std::size_t i = 0; i < high.size(); ++i) {
        file_of.push_back(i);
        names.add_joined(i, high[i].parts);
        models.high.push_back(join_parts(request.high[i], std::move(high[i])));
    }
    models.ids = names.of_meshes(models.high);
    return file_of;
}

/// Adds the textures of the high meshes, which must be in their final places.
void add_textures(const MeshBakeRequest& request, const std::vector<MapAppearance>& appearances,
                  std::span<const std::size_t> file_of, BakeModels& models, Findings& findings) {
    const HighProperties properties{.colors = request.layers.has(LayerKind::color)};
    std::vector<Report> reports(appearances.size());
    for (std::size_t i = 0; i < models.high.size(); ++i) {
        const std::size_t file = file_of[i];
        models.textures.add(request.high[file], models.high[i], appearances[file], request.textures,
                            properties, reports[file]);
    }
    for (std::size_t file = 0; file < appearances.size(); ++file)
        findings.add(request.high[file].string(), reports[file]);
}

}  // namespace

std::vector<NamedTriangles> id_names(const MapModelPart& part,
                                     const std::vector<std::string>& materials,
                                     const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    const auto object_of = [&](std::size_t triangle) -> const std::string& {
        const std::size_t object = part.object_of.empty() ? 0 : part.object_of[triangle];
        const bool has_name = object < part.objects.size() && !part.objects[object].empty();
        return has_name ? part.objects[object] : stem;
    };
    const std::size_t count = part.mesh.triangles.size();
    std::vector<MaterialRange> ranges = part.mesh.material_ranges;
    if (ranges.empty()) ranges.push_back({0, static_cast<std::uint32_t>(count), std::nullopt});
    const std::vector<NamedTriangles> by_material = names_by_material(part.mesh, materials);
    std::vector<NamedTriangles> names;
    for (const MaterialRange& range : ranges) {
        const std::size_t end = std::size_t{range.first_triangle} + range.triangle_count;
        for (std::size_t i = range.first_triangle; i < end; ++i) {
            const bool is_first = i == range.first_triangle;
            if (range.material && !is_first) break;
            const std::string& name = range.material
                                          ? std::ranges::find(by_material, range.first_triangle,
                                                              &NamedTriangles::first_triangle)
                                                ->name
                                          : object_of(i);
            if (names.empty() || names.back().name != name)
                names.push_back({static_cast<std::uint32_t>(i), name});
        }
    }
    return names;
}

ModelPairs pair_models(std::span<const NamedModel> high, const NamedModel& low,
                       PartMatching matching) {
    ModelPairs pairs = pair_parts(high, low, matching);
    require_counterparts(low.file, pairs.unmatched_low);
    return pairs;
}

namespace {

/// The same file may be read as a normal map, a color and data.
std::string image_key(const std::string& name, TextureSlot slot) {
    return fmt::format("{} {} {}", name, static_cast<int>(slot_info(slot).use),
                       slot == TextureSlot::normal);
}

}  // namespace

std::shared_ptr<const Image> HighTextures::image(const std::filesystem::path& file,
                                                 TextureSlot slot) {
    const std::string key = image_key(file.string(), slot);
    const auto known = images_.find(key);
    if (known != images_.end()) return known->second;
    const auto added = std::make_shared<const Image>(slot == TextureSlot::normal
                                                         ? read_normal_map_image(file)
                                                         : read_image(file, slot_info(slot).use));
    images_[key] = added;
    metadata_[added.get()] = read_image_info(file).metadata;
    names_[added.get()] = file;
    return added;
}

std::shared_ptr<const Image> HighTextures::image(const std::filesystem::path& model,
                                                 const MapAppearance& appearance, std::size_t index,
                                                 TextureSlot slot) {
    const GltfImage& source = appearance.images[index];
    const char* remedy = "put it there, or use --high-normal-map none, --high-color none";
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) {
        if (!std::filesystem::exists(*file))
            throw failure(model, fmt::format("image {} is missing", file->string()), remedy);
        return image(*file, slot);
    }
    const std::string name = fmt::format("{}, image {}", model.string(), index);
    const std::string key = image_key(name, slot);
    const auto known = images_.find(key);
    if (known != images_.end()) return known->second;
    const auto& bytes = std::get<std::vector<std::byte>>(source.source);
    if (bytes.empty()) {
        throw failure(model, fmt::format("image {} is outside of its folder", index), remedy);
    }
    const auto added = std::make_shared<const Image>(read_image(bytes, name, slot_info(slot).use));
    images_[key] = added;
    metadata_[added.get()] = read_image_info(bytes, name).metadata;
    names_[added.get()] = name;
    return added;
}

SurfaceTexture HighTextures::texture(const std::filesystem::path& model,
                                     const MapAppearance& appearance, const GltfMaterial& material,
                                     TextureSlot slot) {
    const Texture& texture = *find_texture(material, slot);
    return {image(model, appearance, texture.image, slot), texture.wrap_u, texture.wrap_v,
            texture.filter, material.texcoords_of(slot).transform};
}

SurfaceNormalMap HighTextures::normal_map(const SurfaceTexture& texture, float scale,
                                          const AssumedKinds& assumed) const {
    const Image& map = *texture.image;
    const MapInput input = {names_.at(&map), {MapKind::normal}, metadata_.at(&map), map.channels};
    if (!check_stated_kind(input, assumed)) check_judged_kind(input, map);
    const MapDescription stated = read_description(input.metadata);
    SurfaceNormalMap result{
        texture, scale, stated.green.value_or(Green::up), stated.flat.value_or(FlatCode::half), {}};
    if (result.flat == FlatCode::half) result.flat_codes = flat_texel_codes(map);
    return result;
}

SurfaceTexture HighTextures::color(const SurfaceTexture& texture,
                                   const AssumedKinds& assumed) const {
    const Image& map = *texture.image;
    check_stated_kind({names_.at(&map), {MapKind::color}, metadata_.at(&map)}, assumed);
    return texture;
}

void HighTextures::add_alpha(const BakedAlpha& alpha) {
    if (!alpha_) alpha_ = alpha;
    if (*alpha_ != alpha) alpha_ = BakedAlpha{AlphaMode::blend, alpha.cutoff};
}

namespace {

/// Returns whether an image has alpha below 1 in any texel.
bool has_transparency(const Image& image) {
    const auto channels = static_cast<std::size_t>(image.channels);
    if (channels != 2 && channels != 4) return false;
    return std::visit(
        [&]<typename Sample>(const std::vector<Sample>& samples) {
            const Sample full =
                std::is_floating_point_v<Sample> ? Sample{1} : std::numeric_limits<Sample>::max();
            for (std::size_t i = channels - 1; i < samples.size(); i += channels) {
                if (samples[i] < full) return true;
            }
            return false;
        },
        image.samples);
}

}  // namespace

namespace {

/// Returns the texture coordinate set that the meshes of a material have
/// (GltfDocument::tangent_texcoords()).
int set_of_meshes(const GltfMaterial& material) {
    for (const TextureSlot slot :
         {TextureSlot::normal, TextureSlot::clearcoat_normal, TextureSlot::anisotropy}) {
        if (find_texture(material, slot) != nullptr) return material.texcoords_of(slot).set;
    }
    return 0;
}

float share(float factor) {
    return std::clamp(factor, 0.0F, 1.0F);
}

}  // namespace

void HighTextures::add_texture(const std::filesystem::path& model, const MapAppearance& appearance,
                               std::size_t material, TextureSlot slot,
                               std::optional<SurfaceTexture>& target, Report& report) {
    const GltfMaterial& source = appearance.materials[material];
    if (find_texture(source, slot) == nullptr) return;
    if (source.texcoords_of(slot).set != set_of_meshes(source)) {
        const char* name = slot == TextureSlot::base_color ? "color" : slot_info(slot).name;
        report.add(fmt::format("{} texture on another texture coordinate set", name), "material",
                   material, "is left out");
        return;
    }
    target = texture(model, appearance, source, slot);
    ++textures_[slot];
}

void HighTextures::add_surface(const std::filesystem::path& model, const MapAppearance& appearance,
                               std::size_t index, HighMaterial& material, Report& report) {
    const GltfMaterial& source = appearance.materials[index];
    material.roughness = share(source.metallic_roughness->roughness);
    material.metallic = share(source.metallic_roughness->metallic);
    add_texture(model, appearance, index, TextureSlot::metallic_roughness, material.surface_texture,
                report);
    material.occlusion_strength = share(source.occlusion_strength);
    add_texture(model, appearance, index, TextureSlot::occlusion, material.occlusion_texture,
                report);
}

void HighTextures::add_emission(const std::filesystem::path& model, const MapAppearance& appearance,
                                std::size_t index, HighMaterial& material, Report& report) {
    const GltfMaterial& source = appearance.materials[index];
    add_texture(model, appearance, index, TextureSlot::emission, material.emission_texture, report);
    // Without its texture, the surface would glow as a whole.
    const bool is_left_out = source.emission_texture && !material.emission_texture;
    if (!is_left_out) material.emission = glm::max(source.emission, 0.0F);
}

void HighTextures::add(const std::filesystem::path& file, const Mesh& mesh,
                       const MapAppearance& appearance, const HighTextureOptions& options,
                       const HighProperties& properties, Report& report) {
    const bool with_colors = properties.colors;
    HighMaterials detail{&mesh, {}, {}};
    for (std::size_t i = 0; i < appearance.materials.size(); ++i) {
        const GltfMaterial& source = appearance.materials[i];
        HighMaterial material;
        if (source.normal_map && !options.normal_map) {
            material.normal_map = normal_map(texture(file, appearance, source, TextureSlot::normal),
                                             source.normal_map->scale, options.assumed);
            ++normal_maps_;
        }
        if (with_colors && !options.color) {
            material.color = source.metallic_roughness->base_color;
            if (source.alpha_mode != AlphaMode::opaque) {
                material.opacity = source.opacity;
                add_alpha({source.alpha_mode, source.alpha_cutoff});
            }
        }
        if (with_colors && !options.color) {
            add_texture(file, appearance, i, TextureSlot::base_color, material.color_texture,
                        report);
            if (material.color_texture)
                material.color_texture = color(*material.color_texture, options.assumed);
        }
        if (properties.surfaces) add_surface(file, appearance, i, material, report);
        if (properties.emission) add_emission(file, appearance, i, material, report);
        detail.materials.push_back(std::move(material));
    }
    // Textures that options give apply to the whole mesh.
    const bool has_normal_map = options.normal_map && !options.normal_map->empty();
    const bool has_color = with_colors && options.color && !options.color->empty();
    if (has_normal_map || has_color) detail.otherwise.emplace();
    const auto set_textures = [&](HighMaterial& material) {
        if (has_normal_map) {
            const SurfaceTexture texture{.image = image(*options.normal_map, TextureSlot::normal)};
            material.normal_map = normal_map(texture, 1.0F, options.assumed);
        }
        if (!has_color) return;
        material.color_texture =
            color({.image = image(*options.color, TextureSlot::base_color)}, options.assumed);
        if (!has_transparency(*material.color_texture->image)) return;
        material.opacity = 1.0F;
        add_alpha({AlphaMode::blend, 0.5F});
    };
    for (HighMaterial& material : detail.materials)
        set_textures(material);
    if (detail.otherwise) set_textures(*detail.otherwise);
    normal_maps_ += has_normal_map ? 1 : 0;
    if (has_color) ++textures_[TextureSlot::base_color];
    materials_.push_back(std::move(detail));
}

std::string HighTextures::description() const {
    std::string text;
    if (normal_maps_ > 0) text = counted(normal_maps_, "normal map") + " added to their normals";
    for (const auto& [slot, count] : textures_) {
        const std::string name = slot == TextureSlot::base_color ? "color" : slot_info(slot).name;
        text += (text.empty() ? "" : ", ") + counted(count, name + " texture");
    }
    return text;
}

BakeModels read_bake_models(const MeshBakeRequest& request, Findings& findings) {
    BakeModels models;
    Progress opened;
    const ProgressScope scope(opened);
    MapModel low = read(request.low, findings);
    require_texcoords(request.low, low, "no texture coordinates, which a map needs",
                      "unwrap it with relief-mesh unwrap");
    std::vector<MapModel> high;
    std::vector<MapAppearance> appearances;
    for (const std::filesystem::path& file : request.high) {
        high.push_back(read_with_origin(low.origin, file, findings));
        appearances.push_back(std::move(high.back().appearance));
    }
    if (request.cage) {
        models.cage = std::make_shared<const Mesh>(
            join_parts(*request.cage, read_with_origin(low.origin, *request.cage, findings)));
    }
    const std::vector<std::size_t> file_of =
        add_high(request, low, std::move(high), models, findings);
    add_textures(request, appearances, file_of, models, findings);
    models.files = names_of(opened.files());
    for (const MapAppearance& appearance : appearances) {
        for (const GltfImage& image : appearance.images) {
            if (const auto* file = std::get_if<std::filesystem::path>(&image.source))
                models.files.push_back(*file);
        }
    }
    models.materials = low.materials;
    models.world_from_low = low.world_from_object;
    models.origin = low.origin;
    models.low = join_parts(request.low, std::move(low));
    return models;
}

glm::dmat3 output_axes(const MeshBakeRequest& request,
                       const std::optional<glm::dmat3>& world_from_low) {
    if (request.bake.space != VectorSpace::object) return glm::dmat3(1.0);
    if (!world_from_low) {
        throw failure(request.low, "has several primitives, and therefore no single object space",
                      "use --space world or tangent");
    }
    // Normals transform with the inverse transpose of the matrix of positions.
    return glm::transpose(*world_from_low);
}

// Bounding boxes, and the share of texels whose rays hit nothing.

namespace {

constexpr double estimate_margin = 5.0;  // Error of the estimate, in percent points.

std::string high_name(const MeshBakeRequest& request) {
    return request.high.size() == 1 ? request.high[0].string()
                                    : counted(request.high.size(), "high model");
}

std::string to_text(const glm::dvec3& point) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", point.x, point.y, point.z);
}

/// "(0, 0, 0) to (1, 1, 1), diagonal 1.732", in world space.
std::string to_text(const Bounds& box, const glm::dvec3& origin) {
    if (box.empty()) return "empty";
    const glm::dvec3 min(box.min), max(box.max);
    return fmt::format("{} to {}, diagonal {:.4g}", to_text(min + origin), to_text(max + origin),
                       glm::length(max - min));
}

std::string describe_boxes(const MeshBakeRequest& request, const BakeFit& fit,
                           const glm::dvec3& origin) {
    const std::string cause = likely_cause(fit);
    return fmt::format("the bounding box of {} is {}; that of {} is {}{}{}", high_name(request),
                       to_text(fit.high, origin), request.low.string(), to_text(fit.low, origin),
                       cause.empty() ? "" : "; ", cause);
}

FileError mismatch_error(const MeshBakeRequest& request, const BakeMismatch& mismatch,
                         const glm::dvec3& origin) {
    const BakeFit& fit = mismatch.fit();
    const std::string part =
        mismatch.part().empty() ? "" : fmt::format("part '{}': ", mismatch.part());
    const std::string file = high_name(request);
    if (mismatch.kind() == BakeMismatch::Kind::no_surface) {
        return failure(file, part + "has no triangle with finite corners",
                       "nothing can be baked from it");
    }
    const std::string boxes = describe_boxes(request, fit, origin);
    if (mismatch.kind() == BakeMismatch::Kind::size) {
        const double ratio = fit.size_ratio;
        return failure(
            file,
            fmt::format("{}is {:.4g} times as {} as {}: {}", part, std::max(ratio, 1.0 / ratio),
                        ratio > 1.0 ? "large" : "small", request.low.string(), boxes),
            "scale one of them, or give --allow-size-mismatch");
    }
    return failure(file,
                   fmt::format("{}is {:.4g} away from {}, but rays are only {:.4g} long: {}", part,
                               fit.gap, request.low.string(), mismatch.reach(), boxes),
                   request.cage ? "move one of them, or move the cage outwards"
                                : "move one of them, or give a longer --offset and --max-distance");
}

/// A length rounded up to four digits, after adding a thousandth, so that it is never too short.
std::string length_text(double length) {
    const double longer = 1.001 * length;
    const double unit = std::pow(10.0, std::floor(std::log10(longer)) - 3.0);
    return fmt::format("{:.4g}", std::ceil(longer / unit) * unit);
}

/// "312 of them would be hit with --offset 0.12, half of those with 0.08"
std::string clipped_text(const ClippedRays& clipped, const std::string& remedy) {
    std::string text = fmt::format("{} of them would be hit with {} {}", clipped.texels, remedy,
                                   length_text(clipped.longest));
    if (clipped.half < clipped.longest)
        text += fmt::format(", half of those with {}", length_text(clipped.half));
    return text;
}

/// Describes the missed texels that longer rays, or rays that accept back faces, would hit.
std::vector<std::string> ray_lines(const MeshBakeRequest& request, const BakeResult& result) {
    std::vector<std::string> lines;
    if (result.clipped_outside.texels > 0) {
        lines.push_back(clipped_text(result.clipped_outside,
                                     request.cage ? "the cage moved outwards by" : "--offset"));
    }
    if (result.clipped_inside.texels > 0)
        lines.push_back(clipped_text(result.clipped_inside, "--max-distance"));
    if (result.missed_from_behind > 0) {
        lines.push_back(
            fmt::format("{} of them see only back faces of {} (flip its faces, or give "
                        "--back-faces take)",
                        result.missed_from_behind, high_name(request)));
    }
    return lines;
}

/// \param measured  the place of an estimate: " of a map of 256 x 256"; empty: the map itself
/// \param boxes     describe_boxes()
FileError missed_error(const MeshBakeRequest& request, const std::string& boxes,
                       const std::string& map, const BakeResult& result,
                       const std::string& measured) {
    const std::size_t all = result.texels_missed + result.texels_baked;
    const std::string share =
        result.texels_baked == 0
            ? fmt::format("no ray hits {}: all {} texels{} are missed", high_name(request), all,
                          measured)
            : fmt::format(
                  "the rays of {} of {} texels{} ({:.3g} %) hit nothing, more than the "
                  "{:g} % of --max-missed",
                  result.texels_missed, all, measured,
                  missed_percent(result.texels_missed, result.texels_baked),
                  request.missed_limit());
    std::string problem = fmt::format("{}{}{}; {}", map, map.empty() ? "" : ": ", share, boxes);
    for (const std::string& line : ray_lines(request, result))
        problem += "; " + line;
    return failure(request.low, problem,
                   result.texels_baked == 0 ? "nothing is written"
                                            : "nothing is written; --max-missed allows more");
}

bool misses_too_much(const BakeResult& result, double limit) {
    if (result.texels_missed == 0) return false;
    return result.texels_baked == 0 ||
           missed_percent(result.texels_missed, result.texels_baked) > limit;
}

}  // namespace

double missed_percent(std::size_t missed, std::size_t baked) {
    return missed == 0 ? 0.0
                       : 100.0 * static_cast<double>(missed) / static_cast<double>(missed + baked);
}

Baker make_baker(const MeshBakeRequest& request, const BakeModels& models,
                 const BakeOptions& options, Report& report) {
    try {
        if (models.pairs.empty()) return {models.high, models.low, options, report};
        std::vector<BakePart> parts;
        for (const BakePair& pair : models.pairs) {
            parts.push_back({std::span(models.high).subspan(pair.first_high, pair.high_count),
                             pair.low, pair.name});
        }
        return {parts, models.low, options, report};
    } catch (const BakeMismatch& mismatch) {
        throw mismatch_error(request, mismatch, models.origin);
    }
}

std::string describe_fit(const MeshBakeRequest& request, const BakeModels& models) {
    return describe_boxes(request, compare_boxes(models.high, models.low), models.origin);
}

void check_missed(const MeshBakeRequest& request, const BakeFit& fit, const glm::dvec3& origin,
                  const std::string& map, const BakeResult& result) {
    if (misses_too_much(result, request.missed_limit()))
        throw missed_error(request, describe_boxes(request, fit, origin), map, result, "");
}

FileError uncovered_error(const MeshBakeRequest& request, const Mesh& low) {
    glm::vec2 min(std::numeric_limits<float>::infinity());
    glm::vec2 max = -min;
    for (const glm::uvec3& triangle : low.triangles) {
        for (int i = 0; i < 3; ++i) {
            const glm::vec2& texcoord = low.texcoords[triangle[i]];
            if (!std::isfinite(texcoord.x) || !std::isfinite(texcoord.y)) continue;
            min = glm::min(min, texcoord);
            max = glm::max(max, texcoord);
        }
    }
    if (!(min.x <= max.x)) {
        return failure(request.low, "covers no texel of the map: no texture coordinates are finite",
                       "unwrap it with relief-mesh unwrap; nothing is written");
    }
    const bool is_outside = !request.bake.map.placement.repeat &&
                            (min.x < 0.0F || min.y < 0.0F || max.x > 1.0F || max.y > 1.0F);
    return failure(
        request.low,
        fmt::format("covers no texel of the map: its texture coordinates are ({:.4g}, {:.4g}) to "
                    "({:.4g}, {:.4g}){}",
                    min.x, min.y, max.x, max.y,
                    is_outside ? ", outside of the unit square" : ", without any area"),
        is_outside ? "give --outside repeat, or <UDIM> in the map's name; nothing is written"
                   : "unwrap it with relief-mesh unwrap; nothing is written");
}

void check_missed_early(const MeshBakeRequest& request, const BakeModels& models,
                        const Baker& baker, const BakeMapOptions& map, const std::string& name) {
    const double limit = request.missed_limit() + estimate_margin;
    if (limit >= 100.0) return;
    // The estimate is not faster than the bake of a small map, but faster than measuring errors.
    const double texels = static_cast<double>(map.width) * static_cast<double>(map.height);
    if (!request.measures_errors() && texels <= 2.0 * estimate_texels) return;
    const MissedEstimate estimate = estimate_missed(baker, map);
    if (!misses_too_much(estimate.result, limit)) return;
    throw missed_error(request, describe_fit(request, models), name, estimate.result,
                       fmt::format(" of a map of {} x {}", estimate.width, estimate.height));
}

std::vector<std::string> missed_lines(const MeshBakeRequest& request, const BakeResult& result,
                                      const glm::dvec3& origin) {
    constexpr std::size_t max_places = 4;
    std::vector<std::string> lines;
    if (result.texels_missed == 0) return lines;
    std::string places;
    for (std::size_t i = 0; i < std::min(max_places, result.first_missed.size()); ++i) {
        const MissedTexel& texel = result.first_missed[i];
        places += fmt::format("{}column {}, row {} at {}", i == 0 ? "" : "; ", texel.x, texel.y,
                              to_text(texel.position + origin));
    }
    if (result.texels_missed > max_places) places += "; ...";
    lines.push_back(fmt::format("{}, {:.3g} % of those covered: {}",
                                counted(result.texels_missed, "texel"),
                                missed_percent(result.texels_missed, result.texels_baked), places));
    std::ranges::move(ray_lines(request, result), std::back_inserter(lines));
    return lines;
}

std::string swapped_models_warning(const MeshBakeRequest& request, std::size_t high_triangles,
                                   std::size_t low_triangles) {
    if (low_triangles / 4 <= high_triangles) return "";
    return fmt::format(
        "{}: has {}, more than four times as many as the high model, {} (are they swapped? "
        "HIGH comes before LOW)",
        request.low.string(), counted(low_triangles, "triangle"), high_triangles);
}

}  // namespace relief::tools
