// SPDX-License-Identifier: Apache-2.0
/// \file
/// Textures of a scene: which textures a draw samples, which are omitted because their images
/// cannot be read, and the images on the GPU. Images that are not in the cache are decoded in
/// parallel and uploaded once. Tests: tests/shade/render/renderer_test.cpp,
/// forced_effects_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "gl/resources.h"
#include "relief/export.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/material.h"
#include "relief/shade/scene.h"
#include "render/program_cache.h"

namespace RELIEF_API relief {
namespace shade::detail {

/// A sampler of the program of a draw.
struct UsedTexture {
    TextureSlot slot{};
    /// Null: a neutral texture, because a forced plan names a missing one.
    const Texture* texture = nullptr;
};

/// Returns the material samplers of a program with these features.
std::vector<UsedTexture> used_textures(const Features& features, const Material& material,
                                       const Mesh& mesh);

/// Removes textures whose images cannot be read from a plan, as if the materials did not have them.
/// A material whose emission texture cannot be read emits nothing, because most texels of such
/// textures are black.
///
/// \param unreadable  the error of each unreadable image, by index
/// \param report      gets the effect, material, image and error of each texture
void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        FramePlan& plan, Report& report);

/// Removes them from a material of the scene, by the same rules and with the same report.
void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        std::uint32_t number, Material& material, Report& report);

/// Returns whether the material has any texture.
bool has_textures(const Material& material);

/// The use of an image.
struct ImagePurpose {
    ImageUse use = ImageUse::color;
    bool normals = false;  ///< For normal maps the code of zero is detected.
    bool heights = false;
    /// For heights of a relief: levels of maxima, for a map that wraps like this in u and v.
    std::optional<std::pair<Wrap, Wrap>> maxima = std::nullopt;

    friend auto operator<=>(const ImagePurpose&, const ImagePurpose&) = default;
};

/// Returns the levels of a relief's heights (height_march.glsl#field) as images of one channel with
/// the same number of bits: the red channel within [0,1], where holes are filled, and the maxima.
std::vector<Image> height_levels(const Image& image, Wrap wrap_u, Wrap wrap_v);

/// An image on the GPU.
struct GpuImage {
    gl::Texture texture;
    int bits = 8;
    FlatCode flat = FlatCode::half;  ///< Detected for normal maps only.
    /// For normals and heights: the content by the texels, unless the file states it.
    std::optional<MapContent> content = std::nullopt;
};

/// A texture and its sampler for one unit.
struct BoundTexture {
    GLuint texture = 0;
    GLuint sampler = 0;
};

/// Tells whether an image is unchanged since it was decoded.
class ImageIdentity {
  public:
    explicit ImageIdentity(const ImageSource& source);

    /// Tells whether the source is the same value in memory, or a file of the same name and stamp.
    [[nodiscard]] bool is(const ImageSource& source) const;

  private:
    struct File {
        std::filesystem::path path;
        FileStamp stamp;

        explicit File(std::filesystem::path name);
        bool operator==(const File&) const = default;
    };

    std::variant<File, Shared<std::vector<std::byte>>::Identity, Shared<Image>::Identity> identity_;

    static decltype(identity_) identity_of(const ImageSource& source);
};

/// The images of a context by identity and use.
class TextureCache {
  public:
    explicit TextureCache(const gl::Api& api) : api_(&api) {}

    /// Null if the image is not in the cache.
    std::shared_ptr<const GpuImage> find(const ImageSource& source, const ImagePurpose& purpose);

    /// Uploads a decoded image and keeps it. \throws GpuError
    std::shared_ptr<const GpuImage> add(const ImageSource& source, const ImagePurpose& purpose,
                                        const Image& image);

    /// Returns the error of an image that could not be decoded, while its file or its bytes are
    /// unchanged; otherwise null.
    [[nodiscard]] const std::string* find_fault(const ImageSource& source,
                                                const ImagePurpose& purpose) const;

    /// \param identity  taken before decoding, so that a file that changes meanwhile is read again
    void add_fault(ImageIdentity identity, const ImagePurpose& purpose, std::string fault);

    GLuint sampler(Wrap u, Wrap v, TextureFilter filter);
    BoundTexture white();
    BoundTexture flat();     ///< Every lookup gives (0, 0, 1).
    BoundTexture tangent();  ///< Every lookup gives (1, 0.5, 1): anisotropy along the tangent.

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return images_.size(); }

  private:
    BoundTexture constant(std::optional<gl::Texture>& texture, const glm::vec3& color,
                          const char* name);

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
    std::map<std::tuple<Wrap, Wrap, TextureFilter>, gl::Sampler> samplers_;
    std::optional<gl::Texture> white_;
    std::optional<gl::Texture> flat_;
    std::optional<gl::Texture> tangent_;
};

/// The images that one scene uses.
class SceneTextures {
  public:
    explicit SceneTextures(TextureCache& cache) : cache_(&cache) {}

    void request(std::size_t image, const ImagePurpose& purpose) {
        images_.try_emplace({image, purpose});
    }

    /// Decodes the requested images that are not in the cache. Requests of images that cannot be
    /// read are dropped.
    /// \return those images, by index, each with its error
    /// \throws FileError if an image that is required cannot be read
    std::map<std::size_t, std::string> decode(const std::vector<ImageSource>& sources);

    /// Uploads the decoded images. \throws GpuError
    void upload(const std::vector<ImageSource>& sources);

    [[nodiscard]] const GpuImage& image(std::size_t image, const ImagePurpose& purpose) const {
        return *images_.at({image, purpose});
    }
    [[nodiscard]] BoundTexture bound(const Texture& texture, const ImagePurpose& purpose) const {
        return {image(texture.image, purpose).texture.name(),
                cache_->sampler(texture.wrap_u, texture.wrap_v, texture.filter)};
    }

    [[nodiscard]] std::size_t size() const { return images_.size(); }

  private:
    using Key = std::pair<std::size_t, ImagePurpose>;

    std::vector<std::string> decode_all(const std::vector<ImageSource>& sources);

    TextureCache* cache_;
    std::map<Key, std::shared_ptr<const GpuImage>> images_;
    std::vector<std::pair<Key, Image>> decoded_;
};

}  // namespace shade::detail
}  // namespace relief
