// SPDX-License-Identifier: Apache-2.0
/// \file
/// Small models with one planted defect each, by which `relief check` is measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace relief::test {

/// A kind of defect.
struct PlantedKind {
    std::string rule;  ///< That must report it.
    /// Further rules that report errors or warnings about the same defect.
    std::vector<std::string> also{};
};

/// The kinds; the first one has no defect, and no rule.
const std::vector<PlantedKind>& planted_kinds();

/// The models of each kind.
inline constexpr int planted_variants = 10;

/// "12-3": the start of the names of the files of a model.
std::string planted_name(std::size_t kind, int variant);

/// Writes a model of each kind and variant, as a .gltf with its buffer and images.
void write_planted_defects(const std::filesystem::path& folder);

/// Writes one model.
void write_planted_model(const std::filesystem::path& folder, const std::string& name,
                         std::size_t kind, int variant);

}  // namespace relief::test
