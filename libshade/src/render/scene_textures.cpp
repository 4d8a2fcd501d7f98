// SPDX-License-Identifier: Apache-2.0
// Colors are looked up linear, data unchanged; nothing is flipped.
#include "render/scene_textures.h"

#include <algorithm>
#include <utility>

#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_source.h"

namespace relief {

// The cache

namespace {

GLenum wrap_of(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::clamp:
            return GL_CLAMP_TO_EDGE;
        case TextureWrap::mirror:
            return GL_MIRRORED_REPEAT;
        case TextureWrap::repeat:
            break;
    }
    return GL_REPEAT;
}

}  // namespace

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
    return constant(white_, 1.0F, 1.0F, "white");
}

BoundTexture TextureCache::flat() {
    return constant(flat_, 0.0F, 1.0F, "flat");
}

BoundTexture TextureCache::constant(std::optional<gl::Texture>& texture, float rg, float b,
                                    const char* name) {
    if (!texture) {
        Image image = make_image(1, 1, 3, 32, ColorSpace::data);
        image.samples = std::vector<float>{rg, rg, b};
        texture = gl::make_texture(*api_, image, name);
    }
    return {texture->name(),
            sampler(TextureWrap::repeat, TextureWrap::repeat, TextureFilter::nearest)};
}

GLuint TextureCache::sampler(TextureWrap u, TextureWrap v, TextureFilter filter) {
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

// The images of a scene

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
        images_.at(key) = cache_->add(sources[key.first], key.second, image);
        stage.advance(1);
    }
    decoded_.clear();
}

}  // namespace relief
