// SPDX-License-Identifier: Apache-2.0
// Errors of the weightings of vertex normals.
#include <fmt/format.h>

#include <array>
#include <vector>

#include "error_tables/error_tables.h"
#include "experiment_parts.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

const std::vector<NormalMethod>& weightings() {
    static const std::vector<NormalMethod> all = normal_methods(std::array{Arithmetic::float64});
    return all;
}

std::string header() {
    std::vector<std::string> names;
    for (const NormalMethod& method : weightings())
        names.push_back(method.choices.front().second);
    return table_header(names);
}

std::string surface_table(const char* title, Triangulation triangulation) {
    constexpr int cells = 64;
    std::string text = fmt::format("\n{}\n\n{}", title, header());
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh reference = analytic_mesh(surface, triangulation, cells, 1);
        std::vector<double> ranks;
        std::vector<std::string> entries;
        for (const NormalMethod& method : weightings()) {
            const ErrorStats error = normal_errors(method.compute(reference.mesh), reference);
            ranks.push_back(error.rms);
            entries.push_back(rms_and_max(error));
        }
        text += table_row(name_of(surface), ranks, entries);
    }
    return text;
}

std::string fan_table() {
    constexpr std::uint32_t fans = 20000;
    std::string text =
        "\nFans on random cubic surfaces, as in [Max 1999]: RMS of 20,000 each, by the number of "
        "neighbors\n\n" +
        header();
    for (const int valence : {3, 4, 5, 6, 7, 8, 9}) {
        std::vector<double> ranks;
        std::vector<std::string> entries;
        for (const NormalMethod& method : weightings()) {
            ranks.push_back(fan_errors(method, valence, fans).rms);
            entries.push_back(in_digits(ranks.back()));
        }
        text += table_row(fmt::format("{} neighbors", valence), ranks, entries);
    }
    return text;
}

}  // namespace

std::vector<PageSection> normal_tables() {
    const std::string text =
        surface_table("Regular grids, 64 x 64 cells: RMS / maximum error in degrees",
                      Triangulation::regular) +
        surface_table("Jittered: points moved by up to 0.24 cells", Triangulation::jittered) +
        surface_table("Anisotropic: jittered cells, 16 times as long as wide",
                      Triangulation::anisotropic) +
        surface_table("Folded: points moved by up to 0.6 cells, some triangles inverted",
                      Triangulation::folded) +
        fan_table();
    return {written_section("tables", text)};
}

}  // namespace relief::test
