// SPDX-License-Identifier: Apache-2.0
// Decodes and uploads a scene's images. Colours are looked up linear, data as it is; nothing is
// flipped. Unreadable files throw FileError. Tests: tests/shade/render/renderer_test.cpp.
#include "render/scene_textures.h"

#include "parallel.h"
#include "scene/image_source.h"

namespace relief {

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

void DecodedImages::decode_all(const std::vector<ImageSource>& sources) {
    using Entry = decltype(images_)::value_type;
    std::vector<Entry*> entries;
    for (Entry& entry : images_)
        entries.push_back(&entry);
    parallel_for(entries.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto& [image, use] = entries[i]->first;
            entries[i]->second = decode(sources[image], use);
        }
    });
}

void SceneTextures::upload(const DecodedImages& images, const std::vector<ImageSource>& sources) {
    for (const auto& [key, image] : images.all()) {
        textures_.emplace(key, gl::make_texture(*api_, image, sources[key.first].name));
    }
}

BoundTexture SceneTextures::get(const Texture& texture, ImageUse use) {
    return {textures_.at({texture.image, use}).name(),
            sampler(texture.wrap_u, texture.wrap_v, texture.filter)};
}

BoundTexture SceneTextures::white() {
    return constant(white_, 1.0F, 1.0F, "white");
}

BoundTexture SceneTextures::flat() {
    return constant(flat_, 0.0F, 1.0F, "flat");
}

BoundTexture SceneTextures::constant(std::optional<gl::Texture>& texture, float rg, float b,
                                     const char* name) {
    if (!texture) {
        Image image = make_image(1, 1, 3, 32, ColorSpace::data);
        image.samples = std::vector<float>{rg, rg, b};
        texture = gl::make_texture(*api_, image, name);
    }
    return {texture->name(),
            sampler(TextureWrap::repeat, TextureWrap::repeat, TextureFilter::nearest)};
}

GLuint SceneTextures::sampler(TextureWrap u, TextureWrap v, TextureFilter filter) {
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

FlatCode flat_code_of(const NormalMap& map, const Image& image, const ImageSource& source) {
    if (map.flat) return *map.flat;
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) {
        return detect_flat_code(image, read_image_info(*file).metadata);
    }
    return detect_flat_code(image);
}

}  // namespace relief
