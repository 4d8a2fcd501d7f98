// SPDX-License-Identifier: Apache-2.0
// Checks a normal map: is it one, which way is green, and what is wrong with it? Reads the file
// that is named, or makes a map whose green points down.
#include <cmath>
#include <cstdio>
#include <exception>
#include <span>

#include "relief/mesh/bump.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/report.h"

namespace {

relief::Image map_with_green_down() {
    const int size = 128;
    relief::Image heights = relief::make_image(size, size, 1, 32, relief::ColorSpace::data);
    const std::span<float> values = heights.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double x = 0.0490873852 * static_cast<double>(i % size);  // One wave is 128 texels.
        const double y = 0.0490873852 * static_cast<double>(i / size);
        values[i] =
            static_cast<float>(0.5 + 0.2 * std::sin(3.0 * x + y) + 0.2 * std::sin(2.0 * y - x));
    }
    relief::Report report;
    return relief::normal_map_from_height(heights, {.strength = 16.0},
                                          {.bits = 8, .green = relief::Green::down}, report);
}

}  // namespace

int main(int count, char** arguments) {
    try {
        const relief::Image map = count > 1
                                      ? relief::read_image(arguments[1], relief::ImageUse::data)
                                      : map_with_green_down();
        const relief::NormalMapCheck check = relief::check_normal_map(map);
        const bool is_known = check.green.green.has_value();
        std::printf("tangent-space normals: %s\n",
                    check.content == relief::MapContent::tangent_normals ? "yes" : "no");
        std::printf("green: %s\n", !is_known                                   ? "unknown"
                                   : *check.green.green == relief::Green::down ? "down"
                                                                               : "up");
        std::printf("confidence: %.3f\n", check.green.confidence);
        std::printf("mean length: %.3f\n", check.lengths.mean);
        const relief::Report report = relief::to_report(check);
        for (const relief::Finding& finding : report.findings())
            std::printf("%s\n", relief::to_string(finding).c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
