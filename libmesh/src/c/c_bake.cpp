// SPDX-License-Identifier: Apache-2.0
// Bakes: copies the meshes, and writes bands of rows to the caller's images.
#include <glm/vec2.hpp>
#include <memory>
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
        if (maps.normals.pixels) {
            normals_ = view_of(maps.normals, "normal map");
            format_ = normal_map_format(options.green, options.flat, options.dither, maps.normals);
            use("normal map", maps.normals, 2, 4);
        }
        if (maps.heights.pixels) {
            heights_ = view_of(maps.heights, "height map");
            use("height map", maps.heights, 1, 1);
        }
        if (maps.occlusion.pixels) {
            occlusion_ = view_of(maps.occlusion, "occlusion map");
            use("occlusion map", maps.occlusion, 1, 1);
        }
        if (!first_) throw InvalidInput("no map to bake has pixels");
        states_ = maps.states;
    }

    [[nodiscard]] glm::ivec2 size() const { return {first_->width, first_->height}; }
    [[nodiscard]] bool has_heights() const { return heights_.has_value(); }
    [[nodiscard]] bool has_occlusion() const { return occlusion_.has_value(); }
    [[nodiscard]] bool has_normals() const { return normals_.has_value(); }

    void take(const BakedRows& rows) const {
        const auto width = static_cast<std::size_t>(size().x);
        if (normals_) {
            // A band begins at a multiple of 64 rows, after which dithering repeats.
            const ImageView band(rows.normals.data(), size().x, rows.row_count, 3);
            encode_normal_map(band, format_, rows_of(*normals_, rows));
        }
        for (int row = 0; row < rows.row_count; ++row) {
            const std::size_t first = static_cast<std::size_t>(row) * width;
            if (heights_)
                std::copy_n(&rows.heights[first], width,
                            heights_->row<float>(rows.first_row + row));
            if (occlusion_)
                std::copy_n(&rows.occlusion[first], width,
                            occlusion_->row<float>(rows.first_row + row));
        }
        const std::size_t first = static_cast<std::size_t>(rows.first_row) * width;
        for (std::size_t i = 0; states_ != nullptr && i < rows.states.size(); ++i)
            states_[first + i] = static_cast<std::uint8_t>(rows.states[i]);
    }

  private:
    void use(const char* name, const relief_output_image& image, int min_channels,
             int max_channels) {
        const bool is_value = max_channels == 1;
        if (image.channels < min_channels || image.channels > max_channels ||
            (is_value && image.sample_type != RELIEF_SAMPLE_FLOAT)) {
            throw InvalidInput(fmt::format("the {} has {} channels, but must have {}", name,
                                           image.channels, is_value ? "one of floats" : "2 to 4"));
        }
        if (!first_) first_ = &image;
        if (image.width != first_->width || image.height != first_->height) {
            throw InvalidInput(fmt::format("the {} has {} x {} texels, but another map has {} x {}",
                                           name, image.width, image.height, first_->width,
                                           first_->height));
        }
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
    std::optional<MutableImageView> normals_, heights_, occlusion_;
    NormalMapFormat format_;
    std::uint8_t* states_ = nullptr;
};

BakeOptions bake_options(const relief_bake_options& given, const BakedImages& images) {
    BakeOptions options;
    options.map.width = images.size().x;
    options.map.height = images.size().y;
    options.map.samples = given.samples;
    options.map.sample_angle = optional_value(given.sample_angle);
    options.map.padding = given.padding;
    options.map.layers.normals = images.has_normals();
    options.map.layers.heights = images.has_heights();
    if (images.has_occlusion()) {
        options.map.layers.occlusion =
            OcclusionOptions{given.occlusion_rays, optional_value(given.occlusion_distance)};
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
        const BakeOptions bake = bake_options(read, images);
        std::vector<Mesh> meshes;
        for (std::size_t i = 0; i < high_count; ++i)
            meshes.push_back(CMesh(high[i]).copy());
        const Execution run(execution);
        CallReport findings(report);
        const BakeResult made = bake_normals(
            meshes, CMesh(low).copy(), bake,
            [&images](const BakedRows& rows) { images.take(rows); }, findings, run.options());
        write_struct(result,
                     {.size = 0,
                      .texels_baked = made.texels_baked,
                      .texels_missed = made.texels_missed,
                      .rays = made.rays,
                      .offset = made.distances.offset,
                      .max_distance = made.distances.max_distance,
                      .min_height = made.min_height,
                      .max_height = made.max_height},
                     "relief_bake_result");
    });
}
