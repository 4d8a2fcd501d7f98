// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/hard_cases.h"

#include <fmt/format.h>

#include "relief/mesh/diagnose.h"

namespace relief::test {

const std::vector<HardCase>& hard_cases() {
    static const std::vector<HardCase> table = [] {
        std::vector<HardCase> rows;
        for (const auto& part :
             {triangle_cases(), surface_cases(), number_cases(), stored_cases(), tangent_cases(),
              tangent_surface_cases(), encoding_cases(), image_cases(), image_file_cases(),
              normal_map_cases(), map_check_cases(), bake_cases(), bake_shape_cases()})
            rows.insert(rows.end(), part.begin(), part.end());
        return rows;
    }();
    return table;
}

namespace {

constexpr const char* introduction = R"(# Hard cases

What breaks naive code has one defined outcome here, and nothing is repaired, dropped or clamped without a word: a fallback is a finding in
the report. Directions are always unit vectors; the same input gives the same bits, whatever the order of triangles and the number of threads.
Every line of both tables is run by a test (`tests/hard_cases/`); this page is written from the same table by `relief-hard-cases-page`.
*Orthonormal* tangents are unit and perpendicular to their normals within 1e-6, w is 1 or -1 and one all over a triangle; a row without texture has one laid on from above for them.

`relief-mesh check` uses the words of the first table.
```sh
relief-mesh check data/vase.obj
relief-mesh check data/vase.obj data/scenes/knot.glb --strict --json
```
)";

std::string words() {
    std::string text =
        "## Words\n"
        "*Trouble* makes a step fall back, or its result depend on more than the surface: "
        "`--strict` exits with 3. A *remark* is what sound "
        "models have too.\nVertices at equal positions count as one in all that is about "
        "triangles, edges and fans. Edges are named by the "
        "first triangle on them.\nA triangle without texture gradient is but a remark in a model "
        "of which nothing asks for tangents: no "
        "normal or bump map, none stored. With `--for-baking` it is trouble all the same, and so "
        "is "
        "overlapping texture.\n\n"
        "| word | | what it comes to |\n|---|---|---|\n";
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        text += fmt::format("| {} | {} | {} |\n", condition.word,
                            condition.severity == Severity::problem ? "trouble" : "remark",
                            condition.meaning);
    }
    return text;
}

std::string outcomes(const HardCase& row) {
    std::string text;
    std::string step;
    for (const Expectation& expectation : row.expectations) {
        if (expectation.step != step)
            text += fmt::format("{}*{}:* ", text.empty() ? "" : "<br>", expectation.step);
        else
            text += "; ";
        step = expectation.step;
        text += expectation.outcome;
    }
    return text;
}

std::string cases() {
    std::string text = "## Cases\n| case | input | outcome | known from |\n|---|---|---|---|\n";
    for (const HardCase& row : hard_cases())
        text +=
            fmt::format("| {} | {} | {} | {} |\n", row.name, row.what, outcomes(row), row.source);
    return text;
}

}  // namespace

std::string hard_cases_page() {
    return fmt::format("{}\n{}\n{}", introduction, words(), cases());
}

}  // namespace relief::test
