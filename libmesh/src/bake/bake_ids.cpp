// SPDX-License-Identifier: Apache-2.0
// Names and colors of ids. Tests: tests/mesh/bake/bake_ids_test.cpp.
#include "relief/mesh/bake_ids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <tuple>

#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr int min_brightness = 64;            // Of the largest channel.
constexpr int max_difference = 32;            // Of the most different channel of two colors.
constexpr int tries_of_each_difference = 64;  // Before the difference is halved.

std::uint64_t hash_of(const std::string& name) {
    std::uint64_t hash = name.size();
    for (const char letter : name)
        hash = mixed_bits((hash ^ static_cast<unsigned char>(letter)) + split_mix_step);
    return hash;
}

glm::u8vec3 color_of(std::uint64_t bits) {
    return {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
            static_cast<std::uint8_t>(bits >> 16)};
}

int difference(const glm::u8vec3& a, const glm::u8vec3& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// The colors that are in use.
class UsedColors {
  public:
    /// \param min_difference  0: any color that is not used
    [[nodiscard]] bool accept(const glm::u8vec3& color, int min_difference) const {
        if (std::max({color.r, color.g, color.b}) < min_brightness) return false;
        if (min_difference <= 1) return !exact_.contains({color.r, color.g, color.b});
        return std::ranges::none_of(colors_, [&](const glm::u8vec3& other) {
            return difference(color, other) < min_difference;
        });
    }
    void add(const glm::u8vec3& color) {
        colors_.push_back(color);
        exact_.insert({color.r, color.g, color.b});
    }

  private:
    std::vector<glm::u8vec3> colors_;
    std::set<std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>> exact_;
};

glm::u8vec3 new_color(const std::string& name, const UsedColors& used) {
    std::uint64_t hash = hash_of(name);
    for (int min_difference = max_difference;; min_difference /= 2) {
        for (int i = 0; i < tries_of_each_difference;
             ++i, hash = mixed_bits(hash + split_mix_step)) {
            const glm::u8vec3 color = color_of(hash);
            if (used.accept(color, min_difference)) return color;
        }
    }
}

}  // namespace

std::vector<NamedTriangles> names_by_material(const Mesh& mesh, std::span<const std::string> names,
                                              const std::string& other) {
    const auto name_of = [&](std::optional<std::uint32_t> material) -> std::string {
        if (!material) return other.empty() ? "no-material" : other;
        if (*material >= names.size() || names[*material].empty())
            return fmt::format("material-{}", *material);
        const std::string& name = names[*material];
        const auto first = std::ranges::find(names, name) - names.begin();
        return first < *material ? fmt::format("{}-{}", name, *material) : name;
    };
    std::vector<NamedTriangles> result;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.triangle_count > 0)
            result.push_back({range.first_triangle, name_of(range.material)});
    }
    if (result.empty()) result.push_back({0, name_of(std::nullopt)});
    return result;
}

std::vector<SurfaceId> surface_ids(std::vector<std::string> names) {
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    constexpr std::size_t max_ids = 65536;
    if (names.size() > max_ids) {
        throw InvalidInput(
            fmt::format("there are {} ids, but at most {} are possible", names.size(), max_ids));
    }
    UsedColors used;
    std::vector<SurfaceId> ids;
    for (std::string& name : names) {
        const glm::u8vec3 color = new_color(name, used);
        used.add(color);
        ids.push_back({std::move(name), color});
    }
    return ids;
}

std::string color_text(const SurfaceId& id) {
    return fmt::format("#{:02x}{:02x}{:02x}", id.color.r, id.color.g, id.color.b);
}

}  // namespace relief
