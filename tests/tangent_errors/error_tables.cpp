// SPDX-License-Identifier: Apache-2.0
#include "tangent_errors/error_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "relief/mesh/analytic_surfaces.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/frame_encoding.h"
#include "relief/mesh/tangents.h"
#include "support/random_frames.h"
#include "tangent_errors/bases.h"

namespace relief::test {
namespace {

/// Texels tilted by 30 degrees: to the right, to the left, up and down.
constexpr std::array<glm::dvec3, 4> tilted_texels = {
    glm::dvec3(0.5, 0.0, 0.8660254037844386), glm::dvec3(-0.5, 0.0, 0.8660254037844386),
    glm::dvec3(0.0, 0.5, 0.8660254037844386), glm::dvec3(0.0, -0.5, 0.8660254037844386)};

using TangentFunction = std::vector<glm::vec4> (*)(std::span<const glm::vec3>,
                                                   std::span<const glm::vec3>,
                                                   std::span<const glm::vec2>,
                                                   std::span<const glm::uvec3>, Report&);

TangentMethod stored(const char* name, TangentFunction function) {
    return {name, [function](const Mesh& mesh) {
                Report report;
                return function(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                report);
            }};
}

const std::vector<TangentMethod>& methods() {
    static const std::vector<TangentMethod> all = {stored("mikktspace", mikktspace_tangents),
                                                   stored("area-weighted", area_weighted_tangents),
                                                   stored("lengyel", lengyel_tangents),
                                                   {"screen-space", {}, ShaderBasis::derived}};
    return all;
}

CornerTangents tangents_of(const TangentMethod& method, const Mesh& mesh) {
    return method.tangents ? method.tangents(mesh) : CornerTangents{};
}

struct NamedMesh {
    std::string name;
    TexturedMesh truth;
};

const std::vector<NamedMesh>& meshes() {
    static const std::vector<NamedMesh> all = [] {
        using enum AnalyticSurface;
        using enum Triangulation;
        using enum TextureLayout;
        constexpr int cells = 64;
        std::vector<NamedMesh> made;
        for (const auto& [word, triangulation] :
             {std::pair("regular", regular), std::pair("jittered", jittered),
              std::pair("anisotropic", anisotropic)}) {
            for (const auto& [name, surface] :
                 {std::pair("sphere", sphere), std::pair("torus", torus),
                  std::pair("ellipsoid", ellipsoid), std::pair("saddle", saddle),
                  std::pair("cubic", cubic)}) {
                made.push_back({fmt::format("{}, {}", name, word),
                                textured_mesh(surface, triangulation, upright, cells, 1)});
            }
        }
        made.push_back(
            {"torus, jittered, image sheared", textured_mesh(torus, jittered, sheared, cells, 1)});
        made.push_back({"torus, jittered, image mirrored",
                        textured_mesh(torus, jittered, mirrored, cells, 1)});
        made.push_back({"plate with thin bevels, image sheared on those", bevelled_plate(0.02)});
        return made;
    }();
    return all;
}

/// Adds up angles. One that is no number stays seen.
class Errors {
  public:
    void add(double degrees) {
        squares_ += degrees * degrees;
        sum_ += degrees;
        if (!(degrees <= max_)) max_ = degrees;
        ++count_;
    }
    [[nodiscard]] double rms() const { return std::sqrt(squares_ / static_cast<double>(count_)); }
    [[nodiscard]] double mean() const { return sum_ / static_cast<double>(count_); }
    [[nodiscard]] double max() const { return max_; }

  private:
    double squares_ = 0.0;
    double sum_ = 0.0;
    double max_ = 0.0;
    std::size_t count_ = 0;
};

/// Of tangents at the corners of inner vertices.
Errors corner_errors(const TexturedMesh& truth, const CornerTangents& tangents) {
    const CornerTangents expected = true_tangents(truth);
    Errors errors;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::uint32_t vertex = truth.mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (truth.inner[vertex] == 0) continue;
        errors.add(degrees_between(glm::dvec3(tangents[corner]), glm::dvec3(expected[corner])));
    }
    return errors;
}

/// Of tangents inside of triangles.
Errors inner_errors(const TexturedMesh& truth, const CornerTangents& tangents, ShaderBasis basis) {
    Errors errors;
    for (const Sample& sample : samples_of(truth)) {
        errors.add(degrees_between(basis_at(truth.mesh, tangents, basis, sample)[0],
                                   true_basis_at(truth, sample)[0]));
    }
    return errors;
}

/// Of the normals that tilted texels stand for, inside of triangles.
Errors texel_errors(const TexturedMesh& truth, const CornerTangents& tangents, ShaderBasis basis) {
    Errors errors;
    for (const Sample& sample : samples_of(truth)) {
        const glm::dmat3 found = basis_at(truth.mesh, tangents, basis, sample);
        const glm::dmat3 expected = true_basis_at(truth, sample);
        for (const glm::dvec3& texel : tilted_texels)
            errors.add(degrees_between(found * texel, expected * texel));
    }
    return errors;
}

std::string rms_and_max(const Errors& errors) {
    return in_digits(errors.rms()) + " / " + in_digits(errors.max());
}

constexpr double not_compared = std::numeric_limits<double>::quiet_NaN();

/// One line a mesh; measured(truth, tangents, method) gives the errors. The first column is of the
/// true tangents, which no method can be expected to beat.
template <typename Measured>
std::string method_table(const std::string& title, bool at_corners, Measured measured) {
    std::vector<std::string> names = {"*true*"};
    for (const TangentMethod& method : methods())
        names.push_back(method.name);
    std::string text = "\n" + title + "\n\n" + table_header(names);
    for (const NamedMesh& mesh : meshes()) {
        const Errors least =
            measured(mesh.truth, true_tangents(mesh.truth), ShaderBasis::as_interpolated);
        std::vector<double> ranks = {not_compared};
        std::vector<std::string> cells = {rms_and_max(least)};
        for (const TangentMethod& method : methods()) {
            const bool none = at_corners && !method.tangents;
            const Errors errors =
                none ? Errors{}
                     : measured(mesh.truth, tangents_of(method, mesh.truth.mesh), method.basis);
            ranks.push_back(none ? not_compared : errors.rms());
            cells.push_back(none ? "" : rms_and_max(errors));
        }
        text += table_row(mesh.name, ranks, cells);
    }
    return text;
}

std::string method_tables() {
    return method_table(
               "The normal that a texel tilted by 30 degrees stands for, inside of "
               "triangles: RMS / largest error in degrees",
               false, texel_errors) +
           method_table("The tangent's direction at vertices", true,
                        [](const TexturedMesh& truth, const CornerTangents& tangents, ShaderBasis) {
                            return corner_errors(truth, tangents);
                        }) +
           method_table("The tangent's direction inside of triangles", false, inner_errors) + "\n";
}

/// What a method costs, as bench/frame_costs_bench.cpp measured it, in turns in one run: times are
/// no part of what a test can hold, so they are put in here by hand, and the page dates them.
struct MeasuredCost {
    const char* method;
    const char* computing;
    const char* bytes;
    const char* drawing;
};
constexpr std::array measured_costs = {
    MeasuredCost{"mikktspace", "1 (88 ns a triangle, one thread)", "28; 4 or 8", "1"},
    MeasuredCost{"area-weighted", "0.93", "28; 4 or 8", "1"},
    MeasuredCost{"lengyel", "0.87", "28; 4 or 8", "1"},
    MeasuredCost{"screen-space", "0", "12: normals alone", "1.05 to 1.08"}};

/// Errors of three meshes beside what that costs.
std::string cost_table() {
    const std::array<std::string, 3> shown = {"torus, jittered", "cubic, anisotropic",
                                              "plate with thin bevels, image sheared on those"};
    std::string text = "\n";
    text += table_header({"error: torus, jittered", "cubic, anisotropic", "plate with thin bevels",
                          "computing", "bytes a vertex: floats; codes", "drawing"});
    for (std::size_t i = 0; i < methods().size(); ++i) {
        const TangentMethod& method = methods()[i];
        std::vector<std::string> cells;
        for (const std::string& name : shown) {
            const auto mesh = std::find_if(meshes().begin(), meshes().end(),
                                           [&](const NamedMesh& one) { return one.name == name; });
            const TexturedMesh& truth = mesh->truth;
            cells.push_back(in_digits(
                texel_errors(truth, tangents_of(method, truth.mesh), method.basis).rms()));
        }
        const MeasuredCost& cost = measured_costs.at(i);
        cells.insert(cells.end(), {cost.computing, cost.bytes, cost.drawing});
        text += table_row(cost.method, std::vector(cells.size(), not_compared), cells);
    }
    return text + "\n";
}

/// What becomes of a true normal that is baked in one basis and read in another.
Errors mismatch(const TexturedMesh& truth, const TangentMethod& baker,
                const TangentMethod& reader) {
    const CornerTangents baked = tangents_of(baker, truth.mesh);
    const CornerTangents read = tangents_of(reader, truth.mesh);
    Errors errors;
    for (const Sample& sample : samples_of(truth)) {
        const glm::dmat3 expected = true_basis_at(truth, sample);
        const glm::dmat3 to_texel = glm::inverse(basis_at(truth.mesh, baked, baker.basis, sample));
        const glm::dmat3 from_texel = basis_at(truth.mesh, read, reader.basis, sample);
        for (const glm::dvec3& tilt : tilted_texels) {
            const glm::dvec3 normal = expected * tilt;
            const glm::dvec3 texel = glm::normalize(to_texel * normal);
            errors.add(degrees_between(from_texel * texel, normal));
        }
    }
    return errors;
}

std::string mismatch_table(const std::string& title, const TexturedMesh& truth) {
    std::vector<TangentMethod> bases = methods();
    bases.push_back(bases.front());
    bases.back().name += ", made unit";
    bases.back().basis = ShaderBasis::made_unit;
    std::vector<std::string> names;
    for (const TangentMethod& reader : bases)
        names.push_back("read in " + reader.name);
    std::string text = "\n" + title + "\n\n" + table_header(names);
    for (const TangentMethod& baker : bases) {
        std::vector<double> ranks;
        std::vector<std::string> cells;
        for (const TangentMethod& reader : bases) {
            const Errors errors = mismatch(truth, baker, reader);
            ranks.push_back(errors.rms());
            cells.push_back(rms_and_max(errors));
        }
        text += table_row("baked in " + baker.name, ranks, cells);
    }
    return text;
}

std::string mismatch_tables() {
    return mismatch_table(
               "Normals tilted by 30 degrees on the jittered torus: RMS / largest in degrees",
               textured_mesh(AnalyticSurface::torus, Triangulation::jittered,
                             TextureLayout::upright, 64, 1)) +
           mismatch_table("On a coarse torus, 16 x 16 cells, regular",
                          textured_mesh(AnalyticSurface::torus, Triangulation::regular,
                                        TextureLayout::upright, 16, 1)) +
           mismatch_table("On the plate with thin bevels", bevelled_plate(0.02)) + "\n";
}

/// Of a normal, a tangent and tilted texels that went through an encoding.
struct EncodingErrors {
    Errors normal;
    Errors tangent;
    Errors texel;
    std::size_t lost_hands = 0;
};

EncodingErrors encoding_errors(const TrueFrames& truth, FrameEncoding encoding,
                               FrameRounding rounding) {
    Report report;
    const Frames frames = decode_frames(
        encode_frames(truth.float_normals, truth.float_tangents, encoding, rounding, report),
        encoding, report);
    EncodingErrors errors;
    for (std::size_t i = 0; i < truth.normals.size(); ++i) {
        const glm::dvec3 normal(frames.normals[i]);
        const glm::dvec3 tangent(frames.tangents[i]);
        errors.normal.add(degrees_between(normal, truth.normals[i]));
        errors.tangent.add(degrees_between(tangent, truth.tangents[i]));
        errors.lost_hands += frames.tangents[i].w == truth.float_tangents[i].w ? 0U : 1U;
        const glm::dmat3 found(tangent, glm::cross(normal, tangent), normal);
        const glm::dmat3 expected(
            truth.tangents[i], glm::cross(truth.normals[i], truth.tangents[i]), truth.normals[i]);
        for (const glm::dvec3& texel : tilted_texels)
            errors.texel.add(degrees_between(found * texel, expected * texel));
    }
    return errors;
}

std::string encoding_tables() {
    constexpr std::size_t count = 100000;
    const TrueFrames truth = random_frames(count);
    std::string text =
        "\n100,000 random frames: mean / largest error in degrees of the normal, the tangent, and "
        "the normal of a texel tilted by 30 degrees\n\n" +
        table_header({"rounding", "bytes", "normal", "tangent", "tilted texel", "hands lost"});
    const auto mean_and_max = [](const Errors& errors) {
        return fmt::format("{:.2g} / {:.2g}", errors.mean(), errors.max());
    };
    for (const FrameEncoding encoding : all_frame_encodings) {
        for (const FrameRounding rounding : {FrameRounding::nearest, FrameRounding::best}) {
            if (encoding == FrameEncoding::float32 && rounding == FrameRounding::best) continue;
            const EncodingErrors errors = encoding_errors(truth, encoding, rounding);
            const std::vector<std::string> cells = {
                rounding == FrameRounding::nearest ? "nearest" : "best",
                fmt::format("{}", 4 * words_per_frame(encoding)),
                mean_and_max(errors.normal),
                mean_and_max(errors.tangent),
                mean_and_max(errors.texel),
                fmt::format("{}", errors.lost_hands)};
            text += table_row(fmt::format("`{}`", word_of(encoding)),
                              std::vector(cells.size(), not_compared), cells);
        }
    }
    return text + "\n";
}

std::string begin_of(const char* which) {
    return fmt::format("<!-- tables of {}: written by relief-tangent-errors-page -->\n", which);
}

}  // namespace

std::vector<PageSection> tangent_error_sections() {
    return {{begin_of("methods"), method_tables()},
            {begin_of("bases"), mismatch_tables()},
            {begin_of("costs"), cost_table()},
            {begin_of("encodings"), encoding_tables()}};
}

}  // namespace relief::test
