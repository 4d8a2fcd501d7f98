// SPDX-License-Identifier: Apache-2.0
// Codes written and read back, texel by texel, in degrees. Tests:
// tests/accuracy/own_maps_test.cpp.
#include <fmt/format.h>

#include "own/own_experiment.h"
#include "relief/accuracy/own.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/image_part.h"
#include "relief/mesh/normal_map_operations.h"

namespace relief {
namespace {

/// Nobody sees less; and nothing is worth a byte for it.
constexpr double unseen_degrees = 0.01;

/// A way to store normals.
struct MapCode {
    NormalMapFormat format;
    bool is_xy = false;  ///< Without z, which readers compute.

    [[nodiscard]] bool is_dithered() const { return format.dither != Dither::none; }
    [[nodiscard]] MeasuredMethod described() const {
        const std::string channels = is_xy ? "xy" : "xyz";
        const std::string depth = fmt::format("{} bit", format.bits);
        const std::string dither = is_dithered() ? "blue-noise" : "none";
        MeasuredMethod method;
        method.name = fmt::format("{}, {}{}", channels, depth, is_dithered() ? ", dithered" : "");
        method.choices = {{"channels", channels}, {"depth", depth}, {"dither", dither}};
        method.stored_bytes = (is_xy ? 2.0 : 3.0) * format.bits / 8.0;
        if (is_dithered()) method.note = "right in the mean over a few texels, not in each";
        return method;
    }
    /// There and back.
    [[nodiscard]] Image stored(const Image& normals) const {
        Report ignored;
        const Image codes = encode_normal_map(normals, format, ignored);
        return is_xy ? decode_xy_map(codes, XyChannels{}, format.green, format.flat, ignored)
                     : decode_normal_map(codes, format.green, format.flat, ignored);
    }
    /// relief-bake convert has no maps without z to offer.
    [[nodiscard]] std::string command(const OwnOptions& options) const {
        if (is_xy) return {};
        return fmt::format("relief-bake convert {} OUT.{}{}{}", options.arguments,
                           format.bits == 32 ? "exr" : "png",
                           format.bits == 32 ? "" : fmt::format(" --bits {}", format.bits),
                           is_dithered() ? " --dither blue-noise" : "");
    }
};

std::vector<MapCode> map_codes() {
    std::vector<MapCode> codes;
    for (const bool is_xy : {false, true}) {
        for (const int bits : {8, 16, 32}) {
            for (const Dither dither : {Dither::none, Dither::blue_noise}) {
                if (bits == 32 && dither != Dither::none) continue;
                NormalMapFormat format;
                format.bits = bits;
                format.dither = dither;
                codes.push_back({format, is_xy});
            }
        }
    }
    return codes;
}

void add_angles(const Image& found, const Image& expected, std::vector<float>& degrees) {
    const std::span<const float> a = found.as<float>();
    const std::span<const float> b = expected.as<float>();
    for (std::size_t i = 0; i < a.size(); i += 3) {
        degrees.push_back(static_cast<float>(
            degrees_between({a[i], a[i + 1], a[i + 2]}, {b[i], b[i + 1], b[i + 2]})));
    }
}

}  // namespace

OwnExperiment measure_own_normals(const Image& normals, int bits, const OwnOptions& options,
                                  std::int64_t most_texels) {
    OwnExperiment own =
        own_experiment(Subject::storage, "normal-map", "Storage of the normals", options);
    std::vector<Image> parts;
    for (const ImagePart& part : parts_to_measure(normals.width, normals.height, most_texels))
        parts.push_back(part_of(normals, part));
    Experiment& experiment = own.experiment;
    for (const Image& part : parts)
        experiment.items += static_cast<double>(part.width) * part.height;
    experiment.question = "In how few bits can these normals be stored?";
    experiment.truth = fmt::format(
        "The normals as the file holds them, in {} bits. What was lost before it was written, "
        "nothing can tell.",
        bits);
    experiment.input = fmt::format("{} x {} texels", normals.width, normals.height);
    if (parts.size() > 1) experiment.input += fmt::format(", {:.0f} of them", experiment.items);
    experiment.item = "texel";
    std::vector<OwnMethod> methods;
    for (const MapCode& code : map_codes()) {
        OwnMethod method;
        method.measured = code.described();
        std::vector<float> degrees;
        for (const Image& part : parts)
            add_angles(code.stored(part), part, degrees);
        method.measured.error = figures_of(angle_distribution(std::move(degrees)));
        method.measured.work = [&parts, code] {
            for (const Image& part : parts)
                static_cast<void>(code.stored(part));
        };
        method.command = code.command(options);
        methods.push_back(std::move(method));
    }
    finish(own, std::move(methods), CostKind::bytes, unseen_degrees, options);
    return own;
}

}  // namespace relief
