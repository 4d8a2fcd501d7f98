// SPDX-License-Identifier: Apache-2.0
// Decides which materials an asset has. A map can hold opacity, but not whether it blends or cuts:
// triangles of opaque, masked and blended materials stay apart. Tests:
// tests/make/draw_modes_test.cpp.
#include "draw_modes.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <type_traits>
#include <variant>

namespace relief::make {

std::vector<DrawMode> draw_modes_of(const Asset& asset) {
    if (!asset.draw_modes.empty()) return asset.draw_modes;
    const GltfMaterial& material = asset.material;
    return {{material.alpha_mode, material.alpha_cutoff, material.double_sided}};
}

namespace detail {
namespace {

/// Returns whether all texels of an image without alpha, or with the largest one, are opaque.
bool is_opaque(const Image& image) {
    if (image.channels != 2 && image.channels != 4) return true;
    const auto channels = static_cast<std::size_t>(image.channels);
    return std::visit(
        [&]<typename Sample>(const std::vector<Sample>& samples) {
            for (std::size_t i = channels - 1; i < samples.size(); i += channels) {
                if constexpr (std::is_floating_point_v<Sample>) {
                    if (!(samples[i] >= Sample(1))) return false;
                } else {
                    if (samples[i] != static_cast<Sample>(~Sample{0})) return false;
                }
            }
            return true;
        },
        image.samples);
}

bool is_opaque(const HighMaterial& material) {
    if (!material.opacity) return true;
    if (*material.opacity < 1.0F) return false;
    return !material.color_texture || is_opaque(*material.color_texture->image);
}

/// Returns the materials of a mesh, ascending.
std::set<std::size_t> used_numbers(const Mesh& mesh, std::size_t count) {
    std::set<std::size_t> used;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.triangle_count > 0 && range.material && *range.material < count)
            used.insert(*range.material);
    }
    return used;
}

/// The materials that one material of the asset replaces.
class MaterialGroup {
  public:
    MaterialGroup(const AssetSource& source, const SourceAlpha& alpha,
                  const std::set<std::size_t>& used, bool has_others,
                  std::optional<AlphaMode> alpha_mode)
        : source_(source),
          has_others_(has_others && alpha_mode.value_or(AlphaMode::opaque) == AlphaMode::opaque) {
        for (const std::size_t number : used) {
            const AlphaMode mode = alpha.of_material[number];
            if (!alpha_mode || mode == *alpha_mode) numbers_.push_back({number, mode});
        }
    }

    /// Returns the way to draw all of them.
    DrawMode merge(std::vector<HighMaterial>& materials, Report& report) const;

  private:
    struct Member {
        std::size_t number = 0;
        AlphaMode mode = AlphaMode::opaque;
    };

    void merge_alpha(DrawMode& merged, std::vector<HighMaterial>& materials, Report& report) const;
    void merge_sides(DrawMode& merged, Report& report) const;
    [[nodiscard]] const DrawMode& of(const Member& member) const {
        return source_.draw_modes[member.number];
    }

    const AssetSource& source_;
    std::vector<Member> numbers_;
    bool has_others_;  ///< Triangles without a material, which are opaque and single-sided.
};

void MaterialGroup::merge_alpha(DrawMode& merged, std::vector<HighMaterial>& materials,
                                Report& report) const {
    std::vector<float> cutoffs;
    bool blends = false;
    for (const Member& member : numbers_) {
        blends = blends || member.mode == AlphaMode::blend;
        if (member.mode == AlphaMode::mask) cutoffs.push_back(of(member).alpha_cutoff);
    }
    if (cutoffs.empty() && !blends) return;
    merged.alpha_mode = blends ? AlphaMode::blend : AlphaMode::mask;
    const bool has_one_cutoff = !blends && std::ranges::count(cutoffs, cutoffs.front()) ==
                                               static_cast<std::ptrdiff_t>(cutoffs.size());
    if (has_one_cutoff) {
        merged.alpha_cutoff = cutoffs.front();
        return;
    }
    for (const Member& member : numbers_) {
        if (member.mode == AlphaMode::mask) {
            materials[member.number].alpha_cutoff = of(member).alpha_cutoff;
            report.add(blends ? "masked material beside blended ones"
                              : "masked materials with different alpha cutoffs",
                       "material", member.number, "is cut to opacity 0 or 1");
        } else if (blends && member.mode == AlphaMode::opaque) {
            report.add("opaque material beside blended ones", "material", member.number,
                       "is blended with opacity 1");
        }
    }
}

void MaterialGroup::merge_sides(DrawMode& merged, Report& report) const {
    merged.double_sided = std::ranges::any_of(
        numbers_, [&](const Member& member) { return of(member).double_sided; });
    if (!merged.double_sided) return;
    for (const Member& member : numbers_) {
        if (!of(member).double_sided) {
            report.add("single-sided material beside double-sided ones", "material", member.number,
                       "is double-sided");
        }
    }
    if (has_others_) {
        report.add("triangles without a material beside double-sided ones", "mesh", 0,
                   "are double-sided");
    }
}

DrawMode MaterialGroup::merge(std::vector<HighMaterial>& materials, Report& report) const {
    DrawMode merged;
    merge_alpha(merged, materials, report);
    merge_sides(merged, report);
    return merged;
}

/// Returns whether triangles of a mesh have no material.
bool has_others(const Mesh& mesh, std::size_t count) {
    return std::ranges::any_of(mesh.material_ranges, [&](const MaterialRange& range) {
        return range.triangle_count > 0 && (!range.material || *range.material >= count);
    });
}

}  // namespace

AlphaMode SourceAlpha::of(const MaterialRange& range) const {
    if (!range.material || *range.material >= of_material.size()) return AlphaMode::opaque;
    return of_material[*range.material];
}

SourceAlpha source_alpha(const AssetSource& source, Report& report) {
    SourceAlpha result;
    const bool has_opaque_colors = std::ranges::all_of(
        source.mesh.colors, [](const glm::vec4& color) { return color.a >= 1.0F; });
    const std::size_t count = std::min(source.draw_modes.size(), source.materials.size());
    for (std::size_t i = 0; i < count; ++i) {
        AlphaMode mode = source.draw_modes[i].alpha_mode;
        if (mode != AlphaMode::opaque && has_opaque_colors && is_opaque(source.materials[i])) {
            report.add("transparent material that is opaque everywhere", "material", i,
                       "is opaque");
            mode = AlphaMode::opaque;
        }
        result.of_material.push_back(mode);
    }
    return result;
}

std::vector<AlphaMode> alpha_modes_of(const Mesh& mesh, const SourceAlpha& alpha) {
    if (alpha.of_material.empty()) return {};
    std::vector<AlphaMode> modes(mesh.triangles.size(), AlphaMode::opaque);
    for (const MaterialRange& range : mesh.material_ranges)
        std::fill_n(modes.begin() + range.first_triangle, range.triangle_count, alpha.of(range));
    if (!is_mixed(modes)) modes.clear();
    return modes;
}

bool is_mixed(std::span<const AlphaMode> modes) {
    return std::ranges::any_of(modes, [&](AlphaMode mode) { return mode != modes.front(); });
}

DrawnMaterials drawn_materials(const Mesh& high, const AssetSource& source,
                               const SourceAlpha& alpha, std::span<const AlphaMode> alpha_modes,
                               Report& report) {
    DrawnMaterials result{source.materials, {}};
    if (alpha.of_material.empty()) {
        const GltfMaterial& shared = source.shared;
        result.modes = {{shared.alpha_mode, shared.alpha_cutoff, shared.double_sided}};
        return result;
    }
    const std::size_t count = alpha.of_material.size();
    const std::set<std::size_t> used = used_numbers(high, count);
    const auto merged = [&](std::optional<AlphaMode> mode) {
        return MaterialGroup(source, alpha, used, has_others(high, count), mode)
            .merge(result.materials, report);
    };
    if (!is_mixed(alpha_modes)) {
        result.modes = {merged(std::nullopt)};
        return result;
    }
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
        if (std::ranges::find(alpha_modes, mode) != alpha_modes.end())
            result.modes.push_back(merged(mode));
    }
    return result;
}

std::vector<MaterialRange> ranges_of(std::span<const AlphaMode> alpha_modes,
                                     std::span<const DrawMode> modes) {
    std::vector<MaterialRange> ranges;
    for (std::uint32_t i = 0; i < alpha_modes.size(); ++i) {
        const auto mode = std::ranges::find(modes, alpha_modes[i], &DrawMode::alpha_mode);
        const auto number = static_cast<std::uint32_t>(mode - modes.begin());
        if (ranges.empty() || ranges.back().material != number) ranges.push_back({i, 0, number});
        ++ranges.back().triangle_count;
    }
    return ranges;
}

}  // namespace detail
}  // namespace relief::make
