// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which high parts each low part sees: all, or those of its own name. "bolt_low" has that of
/// "bolt_high", so that neighbours do not catch each other's rays.
/// Tests: tests/tools/model_pairs_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/map_models.h"

namespace relief::tools {

/// --match
enum class MatchChoice { automatic, name, all };

enum class PairSide { high, low };

/// The name that a part has in common with its counterparts, in lower case: what stands before
/// "high" or "low", whichever side it is, as a word of its own, parted by '_', '-', '.' or a blank.
/// What comes after is of no matter: "Bolt_high", "bolt_high.001" and "bolt-high-cap" are all of
/// "bolt". Of several such words the last one counts. Nothing where there is none, or no name.
std::optional<std::string> pair_name(const std::string& name, PairSide side);

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

/// What has one name on both sides.
struct ModelPair {
    std::string name;
    std::vector<HighPiece> high;
    std::vector<std::uint32_t> low;  ///< Triangles of the low model's parts, joined. Ascending.
};

struct ModelPairs {
    std::vector<ModelPair> pairs;  ///< By name; none: all is seen by all.
    Report report;                 ///< High parts that nobody sees.
    /// Automatic, and without a counterpart, while others have one.
    std::vector<std::string> unpaired;
};

/// Pairs up parts. A part goes by its object (glTF: node; OBJ: o, else g), if that has such a name,
/// else by its file.
///
/// automatic: by name where every part on both sides has a counterpart and there are several names,
/// else all. name: every low part must have one; high parts that have none are counted.
/// \throws FileError naming low parts without a counterpart
ModelPairs pair_models(std::span<const NamedModel> high, const NamedModel& low, MatchChoice choice);

}  // namespace relief::tools
