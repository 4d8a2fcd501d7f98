// SPDX-License-Identifier: Apache-2.0
// Changes of a height map that must not change its normals, or change them in the same way, in
// combination with random options of bump maps: the map transposed, mirrored or shifted across a
// border that repeats; heights, strength and texel size scaled by powers of two; other numbers of
// threads. bump_file_test.cpp tests bands of rows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "hard_cases/mesh_changes.h"
#include "hard_cases/random_meshes.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/normal_map.h"
#include "support/hard_meshes.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief::test {
namespace {

/// A height map of floats with the options of its conversion.
struct BumpCase {
    Image height;
    BumpOptions options;
    NormalMapFormat format;
    int height_bits = 32;  ///< With 8 and 16, heights are converted to codes after the change.
};

/// A change of a map: the texels of the original in it, and the normals that correspond.
struct BumpChange {
    const char* name;
    /// Changes the case. Returns the texel of the original for each texel of the changed map.
    std::function<glm::ivec2(glm::ivec2)> (*apply)(BumpCase& bump, Dice& dice);
    /// Returns the original's normal in the changed map.
    glm::vec3 (*corresponding)(const glm::vec3& normal);
    /// The maximum angle to the corresponding normal with Arithmetic::float64 and float32.
    double max_degrees[2] = {0.0, 0.0};
};

BumpCase random_case(Dice& dice) {
    const auto side = [&] { return static_cast<int>(1 + dice.below(dice.one_in(3) ? 70 : 9)); };
    BumpCase bump;
    const int width = side();
    const int height = side();
    bump.height = rough(width, height, dice.below(1000));
    // Holes, levels and heights of another size.
    const bool has_holes = dice.one_in(3), has_levels = dice.one_in(3);
    for (float& value : bump.height.as<float>()) {
        if (has_levels) value = std::floor(8.0F * value) / 8.0F;
        if (has_holes && dice.one_in(9)) value = dice.one_in(2) ? not_a_number : infinite;
    }
    const auto any = [&](const auto& names) {
        return names[dice.below(static_cast<std::uint32_t>(names.size()))].value;
    };
    if (!dice.one_in(6)) bump.options.kernel = any(enum_names<Kernel>);
    if (!dice.one_in(6)) bump.options.wrap = Wraps(any(enum_names<Wrap>), any(enum_names<Wrap>));
    bump.options.strength = dice.one_in(4) ? 1e6 * dice.any_digits() : 40.0 * dice.any_digits();
    bump.options.texel = {1.5 + dice.any_digits(), 1.5 + dice.any_digits()};
    bump.options.gaussian_radius = static_cast<int>(1 + dice.below(5));
    if (!dice.one_in(3)) bump.options.arithmetic = any(enum_names<Arithmetic>);
    constexpr int bits[] = {8, 16, 32};
    bump.format.bits = bits[dice.below(3)];
    bump.format.flat = any(enum_names<FlatCode>);
    bump.format.green = any(enum_names<Green>);
    if (bump.format.bits < 32) bump.format.dither = any(enum_names<Dither>);
    bump.height_bits = bits[dice.below(3)];
    return bump;
}

/// Returns heights as codes of 8 or 16 bits; heights that are not finite become 0.
Image coded(const Image& height, int bits) {
    if (bits == 32) return height;
    Image result = make_image(height.width, height.height, 1, bits, height.color_space);
    const std::span<const float> values = height.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float value = std::isfinite(values[i]) ? std::abs(values[i]) : 0.0F;
        const auto code = static_cast<std::uint16_t>(std::lround(4096.0F * value) % (1 << bits));
        if (bits == 8) {
            result.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(code);
        } else {
            result.as<std::uint16_t>()[i] = code;
        }
    }
    return result;
}

/// Returns the map with the texel `from(x, y)` at (x, y).
Image rearranged(const Image& map, int width, int height,
                 const std::function<glm::ivec2(glm::ivec2)>& from) {
    Image result = make_image(width, height, map.channels, 32, map.color_space);
    const auto channels = static_cast<std::size_t>(map.channels);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::ivec2 source = from({x, y});
            for (std::size_t channel = 0; channel < channels; ++channel) {
                result.as<float>()[static_cast<std::size_t>(y * width + x) * channels + channel] =
                    map.as<float>()[static_cast<std::size_t>(source.y * map.width + source.x) *
                                        channels +
                                    channel];
            }
        }
    }
    return result;
}

glm::ivec2 same_texel(glm::ivec2 at) {
    return at;
}

glm::vec3 same_normal(const glm::vec3& normal) {
    return normal;
}

/// Returns whether the kernel is Kernel::forward, whose slopes are those half a texel farther on.
bool is_one_sided(const BumpCase& bump) {
    return bump.options.kernel == Kernel::forward;
}

std::function<glm::ivec2(glm::ivec2)> transpose(BumpCase& bump, Dice&) {
    const auto from = [](glm::ivec2 at) { return glm::ivec2(at.y, at.x); };
    bump.height = rearranged(bump.height, bump.height.height, bump.height.width, from);
    if (bump.options.wrap) std::swap(bump.options.wrap->x, bump.options.wrap->y);
    std::swap(bump.options.texel.x, bump.options.texel.y);
    return from;
}

std::function<glm::ivec2(glm::ivec2)> mirror_columns(BumpCase& bump, Dice&) {
    if (is_one_sided(bump)) bump.options.kernel = Kernel::central3;
    const auto from = [width = bump.height.width](glm::ivec2 at) {
        return glm::ivec2(width - 1 - at.x, at.y);
    };
    bump.height = rearranged(bump.height, bump.height.width, bump.height.height, from);
    return from;
}

std::function<glm::ivec2(glm::ivec2)> mirror_rows(BumpCase& bump, Dice&) {
    if (is_one_sided(bump)) bump.options.kernel = Kernel::central3;
    const auto from = [height = bump.height.height](glm::ivec2 at) {
        return glm::ivec2(at.x, height - 1 - at.y);
    };
    bump.height = rearranged(bump.height, bump.height.width, bump.height.height, from);
    return from;
}

std::function<glm::ivec2(glm::ivec2)> shift(BumpCase& bump, Dice& dice) {
    const int width = bump.height.width;
    const int height = bump.height.height;
    const auto along = [&](Wrap wrap, int count) {
        return wrap == Wrap::repeat
                   ? static_cast<int>(dice.below(static_cast<std::uint32_t>(count)))
                   : 0;
    };
    if (!bump.options.wrap) return same_texel;
    const int right = along(bump.options.wrap->x, width);
    const int down = along(bump.options.wrap->y, height);
    const auto from = [=](glm::ivec2 at) {
        return glm::ivec2((at.x + right) % width, (at.y + down) % height);
    };
    bump.height = rearranged(bump.height, width, height, from);
    return from;
}

/// Scales heights, strength and texels so that slopes stay the same.
std::function<glm::ivec2(glm::ivec2)> scale(BumpCase& bump, Dice& dice) {
    const auto power = [&] { return static_cast<int>(dice.below(41)) - 20; };
    const int of_heights = bump.height_bits == 32 ? power() : 0;
    const int of_texels = power();
    for (float& value : bump.height.as<float>())
        value = std::ldexp(value, of_heights);
    bump.options.strength = std::ldexp(bump.options.strength, of_texels - of_heights);
    bump.options.texel *= std::ldexp(1.0, of_texels);
    return same_texel;
}

std::function<glm::ivec2(glm::ivec2)> keep(BumpCase&, Dice&) {
    return same_texel;
}

constexpr BumpChange bump_changes[] = {
    // Sums along x and along y have different orders.
    {"Transposed",
     transpose,
     [](const glm::vec3& n) { return glm::vec3(-n.y, -n.x, n.z); },
     {1e-5, 1e-3}},
    {"MirroredColumns", mirror_columns,
     [](const glm::vec3& n) { return glm::vec3(-n.x, n.y, n.z); }},
    {"MirroredRows", mirror_rows, [](const glm::vec3& n) { return glm::vec3(n.x, -n.y, n.z); }},
    {"Shifted", shift, same_normal},
    {"PowersOfTwo", scale, same_normal},
    {"NumberOfThreads", keep, same_normal}};

/// Returns the first texel whose normal does not correspond, or an empty string.
std::string normal_difference(const BumpChange& change, const BumpCase& before,
                              const BumpCase& after,
                              const std::function<glm::ivec2(glm::ivec2)>& from) {
    const Image expected = normals_from_height(before.height, before.options);
    const Image found = normals_from_height(after.height, after.options);
    const auto at = [](const Image& image, glm::ivec2 texel) {
        const auto first = 3 * static_cast<std::size_t>(texel.y * image.width + texel.x);
        const std::span<const float> all = image.as<float>();
        return glm::vec3(all[first], all[first + 1], all[first + 2]);
    };
    for (int y = 0; y < found.height; ++y) {
        for (int x = 0; x < found.width; ++x) {
            const glm::vec3 was = change.corresponding(at(expected, from({x, y})));
            const glm::vec3 is = at(found, {x, y});
            // Equal as numbers: the negative of 0 is -0.
            const bool is_float32 = before.options.arithmetic == Arithmetic::float32;
            const double limit = change.max_degrees[is_float32 ? 1 : 0];
            const double degrees = degrees_between(glm::dvec3(was), glm::dvec3(is));
            if (was == is || (limit > 0.0 && degrees <= limit)) continue;
            return fmt::format("texel ({}, {}): ({}, {}, {}) instead of ({}, {}, {})", x, y, is.x,
                               is.y, is.z, was.x, was.y, was.z);
        }
    }
    return "";
}

class BumpChanges : public testing::TestWithParam<BumpChange> {};

TEST_P(BumpChanges, GiveCorrespondingNormals) {
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
        Dice dice(seed);
        BumpCase before = random_case(dice);
        // The choice of a kernel depends on the map as it is.
        if (!before.options.kernel && GetParam().apply != keep) {
            const Image chosen_for = coded(before.height, before.height_bits);
            before.options.kernel = resolve_options(chosen_for, before.options).kernel;
        }
        BumpCase after = before;
        const auto from = GetParam().apply(after, dice);
        before.options.kernel = after.options.kernel;
        before.height = coded(before.height, before.height_bits);
        after.height = coded(after.height, after.height_bits);
        const ExecutionScope scope({.threads = 1 + dice.below(4)});
        ASSERT_EQ(normal_difference(GetParam(), before, after, from), "")
            << "seed " << seed << ": " << before.height.width << " x " << before.height.height
            << " texels, kernel "
            << (before.options.kernel ? enum_name(*before.options.kernel) : "automatic")
            << ", wrap " << (before.options.wrap ? name_of(*before.options.wrap) : "automatic");
        // Codes are symmetric only for FlatCode::middle.
        if (GetParam().corresponding(glm::vec3(1, 2, 3)) != glm::vec3(1, 2, 3) ||
            from({1, 2}) != glm::ivec2(1, 2))
            continue;
        const Image codes = normal_map_from_height(before.height, before.options, before.format);
        const ExecutionScope one_thread({.threads = 1});
        ASSERT_EQ(normal_map_from_height(after.height, after.options, after.format).samples,
                  codes.samples)
            << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, BumpChanges, testing::ValuesIn(bump_changes), name_of_change);

}  // namespace
}  // namespace relief::test
