// SPDX-License-Identifier: Apache-2.0
// Textures of materials, omission of unreadable images, decoding and upload. Colors are sampled as
// linear values, data unchanged. Meshes without texture coordinates show no textures. Tests:
// tests/shade/render/renderer_test.cpp, forced_effects_test.cpp.
#include "render/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "effects/features.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene_file.h"

namespace relief {
namespace {

const char* const unreadable_reason = "its image cannot be read";

/// A texture of a material: its unit, its use, the effects that sample it, and access to it.
struct TextureRow {
    TextureUnit unit;
    ImageUse use;
    std::vector<std::string_view> effects;  ///< At most one of them is on.
    const Texture* (*texture)(const Material& m);
    void (*remove)(Material& m);
};

template <auto Member>
const Texture* optional_texture(const Material& m) {
    return m.*Member ? &*(m.*Member) : nullptr;
}
template <auto Member>
const Texture* texture_of_map(const Material& m) {
    return m.*Member ? &(m.*Member)->texture : nullptr;
}
template <auto Member>
void remove_optional(Material& m) {
    (m.*Member).reset();
}

template <auto Member>
const Texture* texture_of_model(const Material& m) {
    const auto& model = m.metallic_roughness;
    return model && (*model).*Member ? &*((*model).*Member) : nullptr;
}
template <auto Member>
void remove_of_model(Material& m) {
    ((*m.metallic_roughness).*Member).reset();
}
const Texture* texture_of_coat(const Material& m) {
    const auto& model = m.metallic_roughness;
    return model && model->clearcoat_normal_map ? &model->clearcoat_normal_map->texture : nullptr;
}

/// Returns the row of a texture of glTF's model.
template <auto Member>
TextureRow model_row(TextureUnit unit, ImageUse use, std::string_view effect) {
    return {unit, use, {effect}, texture_of_model<Member>, remove_of_model<Member>};
}

/// The rows, in the order of TextureUnit.
const std::array<TextureRow, material_unit_count>& texture_rows() {
    using M = Material;
    using P = MetallicRoughness;
    static const std::array<TextureRow, material_unit_count> all{{
        {TextureUnit::diffuse_texture,
         ImageUse::color,
         {"diffuse texture"},
         optional_texture<&M::diffuse_texture>,
         remove_optional<&M::diffuse_texture>},
        {TextureUnit::specular_texture,
         ImageUse::color,
         {"specular texture"},
         optional_texture<&M::specular_texture>,
         remove_optional<&M::specular_texture>},
        {TextureUnit::emission_texture,
         ImageUse::color,
         {"emission texture"},
         optional_texture<&M::emission_texture>,
         [](M& m) {
             m.emission_texture.reset();
             m.emission = glm::vec3(0.0F);
         }},
        {TextureUnit::occlusion_texture,
         ImageUse::data,
         {"occlusion texture"},
         optional_texture<&M::occlusion_texture>,
         remove_optional<&M::occlusion_texture>},
        {TextureUnit::opacity_texture,
         ImageUse::data,
         {"opacity texture"},
         optional_texture<&M::opacity_texture>,
         remove_optional<&M::opacity_texture>},
        model_row<&P::texture>(TextureUnit::metallic_roughness_texture, ImageUse::data,
                               "metallic-roughness texture"),
        {TextureUnit::normal_texture,
         ImageUse::data,
         {"normal map", "object-space normal map"},
         texture_of_map<&M::normal_map>,
         remove_optional<&M::normal_map>},
        {TextureUnit::bump_texture,
         ImageUse::data,
         {"bump map"},
         texture_of_map<&M::bump_map>,
         remove_optional<&M::bump_map>},
        model_row<&P::specular_texture>(TextureUnit::specular_weight_texture, ImageUse::data,
                                        "specular weight texture"),
        model_row<&P::specular_color_texture>(TextureUnit::specular_color_texture, ImageUse::color,
                                              "specular color texture"),
        model_row<&P::sheen_color_texture>(TextureUnit::sheen_color_texture, ImageUse::color,
                                           "sheen color texture"),
        model_row<&P::sheen_roughness_texture>(TextureUnit::sheen_roughness_texture, ImageUse::data,
                                               "sheen roughness texture"),
        model_row<&P::clearcoat_texture>(TextureUnit::clearcoat_texture, ImageUse::data,
                                         "clearcoat texture"),
        model_row<&P::clearcoat_roughness_texture>(TextureUnit::clearcoat_roughness_texture,
                                                   ImageUse::data, "clearcoat roughness texture"),
        {TextureUnit::clearcoat_normal_texture,
         ImageUse::data,
         {"clearcoat normal map"},
         texture_of_coat,
         remove_of_model<&P::clearcoat_normal_map>},
        model_row<&P::anisotropy_texture>(TextureUnit::anisotropy_texture, ImageUse::data,
                                          "anisotropy texture"),
        model_row<&P::iridescence_texture>(TextureUnit::iridescence_texture, ImageUse::data,
                                           "iridescence texture"),
        model_row<&P::iridescence_thickness_texture>(TextureUnit::film_thickness_texture,
                                                     ImageUse::data, "film thickness texture"),
        model_row<&P::transmission_texture>(TextureUnit::transmission_texture, ImageUse::data,
                                            "transmission texture"),
        model_row<&P::thickness_texture>(TextureUnit::thickness_texture, ImageUse::data,
                                         "thickness texture"),
    }};
    return all;
}

const TextureRow& row_of(TextureUnit unit) {
    return texture_rows().at(static_cast<std::size_t>(unit));
}

/// Returns the effect by which these features sample a texture, or null.
const Effect* sampling_effect(const TextureRow& row, const Features& features) {
    for (const std::string_view name : row.effects) {
        const Effect& effect = find_effect(name)->effect;
        if (effect.on(features)) return &effect;
    }
    return nullptr;
}

void omit_effect(Features& features, TextureUnit unit) {
    if (const Effect* effect = sampling_effect(row_of(unit), features))
        effect->set(features, false);
    if (unit == TextureUnit::emission_texture) features.emission = false;
}

void report_omitted(const Scene& scene, std::optional<std::uint32_t> material,
                    std::string_view effect, const std::pair<const std::size_t, std::string>& image,
                    Report& report) {
    report.add(fmt::format("unreadable {} of {}", effect, material_label(scene, material)), "image",
               image.first,
               "drawn without it: " + with_origin(scene.images[image.first], image.second));
}

/// Updates the reasons of effects that were removed from a draw.
void correct_reasons(DrawPlan& draw, const Features& planned) {
    for (const Effect& effect : effects()) {
        if (!effect.on(planned) || effect.on(draw.features)) continue;
        for (EffectReason& reason : draw.reasons.edit()) {
            if (reason.effect == effect.name) reason = {effect.name, false, unreadable_reason};
        }
    }
    if (!draw.needs_tangents || lies_in_frame(draw.features)) return;
    draw.needs_tangents = false;
    for (EffectReason& reason : draw.reasons.edit()) {
        if (reason.effect == "computed tangents")
            reason = {reason.effect, false, unreadable_reason};
    }
}

GLenum wrap_of(Wrap wrap) {
    switch (wrap) {
        case Wrap::clamp:
            return GL_CLAMP_TO_EDGE;
        case Wrap::mirror:
            return GL_MIRRORED_REPEAT;
        case Wrap::repeat:
            break;
    }
    return GL_REPEAT;
}

}  // namespace

std::vector<UsedTexture> used_textures(const Features& features, const Material& material,
                                       const Mesh& mesh) {
    std::vector<UsedTexture> used;
    for (const TextureRow& row : texture_rows()) {
        if (sampling_effect(row, features) == nullptr) continue;
        const Texture* texture = row.texture(material);
        const bool is_map = row.unit == TextureUnit::normal_texture ||
                            row.unit == TextureUnit::bump_texture ||
                            row.unit == TextureUnit::clearcoat_normal_texture ||
                            row.unit == TextureUnit::anisotropy_texture;
        const bool has_texcoords =
            texture != nullptr && !(is_map ? mesh.texcoords : texcoords_of(mesh, *texture)).empty();
        if (!has_texcoords) texture = nullptr;
        used.push_back({row.unit, texture, row.use});
    }
    return used;
}

void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        FramePlan& plan, Report& report) {
    std::set<std::pair<std::optional<std::uint32_t>, TextureUnit>> reported;
    for (DrawPlan& draw : plan.draws) {
        const std::optional<std::uint32_t> number = draw.range.material;
        const Material& material = number ? scene.materials[*number] : default_material();
        const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
        const Features planned = draw.features;
        for (const UsedTexture& used : used_textures(planned, material, mesh)) {
            const auto entry =
                used.texture == nullptr ? unreadable.end() : unreadable.find(used.texture->image);
            if (entry == unreadable.end()) continue;
            omit_effect(draw.features, used.unit);
            if (!reported.emplace(number, used.unit).second) continue;
            report_omitted(scene, number, sampling_effect(row_of(used.unit), planned)->name, *entry,
                           report);
        }
        if (draw.features == planned) continue;
        draw.features = canonical(draw.features);
        correct_reasons(draw, planned);
    }
}

void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        std::uint32_t number, Material& material, Report& report) {
    const bool has_object_map =
        material.normal_map && material.normal_map->space == NormalSpace::object;
    for (const TextureRow& row : texture_rows()) {
        const Texture* const texture = row.texture(material);
        const auto entry = texture == nullptr ? unreadable.end() : unreadable.find(texture->image);
        if (entry == unreadable.end()) continue;
        const bool is_object_map = has_object_map && row.unit == TextureUnit::normal_texture;
        report_omitted(scene, number, is_object_map ? row.effects.back() : row.effects.front(),
                       *entry, report);
        row.remove(material);
    }
}

bool has_textures(const Material& material) {
    return std::any_of(texture_rows().begin(), texture_rows().end(),
                       [&](const TextureRow& row) { return row.texture(material) != nullptr; });
}

/// A file whose stamp cannot be read counts as missing; reading it reports the reason.
ImageIdentity::File::File(std::filesystem::path name)
    : path(std::move(name)), stamp(stamp_of(path)) {}

decltype(ImageIdentity::identity_) ImageIdentity::identity_of(const ImageSource& source) {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) return File(*file);
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source))
        return bytes->identity();
    return std::get<Shared<Image>>(source.source).identity();
}

ImageIdentity::ImageIdentity(const ImageSource& source) : identity_(identity_of(source)) {}

bool ImageIdentity::is(const ImageSource& source) const {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) {
        const auto* known = std::get_if<File>(&identity_);
        return known != nullptr && *known == File(*file);
    }
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source)) {
        const auto* known = std::get_if<Shared<std::vector<std::byte>>::Identity>(&identity_);
        return known != nullptr && known->is(*bytes);
    }
    const auto* known = std::get_if<Shared<Image>::Identity>(&identity_);
    return known != nullptr && known->is(std::get<Shared<Image>>(source.source));
}

std::shared_ptr<const GpuImage> TextureCache::find(const ImageSource& source,
                                                   const ImagePurpose& purpose) {
    const auto entry = std::find_if(images_.begin(), images_.end(), [&](const Entry& known) {
        return known.purpose == purpose && known.identity.is(source);
    });
    return entry == images_.end() ? nullptr : entry->image;
}

std::shared_ptr<const GpuImage> TextureCache::add(const ImageSource& source,
                                                  const ImagePurpose& purpose, const Image& image) {
    GpuImage made{gl::make_texture(*api_, image, source.name), image.bits()};
    if (purpose.normals) made.flat = detected_flat_code(source, image);
    images_.push_back(
        {ImageIdentity(source), purpose, std::make_shared<const GpuImage>(std::move(made))});
    return images_.back().image;
}

const std::string* TextureCache::find_fault(const ImageSource& source,
                                            const ImagePurpose& purpose) const {
    const auto fault = std::find_if(faults_.begin(), faults_.end(), [&](const Fault& known) {
        return known.purpose == purpose && known.identity.is(source);
    });
    return fault == faults_.end() ? nullptr : &fault->text;
}

void TextureCache::add_fault(ImageIdentity identity, const ImagePurpose& purpose,
                             std::string fault) {
    constexpr std::size_t max_faults = 256;  // A window may show many versions of a file.
    if (faults_.size() == max_faults) faults_.erase(faults_.begin());
    faults_.push_back({std::move(identity), purpose, std::move(fault)});
}

BoundTexture TextureCache::white() {
    return constant(white_, glm::vec3(1.0F), "white");
}

BoundTexture TextureCache::flat() {
    return constant(flat_, {0.0F, 0.0F, 1.0F}, "flat");
}

BoundTexture TextureCache::tangent() {
    return constant(tangent_, {1.0F, 0.5F, 1.0F}, "tangent");
}

BoundTexture TextureCache::constant(std::optional<gl::Texture>& texture, const glm::vec3& color,
                                    const char* name) {
    if (!texture) {
        Image image = make_image(1, 1, 3, 32, ColorSpace::data);
        image.samples = std::vector<float>{color.r, color.g, color.b};
        texture = gl::make_texture(*api_, image, name);
    }
    return {texture->name(), sampler(Wrap::repeat, Wrap::repeat, TextureFilter::nearest)};
}

GLuint TextureCache::sampler(Wrap u, Wrap v, TextureFilter filter) {
    gl::Sampler& entry = samplers_[{u, v, filter}];
    if (!entry) {
        gl::Sampling sampling;
        sampling.wrap_s = wrap_of(u);
        sampling.wrap_t = wrap_of(v);
        if (filter == TextureFilter::nearest) {
            sampling.minify = GL_NEAREST_MIPMAP_NEAREST;
            sampling.magnify = GL_NEAREST;
            sampling.anisotropy = 1.0F;
        }
        entry = gl::make_sampler(*api_, sampling);
    }
    return entry.name();
}

void TextureCache::drop_unused() {
    std::erase_if(images_, [](const Entry& entry) { return entry.image.use_count() == 1; });
}

std::map<std::size_t, std::string> SceneTextures::decode(const std::vector<ImageSource>& sources) {
    std::map<std::size_t, std::string> unreadable;
    std::vector<ImageIdentity> identities;
    for (auto& [key, image] : images_) {
        const ImageSource& source = sources[key.first];
        note_image_file(source);
        image = cache_->find(source, key.second);
        if (image) continue;
        const std::string* const fault = cache_->find_fault(source, key.second);
        if (fault != nullptr && !source.is_required) {
            unreadable.try_emplace(key.first, *fault);
            continue;
        }
        identities.emplace_back(source);
        decoded_.emplace_back(key, Image{});
    }
    const std::vector<std::string> faults = decode_all(sources);
    for (std::size_t i = 0; i < faults.size(); ++i) {
        if (faults[i].empty()) continue;
        const Key& key = decoded_[i].first;
        cache_->add_fault(identities[i], key.second, faults[i]);
        unreadable.try_emplace(key.first, faults[i]);
    }
    const auto is_unreadable = [&](const auto& entry) {
        return unreadable.contains(entry.first.first);
    };
    std::erase_if(decoded_, is_unreadable);
    std::erase_if(images_, is_unreadable);
    return unreadable;
}

/// Fills decoded_. \return the error of each image; empty if there is none
std::vector<std::string> SceneTextures::decode_all(const std::vector<ImageSource>& sources) {
    std::vector<std::string> faults(decoded_.size());
    ProgressStage stage("images", decoded_.size());
    parallel_for(decoded_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            auto& [key, image] = decoded_[i];
            const ImageSource& source = sources[key.first];
            try {
                image = relief::decode(source, key.second.use);
            } catch (const FileError& error) {
                if (source.is_required) throw;
                faults[i] = error.what();
            }
            stage.advance(1);
        }
    });
    return faults;
}

void SceneTextures::upload(const std::vector<ImageSource>& sources) {
    ProgressStage stage("uploading images", decoded_.size());
    for (const auto& [key, image] : decoded_) {
        try {
            images_.at(key) = cache_->add(sources[key.first], key.second, image);
        } catch (const InvalidInput& error) {
            throw FileError(sources[key.first].name, error.what());
        }
        stage.advance(1);
    }
    decoded_.clear();
}

}  // namespace relief
