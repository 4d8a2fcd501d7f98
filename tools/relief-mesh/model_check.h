// SPDX-License-Identifier: Apache-2.0
/// \file
/// The health of a model file, primitive by primitive, and how relief-mesh check says it.
/// Tests: tests/tools/relief_mesh_check_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/findings.h"
#include "relief/mesh/diagnose.h"
#include "tangent_check.h"

namespace relief::tools {

/// One triangle primitive, or the one mesh of a mesh file.
struct CheckedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    Diagnosis diagnosis;
    Report trouble;
    Report remarks;
    std::optional<CheckedTangents> tangents;  ///< Where it has some.
};

struct CheckedModel {
    std::filesystem::path file;
    std::string error;  ///< Why it cannot be read; empty where it could.
    std::string format;
    /// What reading could not use. References to what is not there are trouble; what the format
    /// has but relief has no use for (points, lines, foreign properties) is remarked.
    Report reading_trouble;
    Report reading_remarks;
    std::vector<CheckedPart> parts;

    /// Nothing is in trouble.
    [[nodiscard]] bool is_sound() const;
};

/// Reads and diagnoses. A file that cannot be read, or is not valid, has an `error`.
///
/// \param for_baking  maps will be baked onto the model: then overlapping texture is trouble
///
/// Else, severities are those of diagnose.h, but that triangles without texture gradient are a
/// remark where nothing asks for tangents: nothing is to be baked, no material has a normal or bump
/// map, no tangents are stored.
CheckedModel check_model(const std::filesystem::path& file, bool for_baking);

void print_text(const CheckedModel& model);
nlohmann::ordered_json json_of(const CheckedModel& model);

}  // namespace relief::tools
