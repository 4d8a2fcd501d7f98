// SPDX-License-Identifier: Apache-2.0
// The figures of fidelity.h from two pictures of one view. Tests:
// tests/shade/render/fidelity_test.cpp.
#include "render/fidelity_figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "relief/mesh/statistics.h"

namespace relief::shade::detail {
namespace {

/// Marks the pixels within fidelity_margin of marked ones, along rows (step 1) or columns.
std::vector<std::uint8_t> grown(const std::vector<std::uint8_t>& marked, int size, bool is_row) {
    std::vector<std::uint8_t> result(marked.size(), 0);
    const auto index = [&](int line, int i) {
        return static_cast<std::size_t>(is_row ? line * size + i : i * size + line);
    };
    for (int line = 0; line < size; ++line) {
        int next = -1;  // The last pixel that is marked in the result.
        for (int i = 0; i < size; ++i) {
            if (marked[index(line, i)] == 0) continue;
            const int end = std::min(i + fidelity_margin, size - 1);
            for (int j = std::max(next + 1, i - fidelity_margin); j <= end; ++j)
                result[index(line, j)] = 1;
            next = end;
        }
    }
    return result;
}

}  // namespace

ComparedPart compared_part(const NormalPicture& a, const NormalPicture& b, int size) {
    std::vector<std::uint8_t> covered(a.coverage.size(), 0);
    glm::ivec2 begin(size);
    glm::ivec2 end(0);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const auto i = static_cast<std::size_t>(y * size + x);
            if (!(a.coverage[i] > 0.0F) && !(b.coverage[i] > 0.0F)) continue;
            covered[i] = 1;
            begin = glm::min(begin, glm::ivec2(x, y));
            end = glm::max(end, glm::ivec2(x + 1, y + 1));
        }
    }
    if (begin.x >= end.x) return {std::move(covered), {}};
    // Twice: the filters at the outermost pixels that are compared reach as far again.
    begin = glm::max(begin - 2 * fidelity_margin, glm::ivec2(0));
    end = glm::min(end + 2 * fidelity_margin, glm::ivec2(size));
    return {grown(grown(covered, size, true), size, false),
            {begin.x, begin.y, end.x - begin.x, end.y - begin.y}};
}

Image over_gray(const ColorPicture& picture, int size, const ImagePart& part, float background) {
    Image image = make_image(part.width, part.height, 3, 32, ColorSpace::linear);
    const std::span<float> samples = image.as<float>();
    std::size_t sample = 0;
    for (int y = 0; y < part.height; ++y) {
        for (int x = 0; x < part.width; ++x) {
            const auto i = static_cast<std::size_t>((part.y + y) * size + part.x + x);
            const glm::vec4 color = glm::vec4(picture[i]) / 65535.0F;
            for (int channel = 0; channel < 3; ++channel)
                samples[sample++] = color[channel] + (1.0F - color.a) * background;
        }
    }
    return image;
}

std::vector<float> compared_values(const Image& map, const ComparedPart& compared, int size) {
    const std::span<const float> errors = map.as<float>();
    std::vector<float> values;
    std::size_t i = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x, ++i) {
            const auto pixel =
                static_cast<std::size_t>((compared.part.y + y) * size + compared.part.x + x);
            if (compared.is_compared[pixel] != 0) values.push_back(errors[i]);
        }
    }
    return values;
}

Image whole_map(const Image& part_map, const ImagePart& part, int size) {
    Image map = make_image(size, size, 1, 32, ColorSpace::data);
    const std::span<const float> from = part_map.as<float>();
    const std::span<float> to = map.as<float>();
    for (int y = 0; y < part.height; ++y) {
        const auto row = from.subspan(static_cast<std::size_t>(y * part.width),
                                      static_cast<std::size_t>(part.width));
        std::copy(row.begin(), row.end(),
                  to.begin() + static_cast<std::ptrdiff_t>((part.y + y) * size + part.x));
    }
    return map;
}

double mean_of(std::span<const float> values) {
    double sum = 0.0;
    for (const float value : values)
        sum += static_cast<double>(value);
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double percentile(std::vector<float> values, std::size_t percent) {
    if (values.empty()) return 0.0;
    const std::size_t rank = (values.size() * percent + 99) / 100 - 1;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                     values.end());
    return static_cast<double>(values[rank]);
}

bool is_covered_completely(float coverage) {
    return coverage > 1.0F - 1e-3F;
}

AngleValues angles_between(const NormalPicture& a, const NormalPicture& b) {
    AngleValues values;
    for (std::size_t i = 0; i < a.normals.size(); ++i) {
        if (!is_covered_completely(a.coverage[i]) || !is_covered_completely(b.coverage[i]))
            continue;
        const double degrees =
            a.normals[i] == b.normals[i] && a.normals[i] != glm::vec3(0.0F)
                ? 0.0
                : degrees_between(glm::dvec3(a.normals[i]), glm::dvec3(b.normals[i]));
        if (std::isnan(degrees))
            ++values.undefined;
        else
            values.degrees.push_back(static_cast<float>(degrees));
    }
    return values;
}

/// The length is the integral of the gradient of the coverage.
SilhouetteSums silhouette_sums(const NormalPicture& source, const NormalPicture& result, int size) {
    SilhouetteSums sums;
    const auto coverage = [&](int x, int y) {
        return x < size && y < size
                   ? static_cast<double>(source.coverage[static_cast<std::size_t>(y * size + x)])
                   : 0.0;
    };
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double here = coverage(x, y);
            const double dx = coverage(x + 1, y) - here;
            const double dy = coverage(x, y + 1) - here;
            sums.length += std::sqrt(dx * dx + dy * dy);
            sums.area +=
                std::abs(here - static_cast<double>(
                                    result.coverage[static_cast<std::size_t>(y * size + x)]));
        }
    }
    return sums;
}

}  // namespace relief::shade::detail
