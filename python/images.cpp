// SPDX-License-Identifier: Apache-2.0
// Image files, height maps, normal maps, and checks and comparisons of images.
// Tests: tests/python/test_command_line.py.
#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <map>
#include <memory>

#include "arrays.h"
#include "heights.h"
#include "map_kind.h"
#include "mesh_type.h"
#include "relief/mesh/block_compression.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/texture_file.h"
#include "relief/shade/image_compare.h"

namespace relief::python {
using namespace relief::shade;

Wraps wraps_of(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) return value_of<Wrap>(text, "wrap");
    return {value_of<Wrap>(text.substr(0, comma), "wrap"),
            value_of<Wrap>(text.substr(comma + 1), "wrap")};
}

Image heights_of(const py::object& height, const char* name, const std::string& channel,
                 const std::optional<std::string>& assume, Report& findings) {
    const HeightChannel chosen = value_of<HeightChannel>(channel, "channel");
    Image image = image_of(height, name, findings);
    return without_gil([&] {
        // Any channel of alpha may be heights.
        if (chosen != HeightChannel::alpha) check_kind(image, name, {MapKind::height}, assume);
        return image.channels == 1 ? std::move(image) : height_field(image, chosen);
    });
}

namespace {

using Text = std::optional<std::string>;
using Metadata = std::map<std::string, std::string>;

constexpr auto color_spaces = std::to_array<EnumName<ColorSpace>>(
    {{"data", ColorSpace::data}, {"linear", ColorSpace::linear}, {"srgb", ColorSpace::srgb}});
constexpr auto blends =
    std::to_array<EnumName<NormalBlend>>({{"reoriented", NormalBlend::reoriented},
                                          {"partial-derivative", NormalBlend::partial_derivative},
                                          {"whiteout", NormalBlend::whiteout},
                                          {"udn", NormalBlend::udn},
                                          {"unity", NormalBlend::unity},
                                          {"linear", NormalBlend::linear},
                                          {"overlay", NormalBlend::overlay}});
constexpr auto filters =
    std::to_array<EnumName<ResizeFilter>>({{"best", ResizeFilter::best},
                                           {"box", ResizeFilter::box},
                                           {"triangle", ResizeFilter::triangle},
                                           {"cubic", ResizeFilter::cubic},
                                           {"lanczos", ResizeFilter::lanczos}});
constexpr auto domains = std::to_array<EnumName<ResizeDomain>>(
    {{"slopes", ResizeDomain::slopes}, {"vectors", ResizeDomain::vectors}});
constexpr auto contents =
    std::to_array<EnumName<MapContent>>({{"tangent-space", MapContent::tangent_normals},
                                         {"object-space", MapContent::object_normals},
                                         {"xy", MapContent::xy_normals},
                                         {"gray", MapContent::gray},
                                         {"other", MapContent::other}});
constexpr auto curves =
    std::to_array<EnumName<StoredCurve>>({{"none", StoredCurve::none},
                                          {"srgb-encoded", StoredCurve::srgb_encoded},
                                          {"srgb-decoded", StoredCurve::srgb_decoded}});

template <typename Enum, std::size_t count>
std::string name_in(const std::array<EnumName<Enum>, count>& names, Enum value) {
    for (const EnumName<Enum>& entry : names) {
        if (entry.value == value) return entry.name;
    }
    return "";
}

NormalMapFormat format_of(int bits, const std::string& green, const std::string& zero_code,
                          const std::string& dither) {
    return {.bits = bits,
            .green = value_of<Green>(green, "green"),
            .flat = value_of<FlatCode>(zero_code, "zero_code"),
            .dither = value_of<Dither>(dither, "dither")};
}

py::tuple py_read_image(const FileName& file) {
    ImageInfo info;
    Image image = without_gil([&] {
        info = read_image_info(file);
        return read_image(file, ImageUse::data);
    });
    return py::make_tuple(array_of(std::move(image)), info.metadata);
}

void py_write_image(const FileName& file, const py::object& image, const std::string& color_space,
                    const Metadata& metadata, bool half, const FindingList& report) {
    Report findings;
    const Image copy = image_of(image, "image", findings,
                                value_of<ColorSpace>(color_space, "color_space", color_spaces));
    without_gil([&] {
        ImageWriteOptions options;
        options.half = half;
        write_image(file, copy, metadata, options, findings);
    });
    append(findings, report);
}

void py_write_texture(const FileName& file, const py::list& levels, const std::string& format,
                      const std::string& quality, bool srgb, const Metadata& metadata,
                      std::optional<int> zstd, const FindingList& report) {
    GpuTexture texture;
    texture.format = value_of<TextureFormat>(format, "format");
    texture.is_srgb = srgb;
    texture.metadata = metadata;
    const auto effort = value_of<BlockQuality>(quality, "quality");
    const std::optional<BlockFormat> blocks = block_format_of(texture.format);
    const bool has_two = blocks && channels_of(*blocks) == 2;
    std::vector<Image> images;
    Report findings;
    for (const py::handle& level : levels)
        images.push_back(image_of(level, "levels", findings));
    if (images.empty()) throw InvalidInput("levels: is empty");
    texture.width = images.front().width;
    texture.height = images.front().height;
    without_gil([&] {
        for (const Image& image : images) {
            const bool is_normals = has_two && image.channels == 3 && image.bits() == 32;
            texture.levels.push_back(
                is_normals
                    ? encode_normal_blocks(image, {.format = *blocks, .quality = effort}, findings)
                    : encode_texture_level(image, texture.format, effort, findings));
        }
        write_texture(file, texture, {.zstd_level = zstd}, findings);
    });
    append(findings, report);
}

py::list py_normal_mip_levels(const py::object& normals) {
    const Image image = image_of(normals, "normals", IgnoredReport());
    std::vector<Image> levels = without_gil([&] { return normal_mip_levels(image); });
    py::list result;
    for (Image& level : levels)
        result.append(array_of(std::move(level)));
    return result;
}

// Height maps.

BumpOptions bump_options(double strength, const Text& kernel, int kernel_radius, const Text& wrap,
                         std::pair<double, double> texel, const Text& arithmetic) {
    BumpOptions options;
    options.kernel = optional_value<Kernel>(kernel, "kernel");
    options.gaussian_radius = kernel_radius;
    if (wrap && *wrap != "auto") options.wrap = wraps_of(*wrap);
    options.strength = strength;
    options.texel = {texel.first, texel.second};
    options.arithmetic = optional_value<Arithmetic>(arithmetic, "arithmetic");
    return options;
}

py::array py_bump(const py::object& height, double strength, const Text& kernel, int kernel_radius,
                  const Text& wrap, std::pair<double, double> texel, const Text& arithmetic,
                  const std::string& channel, int bits, const std::string& green,
                  const std::string& zero_code, const std::string& dither, const Text& assume,
                  const FindingList& report) {
    const BumpOptions options =
        bump_options(strength, kernel, kernel_radius, wrap, texel, arithmetic);
    const NormalMapFormat format = format_of(bits, green, zero_code, dither);
    Report findings;
    const Image heights = heights_of(height, "height", channel, assume, findings);
    Image map =
        without_gil([&] { return normal_map_from_height(heights, options, format, findings); });
    append(findings, report);
    return array_of(std::move(map));
}

py::array py_slopes(const py::object& height, double strength, const Text& kernel,
                    int kernel_radius, const Text& wrap, std::pair<double, double> texel,
                    const Text& arithmetic, const std::string& channel, const Text& assume,
                    const FindingList& report) {
    const BumpOptions options =
        bump_options(strength, kernel, kernel_radius, wrap, texel, arithmetic);
    Report findings;
    const Image heights = heights_of(height, "height", channel, assume, findings);
    Image slopes = without_gil([&] { return slopes_from_height(heights, options, findings); });
    append(findings, report);
    return array_of(std::move(slopes));
}

py::dict py_bump_options(const py::object& height, double strength, const Text& kernel,
                         const Text& wrap, const std::string& channel, const Text& assume) {
    const Image heights = heights_of(height, "height", channel, assume, IgnoredReport());
    const BumpOptions given = bump_options(strength, kernel, 2, wrap, {1.0, 1.0}, std::nullopt);
    const BumpOptions options = without_gil([&] { return resolve_options(heights, given); });
    py::dict result;
    result["kernel"] = enum_name(options.kernel.value());
    result["kernel_radius"] = options.gaussian_radius;
    result["wrap"] = name_of(options.wrap.value());
    return result;
}

py::tuple py_heights(const py::object& normals, const std::string& kernel, const std::string& wrap,
                     double max_slope, bool level, const FindingList& report) {
    IntegrationOptions options;
    options.kernel = value_of<Kernel>(kernel, "kernel");
    options.wrap = wraps_of(wrap);
    options.max_slope = max_slope;
    options.level = level;
    Report findings;
    const Image image = image_of(normals, "normals", findings);
    IntegratedHeights integrated =
        without_gil([&] { return heights_from_normals(image, options, findings); });
    append(findings, report);
    py::dict details;
    details["highest"] = integrated.highest;
    details["residual_slope"] = integrated.residual_slope;
    details["rms_slope"] = integrated.rms_slope;
    details["residual"] = to_dict(integrated.residual, "texels");
    return py::make_tuple(array_of(std::move(integrated.heights)), details);
}

// Normal maps.

/// The kinds of maps whose channels are directions. The first one is that of `assume`.
std::vector<MapKind> kinds_of_normals() {
    return {MapKind::normal, MapKind::object_normal, MapKind::world_normal};
}

py::array py_encode(const py::object& normals, int bits, const std::string& green,
                    const std::string& zero_code, const std::string& dither,
                    const FindingList& report) {
    const NormalMapFormat format = format_of(bits, green, zero_code, dither);
    Report findings;
    const Image image = image_of(normals, "normals", findings);
    Image map = without_gil([&] { return encode_normal_map(image, format, findings); });
    append(findings, report);
    return array_of(std::move(map));
}

py::array py_decode(const py::object& map, const std::string& green, const std::string& zero_code,
                    bool exact_flat, const Text& assume, const FindingList& report) {
    const Green direction = value_of<Green>(green, "green");
    const FlatCode flat = value_of<FlatCode>(zero_code, "zero_code");
    Report findings;
    const Image image = image_of(map, "map", findings);
    Image normals = without_gil([&] {
        check_kind(image, "map", kinds_of_normals(), assume);
        return decode_normal_map(image, direction, flat, findings,
                                 exact_flat ? FlatTexels::exact : FlatTexels::as_coded);
    });
    append(findings, report);
    return array_of(std::move(normals));
}

py::array py_flip_green(const py::object& map, const std::string& zero_code, const Text& assume,
                        const FindingList& report) {
    const FlatCode flat = value_of<FlatCode>(zero_code, "zero_code");
    Report findings;
    Image image = image_of(map, "map", findings);
    without_gil([&] {
        check_kind(image, "map", kinds_of_normals(), assume);
        AxisMapping mapping = same_axes;
        mapping[1].is_negative = true;
        map_axes(image, mapping, flat, findings);
    });
    append(findings, report);
    return array_of(std::move(image));
}

py::array py_blend(const py::object& base, const py::object& detail, const std::string& blend,
                   const FindingList& report) {
    const NormalBlend method = value_of<NormalBlend>(blend, "blend", blends);
    Report findings;
    Image result = image_of(base, "base", findings);
    const Image added = image_of(detail, "detail", findings);
    without_gil([&] { blend_normals(result, added, method, findings); });
    append(findings, report);
    return array_of(std::move(result));
}

py::array py_scale_slopes(const py::object& normals, double strength, const FindingList& report) {
    Report findings;
    Image result = image_of(normals, "normals", findings);
    without_gil([&] { scale_slopes(result, strength, findings); });
    append(findings, report);
    return array_of(std::move(result));
}

py::array py_resize(const py::object& normals, int width, int height, const std::string& filter,
                    const std::string& domain, const std::string& wrap, const FindingList& report) {
    ResizeOptions options;
    options.filter = value_of<ResizeFilter>(filter, "filter", filters);
    options.domain = value_of<ResizeDomain>(domain, "domain", domains);
    options.wrap = wraps_of(wrap);
    Report findings;
    const Image image = image_of(normals, "normals", findings);
    Image result =
        without_gil([&] { return resize_normals(image, width, height, options, findings); });
    append(findings, report);
    return array_of(std::move(result));
}

py::array py_convert_space(const py::object& normals, const MeshObject& mesh, const std::string& to,
                           bool repeat, const FindingList& report) {
    const VectorSpace target = value_of<VectorSpace>(to, "to");
    if (target == VectorSpace::world) refuse_name("to", to, {"tangent", "object"});
    const MapRegion region{.repeat = repeat};
    Report findings;
    const Image image = image_of(normals, "normals", findings);
    ConvertedNormals converted = without_gil([&] {
        return target == VectorSpace::object ? object_from_tangent(image, mesh, region, findings)
                                             : tangent_from_object(image, mesh, region, findings);
    });
    append(findings, report);
    return array_of(std::move(converted.normals));
}

// Checks and comparisons, with the keys of the tools' JSON.

py::dict to_dict(const VectorLengths& lengths) {
    py::dict within;
    for (std::size_t i = 0; i < lengths.within.size(); ++i)
        within[fmt::format("{:g}", VectorLengths::bounds[i]).c_str()] = lengths.within[i];
    py::dict result;
    result["mean"] = lengths.mean;
    result["rms_deviation"] = lengths.rms_deviation;
    result["within"] = std::move(within);
    return result;
}

py::object green_of(const NormalMapCheck& check) {
    if (check.content != MapContent::tangent_normals && check.content != MapContent::xy_normals)
        return py::none();
    const GreenEvidence& green = check.green;
    py::dict result;
    result["is"] = green.green ? enum_name(*green.green) : "unknown";
    result["correlation"] = green.correlation;
    result["deviation"] = green.deviation;
    result["confidence"] = green.confidence;
    result["scale"] = green.scale;
    return result;
}

py::list conditions_of(const NormalMapCheck& check, Severity severity) {
    py::list list;
    for (const MapConditionCount& found : check.conditions) {
        const MapConditionInfo& info = condition_info(found.condition);
        if (info.severity != severity) continue;
        py::dict entry;
        entry["kind"] = std::string(info.word);
        entry["element"] = std::string(info.element);
        entry["count"] = found.count;
        entry["first"] = found.first;
        entry["meaning"] = std::string(info.meaning);
        list.append(std::move(entry));
    }
    return list;
}

py::dict py_check_normal_map(const py::object& map, const Metadata& metadata,
                             const std::string& color_tag) {
    const Image image = image_of(map, "map", IgnoredReport());
    const NormalMapCheck check =
        without_gil([&] { return check_normal_map(image, metadata, color_tag); });
    py::dict result;
    result["sound"] = !check.has_problem();
    result["width"] = image.width;
    result["height"] = image.height;
    result["channels"] = image.channels;
    result["bits"] = image.bits();
    result["content"] = name_in(contents, check.content);
    result["curve"] = name_in(curves, check.curve);
    result["color_tag"] = color_tag;
    result["lengths"] = to_dict(check.lengths);
    result["lengths_uncurved"] = to_dict(check.lengths_uncurved);
    result["green"] = green_of(check);
    result["zero_code"] = enum_name(check.flat);
    result["seams"] = std::vector<double>{check.tiling.seam_x, check.tiling.seam_y};
    result["bits_used"] = check.bits;
    result["alpha_correlation"] = check.alpha_correlation;
    result["problems"] = conditions_of(check, Severity::problem);
    result["notes"] = conditions_of(check, Severity::note);
    return result;
}

py::dict py_compare_images(const py::object& a, const py::object& b, const std::string& color_space,
                           double pixels_per_degree) {
    const ColorSpace space = value_of<ColorSpace>(color_space, "color_space", color_spaces);
    const Image first = image_of(a, "a", IgnoredReport(), space);
    const Image second = image_of(b, "b", IgnoredReport(), space);
    ImageDifference difference;
    std::optional<FlipDifference> flip;
    without_gil([&] {
        difference = compare(first, second);
        if (space != ColorSpace::data) flip = flip_difference(first, second, pixels_per_degree);
    });
    py::dict result;
    result["max"] = difference.max;
    result["mean"] = difference.mean;
    result["rms"] = difference.rms;
    result["psnr"] = difference.psnr;
    result["differing_pixels"] = difference.differing_pixels;
    if (flip) {
        result["flip_mean"] = flip->mean;
        result["flip_max"] = flip->max;
        result["flip_map"] = array_of(std::move(flip->map));
    }
    return result;
}

py::tuple py_compare_normals(const py::object& a, const py::object& b) {
    const Image first = image_of(a, "a", IgnoredReport());
    const Image second = image_of(b, "b", IgnoredReport());
    AngleDifference angles = without_gil([&] { return angle_difference(first, second); });
    return py::make_tuple(python::to_dict(angles.angles, "texels"),
                          array_of(std::move(angles.map)));
}

void add_height_functions(py::module_& module) {
    using py::arg;
    const py::object none = py::none();
    const std::pair<double, double> texel(1.0, 1.0);
    module.def("bump", &py_bump, arg("height"), py::kw_only(), arg("strength") = 16.0,
               arg("kernel") = none, arg("kernel_radius") = 2, arg("wrap") = none,
               arg("texel") = texel, arg("arithmetic") = none, arg("channel") = "mean",
               arg("bits") = 16, arg("green") = "up", arg("zero_code") = "127.5",
               arg("dither") = "none", arg("assume") = none, arg("report") = none,
               "Convert a height map to a normal map of 8 or 16 bits, or 32 (float).\n\n"
               "height: uint8, uint16 or float32 (height, width), or with channels. The result\n"
               "has the shape (height, width, 3). `strength` is the height of the value 1 (white)\n"
               "in texels. Absent options are derived from the map, as `relief-bake bump` does.\n\n"
               "Raises InvalidInput for wrong shapes and options, and for a normal map unless\n"
               "`assume` is \"height\", and TypeError for wrong types.");
    module.def("slopes", &py_slopes, arg("height"), py::kw_only(), arg("strength") = 16.0,
               arg("kernel") = none, arg("kernel_radius") = 2, arg("wrap") = none,
               arg("texel") = texel, arg("arithmetic") = none, arg("channel") = "mean",
               arg("assume") = none, arg("report") = none,
               "Compute the slopes of a height map: to the right and upwards.\n\n"
               "height and the options are those of bump(); the result: float32 (height, width,\n"
               "2).\n\n"
               "Raises what bump() does.");
    module.def("bump_options", &py_bump_options, arg("height"), py::kw_only(),
               arg("strength") = 16.0, arg("kernel") = none, arg("wrap") = none,
               arg("channel") = "mean", arg("assume") = none,
               "Return the kernel and wrap that bump() derives from a height map.\n\n"
               "The result is a dictionary with kernel, kernel_radius and wrap.\n\n"
               "Raises what bump() does.");
    module.def("heights", &py_heights, arg("normals"), py::kw_only(), arg("kernel") = "central7",
               arg("wrap") = "repeat", arg("max_slope") = 16.0, arg("level") = false,
               arg("report") = none,
               "Integrate decoded normals to least-squares heights in texels.\n\n"
               "normals: float32 (height, width, 3). The result is (heights, details): float32\n"
               "(height, width), and the remaining errors as a dictionary.\n\n"
               "Raises InvalidInput for wrong shapes and options, and TypeError for wrong types.");
}

void add_normal_map_functions(py::module_& module) {
    using py::arg;
    const py::object none = py::none();
    module.def("encode_normals", &py_encode, arg("normals"), py::kw_only(), arg("bits") = 16,
               arg("green") = "up", arg("zero_code") = "127.5", arg("dither") = "none",
               arg("report") = none,
               "Encode directions as a normal map of 8, 16 or 32 bits.\n\n"
               "normals: float32 (height, width, 3), y up; the result: uint8, uint16 or float32\n"
               "of the same shape.\n\n"
               "Raises InvalidInput for wrong shapes and options, and TypeError for wrong types.");
    module.def("decode_normals", &py_decode, arg("map"), py::kw_only(), arg("green") = "up",
               arg("zero_code") = "127.5", arg("exact_flat") = false, arg("assume") = none,
               arg("report") = none,
               "Decode a normal map to unit normals, y up: float32 of shape (h, w, 3).\n\n"
               "map: uint8, uint16 or float32 (height, width, 3 or more). `exact_flat` decodes\n"
               "the code of flat texels as exactly flat.\n\n"
               "Raises InvalidInput for wrong shapes and options, and for texels that are clearly\n"
               "no normals, such as a photograph, unless `assume` is \"normal\"; TypeError for\n"
               "wrong types.");
    module.def("flip_green", &py_flip_green, arg("map"), py::kw_only(), arg("zero_code") = "127.5",
               arg("assume") = none, arg("report") = none,
               "Convert a stored map between OpenGL's and DirectX's direction of green.\n\n"
               "The result has the type and shape of the map.\n\n"
               "Raises what decode_normals() does.");
    module.def("blend_normals", &py_blend, arg("base"), arg("detail"), py::kw_only(),
               arg("blend") = "reoriented", arg("report") = none,
               "Blend decoded detail normals into decoded base normals.\n\n"
               "base, detail and the result: float32 (height, width, 3). The detail repeats from\n"
               "the upper left corner.\n\n"
               "Raises InvalidInput for wrong shapes and options, and TypeError for wrong types.");
    module.def("scale_slopes", &py_scale_slopes, arg("normals"), arg("strength"), py::kw_only(),
               arg("report") = none,
               "Multiply the slopes of decoded normals.\n\n"
               "normals and the result: float32 (height, width, 3).\n\n"
               "Raises InvalidInput for wrong shapes and options, and TypeError for wrong types.");
    module.def("resize_normals", &py_resize, arg("normals"), arg("width"), arg("height"),
               py::kw_only(), arg("filter") = "best", arg("domain") = "slopes",
               arg("wrap") = "repeat", arg("report") = none,
               "Resize decoded normals.\n\n"
               "normals: float32 (h, w, 3); the result: float32 (height, width, 3).\n\n"
               "Raises InvalidInput for wrong shapes and options, and TypeError for wrong types.");
    module.def("normal_mip_levels", &py_normal_mip_levels, arg("normals"),
               "Average decoded normals to all mip levels, from half the size to one texel.\n\n"
               "normals: float32 (height, width, 3); the result: a list of such arrays. The\n"
               "vectors are means, with a length of at most 1.\n\n"
               "Raises InvalidInput for wrong shapes, and TypeError for wrong types.");
    module.def("convert_space", &py_convert_space, arg("normals"), arg("mesh"), py::kw_only(),
               arg("to"), arg("repeat") = false, arg("report") = none,
               "Convert decoded normals between the tangent and the object space of a mesh.\n\n"
               "normals and the result: float32 (height, width, 3). The mesh needs normals,\n"
               "tangents and texture coordinates.\n\n"
               "Raises InvalidInput if it lacks one, and for wrong shapes and options, and\n"
               "TypeError for wrong types.");
    module.def("check_normal_map", &py_check_normal_map, arg("map"), py::kw_only(),
               arg("metadata") = Metadata{}, arg("color_tag") = "",
               "Find the content, conventions and defects of a stored normal map.\n\n"
               "map: uint8, uint16 or float32 (height, width, channels). The result has the keys\n"
               "of a file of `relief-bake check --json`.\n\n"
               "Raises InvalidInput for wrong shapes, and TypeError for wrong types.");
}

}  // namespace

void add_images(py::module_& module) {
    using py::arg;
    module.def("read_image", &py_read_image, arg("file"),
               "Read an image with its samples as stored: (image, metadata).\n\n"
               "image: uint8, uint16 or float32, (height, width) or (height, width, channels);\n"
               "metadata: a dictionary of texts.\n\n"
               "Raises FileError if the file cannot be read, or is damaged.");
    module.def("write_image", &py_write_image, arg("file"), arg("image"), py::kw_only(),
               arg("color_space") = "data", arg("metadata") = Metadata{}, arg("half") = false,
               arg("report") = py::none(),
               "Write an image. The extension decides the format: .png .tif .exr .hdr .jpg.\n\n"
               "image: uint8, uint16 or float32, (height, width) or (height, width, channels)\n"
               "with 1 to 4 channels; other floats are rounded to float32.\n\n"
               "Raises FileError if the file cannot be written; then an older file is unchanged.\n"
               "Raises InvalidInput for wrong shapes, and TypeError for wrong types.");
    module.def(
        "write_texture", &py_write_texture, arg("file"), arg("levels"), py::kw_only(),
        arg("format") = "bc5", arg("quality") = "normal", arg("srgb") = false,
        arg("metadata") = Metadata{}, arg("zstd") = py::none(), arg("report") = py::none(),
        "Write a texture with its mip levels, the largest first, as .ktx2 or .dds.\n\n"
        "Formats and qualities are those of `relief-bake convert`. Levels are arrays of the\n"
        "format's channels and bits; for \"bc5\" and \"bc5-snorm\" also decoded normals:\n"
        "three channels of float32. read_image() reads the largest level. `zstd`\n"
        "compresses .ktx2, 1 to 22.\n\n"
        "Raises FileError if the file cannot be written, InvalidInput for levels that do not\n"
        "fit the format or each other, and TypeError for wrong types.");
    add_height_functions(module);
    add_normal_map_functions(module);
    module.def("compare_images", &py_compare_images, arg("a"), arg("b"), py::kw_only(),
               arg("color_space") = "srgb", arg("pixels_per_degree") = default_pixels_per_degree,
               "Compare the samples of two images, and their perceived difference (FLIP).\n\n"
               "FLIP is absent for data. Beside `flip_map`, float32 (height, width), the keys\n"
               "are those of `relief-view --json` with --reference.\n\n"
               "Raises InvalidInput if the shapes differ, and TypeError for wrong types.");
    module.def(
        "compare_normals", &py_compare_normals, arg("a"), arg("b"),
        "Measure the angles between decoded normals: (statistics, degrees of each texel).\n\n"
        "a and b: float32 (height, width, 3); degrees: float32 (height, width).\n\n"
        "Raises InvalidInput if the shapes differ, and TypeError for wrong types.");
}

}  // namespace relief::python
