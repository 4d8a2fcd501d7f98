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
#include "relief/mesh/map_kind_check.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene_file.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {
using namespace relief::detail;

namespace {

const char* const unreadable_reason = "its image cannot be read";

/// Returns the effects that sample the texture of a slot; at most one of them is on.
const std::vector<const Effect*>& effects_of(TextureSlot slot) {
    static const auto all = [] {
        std::array<std::vector<const Effect*>, texture_slot_count> effects;
        for (std::size_t i = 0; i < texture_slot_count; ++i) {
            if (const EffectRow* const row = find_effect(texture_slots[i].effect))
                effects[i].push_back(&row->effect);
        }
        const auto add = [&](TextureSlot sampled, const char* effect) {
            effects[static_cast<std::size_t>(sampled)].push_back(&find_effect(effect)->effect);
        };
        add(TextureSlot::normal, "object-space normal map");
        for (const char* const effect : {"parallax mapping", "parallax occlusion mapping",
                                         "relief mapping", "relaxed cones", "maximum mipmaps"})
            add(TextureSlot::height, effect);
        add(TextureSlot::cones, "relaxed cones");
        return effects;
    }();
    return all[static_cast<std::size_t>(slot)];
}

/// Returns the effect by which these features sample a texture, or null.
const Effect* sampling_effect(TextureSlot slot, const Features& features) {
    for (const Effect* const effect : effects_of(slot)) {
        if (effect->on(features)) return effect;
    }
    return nullptr;
}

void omit_effect(Features& features, TextureSlot slot) {
    if (const Effect* effect = sampling_effect(slot, features)) effect->set(features, false);
    if (slot == TextureSlot::emission) features.emission = false;
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
    for (const TextureSlotInfo& slot : texture_slots) {
        if (sampling_effect(slot.slot, features) == nullptr) continue;
        const Texture* texture = find_texture(material, slot.slot);
        const bool has_texcoords =
            texture != nullptr &&
            !(slot.in_tangent_frame ? mesh.texcoords : texcoords_of(mesh, *texture)).empty();
        if (!has_texcoords) texture = nullptr;
        used.push_back({slot.slot, texture});
    }
    return used;
}

void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        FramePlan& plan, Report& report) {
    std::set<std::pair<std::optional<std::uint32_t>, TextureSlot>> reported;
    for (DrawPlan& draw : plan.draws) {
        const std::optional<std::uint32_t> number = draw.range.material;
        const Material& material = number ? scene.materials[*number] : default_material();
        const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
        const Features planned = draw.features;
        for (const UsedTexture& used : used_textures(planned, material, mesh)) {
            const auto entry =
                used.texture == nullptr ? unreadable.end() : unreadable.find(used.texture->image);
            if (entry == unreadable.end()) continue;
            omit_effect(draw.features, used.slot);
            if (!reported.emplace(number, used.slot).second) continue;
            report_omitted(scene, number, sampling_effect(used.slot, planned)->name, *entry,
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
    for (const TextureSlotInfo& slot : texture_slots) {
        const Texture* const texture = find_texture(material, slot.slot);
        const auto entry = texture == nullptr ? unreadable.end() : unreadable.find(texture->image);
        if (entry == unreadable.end()) continue;
        const bool is_object_map = has_object_map && slot.slot == TextureSlot::normal;
        const std::vector<const Effect*>& effects = effects_of(slot.slot);
        report_omitted(scene, number, (is_object_map ? effects.back() : effects.front())->name,
                       *entry, report);
        remove_texture(material, slot.slot);
        if (slot.slot == TextureSlot::emission) material.emission = glm::vec3(0.0F);
    }
}

bool has_textures(const Material& material) {
    return std::any_of(
        texture_slots.begin(), texture_slots.end(),
        [&](const TextureSlotInfo& slot) { return find_texture(material, slot.slot) != nullptr; });
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
    GpuImage made{purpose.maxima ? gl::make_texture(*api_,
                                                    height_levels(image, purpose.maxima->first,
                                                                  purpose.maxima->second),
                                                    source.name)
                                 : gl::make_texture(*api_, image, source.name),
                  image.bits()};
    if (purpose.normals) made.flat = detected_flat_code(source, image);
    if (purpose.normals || purpose.heights)
        made.content = unstated_content(image, stated_description(source));
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
                image = shade::decode(source, key.second.use);
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

}  // namespace relief::shade::detail
