// SPDX-License-Identifier: Apache-2.0
/// \file
/// From a file of heights to a file of normals or slopes, band by band, so that images larger than
/// memory can be converted. Tests: tests/mesh/io/maps/bump_file_test.cpp,
/// bump_file_memory_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/image_part.h"
#include "relief/mesh/image_rows.h"

namespace relief {

/// Which heights of a file to take.
struct HeightMapChoice {
    HeightChannel channel = HeightChannel::mean;
    /// Takes transparent texels for a part of the surface.
    bool ignore_alpha = false;
    /// Maps whose samples take more bytes than this are read by rows, twice or more often.
    std::size_t most_memory = std::size_t{640} << 20;
    /// How much is worked on at once.
    std::size_t texels_per_band = std::size_t{1} << 22;
};

/// A height map in a file: in memory if it is not too large, else read as its rows are needed.
class HeightMapFile {
  public:
    /// Opens a file; one that is not too large is read.
    /// \throws FileError as read_image(); InvalidInput as height_map()
    explicit HeightMapFile(const std::filesystem::path& file, const HeightMapChoice& choice = {});

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] const HeightMapChoice& choice() const { return choice_; }
    /// Of the file.
    [[nodiscard]] const ImageInfo& info() const { return info_; }
    /// Whether it is too large to be in memory.
    [[nodiscard]] bool is_streamed() const { return is_streamed_; }
    /// All of it, unless it is streamed; it may be changed before it is converted.
    [[nodiscard]] HeightMap& map() { return map_; }
    [[nodiscard]] const HeightMap& map() const { return map_; }
    [[nodiscard]] int rows_per_band() const;

    /// What the map shows of itself.
    struct Survey {
        Tiling tiling;
        std::vector<Image> parts;
        double colored_share = 0.0;        ///< As in HeightMap.
        double partial_alpha_share = 0.0;  ///< The same.
    };
    /// Looks at the seams, and takes out parts; a streamed map is read once for both. What a
    /// transparent texel hides counts for neither: in parts, the surface beside goes on there.
    /// \param parts  within the map, from top to bottom
    /// \throws FileError
    [[nodiscard]] Survey survey(std::span<const ImagePart> parts) const;

  private:
    std::filesystem::path path_;
    HeightMapChoice choice_;
    ImageInfo info_;
    bool is_streamed_ = false;
    HeightMap map_;
};

/// What is made of the heights.
enum class BumpContent {
    normals,
    /// Height, slopes dh/dx and dh/dy, their squares and their product: the moments of which
    /// filtered texels give mean and variance of the slope [Olano and Baker 2010]. Six float
    /// channels, in the order and by the names of OpenImageIO's bumpslopes; EXR and TIFF only.
    slope_moments,
};

/// What goes into the alpha of a normal map.
enum class MapAlpha {
    none,
    height,  ///< The height as it was read: 0 to 1.
    keep,    ///< The alpha of the height map; 1 where it has none.
};

struct BumpFileFormat {
    BumpContent content = BumpContent::normals;
    /// Of normals. Of slope moments only `green` counts: it says where dh/dy points.
    NormalMapFormat normals{};
    /// Normals without z: blue is 0.
    bool xy_only = false;
    MapAlpha alpha = MapAlpha::none;
    ImageWriteOptions write{};
    /// Added to what says what the map holds: normal_map_metadata().
    std::map<std::string, std::string> metadata{};
};

/// Milliseconds of the parts of a conversion. Of a streamed map the reading overlaps the rest.
struct BumpFileTimes {
    double read = 0.0;
    double convert = 0.0;
    double write = 0.0;
};

/// Converts a height map and writes the result.
///
/// \param options   as in normals_from_height(). A negative strength turns the heights that
///                  MapAlpha::height keeps around as well: 1 less them
/// \param report    counts what normals_from_height() does, heights and alphas outside [0,1] that
///                  had to be clamped to it (in 8 and 16 bits), and what write_image() reports
/// \param progress  if given, called with the part that is done, 0 to 1, after every band
///
/// Transparent texels become flat, and the surface around them does not see what colour they hide
/// (see filled_holes()). The same bytes whether the map is streamed or not, and for any number of
/// threads.
///
/// \throws InvalidInput, FileError as normal_map_from_height() and write_image(); FileError if a
///         streamed map has a transparent texel or a height that is not finite, which only a map in
///         memory has filled
BumpFileTimes write_bump_file(const HeightMapFile& source, const BumpOptions& options,
                              const std::filesystem::path& file, const BumpFileFormat& format,
                              Report& report, const std::function<void(double)>& progress = {});

}  // namespace relief
