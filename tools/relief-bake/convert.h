// SPDX-License-Identifier: Apache-2.0
/// \file
/// `relief-bake convert`: the request, the conversion of one normal map, and its summary.
/// Tests: tests/tools/relief_bake_convert_test.cpp, tests/tools/relief_bake_texture_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "common/error_bound.h"
#include "common/measuring.h"
#include "common/normal_map_input.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/map_texture.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/texture_file.h"

namespace relief::tools {

/// A size in texels, or as a fraction of the size of the map.
struct SizeChoice {
    glm::ivec2 texels{0, 0};
    double fraction = 0.0;  ///< If positive, it replaces `texels`.
};

enum class Flip { green, red, both };

enum class AlphaChoice { keep, drop };

struct DetailOptions {
    std::optional<std::filesystem::path> file;
    NormalBlend blend = NormalBlend::reoriented;
    std::optional<double> strength;
    std::optional<glm::dvec2> repeat;
    MapInputOptions input;
};

struct ResizeChoice {
    std::optional<SizeChoice> size;
    ResizeOptions options;
};

/// The mesh of a conversion between tangent space and object space.
struct SpaceOptions {
    std::optional<std::filesystem::path> to_object;
    std::optional<std::filesystem::path> to_tangent;
    std::optional<TangentMethod> tangents;
    std::optional<bool> repeats;  ///< Texture coordinates outside of the unit square.
    std::optional<int> udim;      ///< From 1001.
};

struct MipOptions {
    bool wanted = false;
    bool lengths = false;             ///< Stored in alpha.
    std::optional<double> roughness;  ///< Of the surface.
};

/// The options of KTX2 and DDS files.
struct TextureOptions {
    std::optional<TextureFormat> format;
    std::optional<BlockQuality> quality;
    ErrorBound bound;  ///< Of the largest level.
    std::optional<int> zstd_level;
    std::optional<Measuring> measuring;  ///< Of the errors of all levels. Default: quick.

    /// For MapTextureOptions and NormalTextureOptions.
    [[nodiscard]] std::size_t measured_texels() const;
};

/// The options of maps that hold no normals.
struct ValueOptions {
    std::optional<MapKind> kind;
    std::optional<int> channel;
    std::optional<float> alpha_cutoff;
    std::optional<std::filesystem::path> normals;
};

/// The options of a conversion, the same for every map of a call.
struct ConvertRequest {
    MapInputOptions input;
    std::optional<Flip> flip;
    std::optional<AxisMapping> axes;
    std::optional<XyChannels> rebuild_z;
    bool normalize = false;
    ResizeChoice resize;
    std::optional<double> strength;
    DetailOptions detail;
    SpaceOptions space;
    MipOptions mips;
    AlphaChoice alpha = AlphaChoice::keep;
    MapOutputOptions output;
    TextureOptions texture;
    ValueOptions values;

    /// Returns whether the output has the alpha of an input that has some.
    [[nodiscard]] bool keeps_alpha() const {
        return alpha == AlphaChoice::keep && !(rebuild_z && rebuild_z->x == 3);
    }
};

/// The names of choices, for options and summaries.
Choices<ResizeFilter> filter_choices();
Choices<ResizeDomain> domain_choices();
Choices<NormalBlend> blend_choices();

/// The smallest UDIM tile number.
inline constexpr int first_udim = 1001;

/// A written mip level; level 0 is the map itself.
struct WrittenLevel {
    std::filesystem::path file;
    int width = 0;
    int height = 0;
    double mean_length = 1.0;  ///< Of the averaged vectors: 1 if all normals agree.
    double min_length = 1.0;
    std::optional<std::filesystem::path> roughness_file;
    std::optional<double> mean_roughness;
    std::optional<ErrorStats> error;  ///< Of levels in textures, in degrees.
    std::optional<SampleConfidence> confidence{};
};

/// A format and the effort of encoding it.
struct TextureEncoding {
    TextureFormat format = TextureFormat::bc5;
    BlockQuality quality = BlockQuality::normal;
};

/// The result of a conversion.
struct MapConversion {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits_read = 0;
    std::string input_text;              ///< The conventions of the input.
    std::vector<std::string> steps;      ///< The operations, in order.
    std::optional<LengthRange> lengths;  ///< Of the input's vectors, if they were measured.
    NormalMapFormat format;
    std::optional<TextureEncoding> texture;  ///< Instead of `format`, if the file is a texture.
    std::optional<Green> green;              ///< Absent: unknown.
    std::optional<MapKind> kind;             ///< The new kind, if it changes.
    std::vector<WrittenLevel> levels;
    Findings findings;
};

/// Converts a file. The stages are "read", "convert" and "write".
/// \throws FileError, UsageError
MapConversion convert_map(const Job& job, const ConvertRequest& request, Stages& stages);

void add_texture_options(CLI::App& app, TextureOptions& options);

// Maps that hold no normals become textures.

void add_value_options(CLI::App& app, ValueOptions& options);

/// \throws UsageError if options contradict each other, or have no effect
void check_value_options(const CLI::App& app, const ConvertRequest& request,
                         const std::filesystem::path& output);

/// The kind of a map that holds no normals: that of --kind, or of the metadata of the file. Absent:
/// the map holds normals. \throws FileError if the file cannot be read
std::optional<MapKind> value_kind_of(const Job& job, const ConvertRequest& request);

/// Converts a map that holds no normals. \throws FileError, UsageError
FileOutcome convert_values(const Job& job, const ConvertRequest& request, MapKind kind,
                           Stages& stages);

/// \throws UsageError if options contradict each other, or have no effect on this file
void check_texture_options(const CLI::App& app, const ConvertRequest& request,
                           const std::filesystem::path& output);

/// Chooses the encoding for --max-error, or returns the given one.
/// \throws UsageError if no encoding has so small an error
TextureEncoding choose_encoding(const TextureOptions& options, const Image& normals);

/// The angles between the normals of a mip level and the exact ones, in degrees.
struct LevelError {
    int width = 0;
    int height = 0;
    ErrorStats error;
    std::optional<SampleConfidence> confidence{};
};

/// "level 1, 128 x 128: error 0.152 degrees (99 %: 0.410, maximum: 0.900)"
std::string level_text(std::size_t level, const LevelError& error);

/// A map that others are compared with.
struct ExactMap {
    std::filesystem::path file;
    Image normals;               ///< y up; flat texels are exactly flat, as convert reads them.
    std::optional<Green> green;  ///< Of its metadata. Absent: `normals` are read with green up.
};
/// \throws FileError if the file cannot be read, or holds no normals
ExactMap read_exact_map(const std::filesystem::path& file, const AssumedKinds& assumed);

struct ExactComparison {
    std::vector<LevelError> levels;
    /// The direction of green is known for one of the maps only, and the errors are smaller if it
    /// is the opposite in the other one: they are compared so.
    bool inverts_exact = false;
    /// The direction of green is unknown for both, and the errors would be smaller with opposite
    /// ones.
    bool may_be_inverted = false;
};

/// Compares the levels of a texture, or another map, with an exact map of the same size, whose
/// levels are filtered as normals. The compared normals are those that shaders decode.
/// \param input  the conventions of `file`; absent: those of its metadata
/// \throws FileError if the file cannot be read or holds no normals, or the sizes differ
ExactComparison compare_levels(const std::filesystem::path& file, const ExactMap& exact,
                               const MapInputOptions& input);

/// The text entries of a texture with this direction of green.
std::map<std::string, std::string> texture_metadata(Green green, TextureFormat format);

/// All files that the output may consist of, with as many mip levels as the largest map has.
std::vector<std::filesystem::path> output_files(const std::filesystem::path& output,
                                                const MipOptions& mips);

}  // namespace relief::tools
