// SPDX-License-Identifier: Apache-2.0
// Bakes: copies the meshes, and writes bands of rows to the caller's images.
#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "c/c_call.h"

using namespace relief;
using namespace relief::detail;

namespace {

/// The images of the caller that are baked.
class BakedImages {
  public:
    /// \throws InvalidInput if an image is not as documented, or there is none
    BakedImages(const relief_bake_maps& maps, const relief_bake_options& options) {
        const auto use_normals = [&](const char* name, const relief_output_image& image) {
            return use(name, image, 2, 4, &options);
        };
        normals_ = use_normals("normal map", maps.normals);
        bent_normals_ = use_normals("map of bent normals", maps.bent_normals);
        add_values("height map", maps.heights, 1, &BakedRows::heights);
        add_values("occlusion map", maps.occlusion, 1, &BakedRows::occlusion);
        add_values("thickness map", maps.thickness, 1, &BakedRows::thickness);
        add_values("curvature map", maps.curvature, 1, &BakedRows::curvature);
        add_values("position map", maps.positions, 3, &BakedRows::positions);
        ids_ = use("map of ids", maps.ids, 1, 1, nullptr);
        if (!first_) throw InvalidInput("no map to bake has pixels");
        states_ = maps.states;
    }

    [[nodiscard]] glm::ivec2 size() const { return {first_->width, first_->height}; }
    [[nodiscard]] bool has_normals() const { return normals_.has_value(); }
    [[nodiscard]] bool has_bent_normals() const { return bent_normals_.has_value(); }
    [[nodiscard]] bool has_ids() const { return ids_.has_value(); }
    /// Returns whether a layer of values is baked.
    [[nodiscard]] bool has(std::span<float> BakedRows::*values) const {
        return std::ranges::find(values_, values, &ValueImage::values) != values_.end();
    }

    /// \param ids  the numbers of the caller
    void take(const BakedRows& rows, std::span<const std::uint32_t> ids) const {
        // A band begins at a multiple of 64 rows, after which dithering repeats.
        const auto encode = [&](const std::optional<NormalImage>& image,
                                std::span<const float> normals) {
            if (!image) return;
            const ImageView band(normals.data(), size().x, rows.row_count, 3);
            encode_normal_map(band, image->format, rows_of(image->pixels, rows));
        };
        encode(normals_, rows.normals);
        encode(bent_normals_, rows.bent_normals);
        const auto width = static_cast<std::size_t>(size().x);
        for (int row = 0; row < rows.row_count; ++row) {
            for (const ValueImage& image : values_) {
                const std::size_t count = image.channels * width;
                std::copy_n(&(rows.*image.values)[static_cast<std::size_t>(row) * count], count,
                            image.pixels.row<float>(rows.first_row + row));
            }
            for (std::size_t x = 0; ids_ && x < width; ++x) {
                const float id = rows.ids[static_cast<std::size_t>(row) * width + x];
                ids_->pixels.row<float>(rows.first_row + row)[x] =
                    id < 0.0F ? id : static_cast<float>(ids[static_cast<std::size_t>(id)]);
            }
        }
        const std::size_t first = static_cast<std::size_t>(rows.first_row) * width;
        for (std::size_t i = 0; states_ != nullptr && i < rows.states.size(); ++i)
            states_[first + i] = static_cast<std::uint8_t>(rows.states[i]);
    }

  private:
    struct NormalImage {
        MutableImageView pixels;
        NormalMapFormat format;
    };
    struct ValueImage {
        MutableImageView pixels;
        std::size_t channels = 1;
        std::span<float> BakedRows::*values = nullptr;
    };

    void add_values(const char* name, const relief_output_image& image, int channels,
                    std::span<float> BakedRows::*values) {
        if (const auto used = use(name, image, channels, channels, nullptr))
            values_.push_back({used->pixels, static_cast<std::size_t>(channels), values});
    }

    /// \param options  of normals; null: the image has values
    /// \return none if the image has no pixels
    std::optional<NormalImage> use(const char* name, const relief_output_image& image,
                                   int min_channels, int max_channels,
                                   const relief_bake_options* options) {
        if (image.pixels == nullptr) return std::nullopt;
        const MutableImageView pixels = view_of(image, name);
        const NormalMapFormat format =
            options == nullptr
                ? NormalMapFormat{}
                : normal_map_format(options->green, options->flat, options->dither, image);
        if (image.channels < min_channels || image.channels > max_channels ||
            (options == nullptr && image.sample_type != RELIEF_SAMPLE_FLOAT)) {
            throw InvalidInput(fmt::format("the {} has {} channels, but must have {}", name,
                                           image.channels,
                                           options != nullptr  ? "2 to 4"
                                           : min_channels == 1 ? "one of floats"
                                                               : "three of floats"));
        }
        if (!first_) first_ = &image;
        if (image.width != first_->width || image.height != first_->height) {
            throw InvalidInput(fmt::format("the {} has {} x {} texels, but another map has {} x {}",
                                           name, image.width, image.height, first_->width,
                                           first_->height));
        }
        return NormalImage{pixels, format};
    }

    /// Returns the rows of an image that a band has.
    static MutableImageView rows_of(const MutableImageView& image, const BakedRows& rows) {
        const auto part = [&]<typename Sample>(Sample) {
            Sample* const first = image.row<Sample>(rows.first_row);
            const std::ptrdiff_t stride =
                image.height == 1 ? 0
                                  : reinterpret_cast<std::byte*>(image.row<Sample>(1)) -
                                        reinterpret_cast<std::byte*>(image.row<Sample>(0));
            return MutableImageView(first, image.width, rows.row_count, image.channels, stride);
        };
        if (image.bits() == 8) return part(std::uint8_t{});
        if (image.bits() == 16) return part(std::uint16_t{});
        return part(float{});
    }

    const relief_output_image* first_ = nullptr;
    std::optional<NormalImage> normals_, bent_normals_, ids_;
    std::vector<ValueImage> values_;
    std::uint8_t* states_ = nullptr;
};

/// The numbers of triangles, whose order is that of their names.
class GivenIds {
  public:
    GivenIds(const relief_bake_options& options, std::span<const Mesh> high) {
        std::set<std::uint32_t> all;
        for (std::size_t i = 0; i < high.size(); ++i) {
            const std::uint32_t* const given =
                options.high_ids == nullptr ? nullptr : options.high_ids[i];
            HighIds& ids = of_meshes_.emplace_back();
            ids.mesh = &high[i];
            const auto number = static_cast<std::uint32_t>(i);
            const std::size_t count = given == nullptr ? 1 : high[i].triangles.size();
            for (std::size_t t = 0; t < count; ++t) {
                const std::uint32_t id = given == nullptr ? number : given[t];
                if (id >= max_id)
                    throw InvalidInput(
                        fmt::format("triangle {} of high mesh {} has the id {}, but "
                                    "ids must be below {}",
                                    t, i, id, max_id));
                if (t > 0 && id == given[t - 1]) continue;
                ids.triangles.push_back({static_cast<std::uint32_t>(t), fmt::format("{:08}", id)});
                all.insert(id);
            }
        }
        numbers_.assign(all.begin(), all.end());
    }

    [[nodiscard]] const std::vector<HighIds>& of_meshes() const { return of_meshes_; }
    /// By the index of a name in Baker::ids().
    [[nodiscard]] std::span<const std::uint32_t> numbers() const { return numbers_; }

  private:
    static constexpr std::uint32_t max_id = 1U << 24U;  // Floats have all smaller numbers.
    std::vector<HighIds> of_meshes_;
    std::vector<std::uint32_t> numbers_;
};

BakeOptions bake_options(const relief_bake_options& given, const BakedImages& images) {
    BakeOptions options;
    options.map.width = images.size().x;
    options.map.height = images.size().y;
    options.map.samples = given.samples;
    options.map.sample_angle = optional_value(given.sample_angle);
    options.map.padding = given.padding;
    BakeLayers& layers = options.map.layers;
    layers.normals = images.has_normals();
    layers.heights = images.has(&BakedRows::heights);
    layers.curvature = images.has(&BakedRows::curvature);
    layers.positions = images.has(&BakedRows::positions);
    layers.ids = images.has_ids();
    const OcclusionOptions occlusion{given.occlusion_rays,
                                     optional_value(given.occlusion_distance)};
    if (images.has(&BakedRows::occlusion)) layers.occlusion = occlusion;
    if (images.has_bent_normals()) layers.bent_normals = occlusion;
    if (images.has(&BakedRows::thickness)) {
        layers.thickness =
            ThicknessOptions{given.thickness_rays, optional_value(given.thickness_distance)};
    }
    options.space = enumerator(given.space, bake_spaces, "space");
    options.directions = enumerator(given.directions, bake_ray_directions, "directions");
    options.hardness = given.hardness;
    options.offset = optional_value(given.offset);
    options.max_distance = optional_value(given.max_distance);
    options.back_faces = given.take_back_faces != 0 ? BackFaces::take : BackFaces::skip;
    options.allow_size_mismatch = given.allow_size_mismatch != 0;
    if (given.cage != nullptr)
        options.cage = std::make_shared<const Mesh>(CMesh(given.cage).copy());
    return options;
}

}  // namespace

relief_status relief_bake(const relief_mesh* const* high, size_t high_count, const relief_mesh* low,
                          const relief_bake_options* options, const relief_execution* execution,
                          const relief_bake_maps* maps, relief_bake_result* result,
                          relief_report* report) {
    return guarded([&] {
        if (high == nullptr && high_count > 0) throw InvalidInput("the high meshes are NULL");
        if (maps == nullptr) throw InvalidInput("relief_bake_maps is NULL");
        const relief_bake_options read =
            read_struct(options, default_bake_options(), "relief_bake_options");
        const relief_bake_maps read_maps = read_struct(maps, {}, "relief_bake_maps");
        const BakedImages images(read_maps, read);
        if (result != nullptr)
            check_struct_size<relief_bake_result>(result->size, "relief_bake_result");
        BakeOptions bake = bake_options(read, images);
        std::vector<Mesh> meshes;
        for (std::size_t i = 0; i < high_count; ++i)
            meshes.push_back(CMesh(high[i]).copy());
        std::optional<GivenIds> ids;
        if (images.has_ids()) bake.ids = ids.emplace(read, meshes).of_meshes();
        const Execution run(execution);
        CallReport findings(report);
        const BakeResult made = bake_normals(
            meshes, CMesh(low).copy(), bake,
            [&](const BakedRows& rows) {
                images.take(rows, ids ? ids->numbers() : std::span<const std::uint32_t>());
            },
            findings, run.options());
        write_struct(result,
                     {.size = 0,
                      .texels_baked = made.texels_baked,
                      .texels_missed = made.texels_missed,
                      .rays = made.rays,
                      .offset = made.distances.offset,
                      .max_distance = made.distances.max_distance,
                      .min_height = made.min_height,
                      .max_height = made.max_height,
                      .occlusion_rays = made.occlusion_rays,
                      .thickness_rays = made.thickness_rays,
                      .open_thickness_rays = made.open_thickness_rays},
                     "relief_bake_result");
    });
}
