// SPDX-License-Identifier: Apache-2.0
// Codes written and read back, texel by texel, in degrees. Tests:
// tests/accuracy/own_maps_test.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <string_view>

#include "own/own_experiment.h"
#include "relief/accuracy/own.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/image_part.h"
#include "storage/normal_codes.h"

namespace relief {
namespace {

void add_angles(const Image& found, const Image& expected, std::vector<float>& degrees) {
    const std::span<const float> a = found.as<float>();
    const std::span<const float> b = expected.as<float>();
    for (std::size_t i = 0; i < a.size(); i += 3) {
        degrees.push_back(static_cast<float>(
            degrees_between({a[i], a[i + 1], a[i + 2]}, {b[i], b[i + 1], b[i + 2]})));
    }
}

/// The root mean square of what rounding to codes of so many bits alone does to a normal, degrees:
/// errors of up to half a code across two axes, spread evenly. 0 of floats.
double rounding_degrees(int bits) {
    if (bits >= 32) return 0.0;
    const double code = 2.0 / (std::exp2(bits) - 1.0);
    return glm::degrees(code * std::sqrt(2.0 / 12.0));
}

/// The file as it is: `relief-bake convert` keeps every code if it is asked for nothing else.
OwnMethod as_it_is(const NormalMapOnFile& file, std::size_t texels, const OwnOptions& options) {
    OwnMethod method;
    method.measured.name = "as it is";
    method.measured.choices = {
        {"layout", "as it is"}, {"bits", fmt::format("{} bit", file.bits)}, {"rounding", "none"}};
    method.measured.stored_bytes = file.channels * file.bits / 8.0;
    method.measured.error = figures_of(angle_distribution(std::vector<float>(texels, 0.0F)));
    method.measured.note = "every code is kept; no time of its own";
    method.command = fmt::format("relief-bake convert {} OUT{}", options.arguments, file.extension);
    return method;
}

/// Of relief-bake convert, which writes x, y and z in whole codes or floats; empty for others.
std::string command_of(const NormalCode& code, const OwnOptions& options) {
    struct Offer {
        std::string_view name;
        std::string_view file_and_options;
    };
    constexpr std::array offers = {
        Offer{"xyz 8 bit", "OUT.png --bits 8 --zero-code 127.5"},
        Offer{"xyz 8 bit, zero at 128", "OUT.png --bits 8 --zero-code 128"},
        Offer{"xyz 8 bit, blue-noise", "OUT.png --bits 8 --zero-code 127.5 --dither blue-noise"},
        Offer{"xyz 8 bit, ordered", "OUT.png --bits 8 --zero-code 127.5 --dither ordered"},
        Offer{"xyz 16 bit", "OUT.png --bits 16 --zero-code 127.5"},
        Offer{"xyz half", "OUT.exr --half"},
        Offer{"xyz float", "OUT.exr"}};
    for (const Offer& offer : offers) {
        if (offer.name == code.name)
            return fmt::format("relief-bake convert {} {}", options.arguments,
                               offer.file_and_options);
    }
    return {};
}

}  // namespace

OwnExperiment measure_own_normals(const Image& normals, const NormalMapOnFile& file,
                                  const OwnOptions& options, std::int64_t most_texels) {
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
        "The normals as the file holds them, in {} bits. What was lost before it was written is "
        "unknown, but for the rounding to these bits.",
        file.bits);
    if (file.bits < 32) experiment.reference_error = rounding_degrees(file.bits);
    experiment.input = fmt::format("{} x {} texels", normals.width, normals.height);
    if (parts.size() > 1) experiment.input += fmt::format(", {:.0f} of them", experiment.items);
    experiment.item = "texel";
    std::vector<OwnMethod> methods = {
        as_it_is(file, static_cast<std::size_t>(experiment.items), options)};
    for (const NormalCode& code : normal_codes()) {
        OwnMethod method;
        method.measured.name = code.name;
        method.measured.choices = code.choices;
        method.measured.stored_bytes = code.bytes;
        std::vector<float> degrees;
        for (const Image& part : parts)
            add_angles(code.stored(part), part, degrees);
        method.measured.error = figures_of(angle_distribution(std::move(degrees)));
        method.measured.work = [&parts, code] {
            for (const Image& part : parts)
                static_cast<void>(code.stored(part));
        };
        method.command = command_of(code, options);
        methods.push_back(std::move(method));
    }
    finish(own, std::move(methods),
           {CostKind::bytes, unseen_degrees, "the rounding of the file itself"}, options);
    return own;
}

}  // namespace relief
