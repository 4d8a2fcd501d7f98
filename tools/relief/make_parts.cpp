// SPDX-License-Identifier: Apache-2.0
// The named parts of models. Tests: tests/make/part_matching_test.cpp.
#include "make_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "common/summary.h"

namespace relief::tools {

void add_named_parts(const MapModelPart& part, const std::string& file, BakeSide side,
                     make::NamedParts& parts) {
    std::vector<std::string> objects = part.objects;
    if (objects.empty()) objects.emplace_back();
    std::vector<std::uint32_t> numbers;
    for (const std::string& object : objects) {
        const std::string name = part_name({object, file}, side);
        const auto known = std::ranges::find(parts.names, name);
        numbers.push_back(static_cast<std::uint32_t>(known - parts.names.begin()));
        if (known == parts.names.end()) parts.names.push_back(name);
    }
    for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i)
        parts.part_of.push_back(numbers[part.object_of.empty() ? 0 : part.object_of[i]]);
}

std::vector<std::string> part_lines(const make::PartDecision& decision) {
    constexpr std::size_t max_named = 8;
    if (!decision.reason.empty()) return {"not matched by name: " + decision.reason};
    if (!decision.is_matched) return {};
    std::string names;
    for (std::size_t i = 0; i < std::min(decision.parts.size(), max_named); ++i)
        names += (i == 0 ? "" : ", ") + decision.parts[i].name;
    return {fmt::format("{} matched by name: {}{}", decision.parts.size(), names,
                        decision.parts.size() > max_named ? ", ..." : "")};
}

Json parts_json(const make::PartDecision& decision) {
    return {{"matched", decision.is_matched},
            {"reason", decision.reason.empty() ? Json() : Json(decision.reason)},
            {"parts", json_list(decision.parts, [](const make::AssetPart& part) -> Json {
                 return {{"name", part.name},
                         {"source_triangles", part.source_triangles},
                         {"triangles", part.triangles}};
             })}};
}

}  // namespace relief::tools
