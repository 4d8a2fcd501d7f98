// SPDX-License-Identifier: Apache-2.0
#include "normal_errors/error_tables.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "relief/mesh/analytic_surfaces.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/normals.h"
#include "support/error_page.h"

namespace relief::test {
namespace {

struct Method {
    const char* name;
    std::function<std::vector<glm::vec3>(const Mesh&)> normals;
};

Method by(const char* name, NormalWeight weight) {
    return {name, [weight](const Mesh& mesh) {
                Report report;
                return vertex_normals(mesh.positions, mesh.triangles, weight, report);
            }};
}

const std::vector<Method>& methods() {
    static const std::vector<Method> all = {
        by("uniform", NormalWeight::uniform),
        by("area", NormalWeight::area),
        by("angle", NormalWeight::angle),
        by("sine", NormalWeight::sine),
        by("max", NormalWeight::max),
        by("angle-edges", NormalWeight::angle_edges),
        by("area-angle", NormalWeight::area_angle),
        {"auto", [](const Mesh& mesh) {
             Report report;
             return chosen_normals(mesh.positions, mesh.triangles, {}, report).normals;
         }}};
    return all;
}

struct Named {
    const char* name;
    AnalyticSurface surface;
};
constexpr std::array surfaces = {
    Named{"sphere", AnalyticSurface::sphere}, Named{"torus", AnalyticSurface::torus},
    Named{"ellipsoid", AnalyticSurface::ellipsoid}, Named{"saddle", AnalyticSurface::saddle},
    Named{"cubic", AnalyticSurface::cubic}};

std::string header() {
    std::vector<std::string> names;
    for (const Method& method : methods())
        names.emplace_back(method.name);
    return table_header(names);
}

std::string surface_table(const char* title, Triangulation triangulation) {
    constexpr int cells = 64;
    std::string text = fmt::format("\n{}\n\n{}", title, header());
    for (const Named& named : surfaces) {
        const AnalyticMesh truth = analytic_mesh(named.surface, triangulation, cells, 1);
        std::vector<double> ranks;
        std::vector<std::string> entries;
        for (const Method& method : methods()) {
            const DirectionError error =
                direction_error(method.normals(truth.mesh), truth.normals, truth.inner);
            ranks.push_back(error.rms);
            entries.push_back(in_digits(error.rms) + " / " + in_digits(error.max));
        }
        text += table_row(named.name, ranks, entries);
    }
    return text;
}

std::string fan_table() {
    constexpr std::uint32_t fans = 20000;
    std::string text =
        "\nFans on random cubic surfaces, as in [Max 1999]: RMS of 20,000 each, by the number of "
        "neighbours\n\n" +
        header();
    for (const int valence : {3, 4, 5, 6, 7, 8, 9}) {
        std::vector<double> squares(methods().size(), 0.0);
        for (std::uint32_t seed = 0; seed < fans; ++seed) {
            const Mesh fan = cubic_fan(valence, seed);
            for (std::size_t m = 0; m < squares.size(); ++m) {
                const double degrees = degrees_between(
                    glm::dvec3(methods()[m].normals(fan).front()), glm::dvec3(0.0, 0.0, 1.0));
                squares[m] += degrees * degrees;
            }
        }
        std::vector<double> ranks;
        std::vector<std::string> entries;
        for (const double sum : squares) {
            ranks.push_back(std::sqrt(sum / fans));
            entries.push_back(in_digits(ranks.back()));
        }
        text += table_row(fmt::format("{} neighbours", valence), ranks, entries);
    }
    return text;
}

}  // namespace

std::string normal_error_tables() {
    return surface_table("Regular grids, 64 x 64 cells: RMS / largest error in degrees",
                         Triangulation::regular) +
           surface_table("Jittered: points moved by up to 0.24 cells", Triangulation::jittered) +
           surface_table("Anisotropic: jittered cells, 16 times as long as wide",
                         Triangulation::anisotropic) +
           surface_table("Folded: points moved by up to 0.6 cells, some triangles turned over",
                         Triangulation::folded) +
           fan_table();
}

}  // namespace relief::test
