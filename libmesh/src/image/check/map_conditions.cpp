// SPDX-License-Identifier: Apache-2.0
// The words for what can be found in a normal map. Tests:
// tests/mesh/image/check/normal_map_check_test.cpp.
#include <algorithm>
#include <array>

#include "relief/mesh/normal_map_check.h"

namespace relief {
namespace {

using enum MapCondition;
using enum Severity;

constexpr std::array all_map_conditions = {
    MapConditionInfo{not_normals, "no normal map", "map", trouble,
                     "its vectors have no common length, or all its channels are the same"},
    MapConditionInfo{object_space, "object-space normals", "map", remark,
                     "its vectors face all ways: for one mesh only, and no tangent-space map"},
    MapConditionInfo{z_missing, "no third component", "map", trouble,
                     "only x and y are stored: who reads three channels gets wrong normals"},
    MapConditionInfo{z_constant, "constant third component", "map", remark,
                     "x and y carry all; true only where slopes are small"},
    MapConditionInfo{stored_through_srgb, "stored through the sRGB curve", "map", trouble,
                     "too bright: flat is 188 of 255 instead of 128"},
    MapConditionInfo{decoded_from_srgb, "darkened by the sRGB curve", "map", trouble,
                     "read as colour and stored as light: flat is 55 of 255 instead of 128"},
    MapConditionInfo{tagged_as_color, "tagged as a colour", "map", remark,
                     "its file says sRGB or the like: programs that follow such tags bend the "
                     "normals (relief does not, nor does glTF)"},
    MapConditionInfo{signed_samples, "signed samples", "map", trouble,
                     "float samples hold n itself; relief and most others read (n + 1) / 2"},
    MapConditionInfo{texel_not_finite, "texel not finite", "texel", trouble, "is read as flat"},
    MapConditionInfo{texel_without_direction, "texel without direction", "texel", trouble,
                     "is (0,0,0) or all but that; what it is read as differs between programs"},
    MapConditionInfo{texel_facing_back, "texel facing back", "texel", trouble,
                     "has z below 0, which no surface seen from outside has in tangent space"},
    MapConditionInfo{texel_grey, "grey texel", "texel", remark,
                     "is black, white or grey: a background, which filtering mixes into its "
                     "neighbours"},
    MapConditionInfo{not_unit, "not of unit length", "map", trouble,
                     "lengths are off by more than 0.05 (RMS): programs that do not normalise "
                     "shade it wrong"},
    MapConditionInfo{not_quite_unit, "not quite of unit length", "map", remark,
                     "lengths are off by more than 0.02 (RMS): filtered or compressed"},
    MapConditionInfo{green_contradicted, "green is not as said", "map", trouble,
                     "its slopes are those of a surface only with green the other way round"},
    MapConditionInfo{green_down, "green is down", "map", remark,
                     "as DirectX has it; OpenGL and glTF want it up"},
    MapConditionInfo{green_unknown, "green cannot be told", "map", remark,
                     "its slopes are as good a surface with green up as with green down"},
    MapConditionInfo{flat_contradicted, "zero is not what the file says", "map", trouble,
                     "its flat texels have another code than the one named"},
    MapConditionInfo{all_flat, "every texel the same", "map", remark, "shows nothing"},
    MapConditionInfo{x_constant, "constant first component", "map", remark,
                     "no slope left and right"},
    MapConditionInfo{y_constant, "constant second component", "map", remark,
                     "no slope up and down"},
    MapConditionInfo{bits_unused, "bits unused", "map", remark,
                     "holds no more than 8 bits: as large as a finer map and no better"},
    MapConditionInfo{alpha_opaque, "constant alpha", "map", remark,
                     "a fourth channel that says nothing"},
    MapConditionInfo{alpha_heights, "heights in alpha", "map", remark,
                     "the slopes of the fourth channel are those of the normals"},
    MapConditionInfo{alpha_other, "something in alpha", "map", remark,
                     "a fourth channel that is not these normals' heights"},
    MapConditionInfo{seam_x, "seam left and right", "map", remark, "does not tile along x"},
    MapConditionInfo{seam_y, "seam top and bottom", "map", remark, "does not tile along y"},
};

static_assert([] {
    for (std::size_t i = 0; i < all_map_conditions.size(); ++i) {
        if (all_map_conditions[i].condition != static_cast<MapCondition>(i)) return false;
    }
    return all_map_conditions.size() == static_cast<std::size_t>(seam_y) + 1;
}());

}  // namespace

std::span<const MapConditionInfo> map_conditions() {
    return all_map_conditions;
}

const MapConditionInfo& condition_info(MapCondition condition) {
    return all_map_conditions[static_cast<std::size_t>(condition)];
}

bool NormalMapCheck::has(MapCondition condition) const {
    return std::any_of(found.begin(), found.end(), [condition](const FoundMapCondition& one) {
        return one.condition == condition;
    });
}

bool NormalMapCheck::has_trouble() const {
    return std::any_of(found.begin(), found.end(), [](const FoundMapCondition& one) {
        return condition_info(one.condition).severity == trouble;
    });
}

Report to_report(const NormalMapCheck& check, std::optional<Severity> severity) {
    Report report;
    for (const FoundMapCondition& found : check.found) {
        const MapConditionInfo& info = condition_info(found.condition);
        if (severity && info.severity != *severity) continue;
        report.add(Finding{std::string(info.word), std::string(info.element),
                           std::string(info.meaning), found.count, found.first});
    }
    return report;
}

}  // namespace relief
