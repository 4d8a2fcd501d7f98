// SPDX-License-Identifier: Apache-2.0
// From runs to numbers. Tests: tests/mesh/io/mesh/obj_objects_test.cpp.
#include "io/mesh/obj_objects.h"

#include <map>

namespace relief {

ObjObjects objects_of(const ObjStatements& statements) {
    const std::vector<ObjRun>& runs =
        statements.objects.empty() ? statements.groups : statements.objects;
    ObjObjects objects;
    if (runs.empty()) return objects;
    std::map<std::string, std::uint32_t> numbers;
    /// Number of each run, and where it ends.
    std::vector<std::pair<std::uint32_t, std::size_t>> numbered;
    const auto add = [&](const std::string& name, std::size_t first, std::size_t end) {
        if (first == end) return;
        const auto next = static_cast<std::uint32_t>(objects.names.size());
        const auto [known, is_new] = numbers.emplace(name, next);
        if (is_new) objects.names.push_back(name);
        numbered.emplace_back(known->second, end);
    };
    add("", 0, runs.front().first_face);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const bool is_last = i + 1 == runs.size();
        add(runs[i].name, runs[i].first_face,
            is_last ? statements.faces.size() : runs[i + 1].first_face);
    }
    if (objects.names.size() < 2) return objects;
    objects.of_face.reserve(statements.faces.size());
    for (const auto& [number, end] : numbered)
        objects.of_face.resize(end, number);
    return objects;
}

}  // namespace relief
