// SPDX-License-Identifier: Apache-2.0
// Some rows at a time. Tests: tests/tools/relief_bake_verify_test.cpp.
#include "mesh/error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "relief/mesh/heat_picture.h"
#include "relief/mesh/image_rows.h"

namespace relief::tools {
namespace {

/// 1, 2 or 5 of some power of ten, no less than the value.
double rounded_up(double value) {
    if (!(value > 0.0)) return 1.0;
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (value <= step * power) return step * power;
    }
    return 10.0 * power;
}

Image heat_rows(std::span<const float> degrees, int width, double brightest) {
    const int height = static_cast<int>(degrees.size() / static_cast<std::size_t>(width));
    Image values = make_image(width, height, 1, 32, ColorSpace::data);
    std::copy(degrees.begin(), degrees.end(), values.as<float>().begin());
    const Image heat = heat_picture(values, brightest);
    Image result = make_image(width, height, 4, 8, ColorSpace::srgb);
    const auto from = heat.as<std::uint8_t>();
    const auto to = result.as<std::uint8_t>();
    for (std::size_t i = 0; i < degrees.size(); ++i) {
        if (std::isnan(degrees[i])) continue;
        std::copy_n(&from[3 * i], 3, &to[4 * i]);
        to[4 * i + 3] = 255;
    }
    return result;
}

}  // namespace

double ErrorMap::write(const std::filesystem::path& file, const BakeCheck& check) {
    const double brightest = rounded_up(check.error.p99);
    const bool is_picture = extension_of(file) == ".png";
    const std::map<std::string, std::string> metadata = {
        {"relief:content", is_picture ? "errors of normals as heat" : "errors of normals, degrees"},
        {"relief:brightest", fmt::format("{:g}", brightest)}};
    const ImageShape shape = {width_, height_, is_picture ? 4 : 1, is_picture ? 8 : 32,
                              is_picture ? ColorSpace::srgb : ColorSpace::data};
    ImageRowWriter writer(file, shape, metadata);
    const auto row = static_cast<std::size_t>(width_);
    constexpr std::size_t rows_at_once = 256;
    for (std::size_t first = 0; first < degrees_.size(); first += rows_at_once * row) {
        const std::span<const float> part = std::span<const float>(degrees_).subspan(
            first, std::min(rows_at_once * row, degrees_.size() - first));
        if (!is_picture) {
            writer.write(std::as_bytes(part));
            continue;
        }
        const Image picture = heat_rows(part, width_, brightest);
        writer.write(std::as_bytes(picture.as<std::uint8_t>()));
    }
    writer.finish();
    return brightest;
}

}  // namespace relief::tools
