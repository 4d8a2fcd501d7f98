// SPDX-License-Identifier: Apache-2.0
// Converts a normal map file. If only the axes change, the stored codes are mapped exactly;
// otherwise the normals are decoded to unit floats, pass through a list of steps, and are encoded.
// The library does both by bands of rows. Mip levels, conversions of the space and textures
// for GPUs need the whole map in memory.
// Tests: tests/tools/relief_bake_convert_test.cpp, tests/tools/relief_bake_texture_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/model_file.h"
#include "common/options.h"
#include "common/text.h"
#include "convert.h"
#include "relief/mesh/image.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_file.h"
#include "relief/mesh/normal_texture.h"
#include "relief/mesh/report.h"

namespace relief::tools {
namespace {

/// Bands of textures are small, because their floats and those of all levels stay in the cache.
constexpr std::size_t texels_per_band_of_textures = std::size_t{1} << 18;

constexpr AxisMapping flip_green = {{{0, false}, {1, true}, {2, false}}};

/// A decoded map between the steps.
struct NormalField {
    Image normals;               ///< Three float channels, unit.
    std::optional<Image> alpha;  ///< One float channel of the same size, if it is kept.
    /// The direction of y in the image, which is already that of the output; absent: unknown.
    std::optional<Green> green;
    bool is_object_space = false;  ///< Object space has no green direction.
    std::string note;              ///< Added by a step to its description.
};

/// An operation on the normals, with its description for the summary: "slopes times 2".
struct ConvertStep {
    std::string description;
    std::function<void(NormalField& field, Report& report)> apply;
};

// Size, slopes and detail.

glm::ivec2 size_of(const SizeChoice& choice, int width, int height) {
    if (choice.fraction == 0.0) return choice.texels;
    const auto side = [&](int size) {
        return std::max(1, static_cast<int>(std::lround(size * choice.fraction)));
    };
    return {side(width), side(height)};
}

ConvertStep resize_step(const ResizeChoice& choice) {
    const ResizeOptions& options = choice.options;
    const SizeChoice& size = *choice.size;
    const std::string target = size.fraction > 0.0
                                   ? fmt::format("{:g} %", size.fraction * 100.0)
                                   : fmt::format("{} x {}", size.texels.x, size.texels.y);
    return {
        fmt::format("resized to {} by {} ({})", target, name_of(options.domain, domain_choices()),
                    name_of(options.filter, filter_choices())),
        [=](NormalField& field, Report& report) {
            const glm::ivec2 texels = size_of(size, field.normals.width, field.normals.height);
            field.normals = resize_normals(field.normals, texels.x, texels.y, options, report);
            if (field.alpha)
                field.alpha = resize_samples(*field.alpha, texels.x, texels.y, options);
        }};
}

ConvertStep strength_step(double strength) {
    return {fmt::format("slopes times {:g}", strength), [=](NormalField& field, Report& report) {
                scale_slopes(field.normals, strength, report);
            }};
}

/// Reads the normals of the detail map, with the green direction of the base.
Image read_detail(const DetailOptions& options, const std::optional<Green>& green_of_base,
                  Report& report) {
    const InputMap detail = read_normal_map(*options.file, options.input);
    Image normals = about(*options.file, [&] {
        return decode_normal_map(detail.image, Green::up, detail.flat, report, FlatTexels::exact);
    });
    const std::optional<Green> base_green = green_of_base ? green_of_base : detail.green;
    const Green green = detail.green.value_or(base_green.value_or(Green::up));
    if (base_green && green != *base_green) map_normal_axes(normals, flip_green);
    if (options.strength) scale_slopes(normals, *options.strength, report);
    return normals;
}

/// Adds the findings of another file, with a suffix that distinguishes them from the map's.
void add_with_suffix(const Report& other, const std::string& suffix, Report& report) {
    for (Finding finding : other.findings()) {
        finding.kind += suffix;
        report.add(finding);
    }
}

/// Reads the detail map for a base of this size.
DetailLayer detail_layer(const DetailOptions& detail, const ResizeChoice& resize,
                         const std::optional<Green>& green_of_base, glm::ivec2 base_size) {
    ResizeOptions options;
    options.filter = resize.options.filter;
    options.repeat = detail.repeat.value_or(options.repeat);
    DetailLayer layer;
    layer.blend = detail.blend;
    Report report;
    layer.normals = fitted_detail(read_detail(detail, green_of_base, report), base_size.x,
                                  base_size.y, options, report);
    add_with_suffix(report, " in the detail", layer.report);
    return layer;
}

ConvertStep detail_step(const DetailOptions& detail, const ResizeChoice& resize) {
    std::string description = fmt::format("detail {} blended ({}", detail.file->string(),
                                          name_of(detail.blend, blend_choices()));
    if (detail.repeat)
        description += fmt::format(", {:g} x {:g} times", detail.repeat->x, detail.repeat->y);
    if (detail.strength) description += fmt::format(", slopes times {:g}", *detail.strength);
    return {description + ")", [=](NormalField& field, Report& report) {
                const DetailLayer layer = detail_layer(detail, resize, field.green,
                                                       {field.normals.width, field.normals.height});
                report.merge(layer.report);
                blend_normals(field.normals, layer.normals, layer.blend, report);
            }};
}

// Conversions between tangent space and object space.

struct TargetMesh {
    Mesh mesh;
    bool has_file_tangents = true;  ///< All tangents are those of the file.
};

/// Reads the mesh of the map in object space, with normals and tangents.
TargetMesh read_target(const std::filesystem::path& file, std::optional<TangentMethod> tangents,
                       Report& report) {
    TargetMesh target;
    MapModel model = read_map_model(file, ModelSpace::object, report);
    require_texcoords(file, model, "no texture coordinates", "unwrap it first");
    about(file, [&] {
        for (MapModelPart& part : model.parts) {
            const bool keeps =
                !tangents && !part.mesh.tangents.empty() && !part.mesh.normals.empty();
            target.has_file_tangents = target.has_file_tangents && keeps;
            FrameOptions options;
            options.tangents =
                keeps ? TangentMethod::keep : tangents.value_or(TangentMethod::mikktspace);
            part.mesh = with_frames(std::move(part.mesh), options, report).mesh;
        }
        target.mesh = joined(std::move(model.parts));
    });
    if (target.mesh.triangles.empty()) throw FileError(file, "has no triangles");
    return target;
}

/// Converts the field with object_from_tangent() or tangent_from_object(), and notes how much of
/// the map the mesh covers.
template <typename Conversion>
void convert_space(const Conversion& conversion, const SpaceOptions& space,
                   const std::filesystem::path& file, NormalField& field, Report& report) {
    Report mesh_report;
    const TargetMesh target = read_target(file, space.tangents, mesh_report);
    add_with_suffix(mesh_report, " in the mesh", report);
    // UDIM numbers grow upwards, texture coordinates downwards.
    constexpr int tiles_across = 10;
    const int index = space.udim.value_or(first_udim) - first_udim;
    const MapRegion placement = {{index % tiles_across, -(index / tiles_across)},
                                 space.repeats.value_or(false)};
    ConvertedNormals converted = conversion(field.normals, target.mesh, placement, report);
    field.normals = std::move(converted.normals);
    const Coverage& coverage = converted.coverage;
    const double all = static_cast<double>(coverage.inside + coverage.touched + coverage.empty);
    field.note = fmt::format(
        ", with {} tangents; the mesh covers {:.1f} % of the map, the rest is (0, 0, 1)",
        target.has_file_tangents ? "the file's" : "new",
        100.0 * static_cast<double>(coverage.inside + coverage.touched) / all);
}

ConvertStep to_object_step(const SpaceOptions& space) {
    return {fmt::format("to the object space of {}", space.to_object->string()),
            [space](NormalField& field, Report& report) {
                if (!field.green) {
                    throw InvalidInput(
                        "the direction of its green channel is unknown (give --input-green)");
                }
                if (*field.green == Green::down) map_normal_axes(field.normals, flip_green);
                convert_space(object_from_tangent, space, *space.to_object, field, report);
                field.green.reset();
                field.is_object_space = true;
            }};
}

ConvertStep to_tangent_step(const SpaceOptions& space) {
    return {fmt::format("to the tangent space of {}", space.to_tangent->string()),
            [space](NormalField& field, Report& report) {
                convert_space(tangent_from_object, space, *space.to_tangent, field, report);
                if (field.green == Green::down) map_normal_axes(field.normals, flip_green);
                field.green = field.green.value_or(Green::up);
            }};
}

/// The steps of a request, in their fixed order.
std::vector<ConvertStep> steps_of(const ConvertRequest& request) {
    std::vector<ConvertStep> steps;
    if (request.space.to_tangent) steps.push_back(to_tangent_step(request.space));
    if (request.resize.size) steps.push_back(resize_step(request.resize));
    if (request.strength) steps.push_back(strength_step(*request.strength));
    if (request.detail.file) steps.push_back(detail_step(request.detail, request.resize));
    if (request.space.to_object) steps.push_back(to_object_step(request.space));
    return steps;
}

// Axes.

/// The mapping that --flip or --axes asks for.
AxisMapping requested_mapping(const ConvertRequest& request) {
    AxisMapping mapping = request.axes.value_or(same_axes);
    if (!request.flip) return mapping;
    mapping[0].is_negative = *request.flip != Flip::green;
    mapping[1].is_negative = *request.flip != Flip::red;
    return mapping;
}

/// The green direction after a mapping, if it is known.
std::optional<Green> mapped_green(std::optional<Green> green, const AxisMapping& mapping) {
    const bool keeps_axes = mapping[1].axis == 1 && mapping[2] == same_axes[2];
    if (!green || !keeps_axes) return std::nullopt;
    if (!mapping[1].is_negative) return green;
    return *green == Green::up ? Green::down : Green::up;
}

/// The complete mapping of the stored vectors, and the green direction after it.
struct AxisConversion {
    AxisMapping mapping = same_axes;
    std::optional<Green> green;
};

AxisConversion axis_conversion(const Job& job, const ConvertRequest& request,
                               const InputMap& input) {
    AxisMapping mapping = requested_mapping(request);
    const std::optional<Green> green = mapped_green(input.green, mapping);
    const std::optional<Green> wanted = request.output.green;
    if (!wanted || green == wanted) return {mapping, green};
    if (!green) {
        throw failure(job.input, "the direction of its green channel is unknown",
                      "give --input-green, or --flip green to invert it in any case");
    }
    mapping[1].is_negative = !mapping[1].is_negative;
    return {mapping, wanted};
}

std::string describe_axes(const AxisMapping& mapping) {
    if (mapping == flip_green) return "green inverted";
    const auto axis_name = [](const SignedAxis& axis) {
        return std::string(axis.is_negative ? "-" : "") + "xyz"[axis.axis];
    };
    return fmt::format("axes mapped to {},{},{}", axis_name(mapping[0]), axis_name(mapping[1]),
                       axis_name(mapping[2]));
}

// Encoding and writing of the map and its mip levels.

/// "out/wall-mip02.png", "out/wall-roughness-mip02.png"; level 0 has no number.
std::filesystem::path level_file(const std::filesystem::path& output, std::size_t level,
                                 bool is_roughness) {
    std::string name = output.stem().string();
    if (is_roughness) name += "-roughness";
    if (level > 0) name += fmt::format("-mip{:02}", level);
    return output.parent_path() / (name + output.extension().string());
}

double mean_of(const Image& image) {
    double sum = 0.0;
    for (const float value : image.as<float>())
        sum += static_cast<double>(value);
    return sum / static_cast<double>(image.sample_count());
}

/// Rounds one channel to the bit depth of the map.
Image encode_channel(const Image& values, int bits) {
    if (bits == 32) return values;
    Image result = make_image(values.width, values.height, 1, bits, ColorSpace::data);
    const std::span<const float> from = values.as<float>();
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            const float largest = bits == 8 ? 255.0F : 65535.0F;
            for (std::size_t i = 0; i < samples.size(); ++i)
                samples[i] = static_cast<Sample>(std::lround(from[i] * largest));
        },
        result.samples);
    return result;
}

/// Writes the map, its mip levels and their roughness, and adds them to the result.
class LevelWriter {
  public:
    LevelWriter(const Job& job, const ConvertRequest& request, const InputMap& input,
                Stages& stages, Report& report, MapConversion& result)
        : job_(job),
          request_(request),
          kept_(kept_metadata(input.metadata)),
          stated_(read_description(input.metadata)),
          stages_(stages),
          report_(report),
          result_(result) {
        has_alpha_ = input.info.channels == 4 && request.keeps_alpha();
        if (has_alpha_) alpha_ = stated_.alpha;
        if (request.mips.lengths) alpha_ = AlphaContent::length;
    }

    /// Encodes and writes the map, and with --mips all levels. Frees the field on the way.
    void write_field(NormalField& field) {
        if (request_.mips.lengths && field.alpha) {
            throw UsageError(
                fmt::format("--mip-lengths: {} has an alpha channel", job_.input.string()),
                "give --alpha drop");
        }
        if (is_texture(job_.output)) return write_texture_levels(field);
        if (request_.mips.wanted) return write_all_levels(field);
        const Image codes =
            stages_.run("convert", [&] { return encode(field.normals, field.alpha); });
        field = NormalField{};  // Before writing, which needs memory itself.
        stages_.run("write", [&] { write(job_.output, codes, metadata()); });
        result_.levels.push_back(
            {job_.output, codes.width, codes.height, 1.0, 1.0, {}, {}, {}, {}});
    }

    /// Converts the map by rows and writes it as a texture.
    void write_texture_by_rows(const NormalMapSource& source,
                               const NormalMapConversion& conversion) {
        const TextureEncoding encoding{request_.texture.format.value_or(TextureFormat::bc5),
                                       request_.texture.quality.value_or(BlockQuality::normal)};
        check_alpha(encoding.format, has_alpha_);
        EncodedMapFile encoded =
            encode_normal_map_file(source, conversion, options_for(encoding), report_,
                                   [&](double part) { stages_.show_progress("convert", part); });
        stages_.clear_progress();
        if (source.image == nullptr) stages_.book("read", encoded.times.read);
        stages_.book("convert", encoded.times.convert);
        result_.lengths = encoded.lengths;
        write_encoded(encoding, std::move(encoded.encoded));
    }

    /// Adds the step of the levels of a texture that was written.
    void describe_texture_levels() {
        if (request_.mips.wanted)
            result_.steps.push_back(describe_levels(result_.levels.size() - 1));
    }

    /// Converts and writes the map by rows.
    void write_by_rows(const NormalMapSource& source, NormalMapConversion conversion) {
        conversion.metadata = metadata(conversion.keeps_codes);
        conversion.write = write_options_of(request_.output, job_.output);
        const ConvertedMapFile converted =
            convert_normal_map_file(source, job_.output, conversion, report_,
                                    [&](double part) { stages_.show_progress("convert", part); });
        stages_.clear_progress();
        if (source.image == nullptr) stages_.book("read", converted.times.read);
        stages_.book("convert", converted.times.convert);
        stages_.book("write", converted.times.write);
        result_.lengths = converted.lengths;
        result_.levels.push_back(
            {job_.output, conversion.width, conversion.height, 1.0, 1.0, {}, {}, {}, {}});
    }

  private:
    void write_all_levels(NormalField& field) {
        Image unit_lengths =
            make_image(field.normals.width, field.normals.height, 1, 32, ColorSpace::data);
        std::ranges::fill(unit_lengths.as<float>(), 1.0F);
        write_level(0, field.normals, unit_lengths, field.alpha);
        unit_lengths = Image{};
        std::vector<Image> levels =
            stages_.run("convert", [&] { return normal_mip_levels(field.normals); });
        field.normals = Image{};
        result_.steps.push_back(describe_levels(levels.size()));
        const std::vector<Image> alphas =
            field.alpha ? mip_levels(*field.alpha) : std::vector<Image>{};
        for (std::size_t i = 0; i < levels.size(); ++i) {
            const Image lengths =
                stages_.run("convert", [&] { return split_lengths(levels[i], report_); });
            write_level(i + 1, levels[i], lengths,
                        alphas.empty() ? std::nullopt : std::optional<Image>(alphas[i]));
        }
    }

    void write_level(std::size_t level, const Image& normals, const Image& lengths,
                     const std::optional<Image>& alpha) {
        const Image codes = stages_.run("convert", [&] {
            return request_.mips.lengths ? encode(normals, lengths) : encode(normals, alpha);
        });
        const auto all = lengths.as<float>();
        WrittenLevel written{level == 0 ? job_.output : level_file(job_.output, level, false),
                             codes.width,
                             codes.height,
                             mean_of(lengths),
                             static_cast<double>(*std::min_element(all.begin(), all.end())),
                             {},
                             {},
                             {},
                             {}};
        stages_.run("write", [&] { write(written.file, codes, metadata()); });
        if (request_.mips.roughness) write_roughness(written, level, lengths);
        result_.levels.push_back(std::move(written));
    }

    void write_roughness(WrittenLevel& written, std::size_t level, const Image& lengths) {
        const double base = *request_.mips.roughness;
        const std::filesystem::path file = level_file(job_.output, level, true);
        const Image roughness =
            stages_.run("convert", [&] { return roughness_from_lengths(lengths, base); });
        written.roughness_file = file;
        written.mean_roughness = mean_of(roughness);
        stages_.run("write", [&] {
            write(file, encode_channel(roughness, result_.format.bits),
                  roughness_entries(result_.format.bits));
        });
    }

    // Textures have all levels in one file.

    void write_texture_levels(NormalField& field) {
        const TextureEncoding encoding = stages_.run(
            "convert", [&] { return choose_encoding(request_.texture, field.normals); });
        NormalTexture encoded = stages_.run("convert", [&] {
            check_alpha(encoding.format, field.alpha.has_value());
            NormalTextureEncoder encoder(field.normals.width, field.normals.height,
                                         field.alpha.has_value(), options_for(encoding));
            encoder.add(field.normals, field.alpha ? &*field.alpha : nullptr);
            field = NormalField{};
            return encoder.finish(report_);
        });
        write_encoded(encoding, std::move(encoded));
        describe_texture_levels();
    }

    [[nodiscard]] NormalTextureOptions options_for(const TextureEncoding& encoding) const {
        return {.format = encoding.format,
                .quality = encoding.quality,
                .has_mips = request_.mips.wanted,
                .roughness = request_.mips.roughness,
                .measured_texels = request_.texture.measured_texels()};
    }

    static void check_alpha(TextureFormat format, bool has_alpha) {
        if (!has_alpha || stores_alpha(format)) return;
        throw UsageError(
            fmt::format("--format {}: stores no alpha, which the map has", enum_name(format)),
            "give --alpha drop, or a format with alpha");
    }

    void write_encoded(const TextureEncoding& encoding, NormalTexture encoded) {
        result_.texture = encoding;
        encoded.texture.metadata = texture_entries(encoding.format);
        const TextureWriteOptions options{request_.texture.zstd_level};
        stages_.run("write",
                    [&] { write_texture(job_.output, encoded.texture, options, report_); });
        std::optional<std::filesystem::path> roughness_file;
        if (encoded.roughness) {
            roughness_file = level_file(job_.output, 0, true);
            encoded.roughness->metadata = roughness_entries(bits_of(encoded.roughness->format));
            stages_.run("write", [&] {
                write_texture(*roughness_file, *encoded.roughness, options, report_);
            });
        }
        for (const NormalTextureLevel& level : encoded.levels) {
            result_.levels.push_back({job_.output, level.width, level.height, level.mean_length,
                                      level.min_length, roughness_file, level.mean_roughness,
                                      level.error, level.confidence});
        }
    }

    [[nodiscard]] std::string describe_levels(std::size_t count) const {
        std::string text = fmt::format("{} of averaged normals", counted(count, "mip level"));
        if (request_.mips.lengths) text += ", lengths in alpha";
        if (request_.mips.roughness)
            text += fmt::format(", compensated for roughness {:g}", *request_.mips.roughness);
        return text;
    }

    /// The normals already have the green direction of the output.
    [[nodiscard]] Image encode(const Image& normals, const std::optional<Image>& alpha) const {
        NormalMapFormat format = result_.format;
        format.green = Green::up;
        Image codes = encode_normal_map(normals, format, report_);
        return alpha ? with_alpha(codes, *alpha) : codes;
    }

    void write(const std::filesystem::path& file, const Image& image,
               const std::map<std::string, std::string>& metadata) const {
        write_image(file, image, metadata, write_options_of(request_.output, file), report_);
    }

    [[nodiscard]] std::map<std::string, std::string> roughness_entries(int bits) const {
        std::map<std::string, std::string> entries =
            write_description({.kind = MapKind::roughness, .color_space = ColorSpace::data}, bits);
        entries["relief:roughness"] = fmt::format("{:g}", *request_.mips.roughness);
        return entries;
    }

    /// The input's metadata, with the entries that changed.
    /// \param keeps_codes  z is still missing if the input lacks it
    [[nodiscard]] std::map<std::string, std::string> metadata(bool keeps_codes = false) const {
        NormalMapFormat format = result_.format;
        format.green = result_.green.value_or(Green::up);
        MapDescription description = read_description(normal_map_metadata(format));
        description.xy_only = keeps_codes && stated_.xy_only;
        return with_kept_entries(description, format.bits);
    }

    [[nodiscard]] std::map<std::string, std::string> texture_entries(TextureFormat format) const {
        return with_kept_entries(
            read_description(texture_metadata(result_.green.value_or(Green::up), format)),
            bits_of(format));
    }

    [[nodiscard]] std::map<std::string, std::string> with_kept_entries(MapDescription description,
                                                                       int bits) const {
        description.green = result_.green;
        description.kind = result_.kind.value_or(stated_.kind.value_or(MapKind::normal));
        description.alpha = alpha_;
        std::map<std::string, std::string> entries = write_description(description, bits);
        const auto is_described = [](const std::string& key) {
            return std::ranges::count(description_keys(), key) > 0;
        };
        for (const auto& [key, value] : kept_) {
            if (!is_described(key)) entries.emplace(key, value);
        }
        return entries;
    }

    const Job& job_;
    const ConvertRequest& request_;
    std::map<std::string, std::string> kept_;
    MapDescription stated_;              ///< By the input.
    bool has_alpha_ = false;             ///< The input has alpha, which the output keeps.
    std::optional<AlphaContent> alpha_;  ///< Of the output, if it is known.
    Stages& stages_;
    Report& report_;
    MapConversion& result_;
};

// The conversion.

void check_channels(const Job& job, const ConvertRequest& request, const InputMap& input) {
    if (input.info.channels > 2 || request.rebuild_z) return;
    throw failure(job.input, "has only 2 channels, and no z", "give --rebuild-z rg to compute z");
}

/// Returns whether only the axes change, so that the codes need not be decoded.
bool keeps_codes(const ConvertRequest& request, const InputMap& input,
                 const NormalMapFormat& format) {
    const bool same_codes =
        input.info.bits == format.bits && (format.bits == 32 || input.flat == format.flat);
    return same_codes && !request.rebuild_z && !request.normalize && !request.mips.wanted &&
           steps_of(request).empty();
}

/// Returns whether the whole map must be in memory.
bool needs_whole_map(const Job& job, const ConvertRequest& request) {
    if (request.space.to_object || request.space.to_tangent) return true;
    return is_texture(job.output) ? request.texture.bound.degrees.has_value() : request.mips.wanted;
}

std::string describe_lengths(const LengthRange& lengths) {
    return fmt::format("normalized (lengths were {:.3f} to {:.3f}, mean {:.3f})", lengths.min,
                       lengths.max, lengths.mean);
}

/// Converts the stored codes, of which only axes and alpha change.
void convert_codes(const ConvertRequest& request, const InputMap& input,
                   const NormalMapSource& source, const AxisConversion& axes, LevelWriter& writer,
                   MapConversion& result) {
    if (request.output.dither && *request.output.dither != Dither::none)
        throw UsageError("--dither: has no effect if all codes are kept");
    NormalMapConversion conversion;
    conversion.keeps_codes = true;
    conversion.axes = axes.mapping;
    conversion.keeps_alpha = request.alpha == AlphaChoice::keep;
    conversion.width = input.info.width;
    conversion.height = input.info.height;
    if (axes.mapping != same_axes) result.steps.push_back(describe_axes(axes.mapping));
    if (input.info.channels == 4 && !conversion.keeps_alpha)
        result.steps.emplace_back("alpha dropped");
    if (result.steps.empty()) result.steps.emplace_back("nothing");
    result.steps.back() += ", all codes kept";
    writer.write_by_rows(source, std::move(conversion));
}

/// Decodes, converts and encodes the map by rows.
void convert_rows(const std::filesystem::path& output, const ConvertRequest& request,
                  const InputMap& input, const NormalMapSource& source, const AxisConversion& axes,
                  Stages& stages, LevelWriter& writer, MapConversion& result) {
    NormalMapConversion conversion;
    conversion.rebuild_z = request.rebuild_z;
    conversion.axes = axes.mapping;
    conversion.keeps_alpha = request.alpha == AlphaChoice::keep;
    glm::ivec2 size = {input.info.width, input.info.height};
    if (request.resize.size) size = size_of(*request.resize.size, size.x, size.y);
    conversion.width = size.x;
    conversion.height = size.y;
    conversion.resize = request.resize.options;
    conversion.strength = request.strength;
    if (request.detail.file) {
        conversion.detail = stages.run("convert", [&] {
            return detail_layer(request.detail, request.resize, axes.green, size);
        });
    }
    conversion.format = result.format;
    const bool writes_texture = is_texture(output);
    if (writes_texture) {
        conversion.texels_per_band = texels_per_band_of_textures;
        writer.write_texture_by_rows(source, conversion);
    } else {
        writer.write_by_rows(source, std::move(conversion));
    }
    result.steps.push_back(request.rebuild_z ? "z computed from x and y"
                                             : describe_lengths(*result.lengths));
    if (axes.mapping != same_axes) result.steps.push_back(describe_axes(axes.mapping));
    for (const ConvertStep& step : steps_of(request))
        result.steps.push_back(step.description);
    if (writes_texture) writer.describe_texture_levels();
}

/// Decodes the unit normals of the input, with y as it is stored.
Image decode_input(const ConvertRequest& request, const InputMap& input, MapConversion& result,
                   Report& report) {
    if (request.rebuild_z) {
        result.steps.emplace_back("z computed from x and y");
        return decode_xy_map(input.image, *request.rebuild_z, Green::up, input.flat, report,
                             FlatTexels::exact);
    }
    result.lengths = measure_lengths(input.image, input.flat, report);
    result.steps.push_back(describe_lengths(*result.lengths));
    return decode_normal_map(input.image, Green::up, input.flat, report, FlatTexels::exact);
}

/// Decodes the map and applies all steps. Frees the texels of the input on the way.
void convert_floats(const ConvertRequest& request, InputMap& input, const AxisConversion& axes,
                    MapConversion& result, NormalField& field, Report& report) {
    field.normals = decode_input(request, input, result, report);
    if (input.image.channels >= 4 && request.keeps_alpha())
        field.alpha = channel_of(input.image, 3);
    field.green = axes.green;
    input.image = Image{};
    if (axes.mapping != same_axes) {
        map_normal_axes(field.normals, axes.mapping);
        result.steps.push_back(describe_axes(axes.mapping));
    }
    for (const ConvertStep& step : steps_of(request)) {
        step.apply(field, report);
        result.steps.push_back(step.description + field.note);
        field.note.clear();
    }
    result.green = field.green;
    if (request.space.to_tangent) result.kind = MapKind::normal;
    if (field.is_object_space) result.kind = MapKind::object_normal;
}

}  // namespace

std::vector<std::filesystem::path> output_files(const std::filesystem::path& output,
                                                const MipOptions& mips) {
    std::vector<std::filesystem::path> files = {output};
    if (is_texture(output)) {
        if (mips.roughness) files.push_back(level_file(output, 0, true));
        return files;
    }
    constexpr std::size_t max_level = 31;  // The side of an image is an int.
    for (std::size_t level = 0; mips.wanted && level <= max_level; ++level) {
        if (level > 0) files.push_back(level_file(output, level, false));
        if (mips.roughness) files.push_back(level_file(output, level, true));
    }
    return files;
}

MapConversion convert_map(const Job& job, const ConvertRequest& request, Stages& stages) {
    MapConversion result;
    Report report;
    InputMap input = stages.run("read", [&] {
        if (needs_whole_map(job, request)) return read_normal_map(job.input, request.input);
        // A map that fits is read once instead of three times.
        const std::size_t max_memory =
            std::min<std::uint64_t>(max_normal_map_in_memory, input_limits().memory / 4);
        return open_normal_map(job.input, request.input, max_memory);
    });
    result.width = input.info.width;
    result.height = input.info.height;
    result.channels = input.info.channels;
    result.bits_read = input.info.bits;
    result.input_text = input.conventions;
    check_channels(job, request, input);
    // An object-space map has no green direction; its tangent-space map has that of the output.
    if (request.space.to_tangent) input.green = request.output.green;
    const AxisConversion axes = axis_conversion(job, request, input);
    result.green = axes.green;
    if (!is_texture(job.output)) {
        result.format =
            format_of(request.output, job.output,
                      {.bits = result.bits_read, .green = Green::up, .flat = input.flat});
    }
    LevelWriter writer(job, request, input, stages, report, result);
    const NormalMapSource source = {job.input, input.image.empty() ? nullptr : &input.image,
                                    input.flat, request.input.is_signed};
    const bool decodes = is_texture(job.output) || !keeps_codes(request, input, result.format);
    if (decodes && !request.rebuild_z) require_z(job.input, input);
    if (!decodes) {
        about(job.input, [&] { convert_codes(request, input, source, axes, writer, result); });
    } else if (needs_whole_map(job, request)) {
        NormalField field;
        about(job.input, [&] {
            stages.run("convert",
                       [&] { convert_floats(request, input, axes, result, field, report); });
        });
        writer.write_field(field);
    } else {
        about(job.input, [&] {
            convert_rows(job.output, request, input, source, axes, stages, writer, result);
        });
    }
    // Findings of resized maps and of mip levels count texels of other widths.
    const bool has_one_size = !request.resize.size && !request.mips.wanted;
    result.findings.add("", report, has_one_size ? result.width : 0);
    return result;
}

}  // namespace relief::tools
