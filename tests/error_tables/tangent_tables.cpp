// SPDX-License-Identifier: Apache-2.0
// Errors of the methods and encodings of tangent frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "error_tables/error_tables.h"
#include "experiment_parts.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/frames.h"
#include "storage_experiments.h"
#include "support/shapes.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

const std::vector<FrameMethod>& methods() {
    static const std::vector<FrameMethod> all = tangent_methods();
    return all;
}

struct NamedMesh {
    std::string name;
    TexturedMesh reference;
};

const std::vector<NamedMesh>& meshes() {
    static const std::vector<NamedMesh> all = [] {
        constexpr int cells = 64;
        std::vector<NamedMesh> made;
        for (const TexturedCase& one : textured_cases())
            made.push_back({one.name, one.mesh(cells)});
        return made;
    }();
    return all;
}

constexpr double not_compared = std::numeric_limits<double>::quiet_NaN();

/// Returns a table with one row for each mesh; measured(reference, frames) returns the errors. The
/// first column shows the reference tangents, the lower bound for every method.
template <typename Measured>
std::string method_table(const std::string& title, bool at_corners, Measured measured) {
    std::vector<std::string> names = names_of(methods());
    names.insert(names.begin(), "*true*");
    std::string text = "\n" + title + "\n\n" + table_header(names);
    for (const NamedMesh& mesh : meshes()) {
        const ErrorStats least =
            measured(mesh.reference, TangentFrames{exact_tangents(mesh.reference)});
        std::vector<double> ranks = {not_compared};
        std::vector<std::string> cells = {rms_and_max(least)};
        for (const FrameMethod& method : methods()) {
            const bool none = at_corners && !method.has_work;
            const ErrorStats errors =
                none ? ErrorStats{} : measured(mesh.reference, method.compute(mesh.reference.mesh));
            ranks.push_back(none ? not_compared : errors.rms);
            cells.push_back(none ? "" : rms_and_max(errors));
        }
        text += table_row(mesh.name, ranks, cells);
    }
    return text;
}

std::string method_tables() {
    return method_table(
               "The decoded normal of a texel tilted by 30 degrees, inside triangles: RMS / "
               "maximum error in degrees",
               false, texel_errors) +
           method_table("The tangent's direction at vertices", true,
                        [](const TexturedMesh& reference, const TangentFrames& frames) {
                            return error_stats(corner_tangent_angles(reference, frames.tangents));
                        }) +
           method_table("The tangent's direction inside triangles", false, inner_tangent_errors);
}

/// Costs of methods, measured by bench/frame_costs_bench.cpp with interleaved runs. A test cannot
/// reproduce times, so the numbers are constants, and the page states their date.
struct MeasuredCost {
    const char* method;
    const char* computing;
    const char* bytes;
    const char* device;
};
constexpr std::array measured_costs = {
    MeasuredCost{"mikktspace", "1 (88 ns per triangle, one thread)", "28; 4 or 8", "1"},
    MeasuredCost{"area-weighted", "0.93", "28; 4 or 8", "1"},
    MeasuredCost{"lengyel", "0.87", "28; 4 or 8", "1"},
    MeasuredCost{"screen-space", "0", "12: normals alone", "1.05 to 1.08"}};

/// Returns a table of the errors on three meshes and the costs.
std::string cost_table() {
    const std::array<std::string, 3> shown = {"torus, jittered", "cubic, anisotropic",
                                              "plate with thin bevels and a sheared image on them"};
    std::string text = "\n";
    text += table_header({"error: torus, jittered", "cubic, anisotropic", "plate with thin bevels",
                          "computing", "bytes per vertex: floats; codes", "drawing"});
    for (std::size_t i = 0; i < methods().size(); ++i) {
        const FrameMethod& method = methods()[i];
        std::vector<std::string> cells;
        for (const std::string& name : shown) {
            const auto mesh = std::find_if(meshes().begin(), meshes().end(),
                                           [&](const NamedMesh& one) { return one.name == name; });
            const TexturedMesh& reference = mesh->reference;
            cells.push_back(in_digits(texel_errors(reference, method.compute(reference.mesh)).rms));
        }
        const MeasuredCost& cost = measured_costs.at(i);
        cells.insert(cells.end(), {cost.computing, cost.bytes, cost.device});
        text += table_row(cost.method, cells);
    }
    return text;
}

std::string mismatch_table(const std::string& title, const TexturedMesh& reference) {
    std::vector<FrameMethod> bases = methods();
    bases.push_back(made_unit(bases.front()));
    std::vector<std::string> names;
    for (const FrameMethod& reader : bases)
        names.push_back("read in " + reader.name);
    std::string text = "\n" + title + "\n\n" + table_header(names);
    for (const FrameMethod& baker : bases) {
        std::vector<double> ranks;
        std::vector<std::string> cells;
        for (const FrameMethod& reader : bases) {
            const ErrorStats errors = mismatch_errors(reference, baker, reader);
            ranks.push_back(errors.rms);
            cells.push_back(rms_and_max(errors));
        }
        text += table_row("baked in " + baker.name, ranks, cells);
    }
    return text;
}

std::string mismatch_tables() {
    return mismatch_table(
               "Normals tilted by 30 degrees on the jittered torus: RMS / maximum in degrees",
               textured_mesh(AnalyticSurface::torus, Triangulation::jittered,
                             TextureLayout::upright, 64, 1)) +
           mismatch_table("On a coarse torus, 16 x 16 cells, regular",
                          textured_mesh(AnalyticSurface::torus, Triangulation::regular,
                                        TextureLayout::upright, 16, 1)) +
           mismatch_table("On the plate with thin bevels", beveled_plate(0.02));
}

std::string encoding_tables() {
    constexpr std::size_t count = 100000;
    const ReferenceFrames random = random_frames(count);
    const SampleFrames reference = sample_frames(random.normals, random.tangents);
    std::string text =
        "\n100,000 random frames: mean / maximum error in degrees of the normal, the tangent, "
        "and\nthe normal of a texel tilted by 30 degrees\n\n" +
        table_header({"rounding", "bytes", "normal", "tangent", "tilted texel", "handedness lost"});
    const auto mean_and_max = [](const ErrorStats& errors) {
        return fmt::format("{:.2g} / {:.2g}", errors.mean, errors.max);
    };
    for (const FrameEncoding encoding : all_frame_encodings) {
        for (const FrameRounding rounding : {FrameRounding::nearest, FrameRounding::best}) {
            if (encoding == FrameEncoding::float32 && rounding == FrameRounding::best) continue;
            const FrameCodeErrors errors = frame_code_errors(reference, encoding, rounding);
            const std::vector<std::string> cells = {
                rounding == FrameRounding::nearest ? "nearest" : "best",
                fmt::format("{}", 4 * words_per_frame(encoding)),
                mean_and_max(errors.normal),
                mean_and_max(errors.tangent),
                mean_and_max(errors.texel),
                fmt::format("{}", errors.flipped_frames)};
            text += table_row(fmt::format("`{}`", enum_name(encoding)), cells);
        }
    }
    return text;
}

}  // namespace

std::vector<PageSection> tangent_tables() {
    return {written_section("tables of methods", method_tables()),
            written_section("tables of bases", mismatch_tables()),
            written_section("tables of costs", cost_table()),
            written_section("tables of encodings", encoding_tables())};
}

}  // namespace relief::test
