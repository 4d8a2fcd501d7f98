// SPDX-License-Identifier: Apache-2.0
// Codes written and read back, texel by texel, in degrees. Tests:
// tests/accuracy/own_maps_test.cpp.
#include <fmt/format.h>

#include <array>
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
    finish(own, std::move(methods), CostKind::bytes, unseen_degrees, options);
    return own;
}

}  // namespace relief
