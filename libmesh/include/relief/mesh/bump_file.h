// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts height map files to files of normals or slopes, in bands of rows, so that images may be
/// larger than memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"

namespace RELIEF_API relief {

/// The channel of a file that holds the heights, and the memory limit for reading it.
struct HeightMapOptions {
    HeightChannel channel = HeightChannel::mean;
    /// Treats transparent texels as part of the surface.
    bool ignore_alpha = false;
    /// Maps with more bytes of samples than this are read by rows, two or more times.
    std::size_t max_memory = std::size_t{640} << 20;
    /// Size of a band.
    std::size_t texels_per_band = std::size_t{1} << 22;
};

/// A height map of a file. It is in memory unless it is too large; then its rows are read when they
/// are needed.
class HeightMapFile {
  public:
    /// Opens a file, and reads it unless it is too large.
    /// \throws FileError as read_image(); InvalidInput as height_map()
    explicit HeightMapFile(const std::filesystem::path& file, const HeightMapOptions& choice = {});

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] const HeightMapOptions& choice() const { return choice_; }
    /// Information about the file.
    [[nodiscard]] const ImageInfo& info() const { return info_; }
    /// Returns true if the map is too large to be in memory.
    [[nodiscard]] bool is_streamed() const { return is_streamed_; }
    /// The map, unless it is streamed. It may be changed before the conversion.
    [[nodiscard]] HeightMap& map() { return map_; }
    [[nodiscard]] const HeightMap& map() const { return map_; }
    [[nodiscard]] int rows_per_band() const;

    /// Properties of the map.
    struct Survey {
        Tiling tiling;
        std::vector<Image> parts;
        double colored_fraction = 0.0;        ///< As in HeightMap.
        double partial_alpha_fraction = 0.0;  ///< As in HeightMap.
    };
    /// Examines the seams and copies parts of the map; a streamed map is read once for both. Values
    /// of transparent texels are ignored: in parts they are replaced by a continuation of the
    /// surface.
    /// \param parts  within the map, from top to bottom
    /// \throws FileError
    [[nodiscard]] Survey survey(std::span<const ImagePart> parts) const;

  private:
    std::filesystem::path path_;
    HeightMapOptions choice_;
    ImageInfo info_;
    bool is_streamed_ = false;
    HeightMap map_;
};

/// The content of the result.
enum class BumpContent {
    normals,
    /// Height, slopes dh/dx and dh/dy, their squares and their product: the moments from which
    /// filtered texels give mean and variance of the slope [Olano and Baker 2010]. Six float
    /// channels in the order and with the names of OpenImageIO's bumpslopes; EXR and TIFF only.
    slope_moments,
};

/// The alpha channel of a normal map.
enum class MapAlpha {
    none,
    height,  ///< The height as it was read: 0 to 1.
    keep,    ///< The alpha of the height map; 1 if it has none.
};

template <>
inline constexpr auto enum_names<MapAlpha> = std::to_array<EnumName<MapAlpha>>(
    {{"none", MapAlpha::none}, {"height", MapAlpha::height}, {"keep", MapAlpha::keep}});

struct BumpFileFormat {
    BumpContent content = BumpContent::normals;
    /// The format of normals. For slope moments only `green` matters: it defines the direction of
    /// dh/dy.
    NormalMapFormat normals{};
    /// Normals without z: blue is 0.
    bool xy_only = false;
    MapAlpha alpha = MapAlpha::none;
    ImageWriteOptions write{};
    /// Added to the entries of normal_map_metadata().
    std::map<std::string, std::string> metadata{};
};

/// Milliseconds of the parts of a conversion. Reading a streamed map overlaps the rest.
struct BumpFileTimes {
    double read = 0.0;
    double convert = 0.0;
    double write = 0.0;
};

/// Converts a height map and writes the result.
///
/// \param options   as in normals_from_height(). A negative strength also inverts the heights in
///         alpha (1 - height)
/// \param report    counts the findings of normals_from_height() and write_image(), and heights and
///         alphas outside [0,1] that were clamped (for 8 and 16 bits)
/// \param progress  if given, called after each band with the fraction that is done, 0 to 1
///
/// Transparent texels become flat, and their hidden values do not affect the surface around them
/// (see filled_holes()). The bytes of the result do not depend on streaming and on the number of
/// threads.
///
/// \throws InvalidInput, FileError as normal_map_from_height() and write_image(); FileError if a
///         streamed map has a transparent texel or a non-finite height, which are filled only in
///         maps in memory
BumpFileTimes write_bump_file(const HeightMapFile& source, const BumpOptions& options,
                              const std::filesystem::path& file, const BumpFileFormat& format,
                              Report& report = IgnoredReport(),
                              const std::function<void(double)>& progress = {});

}  // namespace relief
