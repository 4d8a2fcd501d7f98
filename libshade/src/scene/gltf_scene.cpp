// SPDX-License-Identifier: Apache-2.0
// glTF documents as scene graphs. Primitives become meshes (one for each, however many instances it
// has) with the texture coordinates that their material uses, light units become irradiance over
// pi, and node animations become key frames. Materials stay metallic-roughness, or become Phong's
// with the means of the textures that Phong has no place for. World space is glTF's; colors are
// linear. Factors that glTF forbids count as the nearest allowed ones. What cannot be drawn as
// intended is counted in the report; scene_file.h has the list. Source: glTF 2.0, section 3.9.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_fields.h"
#include "relief/shade/scene_file.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

// Mean colors of images

namespace {

double decoded(double sample, ColorSpace space) {
    return space == ColorSpace::srgb
               ? static_cast<double>(linear_from_srgb(static_cast<float>(sample)))
               : sample;
}

/// Returns the mean of one channel of integer codes: codes are counted first and decoded once each.
template <typename Code>
double mean_of_codes(const std::vector<Code>& samples, std::size_t channel, std::size_t channels,
                     ColorSpace space) {
    constexpr std::size_t code_count = std::size_t{1} << (8 * sizeof(Code));
    std::vector<std::size_t> counts(code_count, 0);
    for (std::size_t i = channel; i < samples.size(); i += channels)
        ++counts[samples[i]];
    double sum = 0.0;
    for (std::size_t code = 0; code < code_count; ++code) {
        if (counts[code] == 0) continue;
        const double value =
            static_cast<double>(code) / static_cast<double>(std::numeric_limits<Code>::max());
        sum += static_cast<double>(counts[code]) * decoded(value, space);
    }
    return sum / static_cast<double>(samples.size() / channels);
}

double mean_of_floats(const std::vector<float>& samples, std::size_t channel, std::size_t channels,
                      ColorSpace space) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = channel; i < samples.size(); i += channels) {
        if (!std::isfinite(samples[i])) continue;
        sum += decoded(samples[i], space);
        ++count;
    }
    return count == 0 ? 1.0 : sum / static_cast<double>(count);
}

}  // namespace

glm::vec3 detail::mean_color(const Image& image) {
    if (image.empty()) return glm::vec3(1.0F);
    const auto channels = static_cast<std::size_t>(image.channels);
    glm::vec3 mean(1.0F);
    for (int i = 0; i < 3; ++i) {
        const std::size_t channel = channels < 3 ? 0 : static_cast<std::size_t>(i);
        mean[i] = static_cast<float>(std::visit(
            [&](const auto& samples) {
                using Sample = typename std::decay_t<decltype(samples)>::value_type;
                if constexpr (std::is_same_v<Sample, float>) {
                    return mean_of_floats(samples, channel, channels, image.color_space);
                } else {
                    return mean_of_codes(samples, channel, channels, image.color_space);
                }
            },
            image.samples));
    }
    return mean;
}

// Materials

namespace {

/// The smallest roughness that the exponent of the highlight represents.
constexpr float min_roughness = 0.045F;
/// tan^2 of 3 degrees: facets with a smaller tilt mirror a recognizable picture.
constexpr float mirror_tan_squared = 0.0027465F;

/// Returns the allowed value of a foreign factor that is nearest. NaN counts as the minimum, and a
/// number without limits that is not finite counts as absent.
template <typename Owner>
float allowed(float value, const SceneField<Owner, float>& field) {
    const FieldRange& range = field.range;
    if (range == FieldRange{}) return std::isfinite(value) ? value : field.default_value();
    return value > range.min ? std::min(value, range.max) : range.min;
}
template <typename Owner>
glm::vec3 allowed(const glm::vec3& color, const SceneField<Owner, glm::vec3>& field) {
    return {usable(color.r, field.range.max), usable(color.g, field.range.max),
            usable(color.b, field.range.max)};
}
template <typename Owner>
std::optional<float> allowed(const std::optional<float>& value,
                             const SceneField<Owner, std::optional<float>>& field) {
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return std::max(*value, field.range.min);
}

/// Returns the model with factors that glTF forbids as the nearest allowed ones. An index of 0 is
/// allowed, others begin at 1.
MetallicRoughness allowed(MetallicRoughness model) {
    for_each_field<MetallicRoughness>([&](const auto& field) {
        auto& value = model.*field.member;
        if constexpr (requires { allowed(value, field); }) value = allowed(value, field);
    });
    if (model.refractive_index > 0.0F)
        model.refractive_index = std::max(model.refractive_index, 1.0F);
    return model;
}

}  // namespace

Material phong_from_metallic_roughness(const Material& material, const TextureMeans& means) {
    const MetallicRoughness model = allowed(*material.metallic_roughness);
    const glm::vec3& base = model.base_color;
    const float metallic = usable(material.metallic_roughness->metallic * means.metallic, 1.0F);
    const float roughness = std::max(
        usable(material.metallic_roughness->roughness * means.roughness, 1.0F), min_roughness);
    const float alpha_squared = roughness * roughness * roughness * roughness;
    const glm::vec3 dielectric = dielectric_reflectance(model);
    const glm::vec3 f0 = glm::mix(dielectric, base * means.base_color, metallic);
    const float mirror = mirror_tan_squared / (mirror_tan_squared + alpha_squared);

    Material phong;
    phong.name = material.name;
    phong.specular_model = SpecularModel::blinn_phong;
    phong.shininess = 2.0F / alpha_squared - 2.0F;
    phong.specular = f0 * ((phong.shininess + 2.0F) / 8.0F);
    phong.reflectivity = f0 * mirror;
    phong.grazing_reflectivity =
        glm::vec3(mirror * (1.0F + (model.specular - 1.0F) * (1.0F - metallic)));
    phong.diffuse = base * (1.0F - metallic);
    phong.ambient = phong.diffuse + glm::mix(dielectric, base, metallic);
    phong.emission = usable(material.emission, max_reflectance);
    phong.double_sided = material.double_sided;
    phong.unlit = material.unlit;
    if (material.unlit) phong.diffuse = base;
    return phong;
}

namespace {

/// The two sets of texture coordinates that a mesh of the scene carries for a material. The first
/// are those of the maps in the tangent frame, or else of the material's first texture, in the
/// order of TextureSlot. The second are the next ones that differ.
struct TexcoordSources {
    GltfTexcoords first;
    std::optional<GltfTexcoords> second = std::nullopt;
};

TexcoordSources texcoord_sources(const GltfMaterial& material) {
    std::optional<GltfTexcoords> first;
    std::optional<GltfTexcoords> second;
    for (const bool in_tangent_frame : {true, false}) {
        for (const TextureSlotInfo& slot : texture_slots) {
            if (slot.in_tangent_frame != in_tangent_frame) continue;
            if (find_texture(material, slot.slot) == nullptr) continue;
            const GltfTexcoords& source = material.texcoords_of(slot.slot);
            if (!first) first = source;
            if (!second && source != *first) second = source;
        }
    }
    return {first.value_or(GltfTexcoords{}), second};
}

/// Returns the texture of the scene, or none if its mesh has no coordinates for it.
std::optional<Texture> texture_from(const GltfMaterial& read, const TextureSlotInfo& slot,
                                    const TexcoordSources& sources, std::size_t material,
                                    Report& report) {
    Texture result = *find_texture(read, slot.slot);
    const GltfTexcoords& source = read.texcoords_of(slot.slot);
    if (source == sources.first) return result;
    if (source == sources.second && !slot.in_tangent_frame) {
        result.second_texcoords = true;
        return result;
    }
    if (source.set != sources.first.set) {
        report.add("texture on a further texture coordinate set", "material", material, "left out");
        return std::nullopt;
    }
    report.add("texture transform of its own", "material", material,
               "drawn with that of the material's first texture");
    return result;
}

/// The mean of an image's texels, or the error of decoding it.
using MeanOrError = std::variant<glm::vec3, std::string>;

/// \param keep  the image stays decoded, so that drawing need not decode it again
MeanOrError mean_of(ImageSource& image, ImageUse use, bool keep) {
    try {
        Image decoded = decode(image, use);
        const glm::vec3 mean = mean_color(decoded);
        if (keep) image.source = std::move(decoded);
        return mean;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        return error.what();
    }
}

/// The means of one kind of texture over all materials that request them. Each image is decoded
/// once, on all threads.
class MeansOfImages {
  public:
    MeansOfImages(std::vector<ImageSource>& images, ImageUse use, const std::vector<bool>& keep)
        : images_(images), use_(use), keep_(keep) {}

    void request(std::size_t image) { means_.try_emplace(image); }

    void decode_all() {
        std::vector<std::size_t> requested;
        for (const auto& [image, mean] : means_)
            requested.push_back(image);
        std::vector<MeanOrError> results(requested.size());
        ProgressStage stage("images", requested.size());
        parallel_for(requested.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                results[i] = mean_of(images_[requested[i]], use_, keep_[requested[i]]);
                stage.advance(1);
            }
        });
        for (std::size_t i = 0; i < requested.size(); ++i)
            means_[requested[i]] = results[i];
    }

    /// Returns the mean; 1 if the image could not be read, which is reported.
    glm::vec3 mean(std::size_t image, const char* texture, const std::string& material,
                   Report& report) const {
        const MeanOrError& result = means_.at(image);
        if (const auto* mean = std::get_if<glm::vec3>(&result)) return *mean;
        report.add(fmt::format("unreadable {} of {} for its mean", texture, material), "image",
                   image,
                   "counts as 1 in the material's Phong equivalent: " +
                       with_origin(images_[image], std::get<std::string>(result)));
        return glm::vec3(1.0F);
    }

  private:
    std::vector<ImageSource>& images_;
    ImageUse use_;
    const std::vector<bool>& keep_;
    std::map<std::size_t, MeanOrError> means_;
};

/// Returns the images that are used as color textures only.
std::vector<bool> color_only(const GltfView& view) {
    std::vector<bool> result(view.images.size(), true);
    for (const GltfMaterial& material : view.materials) {
        for (const TextureSlotInfo& slot : texture_slots) {
            const Texture* const texture = find_texture(material, slot.slot);
            if (texture != nullptr && slot.use != ImageUse::color) result[texture->image] = false;
        }
    }
    return result;
}

std::string label(const GltfView& view, std::size_t material) {
    const std::string& name = view.materials[material].name;
    return name.empty() ? fmt::format("material {}", material) : fmt::format("material '{}'", name);
}

std::vector<TextureMeans> texture_means(const GltfView& view, std::vector<ImageSource>& images,
                                        Report& report) {
    const std::size_t count = view.materials.size();
    std::vector<TextureMeans> means(count);

    const std::vector<bool> keep_none(images.size(), false);
    MeansOfImages surfaces(images, ImageUse::data, keep_none);
    const auto has_surface = [&](const GltfMaterial& material) {
        const MetallicRoughness& model = *material.metallic_roughness;
        return model.texture && !material.unlit &&
               (model.metallic > 0.0F || model.roughness > 0.0F);
    };
    for (const GltfMaterial& material : view.materials) {
        if (has_surface(material)) surfaces.request(material.metallic_roughness->texture->image);
    }
    surfaces.decode_all();
    for (std::size_t i = 0; i < count; ++i) {
        if (!has_surface(view.materials[i])) continue;
        const glm::vec3 mean = surfaces.mean(view.materials[i].metallic_roughness->texture->image,
                                             "metallic-roughness texture", label(view, i), report);
        means[i].roughness = mean.y;
        means[i].metallic = mean.z;
    }

    // The mean of a base color tints reflections, and only those of metals.
    const std::vector<bool> keep = color_only(view);
    MeansOfImages colors(images, ImageUse::color, keep);
    const auto is_textured_metal = [&](std::size_t i) {
        const GltfMaterial& material = view.materials[i];
        return material.diffuse_texture && !material.unlit &&
               material.metallic_roughness->metallic * means[i].metallic > 0.0F;
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (is_textured_metal(i)) colors.request(view.materials[i].diffuse_texture->image);
    }
    colors.decode_all();
    for (std::size_t i = 0; i < count; ++i) {
        if (!is_textured_metal(i)) continue;
        means[i].base_color = colors.mean(view.materials[i].diffuse_texture->image,
                                          "diffuse texture", label(view, i), report);
    }
    return means;
}

/// Sets textures and alpha, which are the same in both material models.
void add_textures(Material& result, const GltfMaterial& material, std::size_t index,
                  Report& report) {
    const TexcoordSources sources = texcoord_sources(material);
    for (const TextureSlotInfo& slot : texture_slots) {
        if (find_texture(material, slot.slot) == nullptr) continue;
        if (is_of_metallic_roughness(slot) && !result.metallic_roughness) continue;
        if (const auto texture = texture_from(material, slot, sources, index, report)) {
            set_texture(result, slot.slot, *texture);
        } else {
            remove_texture(result, slot.slot);
        }
    }
    if (result.normal_map) result.normal_map->scale = material.normal_map->scale;
    // As for a texture that cannot be read: most texels are black.
    if (material.emission_texture && !result.emission_texture) result.emission = glm::vec3(0.0F);
    result.occlusion_strength = usable(material.occlusion_strength, 1.0F);
    result.alpha_mode = material.alpha_mode;
    result.opacity = usable(material.opacity, 1.0F);
    result.alpha_cutoff = usable(material.alpha_cutoff, max_reflectance);
}

/// Reports what the file asks for and no effect draws.
void add_undrawn_extensions(Material& result, const GltfMaterial& material, std::size_t index,
                            const std::vector<std::string>& required, Report& report) {
    std::vector<std::string>& names = result.undrawn_extensions;
    names = material.more_extensions;
    // Phong's model has neither layers nor films nor anisotropy.
    if (!result.metallic_roughness && !result.unlit) {
        const MetallicRoughness& model = *material.metallic_roughness;
        if (model.anisotropy > 0.0F) names.emplace_back("KHR_materials_anisotropy");
        if (model.iridescence > 0.0F) names.emplace_back("KHR_materials_iridescence");
        if (model.clearcoat > 0.0F) names.emplace_back("KHR_materials_clearcoat");
        if (model.sheen_color != glm::vec3(0.0F)) names.emplace_back("KHR_materials_sheen");
        if (model.transmission > 0.0F) names.emplace_back("KHR_materials_transmission");
        std::sort(names.begin(), names.end());
    }
    for (const std::string& name : names) {
        const bool is_required =
            std::find(required.begin(), required.end(), name) != required.end();
        report.add(is_required ? name + ", which the file requires" : name, "material", index,
                   is_required ? "not drawn: the picture is not the intended one"
                               : "left out: drawn without it");
    }
}

/// Returns the materials of the document, in order. For MaterialModel::phong some images are
/// decoded for their means, and kept decoded if nothing else needs their bytes.
std::vector<Material> materials_from(const GltfView& view, const SceneOptions& options,
                                     std::vector<ImageSource>& images, Report& report) {
    const bool phong = options.model == SceneOptions::MaterialModel::phong;
    std::vector<TextureMeans> means(view.materials.size());
    if (phong) means = texture_means(view, images, report);
    std::vector<Material> materials;
    for (std::size_t i = 0; i < view.materials.size(); ++i) {
        const GltfMaterial& material = view.materials[i];
        Material& result =
            materials.emplace_back(phong_from_metallic_roughness(material, means[i]));
        if (!phong && !material.unlit)
            result.metallic_roughness = allowed(*material.metallic_roughness);
        add_textures(result, material, i, report);
        add_undrawn_extensions(result, material, i, view.required_extensions, report);
    }
    return materials;
}

// Nodes, meshes, lights, cameras and animations

std::vector<std::string> variant_names(const GltfView& view) {
    std::vector<std::string> names = view.material_variants;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) names[i] = fmt::format("variant {}", i + 1);
    }
    return names;
}

/// Returns the index of the variant that the options select; none for the primitives' own
/// materials. \throws InvalidInput if there is no such variant
std::optional<std::size_t> variant_of(const GltfView& view, const SceneOptions& options) {
    if (!options.material_variant) return std::nullopt;
    const std::vector<std::string> names = variant_names(view);
    const auto found = std::find(names.begin(), names.end(), *options.material_variant);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (*options.material_variant == fmt::format("{}", i + 1)) return i;
    }
    throw InvalidInput(
        fmt::format("no material variant '{}' among: {}", *options.material_variant,
                    names.empty() ? "none" : fmt::to_string(fmt::join(names, ", "))));
}

/// A document that is read as a scene, and how.
struct ReadDocument {
    const GltfDocument& document;
    const GltfView& view;
    const SceneOptions& options;
    std::optional<std::size_t> variant = variant_of(view, options);

    /// Returns a primitive with the material of the variant.
    [[nodiscard]] Mesh mesh(GltfPrimitiveId id, int texcoord_set = 0) const {
        Mesh result = document.mesh(id, texcoord_set);
        if (!variant || result.material_ranges.empty()) return result;
        if (const auto material = document.variant_material(id, *variant))
            result.material_ranges.front().material = static_cast<std::uint32_t>(*material);
        return result;
    }
};

/// Returns a primitive with the texture coordinates at which its material looks up its images. Its
/// tangents belong to the stored coordinates, so they are transformed together with them.
Mesh mesh_from(const ReadDocument& read, GltfPrimitiveId id) {
    Mesh mesh = read.mesh(id);
    if (mesh.material_ranges.empty() || !mesh.material_ranges.front().material) return mesh;
    const auto [source, second] =
        texcoord_sources(read.view.materials[*mesh.material_ranges.front().material]);
    if (source.set != 0) mesh = read.mesh(id, source.set);
    if (second) {
        mesh.texcoords_2 =
            second->set == source.set ? mesh.texcoords : read.mesh(id, second->set).texcoords;
        for (glm::vec2& texcoord : mesh.texcoords_2)
            texcoord = transformed(second->transform, texcoord);
    }
    if (source.transform == GltfTextureTransform{}) return mesh;
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord = transformed(source.transform, texcoord);
    if (mesh.normals.empty()) return mesh;  // Tangents without normals are ignored.
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
        mesh.tangents[v] = transformed(source.transform, mesh.tangents[v], mesh.normals[v]);
    return mesh;
}

/// Returns the mesh of a primitive with normals. glTF demands flat ones for a mesh without normals,
/// and ignores its tangents; the effect plan computes tangents where it needs them.
///
/// The options replace the normals unless they are kept; a crease angle smooths missing ones.
Mesh drawable_mesh(const ReadDocument& read, GltfPrimitiveId id, Report& report) {
    const SceneOptions& options = read.options;
    FrameOptions frames = frame_options("", options);
    frames.if_missing = options.crease_angle ? NormalMode(NormalWeight::angle) : NormalMode::flat;
    frames.tangents = TangentMethod::none;
    Mesh mesh = mesh_from(read, id);
    if (options.normals == NormalMode::keep && !mesh.normals.empty()) return mesh;
    return with_frames(std::move(mesh), frames, report).mesh;
}

/// A mesh at rest and what deforms it.
struct DeformableMesh {
    Mesh rest;
    MeshPose pose;
};

bool has_skin(const GltfView& view, const GltfNode& node) {
    return node.skin && !view.skins[*node.skin].joints.empty();
}

/// Returns a primitive as a node deforms it, or none. The mesh at rest has the tangents that its
/// normal maps or its anisotropy need, because they are deformed with it.
std::optional<DeformableMesh> deformable_mesh(const ReadDocument& read,
                                              const GltfInstance<GltfPrimitiveId>& item,
                                              Report& report) {
    const GltfView& view = read.view;
    const SceneOptions& options = read.options;
    const GltfNode& node = view.nodes[item.node];
    if (!node.skin && !node.has_morph_targets) return std::nullopt;
    GltfDeformation deformation = read.document.deformation(item.what);
    DeformableMesh result;
    if (!has_skin(view, node)) deformation.joints.clear();
    if (deformation.targets.empty() && deformation.joints.empty()) return std::nullopt;
    FrameOptions frames = frame_options("", options);
    frames.if_missing = options.crease_angle ? NormalMode(NormalWeight::angle) : NormalMode::flat;
    Mesh mesh = mesh_from(read, item.what);
    const bool keeps = options.normals == NormalMode::keep && !mesh.normals.empty();
    result.pose.has_flat_normals =
        !keeps && (options.normals == NormalMode::flat ||
                   (options.normals == NormalMode::keep && !options.crease_angle));
    const std::vector<MaterialRange>& ranges = mesh.material_ranges;
    const auto uses_frame = [](const GltfMaterial& material) {
        const MetallicRoughness& model = *material.metallic_roughness;
        return material.normal_map || model.clearcoat_normal_map || model.anisotropy > 0.0F;
    };
    const bool is_framed = !ranges.empty() && ranges.front().material &&
                           uses_frame(view.materials[*ranges.front().material]) &&
                           !mesh.texcoords.empty();
    const bool has_tangents = keeps && !mesh.tangents.empty();
    frames.tangents = has_tangents ? TangentMethod::keep
                      : is_framed  ? TangentMethod::mikktspace
                                   : TangentMethod::none;
    FramedMesh framed = result.pose.has_flat_normals
                            ? with_separate_frames(std::move(mesh), frames, report)
                            : with_frames(std::move(mesh), frames, report);
    result.rest = std::move(framed.mesh);
    result.pose.deformation = of_vertices(std::move(deformation), framed.source_vertex);
    return result;
}

/// Returns the nodes that deform an instance.
DeformedInstance deforming_nodes(const GltfView& view, std::size_t instance, std::size_t node,
                                 const MeshPose& pose) {
    DeformedInstance deformed{instance, node, view.nodes[node].morph_weights, {}, {}};
    if (pose.deformation->joints.empty()) return deformed;
    const GltfSkin& skin = view.skins[*view.nodes[node].skin];
    deformed.joints = skin.joints;
    deformed.joint_from_mesh = skin.joint_from_mesh;
    return deformed;
}

/// Adds meshes and instances. A primitive with several instances is read once.
void add_instances(const ReadDocument& read, SceneGraph& graph, Report& report) {
    Scene& scene = graph.scene;
    const GltfView& view = read.view;
    struct ReadMesh {
        std::size_t mesh = 0;
        std::optional<MeshPose> pose;
    };
    std::map<std::tuple<std::size_t, std::size_t, bool>, ReadMesh> meshes;
    ProgressStage stage("meshes", view.primitives.size());
    for (const auto& item : view.primitives) {
        const std::tuple key(item.what.mesh, item.what.primitive,
                             has_skin(view, view.nodes[item.node]));
        const auto [entry, is_new] = meshes.try_emplace(key, ReadMesh{scene.meshes.size(), {}});
        if (is_new) {
            if (auto deformable = deformable_mesh(read, item, report)) {
                entry->second.pose = std::move(deformable->pose);
                scene.meshes.emplace_back(std::move(deformable->rest));
            } else {
                scene.meshes.push_back(drawable_mesh(read, item.what, report));
            }
        }
        const auto& [mesh, pose] = entry->second;
        if (pose)
            graph.deformed.push_back(
                deforming_nodes(view, scene.instances.size(), item.node, *pose));
        scene.instances.push_back({mesh, item.world_from_object, item.name, pose});
        graph.instances.push_back({item.node, item.node_from_object});
        stage.advance(1);
    }
}

void add_lights(const GltfView& view, SceneGraph& graph) {
    Scene& scene = graph.scene;
    for (const auto& item : view.lights) {
        const GltfLight& light = item.what;
        const glm::vec3 power = light.color * light.intensity * std::numbers::inv_pi_v<float>;
        const PointLight point{glm::vec3(0.0F), power, light.range};
        const Carried carried{item.node};
        switch (light.type) {
            case LightType::directional:
                scene.directional_lights.push_back({glm::vec3(0.0F, 0.0F, -1.0F), power});
                graph.directional_lights.push_back(carried);
                break;
            case LightType::point:
                scene.point_lights.push_back(point);
                graph.point_lights.push_back(carried);
                break;
            case LightType::spot:
                scene.spot_lights.push_back(
                    {point, glm::vec3(0.0F, 0.0F, -1.0F), light.inner_cone, light.outer_cone});
                graph.spot_lights.push_back(carried);
                break;
        }
    }
}

/// Adds the cameras; the first one becomes the scene's.
/// \return the number of each camera in the document
std::vector<std::size_t> add_cameras(const GltfView& view, SceneGraph& graph, Report& report) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < view.cameras.size(); ++i) {
        const auto& item = view.cameras[i];
        const GltfCamera& read = item.what;
        const glm::mat3 axes(item.world_from_object);
        if (!(glm::length(glm::cross(axes[1], axes[2])) > 0.0F)) {
            report.add("camera without a direction", "camera", i, "left out");
            continue;
        }
        numbers.push_back(read.number);
        FileCamera& result = graph.cameras.emplace_back();
        result.name = read.name.empty() ? item.name : read.name;
        result.carried = Carried{item.node};
        result.sees_all = !read.far;
        Camera& camera = result.camera;
        camera.vertical_fov = read.vertical_fov;
        camera.near = read.near;
        camera.far = read.far.value_or(2.0F * camera.near);
        camera.orthographic_height = read.orthographic_height;
        // The near plane of an orthographic camera may be at 0 in glTF.
        if (camera.orthographic_height)
            camera.near = std::max(camera.near, min_near_share * camera.far);
    }
    if (!graph.cameras.empty()) choose_camera(graph, 0);
    return numbers;
}

void add_nodes(const GltfView& view, SceneGraph& graph, Report& report) {
    for (std::size_t i = 0; i < view.nodes.size(); ++i) {
        const GltfNode& node = view.nodes[i];
        const glm::vec4& q = node.rotation;
        SceneNode& result = graph.nodes.emplace_back();
        result.name = node.name;
        result.parent = node.parent;
        result.translation = node.translation;
        result.scale = node.scale;
        result.matrix = node.matrix;
        if (glm::length(q) > 0.0F) {
            result.rotation = glm::quat(q.w, q.x, q.y, q.z);
        } else {
            report.add("rotation without a length", "node", i, "counts as none");
        }
    }
}

/// Returns a channel that moves a number or color of the scene, with converted values.
template <typename Convert>
KeyChannel moving(const KeyChannel& channel, std::string property, std::size_t index,
                  const Convert& convert) {
    KeyChannel result = channel;
    result.node = index;
    result.pointer = std::move(property);
    for (glm::vec4& value : result.values)
        value = convert(value);
    return result;
}

KeyChannel moving(const KeyChannel& channel, std::string property, std::size_t index) {
    return moving(channel, std::move(property), index,
                  [](const glm::vec4& value) { return value; });
}

/// Returns the name of the number or color of a path in glTF; null if the owner has none.
template <typename Owner>
const char* field_of_path(std::string_view path) {
    const char* name = nullptr;
    for_each_field<Owner>([&]<typename Value>(const SceneField<Owner, Value>& field) {
        constexpr bool is_number = std::is_same_v<Value, float> ||
                                   std::is_same_v<Value, glm::vec3> ||
                                   std::is_same_v<Value, std::optional<float>>;
        if (is_number && field.gltf == path) name = field.name;
    });
    return name;
}

/// Returns the channels for an animated property of a material; none if the scene has no such
/// number.
std::vector<KeyChannel> moving_material(const GltfMaterial& read, const Material& material,
                                        const KeyChannel& channel, std::size_t index,
                                        std::string_view property) {
    const bool physical = material.metallic_roughness.has_value();
    if (property == "pbrMetallicRoughness/baseColorFactor" && (physical || material.unlit)) {
        const char* const color =
            physical ? "materials.metallic_roughness.base_color" : "materials.diffuse";
        return {moving(channel, color, index),
                moving(channel, "materials.opacity", index,
                       [](const glm::vec4& v) { return glm::vec4(v.w, 0.0F, 0.0F, 0.0F); })};
    }
    if (property == "emissiveFactor") {
        return {moving(channel, "materials.emission", index,
                       [&](const glm::vec4& v) { return v * read.emission_strength; })};
    }
    if (property == "extensions/KHR_materials_emissive_strength/emissiveStrength") {
        return {moving(channel, "materials.emission", index, [&](const glm::vec4& v) {
            return glm::vec4(read.emission_factor * v.x, 0.0F);
        })};
    }
    if (property == "normalTexture/scale" && material.normal_map)
        return {moving(channel, "materials.normal_map.scale", index)};
    if (const char* const name = field_of_path<Material>(property))
        return {moving(channel, fmt::format("materials.{}", name), index)};
    const char* const name = field_of_path<MetallicRoughness>(property);
    if (name == nullptr || !physical) return {};
    return {moving(channel, fmt::format("materials.metallic_roughness.{}", name), index)};
}

/// Returns the channel for an animated property of one light.
std::optional<KeyChannel> moving_light(const GltfLight& light, const KeyChannel& channel,
                                       std::size_t index, std::string_view property) {
    const std::string list = fmt::format("{}_lights.", enum_name(light.type));
    const float unit = std::numbers::inv_pi_v<float>;
    if (property == "color") {
        return moving(channel, list + "color", index,
                      [&](const glm::vec4& v) { return v * (light.intensity * unit); });
    }
    if (property == "intensity") {
        return moving(channel, list + "color", index, [&](const glm::vec4& v) {
            return glm::vec4(light.color * (v.x * unit), 0.0F);
        });
    }
    if (property == "range" && light.type != LightType::directional)
        return moving(channel, list + "range", index);
    if (light.type != LightType::spot) return std::nullopt;
    if (property == "spot/innerConeAngle") return moving(channel, list + "inner_cone", index);
    if (property == "spot/outerConeAngle") return moving(channel, list + "outer_cone", index);
    return std::nullopt;
}

/// Returns the channels for an animated property of the lights of all nodes that have it.
std::vector<KeyChannel> moving_lights(const GltfView& view, const KeyChannel& channel,
                                      std::size_t number, std::string_view property) {
    std::vector<KeyChannel> channels;
    std::map<LightType, std::size_t> counts;  // In the order of add_lights().
    for (const auto& item : view.lights) {
        const std::size_t index = counts[item.what.type]++;
        if (item.what.number != number) continue;
        if (auto moved = moving_light(item.what, channel, index, property))
            channels.push_back(std::move(*moved));
    }
    return channels;
}

/// Returns the channels for an animated property of a camera.
std::vector<KeyChannel> moving_cameras(const SceneGraph& graph,
                                       const std::vector<std::size_t>& camera_numbers,
                                       const KeyChannel& channel, std::size_t number,
                                       std::string_view property) {
    std::vector<KeyChannel> channels;
    for (std::size_t i = 0; i < camera_numbers.size(); ++i) {
        if (camera_numbers[i] != number) continue;
        const bool orthographic = graph.cameras[i].camera.orthographic_height.has_value();
        if (property == "perspective/yfov" && !orthographic)
            channels.push_back(moving(channel, "cameras.fov", i));
        if (property == "orthographic/ymag" && orthographic) {
            channels.push_back(moving(channel, "cameras.orthographic_height", i,
                                      [](const glm::vec4& v) { return 2.0F * v; }));
        }
    }
    return channels;
}

/// Splits "/materials/3/emissiveFactor" behind a prefix "/materials/" into index and property.
std::optional<std::pair<std::size_t, std::string_view>> index_and_property(
    std::string_view pointer, std::string_view prefix) {
    if (!pointer.starts_with(prefix)) return std::nullopt;
    pointer.remove_prefix(prefix.size());
    std::size_t index = 0;
    const char* const end = pointer.data() + pointer.size();
    const auto [stop, error] = std::from_chars(pointer.data(), end, index);
    if (error != std::errc() || stop == end || *stop != '/') return std::nullopt;
    return std::pair(index, std::string_view(stop + 1, end));
}

/// Returns what an animated property of the document moves in the scene; nothing if it is not
/// drawn.
std::vector<KeyChannel> moved_by(const GltfView& view, const SceneGraph& graph,
                                 const std::vector<std::size_t>& camera_numbers,
                                 const KeyChannel& channel) {
    const std::vector<Material>& materials = graph.scene.materials;
    if (const auto to = index_and_property(channel.pointer, "/materials/")) {
        const std::size_t index = to->first;
        if (index >= materials.size()) return {};
        return moving_material(view.materials[index], materials[index], channel, index, to->second);
    }
    if (const auto to =
            index_and_property(channel.pointer, "/extensions/KHR_lights_punctual/lights/"))
        return moving_lights(view, channel, to->first, to->second);
    if (const auto to = index_and_property(channel.pointer, "/cameras/"))
        return moving_cameras(graph, camera_numbers, channel, to->first, to->second);
    return {};
}

/// Adds animations that move a node, a morph target, or a number or color of the scene.
void add_animations(const GltfDocument& document, const GltfView& view,
                    const std::vector<std::size_t>& camera_numbers, SceneGraph& graph,
                    Report& report) {
    const std::vector<KeyAnimation> animations = document.animations(report);
    for (std::size_t i = 0; i < animations.size(); ++i) {
        KeyAnimation result{animations[i].name, {}};
        for (const KeyChannel& channel : animations[i].channels) {
            if (channel.property != KeyChannel::Property::pointer) {
                result.channels.push_back(channel);
                continue;
            }
            std::vector<KeyChannel> moved = moved_by(view, graph, camera_numbers, channel);
            if (moved.empty()) {
                report.add("animated property that is not drawn", "animation", i,
                           fmt::format("left out: '{}' stays at rest", channel.pointer));
            }
            for (KeyChannel& part : moved) {
                if (!is_in_range(graph, part)) {
                    report.add("animated value outside of its range", "animation", i,
                               fmt::format("'{}' gets the nearest allowed value", channel.pointer));
                }
                result.channels.push_back(std::move(part));
            }
        }
        if (!result.channels.empty()) graph.animations.emplace_back(std::move(result));
    }
}

}  // namespace

namespace {

/// Adds the images and materials of a document.
void add_appearance(const GltfView& view, const std::filesystem::path& model,
                    const SceneOptions& options, Scene& scene, Report& report) {
    for (std::size_t i = 0; i < view.images.size(); ++i) {
        const GltfImage& image = view.images[i];
        ImageSource source;
        const auto* path = std::get_if<std::filesystem::path>(&image.source);
        source.name = !image.name.empty() ? image.name
                      : path != nullptr   ? path->filename().string()
                                          : fmt::format("images[{}]", i);
        std::visit([&](const auto& encoded) { source.source = encoded; }, image.source);
        source.origin = model.string();
        source.fault = image.fault;
        scene.images.push_back(std::move(source));
    }
    scene.materials = materials_from(view, options, scene.images, report);
    apply_stated_green(scene, report);
}

}  // namespace

SceneGraph detail::graph_from(const GltfDocument& document, const std::filesystem::path& model,
                              const SceneOptions& options, Report& report) {
    const GltfView view = document.view();
    SceneGraph graph;
    add_appearance(view, model, options, graph.scene, report);
    add_nodes(view, graph, report);
    add_instances({document, view, options}, graph, report);
    add_lights(view, graph);
    const std::vector<std::size_t> camera_numbers = add_cameras(view, graph, report);
    add_animations(document, view, camera_numbers, graph, report);
    graph.material_variants = variant_names(view);
    return graph;
}

std::vector<Scene> mesh_scenes(const GltfDocument& document, std::span<const std::size_t> meshes,
                               const std::filesystem::path& file, Report& report) {
    const GltfView view = document.view();
    Scene appearance;
    add_appearance(view, file, {}, appearance, report);
    std::vector<Scene> scenes(meshes.size(), appearance);
    const SceneOptions options;
    const ReadDocument read{document, view, options};
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const auto place = std::find(meshes.begin(), meshes.end(), id.mesh);
        if (place == meshes.end()) continue;
        Scene& scene = scenes[static_cast<std::size_t>(place - meshes.begin())];
        scene.instances.push_back({scene.meshes.size(), glm::mat4(1.0F), ""});
        scene.meshes.push_back(drawable_mesh(read, id, report));
    }
    return scenes;
}

}  // namespace relief::shade
