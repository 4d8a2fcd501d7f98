// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks before a bake: pairs of high and low parts by name, the likely cause if the models do not
/// fit, and an estimate of the texels whose rays hit nothing. Tests:
/// tests/tools/relief_bake_models_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/model.h"

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

/// The high parts that each low part sees.
enum class PartMatching {
    automatic,  ///< By name if the low model has several names and all parts have counterparts.
    name,       ///< By name.
    all,        ///< All high parts.
};

/// A file and its parts.
struct NamedModel {
    std::filesystem::path file;
    const MapModel* model = nullptr;
};

/// Triangles of one part of a high model.
struct HighPiece {
    std::size_t model = 0;
    std::size_t part = 0;
    std::vector<std::uint32_t> triangles;
};

/// The high and low triangles with one name.
struct ModelPair {
    std::string name;
    std::vector<HighPiece> high;
    std::vector<std::uint32_t> low;  ///< Triangles of the joined low model, ascending.
};

struct ModelPairs {
    std::vector<ModelPair> pairs;  ///< Sorted by name; empty: every low part sees all high parts.
    Report report;                 ///< High parts that no low part sees.
    /// The names without a counterpart that prevent automatic pairs.
    std::vector<std::string> unpaired;
    /// With PartMatching::name, the low parts without a counterpart, which are in no pair.
    std::vector<std::string> unmatched_low;
};

/// Pairs parts by pair_name(). A part is named by its object (glTF: node; OBJ: o, else g) if that
/// has a pair name, else by its file. High parts without a counterpart are counted.
ModelPairs pair_parts(std::span<const NamedModel> high, const NamedModel& low,
                      PartMatching matching);

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
