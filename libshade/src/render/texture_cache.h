// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images on the GPU, kept by what they are images of. Tests:
/// tests/shade/render/render_cache_test.cpp.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "gl/texture.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/scene.h"
#include "scene/image_identity.h"

namespace relief {

/// What an image is wanted for.
struct ImagePurpose {
    ImageUse use = ImageUse::color;
    bool normals = false;  ///< A normal map: which code means flat is looked for.

    friend auto operator<=>(const ImagePurpose&, const ImagePurpose&) = default;
};

/// An image on the GPU, and what of it the processor still needs.
struct GpuImage {
    gl::Texture texture;
    int bits = 8;
    FlatCode flat = FlatCode::half;  ///< Detected; of normal maps only.
};

/// A texture and its sampler, to be bound to one unit.
struct BoundTexture {
    GLuint texture = 0;
    GLuint sampler = 0;
};

class TextureCache {
  public:
    explicit TextureCache(const gl::Api& api) : api_(&api) {}

    /// Nothing if it is not there.
    std::shared_ptr<const GpuImage> find(const ImageSource& source, const ImagePurpose& purpose);

    /// Uploads a decoded image and keeps it. \throws GpuError
    std::shared_ptr<const GpuImage> add(const ImageSource& source, const ImagePurpose& purpose,
                                        const Image& image);

    /// What is wrong with an image that could not be decoded, as long as its file or its bytes stay
    /// as they were; else null.
    [[nodiscard]] const std::string* find_fault(const ImageSource& source,
                                                const ImagePurpose& purpose) const;

    /// \param identity  from before decoding, so that a file that changed meanwhile is read again
    void add_fault(ImageIdentity identity, const ImagePurpose& purpose, std::string fault);

    GLuint sampler(TextureWrap u, TextureWrap v, TextureFilter filter);
    BoundTexture white();
    BoundTexture flat();  ///< Looks up as (0, 0, 1).

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return images_.size(); }

  private:
    BoundTexture constant(std::optional<gl::Texture>& texture, float rg, float b, const char* name);

    struct Entry {
        ImageIdentity identity;
        ImagePurpose purpose;
        std::shared_ptr<const GpuImage> image;
    };

    struct Fault {
        ImageIdentity identity;
        ImagePurpose purpose;
        std::string text;
    };

    const gl::Api* api_;
    std::vector<Entry> images_;
    std::vector<Fault> faults_;
    std::map<std::tuple<TextureWrap, TextureWrap, TextureFilter>, gl::Sampler> samplers_;
    std::optional<gl::Texture> white_;
    std::optional<gl::Texture> flat_;
};

}  // namespace relief
