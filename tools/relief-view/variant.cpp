// SPDX-License-Identifier: Apache-2.0
#include "variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "common/options.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {
namespace {

template <typename Value>
VariantTopic topic(const std::string& name, const std::string& what,
                   const Choices<Value>& choices) {
    VariantTopic result{name, what, {}};
    for (const auto& [word, value] : choices)
        result.choices.emplace_back(std::string(word), Variant(value));
    return result;
}

/// All modes except keeping the normals.
Choices<NormalMode> computed_normals() {
    Choices<NormalMode> choices = enum_choices<NormalMode>();
    std::erase_if(choices, [](const auto& choice) { return choice.second == NormalMode::keep; });
    return choices;
}

/// The mesh's tangents, computed ones, and none: the shader then derives frames.
Choices<TangentMethod> displayed_tangents() {
    Choices<TangentMethod> choices = {{"stored", TangentMethod::keep}};
    for (const auto& [name, method] : tangent_choices()) {
        if (computes_tangents(method)) choices.emplace_back(name, method);
    }
    choices.emplace_back("derivatives", TangentMethod::none);
    return choices;
}

std::string unknown(const VariantTopic& topic) {
    std::vector<std::string> words;
    for (const auto& [word, variant] : topic.choices)
        words.push_back(word);
    return fmt::format("{}: not one of {}", topic.name, fmt::join(words, ", "));
}

}  // namespace

const std::vector<VariantTopic>& variant_topics() {
    static const std::vector<VariantTopic> topics = {
        topic("interpolation", "Where the lighting is computed", enum_choices<Interpolation>()),
        topic("map", "The map that perturbs the normals",
              Choices<MapUse>{{"none", MapUse::none},
                              {"bump_map", MapUse::bump_map},
                              {"normal_map", MapUse::normal_map}}),
        topic("kernel", "The kernel that computes slopes from heights", enum_choices<Kernel>()),
        topic("tangents", "The tangent frames of the maps", displayed_tangents()),
        topic("bits", "Bits per channel of the normal map",
              Choices<MapBits>{{"8", MapBits::eight}, {"16", MapBits::sixteen}}),
        topic("normals", "The weights of vertex normals", computed_normals()),
    };
    return topics;
}

Variant parse_variant(const std::string& subject, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    std::vector<std::string> names;
    for (const VariantTopic& topic : variant_topics()) {
        names.push_back(topic.name + "=");
        if (topic.name != name || equals == text.size()) continue;
        for (const auto& [word, variant] : topic.choices) {
            if (word == text.substr(equals + 1)) return variant;
        }
        throw UsageError(subject + ": " + unknown(topic));
    }
    throw UsageError(fmt::format("{}: not one of {}", subject, fmt::join(names, ", ")));
}

std::string to_text(const Variant& variant) {
    for (const VariantTopic& topic : variant_topics()) {
        for (const auto& [word, value] : topic.choices) {
            if (value == variant) return topic.name + "=" + word;
        }
    }
    return "";
}

namespace {

[[noreturn]] void refuse_change(const Variant& variant, const std::string& because,
                                const std::string& remedy) {
    throw UsageError("--compare " + to_text(variant) + ": " + because, remedy);
}

/// The heights of a material: its bump map, or the source of its converted normal map.
struct Heights {
    ImageSource image;
    BumpMap map;
};

/// Prepares one variant.
class Preparation {
  public:
    Preparation(const Variant& variant, const Scene& scene, const ViewOptions& options,
                Report& report)
        : variant_(variant), scene_(scene), options_(options), report_(report) {}

    PreparedVariant run() {
        std::visit([this](const auto& choice) { change(choice); }, variant_);
        return std::move(result_);
    }

  private:
    void change(Interpolation interpolation) {
        const bool is_so = std::all_of(
            scene_.materials.begin(), scene_.materials.end(),
            [&](const Material& material) { return material.interpolation == interpolation; });
        if (is_so) refuse_change(variant_, "is the current setting", "choose another one");
        result_.interpolation = interpolation;
    }

    void change(MapUse use) {
        begin_maps();
        bool changed = false;
        for (std::size_t i = 0; i < result_.maps.size(); ++i) {
            MaterialMaps& maps = result_.maps[i];
            const std::optional<Heights> heights = heights_of(scene_.materials[i]);
            if (use == MapUse::none) {
                changed |= maps.normal_map || maps.bump_map;
                maps = {};
            } else if (use == MapUse::bump_map && heights && maps.normal_map) {
                maps = {std::nullopt, as_bump_map(*heights)};
                changed = true;
            } else if (use == MapUse::normal_map && maps.bump_map) {
                convert(maps, *heights, std::nullopt, MapBits::sixteen);
                changed = true;
            }
        }
        if (changed) return;
        refuse_change(variant_,
                      use == MapUse::none ? "there is no normal map or bump map to remove"
                      : use == MapUse::bump_map
                          ? "there is no normal map that was converted from heights"
                          : "there is no bump map to convert",
                      "give --height-map");
    }

    void change(Kernel kernel) {
        const bool is_converted = options_.height_map && options_.height_as != HeightUse::bump_map;
        if (is_converted && kernel == displayed_kernel(options_))
            refuse_change(variant_, "is the current setting", "choose another one");
        begin_maps();
        bool changed = false;
        for (std::size_t i = 0; i < result_.maps.size(); ++i) {
            const std::optional<Heights> heights = heights_of(scene_.materials[i]);
            if (!heights) continue;
            changed |= unless_unreadable(heights->image, [&] {
                convert(result_.maps[i], *heights, kernel, MapBits::sixteen);
                return true;
            });
        }
        if (!changed) refuse_change(variant_, "there is no height map", "give --height-map");
    }

    void change(MapBits bits) {
        begin_maps();
        bool changed = false;
        for (std::size_t i = 0; i < result_.maps.size(); ++i) {
            MaterialMaps& maps = result_.maps[i];
            if (!maps.normal_map) continue;
            const ImageSource& source = scene_.images[maps.normal_map->texture.image];
            changed |= unless_unreadable(source, [&] {
                const Image image = decode(source, ImageUse::data);
                if (image.bits() <= static_cast<int>(bits)) return false;
                if (const std::optional<Heights> heights = heights_of(scene_.materials[i])) {
                    convert(maps, *heights, options_.kernel, bits);
                } else {
                    requantize(*maps.normal_map, source, image, bits);
                }
                return true;
            });
        }
        if (!changed)
            refuse_change(variant_, "there is no normal map with more bits", "give --height-map");
    }

    void change(TangentMethod method) {
        const bool has_frames = std::any_of(
            scene_.materials.begin(), scene_.materials.end(), [](const Material& material) {
                const std::optional<NormalMap>& map = material.normal_map;
                return material.bump_map || (map && map->space == NormalSpace::tangent);
            });
        if (!has_frames) {
            refuse_change(variant_, "there is no normal map or bump map that needs tangents",
                          "give --normal-map or --height-map");
        }
        const bool is_derived = method == TangentMethod::none;
        result_.tangent_frame = is_derived ? TangentFrame::derivatives : TangentFrame::stored;
        if (!computes_tangents(method)) return;
        FrameOptions frames;
        frames.tangents = method;
        change_meshes(frames);
    }

    void change(NormalMode mode) {
        FrameOptions frames;
        frames.normals = mode;
        change_meshes(frames);
    }

    void change_meshes(const FrameOptions& frames) {
        for (const Shared<Mesh>& mesh : scene_.meshes) {
            const bool can = !computes_tangents(frames.tangents) || !mesh->texcoords.empty();
            result_.meshes.push_back(can ? Shared<Mesh>(with_frames(*mesh, frames, report_).mesh)
                                         : mesh);
        }
    }

    /// Runs the work for a material. If an optional image cannot be read, the picture is drawn
    /// without it, and so is the variant. \return the result of the work, or false
    static bool unless_unreadable(const ImageSource& image, const std::function<bool()>& work) {
        try {
            return work();
        } catch (const FileError&) {
            if (image.is_required) throw;
            return false;
        }
    }

    void begin_maps() {
        for (const Material& material : scene_.materials)
            result_.maps.push_back({material.normal_map, material.bump_map});
        result_.first_image = scene_.images.size();
    }

    [[nodiscard]] std::optional<Heights> heights_of(const Material& material) const {
        if (material.bump_map)
            return Heights{scene_.images[material.bump_map->texture.image], *material.bump_map};
        if (!material.normal_map || !options_.height_map) return std::nullopt;
        BumpMap map;
        map.texture = material.normal_map->texture;
        map.strength = static_cast<float>(options_.strength.value_or(BumpOptions{}.strength));
        return Heights{{.name = options_.height_map->string(),
                        .source = *options_.height_map,
                        .is_required = true},
                       map};
    }

    BumpMap as_bump_map(const Heights& heights) {
        BumpMap map = heights.map;
        map.texture.image = added(heights.image.name, [&] { return heights.image; });
        return map;
    }

    /// \param kernel  if absent, the kernel is chosen for the map
    void convert(MaterialMaps& maps, const Heights& heights, std::optional<Kernel> kernel,
                 MapBits bits) {
        BumpOptions bump;
        bump.kernel = kernel;
        bump.strength = heights.map.strength;
        const std::string name = fmt::format("{}, {}", heights.image.name, bump.strength);
        NormalMap map = converted_map(heights.map.texture);
        map.scale = maps.normal_map ? maps.normal_map->scale : 1.0F;
        map.texture.image = added(name, [&] {
            return ImageSource{name, about(heights.image.name, [&] {
                                   return converted_heights(decode(heights.image, ImageUse::data),
                                                            bump, static_cast<int>(bits), report_);
                               })};
        });
        maps = {map, std::nullopt};
    }

    /// Encodes a normal map with fewer bits.
    void requantize(NormalMap& map, const ImageSource& source, const Image& image, MapBits bits) {
        const FlatCode flat = map.flat.value_or(detected_flat_code(source, image));
        const std::string name =
            fmt::format("{}, {}", map.texture.image, static_cast<int>(map.green));
        map.texture.image = added(name, [&] {
            const NormalMapFormat format{
                .bits = static_cast<int>(bits), .green = map.green, .flat = flat};
            const Image normals = decode_normal_map(image, map.green, flat, report_);
            return ImageSource{source.name, encode_normal_map(normals, format, report_)};
        });
        map.flat = flat;
    }

    /// Adds an image that several materials may share.
    template <typename Make>
    std::size_t added(const std::string& name, const Make& make) {
        const auto [entry, is_new] =
            index_of_.try_emplace(name, result_.first_image + result_.images.size());
        if (is_new) result_.images.push_back(make());
        return entry->second;
    }

    const Variant& variant_;
    const Scene& scene_;
    const ViewOptions& options_;
    Report& report_;
    PreparedVariant result_;
    std::map<std::string, std::size_t> index_of_;
};

/// Sets the maps of the variant and keeps the current scale.
void set_maps(Material& material, const MaterialMaps& maps, std::size_t first, std::size_t moved) {
    const std::optional<NormalMap> before = material.normal_map;
    const auto place = [&](Texture& texture) {
        if (texture.image >= first) texture.image += moved;
    };
    material.normal_map = maps.normal_map;
    material.bump_map = maps.bump_map;
    if (material.normal_map) place(material.normal_map->texture);
    if (material.bump_map) place(material.bump_map->texture);
    if (before && material.normal_map) material.normal_map->scale = before->scale;
}

}  // namespace

PreparedVariant prepare(const Variant& variant, const Scene& scene, const ViewOptions& options,
                        Report& report) {
    Scene named = scene;
    name_default_material(named);
    return Preparation(variant, named, options, report).run();
}

Scene with_variant(const Scene& scene, const PreparedVariant& prepared) {
    Scene changed = scene;
    name_default_material(changed);
    for (Material& material : changed.materials) {
        material.interpolation = prepared.interpolation.value_or(material.interpolation);
        material.tangent_frame = prepared.tangent_frame.value_or(material.tangent_frame);
        if (prepared.interpolation == Interpolation::gouraud) material.metallic_roughness.reset();
    }
    if (!prepared.meshes.empty()) changed.meshes = prepared.meshes;
    if (prepared.maps.empty()) return changed;
    const std::size_t moved = changed.images.size() - prepared.first_image;
    changed.images.insert(changed.images.end(), prepared.images.begin(), prepared.images.end());
    for (std::size_t i = 0; i < changed.materials.size() && i < prepared.maps.size(); ++i)
        set_maps(changed.materials[i], prepared.maps[i], prepared.first_image, moved);
    return changed;
}

Scene with_lighting_of(const Scene& scene, Scene other) {
    other.ambient = scene.ambient;
    other.directional_lights = scene.directional_lights;
    other.point_lights = scene.point_lights;
    other.spot_lights = scene.spot_lights;
    other.environment = scene.environment;
    other.background = scene.background;
    other.exposure = scene.exposure;
    other.tone_mapping = scene.tone_mapping;
    return other;
}

}  // namespace relief::tools
