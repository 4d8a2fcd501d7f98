// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks before a bake: pairs of high and low parts by name, the likely cause if the models do not
/// fit, and an estimate of the texels whose rays hit nothing. Tests:
/// tests/tools/relief_bake_models_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bake.h"

namespace RELIEF_API relief {

enum class BakeSide { high, low };

/// Returns the name that a part shares with its counterparts, in lower case.
///
/// It is the text before the last separate word "high" (for a high part) or "low" (for a low part).
/// Words are separated by '_', '-', '.' or a space. The text after the word is ignored:
/// "Bolt_high", "bolt_high.001" and "bolt-high-cap" all give "bolt". Absent if there is no such
/// word, or no text before it.
std::optional<std::string> pair_name(const std::string& name, BakeSide side);

/// The names by which a part can be paired.
struct BakePartName {
    std::string object;  ///< The name of its object (glTF: node); may be empty.
    std::string file;    ///< The stem of its file; used if the object's name gives no pair name.
};

/// The parts with one pair name.
struct BakeNameGroup {
    std::string name;                    ///< Empty: parts without a pair name.
    std::vector<std::size_t> high, low;  ///< Indices of parts, ascending.

    /// Returns whether it has a name and parts on both sides.
    [[nodiscard]] bool is_pair() const { return !name.empty() && !high.empty() && !low.empty(); }
};

/// Groups parts by pair name. \return the groups, sorted by name
std::vector<BakeNameGroup> group_by_pair_name(std::span<const BakePartName> high,
                                              std::span<const BakePartName> low);

/// Returns the likely cause of models that do not fit, as a question or a remark: different units,
/// a different up axis, or a missing transform. Empty if the boxes show none.
std::string likely_cause(const BakeFit& fit);

/// The result of a bake at a reduced size.
struct MissedEstimate {
    int width = 0;
    int height = 0;
    BakeResult result;
};

/// The number of texels of the reduced map in estimate_missed().
inline constexpr double estimate_texels = 65536.0;

/// Estimates which texels of a map are missed by their rays. The map is baked with one sample per
/// texel and with at most `estimate_texels` texels.
MissedEstimate estimate_missed(const Baker& baker, const BakeMapOptions& map);

}  // namespace relief
