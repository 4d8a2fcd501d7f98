// SPDX-License-Identifier: Apache-2.0
// Signed permutations of the axes of a normal map, on its codes (normal_map_operations.h). A code
// is negated by subtracting it from twice the code of zero; only 0 of FlatCode::middle has no
// opposite, and is counted. A mapping that is none throws.
// Tests: tests/mesh/image/normals/normal_map_operations_test.cpp.
#include <fmt/format.h>

#include <limits>

#include "image/texel_loops.h"
#include "relief/mesh/error.h"
#include "relief/mesh/normal_map_operations.h"

namespace relief {
namespace {

/// What stands for minus a sample.
template <typename Sample>
struct Opposite {
    FlatCode flat;

    /// Twice the code of zero. In the codes' own arithmetic, where 256 - c is 0 - c.
    [[nodiscard]] Sample of(Sample code) const {
        constexpr Sample largest = std::numeric_limits<Sample>::max();
        if (flat == FlatCode::half) return static_cast<Sample>(largest - code);
        return code == 0 ? largest : static_cast<Sample>(0 - code);
    }
    [[nodiscard]] bool exists(Sample code) const { return flat == FlatCode::half || code != 0; }
};

template <>
struct Opposite<float> {
    FlatCode flat;
    [[nodiscard]] static float of(float sample) { return 1.0F - sample; }
    [[nodiscard]] static bool exists(float) { return true; }
};

template <typename Sample>
void map_row(Sample* row, std::size_t width, std::size_t channels, const AxisMapping& mapping,
             const Opposite<Sample>& opposite, std::size_t first_texel, Report& found) {
    for (std::size_t x = 0; x < width; ++x) {
        Sample* const texel = row + x * channels;
        const std::array<Sample, 3> old = {texel[0], texel[1], texel[2]};
        for (std::size_t i = 0; i < 3; ++i) {
            const Sample sample = old[static_cast<std::size_t>(mapping[i].axis)];
            texel[i] = mapping[i].is_negative ? opposite.of(sample) : sample;
            if (mapping[i].is_negative && !opposite.exists(sample))
                found.add("code 0 without an opposite", "texel", first_texel + x,
                          "stored as the largest code");
        }
    }
}

void check_mapping(const AxisMapping& mapping) {
    std::array<int, 3> uses{};
    for (const SignedAxis& to : mapping) {
        if (to.axis < 0 || to.axis > 2)
            throw InvalidInput(fmt::format("there is no axis {}, only 0, 1 and 2", to.axis));
        if (++uses[static_cast<std::size_t>(to.axis)] > 1)
            throw InvalidInput(fmt::format("axis {} is used twice", "xyz"[to.axis]));
    }
}

}  // namespace

void map_axes(Image& map, const AxisMapping& mapping, FlatCode flat, Report& report) {
    check_mapping(mapping);
    if (map.channels < 3)
        throw InvalidInput(fmt::format("a normal map has 3 or 4 channels, not {}", map.channels));
    const auto width = static_cast<std::size_t>(map.width);
    const auto channels = static_cast<std::size_t>(map.channels);
    with_sample_type(map, [&]<typename Sample>(Sample) {
        Sample* const samples = map.as<Sample>().data();
        for_each_row(map.width, map.height, report, [&](std::size_t row, Report& found) {
            map_row(samples + row * width * channels, width, channels, mapping,
                    Opposite<Sample>{flat}, row * width, found);
        });
    });
}

void turn_normals(Image& normals, const AxisMapping& mapping) {
    check_mapping(mapping);
    check_floats(normals, 3, "normals");
    const std::span<float> all = normals.as<float>();
    Report unused;
    for_each_texel(all.size() / 3, unused, [&](std::size_t texel, Report&) {
        float* const normal = &all[texel * 3];
        const std::array<float, 3> old = {normal[0], normal[1], normal[2]};
        for (std::size_t i = 0; i < 3; ++i) {
            const float part = old[static_cast<std::size_t>(mapping[i].axis)];
            normal[i] = mapping[i].is_negative ? 0.0F - part : part;  // Never -0.
        }
    });
}

}  // namespace relief
