// SPDX-License-Identifier: Apache-2.0
// `relief-mesh compare A B` matches the corners of two models, measures the angles between their
// normals and between their tangents, and checks them against a limit.
// Tests: tests/tools/relief_mesh_compare_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/text.h"
#include "relief/mesh/compare.h"
#include "relief/mesh/placed.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

struct CompareRequest {
    std::filesystem::path a;
    std::filesystem::path b;
    std::optional<double> tolerance;     ///< Of positions, in the unit of the models.
    std::optional<double> uv_tolerance;  ///< Of texture coordinates.
    bool ignore_uv = false;
    bool in_world_space = false;  ///< Also if both files are glTF.
};

/// A primitive of the joined mesh.
struct ComparedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t first_triangle = 0;
    std::size_t triangle_count = 0;
    bool has_normals = false;
    bool has_tangents = false;
    std::size_t unmatched = 0;   ///< The number of triangles without partner.
    FrameComparison comparison;  ///< Only for parts of the first file.
};

/// The primitives of a file, joined to one mesh with a range per primitive.
struct ComparedModel {
    std::filesystem::path file;
    std::string format;
    Mesh mesh;
    std::vector<ComparedPart> parts;
};

struct ComparedModels {
    ComparedModel a;
    ComparedModel b;
    MatchOptions options;  ///< The tolerances in use.
    bool in_world_space = false;
    CornerMatch match;
    FrameComparison all;
    /// Matched corners with normals, or tangents, in only one of the files.
    std::size_t normals_in_one = 0;
    std::size_t tangents_in_one = 0;

    /// Whether no matched corner differs by more than `degrees` or in its sign.
    [[nodiscard]] bool is_within(double degrees) const;
    /// Whether each triangle has exactly one possible partner, and all directions could be
    /// compared.
    [[nodiscard]] bool is_complete() const;
    /// Whether the files have normals or tangents in common.
    [[nodiscard]] bool has_directions() const;
};

bool ComparedModels::is_within(double degrees) const {
    return all.normals.max <= degrees && all.tangents.max <= degrees && all.sign_differences == 0 &&
           all.normals.undefined + all.tangents.undefined == 0;
}

bool ComparedModels::is_complete() const {
    return match.only_a.empty() && match.only_b.empty() && match.ambiguous == 0 &&
           all.normals.undefined + all.tangents.undefined == 0 &&
           normals_in_one + tangents_in_one == 0;
}

bool ComparedModels::has_directions() const {
    return all.normals.count + all.normals.undefined + all.tangents.count +
               all.tangents.undefined !=
           0;
}

/// The rounding error of text files with six digits, relative to the size of model and texture.
constexpr double default_tolerance = 1e-5;
constexpr double default_uv_tolerance = 1e-6;

constexpr std::size_t max_parts = 24;
constexpr std::size_t max_worst = 24;

/// Appends a primitive. Missing attributes become zeros.
void append(ComparedModel& model, Mesh mesh, std::string name) {
    Mesh& all = model.mesh;
    ComparedPart part;
    part.name = std::move(name);
    part.first_triangle = all.triangles.size();
    part.triangle_count = mesh.triangles.size();
    part.has_normals = !mesh.normals.empty();
    part.has_tangents = !mesh.tangents.empty();
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    const std::size_t count = all.positions.size() + mesh.positions.size();
    const auto add = [&](auto& values, auto& more) {
        if (more.empty() && values.empty()) return;
        values.resize(first);
        std::move(more.begin(), more.end(), std::back_inserter(values));
        values.resize(count);
    };
    add(all.positions, mesh.positions);
    add(all.normals, mesh.normals);
    add(all.texcoords, mesh.texcoords);
    add(all.tangents, mesh.tangents);
    for (const glm::uvec3& triangle : mesh.triangles)
        all.triangles.push_back(triangle + first);
    all.material_ranges.push_back({static_cast<std::uint32_t>(part.first_triangle),
                                   static_cast<std::uint32_t>(part.triangle_count), std::nullopt});
    model.parts.push_back(std::move(part));
}

/// A file's contents, and the origin of its positions.
struct ReadModel {
    Model model;
    glm::dvec3 origin{0.0};

    explicit ReadModel(const std::filesystem::path& file, Report& report)
        : model(read_model(file, report)) {
        if (const auto* mesh = std::get_if<MeshFile>(&model)) origin = mesh->origin;
    }
    [[nodiscard]] bool is_document() const { return std::holds_alternative<GltfDocument>(model); }
};

void append_primitives(ComparedModel& model, const GltfDocument& document, bool in_world_space) {
    if (!in_world_space) {
        for (const GltfPrimitiveId id : document.triangle_primitives())
            append(model, document.mesh(id), document.describe(id));
        return;
    }
    for (const auto& primitive : document.view().primitives) {
        append(model, placed(document.mesh(primitive.what), primitive.world_from_object),
               document.describe(primitive.what));
    }
}

ComparedModel joined(const std::filesystem::path& file, ReadModel read, bool in_world_space,
                     const glm::dvec3& origin) {
    ComparedModel result;
    result.file = file;
    result.format = format_name(readable_format(file));
    about(file, [&] {
        if (auto* contents = std::get_if<MeshFile>(&read.model)) {
            append(result, std::move(contents->mesh), "");
        } else {
            append_primitives(result, std::get<GltfDocument>(read.model), in_world_space);
        }
    });
    if (result.mesh.triangles.empty()) throw FileError(file, "holds no triangles");
    const glm::dvec3 shift = read.origin - origin;
    if (shift != glm::dvec3(0.0)) {
        for (glm::vec3& position : result.mesh.positions)
            position = glm::vec3(glm::dvec3(position) + shift);
    }
    return result;
}

/// The largest absolute coordinate and the longest side of the bounds of the finite positions.
struct Extent {
    double largest = 0.0;
    double size = 0.0;
};

Extent extent_of(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    Extent extent;
    if (bounds.empty()) return extent;
    for (int i = 0; i < 3; ++i) {
        extent.size = std::max(
            extent.size, static_cast<double>(bounds.max[i]) - static_cast<double>(bounds.min[i]));
        extent.largest = std::max({extent.largest, std::abs(static_cast<double>(bounds.max[i])),
                                   std::abs(static_cast<double>(bounds.min[i]))});
    }
    return extent;
}

double largest_texcoord(const Mesh& mesh) {
    double largest = 1.0;
    for (const glm::vec2& texcoord : mesh.texcoords) {
        for (int i = 0; i < 2; ++i) {
            const double value = std::abs(static_cast<double>(texcoord[i]));
            if (std::isfinite(value)) largest = std::max(largest, value);
        }
    }
    return largest;
}

/// The tolerance is at least the spacing of floats at the coordinates of the models.
MatchOptions match_options(const CompareRequest& request, const ComparedModels& models,
                           double farthest_origin) {
    MatchOptions options;
    const Extent a = extent_of(models.a.mesh);
    const Extent b = extent_of(models.b.mesh);
    constexpr double float_spacing = 1.2e-7;
    options.position_tolerance = request.tolerance.value_or(
        std::max(default_tolerance * std::max(a.size, b.size),
                 2.0 * float_spacing * std::max({a.largest, b.largest, farthest_origin})));
    options.texcoord_tolerance = request.uv_tolerance.value_or(
        default_uv_tolerance *
        std::max(largest_texcoord(models.a.mesh), largest_texcoord(models.b.mesh)));
    options.by_texcoord = !request.ignore_uv;
    return options;
}

/// Returns the part of each triangle.
std::vector<const ComparedPart*> parts_of(const ComparedModel& model) {
    std::vector<const ComparedPart*> parts(model.mesh.triangles.size());
    for (const ComparedPart& part : model.parts)
        std::fill_n(parts.begin() + static_cast<std::ptrdiff_t>(part.first_triangle),
                    part.triangle_count, &part);
    return parts;
}

/// Excludes corners of primitives that lack an attribute, and counts those that lack it in one
/// file.
void exclude_missing(ComparedModels& models, CornerDifferences& differences) {
    constexpr float not_compared = -1.0F;
    const auto of_a = parts_of(models.a);
    const auto of_b = parts_of(models.b);
    for (std::size_t corner = 0; corner < models.match.corners.size(); ++corner) {
        const std::uint32_t partner = models.match.corners[corner];
        if (partner == no_corner_matched) continue;
        const ComparedPart& a = *of_a[corner / 3];
        const ComparedPart& b = *of_b[partner / 3];
        models.normals_in_one += a.has_normals != b.has_normals ? 1 : 0;
        models.tangents_in_one += a.has_tangents != b.has_tangents ? 1 : 0;
        if (!differences.normals.empty() && !(a.has_normals && b.has_normals))
            differences.normals[corner] = not_compared;
        if (!differences.tangents.empty() && !(a.has_tangents && b.has_tangents)) {
            differences.tangents[corner] = not_compared;
            differences.sign_differs[corner] = 0;
        }
    }
}

void count_unmatched(std::vector<ComparedPart>& parts, const std::vector<std::uint32_t>& only) {
    for (ComparedPart& part : parts) {
        const auto begin = std::lower_bound(only.begin(), only.end(), part.first_triangle);
        const auto end =
            std::lower_bound(begin, only.end(), part.first_triangle + part.triangle_count);
        part.unmatched = static_cast<std::size_t>(end - begin);
    }
}

/// Two glTF files are compared in the object space of each primitive, or with `in_world_space` once
/// per instance in world space. A glTF file and a file of another format are always compared in
/// world space, because other formats store world space.
///
/// \throws FileError if a file cannot be read or holds no triangles
ComparedModels compare_models(const CompareRequest& request) {
    Report ignored;  // `relief-mesh check` reports the findings of a file.
    ReadModel a(request.a, ignored);
    ReadModel b(request.b, ignored);
    ComparedModels result;
    result.in_world_space = request.in_world_space || a.is_document() != b.is_document();
    const glm::dvec3 origin = a.origin != glm::dvec3(0.0) ? a.origin : b.origin;
    const bool moves = a.origin != b.origin;
    result.a = joined(request.a, std::move(a), result.in_world_space, origin);
    result.b = joined(request.b, std::move(b), result.in_world_space, origin);
    result.options = match_options(request, result, moves ? glm::length(origin) : 0.0);
    result.match = match_corners(result.a.mesh, result.b.mesh, result.options);
    CornerDifferences differences = corner_differences(result.a.mesh, result.b.mesh, result.match);
    exclude_missing(result, differences);
    count_unmatched(result.a.parts, result.match.only_a);
    count_unmatched(result.b.parts, result.match.only_b);
    result.all = compared(differences, result.match, 0, result.a.mesh.triangles.size(), max_worst);
    for (ComparedPart& part : result.a.parts) {
        part.comparison = compared(differences, result.match, part.first_triangle,
                                   part.triangle_count, max_worst);
    }
    return result;
}

std::string degrees_in_words(const AngleDistribution& angles) {
    return fmt::format("{}: rms {:.4g}, mean {:.4g}, 99 % within {:.4g}, maximum {:.4g} degrees",
                       counted(angles.count, "corner"), angles.rms, angles.mean, angles.p99,
                       angles.max);
}

std::string histogram_in_words(const AngleDistribution& angles) {
    std::vector<std::string> bins;
    for (std::size_t i = 0; i < angles.histogram.size(); ++i) {
        if (angles.histogram[i] != 0)
            bins.push_back(
                fmt::format("{} up to {}", angles.histogram[i], AngleDistribution::bounds[i]));
    }
    return fmt::format("{} degrees", fmt::join(bins, ", "));
}

/// Returns why an attribute is not compared: "only in A".
std::string absence(bool in_a, bool in_b) {
    return in_a ? "only in A" : in_b ? "only in B" : "in neither";
}

std::vector<std::string> attribute_lines(const AngleDistribution& angles, bool in_a, bool in_b,
                                         std::size_t in_one) {
    if (!in_a || !in_b) return {absence(in_a, in_b)};
    std::vector<std::string> lines;
    if (angles.count != 0) lines = {degrees_in_words(angles), histogram_in_words(angles)};
    if (angles.undefined != 0) {
        lines.push_back(fmt::format("{} with a zero or non-finite direction",
                                    counted(angles.undefined, "corner")));
    }
    if (in_one != 0)
        lines.push_back(fmt::format("{} with them in only one file", counted(in_one, "corner")));
    if (lines.empty()) lines.emplace_back("no corner has them in both files");
    return lines;
}

const ComparedPart& part_of(const ComparedModel& model, std::size_t triangle) {
    return *std::find_if(model.parts.rbegin(), model.parts.rend(), [&](const ComparedPart& part) {
        return part.first_triangle <= triangle && part.triangle_count != 0;
    });
}

glm::vec3 place_of(const ComparedModel& model, std::uint32_t corner) {
    return model.mesh.positions[model.mesh.triangles[corner / 3][static_cast<int>(corner % 3)]];
}

std::string in_words(const ComparedModels& compared, const WorstCorner& worst,
                     const std::string& what) {
    const ComparedPart& part = part_of(compared.a, worst.corner_a / 3);
    const glm::vec3 at = place_of(compared.a, worst.corner_a);
    return fmt::format(
        "{}{}: {} at ({:.6g}, {:.6g}, {:.6g}), corner {} of triangle {}",
        part.name.empty() ? "" : part.name + ": ", what,
        std::isnan(worst.degrees) ? "undefined" : fmt::format("{:.4g} degrees", worst.degrees),
        at.x, at.y, at.z, worst.corner_a % 3, worst.corner_a / 3 - part.first_triangle);
}

/// Returns the places with the largest differences of both attributes.
std::vector<std::string> worst_lines(const ComparedModels& compared) {
    constexpr std::size_t shown = 3;
    std::vector<std::string> lines;
    const auto add = [&](const std::vector<WorstCorner>& corners, const std::string& what) {
        std::vector<glm::vec3> places;  // Corners at one position share a line.
        for (const WorstCorner& worst : corners) {
            const glm::vec3 place = place_of(compared.a, worst.corner_a);
            if (std::find(places.begin(), places.end(), place) != places.end()) continue;
            places.push_back(place);
            if (places.size() > shown) return;
            lines.push_back(in_words(compared, worst, what));
        }
    };
    add(compared.all.worst_normals, "normal");
    add(compared.all.worst_tangents, "tangent");
    return lines;
}

std::string matched_in_words(const ComparedModels& compared) {
    const CornerMatch& match = compared.match;
    std::string text =
        fmt::format("{} by position{}", counted(match.exact + match.near, "triangle"),
                    match.by_texcoord ? " and texture coordinate" : "");
    if (match.near != 0) {
        text += fmt::format(
            ", {} of them within {:.3g}{}", match.near, compared.options.position_tolerance,
            match.by_texcoord ? fmt::format(" and {:.3g}", compared.options.texcoord_tolerance)
                              : "");
    }
    if (compared.in_world_space) text += ", in world space";
    return text;
}

/// Returns a line per file about its triangles without partner.
std::vector<std::string> unmatched_lines(const ComparedModels& compared) {
    const auto line = [](const char* where, const std::vector<ComparedPart>& parts,
                         const std::vector<std::uint32_t>& only) {
        std::string text = fmt::format("{} only in {}", counted(only.size(), "triangle"), where);
        const auto first = std::find_if(parts.begin(), parts.end(), [](const ComparedPart& part) {
            return part.unmatched != 0;
        });
        if (first != parts.end()) {
            text += fmt::format(" (first: {}triangle {})",
                                first->name.empty() ? "" : first->name + ", ",
                                only.front() - first->first_triangle);
        }
        return text;
    };
    std::vector<std::string> lines;
    const CornerMatch& match = compared.match;
    if (!match.only_a.empty()) lines.push_back(line("A", compared.a.parts, match.only_a));
    if (!match.only_b.empty()) lines.push_back(line("B", compared.b.parts, match.only_b));
    return lines;
}

/// Returns a line per primitive of A if there are several.
std::vector<std::string> part_lines(const ComparedModels& compared) {
    if (compared.a.parts.size() < 2) return {};
    std::vector<std::string> lines;
    for (const ComparedPart& part : compared.a.parts) {
        if (lines.size() == max_parts) {
            lines.push_back(fmt::format("... and {} more (--json lists all)",
                                        compared.a.parts.size() - lines.size()));
            break;
        }
        const FrameComparison& own = part.comparison;
        std::string text = fmt::format("{}: {}", part.name, counted(own.corners, "corner"));
        if (own.normals.count != 0) text += fmt::format(", normals up to {:.4g}", own.normals.max);
        if (own.tangents.count != 0)
            text += fmt::format(", tangents up to {:.4g}", own.tangents.max);
        if (own.normals.count + own.tangents.count != 0) text += " degrees";
        if (own.sign_differences != 0)
            text += fmt::format(", {}", counted(own.sign_differences, "different sign"));
        if (part.unmatched != 0)
            text += fmt::format(", {} unmatched", counted(part.unmatched, "triangle"));
        lines.push_back(std::move(text));
    }
    return lines;
}

std::string in_words(const ComparedModel& model) {
    return fmt::format("{}: {}, {}, {}", model.file.string(), model.format,
                       counted(model.parts.size(), "primitive"),
                       counted(model.mesh.triangles.size(), "triangle"));
}

bool any_has(const ComparedModel& model, bool ComparedPart::*attribute) {
    return std::any_of(model.parts.begin(), model.parts.end(),
                       [&](const ComparedPart& part) { return part.*attribute; });
}

void print_text(const ComparedModels& compared) {
    print_entry("A", in_words(compared.a));
    print_entry("B", in_words(compared.b));
    print_entry("matched", matched_in_words(compared));
    print_entry("unmatched", unmatched_lines(compared));
    if (compared.match.ambiguous != 0) {
        print_entry("ambiguous", fmt::format("{} matched to one of several at the same position",
                                             counted(compared.match.ambiguous, "triangle")));
    }
    print_entry(
        "normals",
        attribute_lines(compared.all.normals, any_has(compared.a, &ComparedPart::has_normals),
                        any_has(compared.b, &ComparedPart::has_normals), compared.normals_in_one));
    print_entry("tangents", attribute_lines(compared.all.tangents,
                                            any_has(compared.a, &ComparedPart::has_tangents),
                                            any_has(compared.b, &ComparedPart::has_tangents),
                                            compared.tangents_in_one));
    if (compared.all.sign_differences != 0) {
        print_entry("signs", fmt::format("{} with different handedness",
                                         counted(compared.all.sign_differences, "tangent")));
    }
    print_entry("worst", worst_lines(compared));
    print_entry("parts", part_lines(compared));
}

nlohmann::ordered_json json_of(const AngleDistribution& angles) {
    nlohmann::ordered_json histogram = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < angles.histogram.size(); ++i)
        histogram.push_back(
            {{"up_to", AngleDistribution::bounds[i]}, {"corners", angles.histogram[i]}});
    return {{"corners", angles.count},
            {"undefined", angles.undefined},
            {"rms", angles.rms},
            {"mean", angles.mean},
            {"p99", angles.p99},
            {"max", angles.max},
            {"histogram", std::move(histogram)}};
}

nlohmann::ordered_json worst_json(const ComparedModels& compared,
                                  const std::vector<WorstCorner>& corners) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const WorstCorner& worst : corners) {
        const ComparedPart& part = part_of(compared.a, worst.corner_a / 3);
        const ComparedPart& other = part_of(compared.b, worst.corner_b / 3);
        const glm::vec3 at = place_of(compared.a, worst.corner_a);
        const nlohmann::ordered_json degrees = std::isnan(worst.degrees)
                                                   ? nlohmann::ordered_json()
                                                   : nlohmann::ordered_json(worst.degrees);
        list.push_back({{"degrees", degrees},
                        {"position", {at.x, at.y, at.z}},
                        {"primitive", part.name},
                        {"triangle", worst.corner_a / 3 - part.first_triangle},
                        {"corner", worst.corner_a % 3},
                        {"triangle_of_b", worst.corner_b / 3 - other.first_triangle},
                        {"corner_of_b", worst.corner_b % 3}});
    }
    return list;
}

nlohmann::ordered_json json_of(const ComparedModels& compared, const FrameComparison& own) {
    return {{"corners", own.corners},
            {"normals", json_of(own.normals)},
            {"tangents", json_of(own.tangents)},
            {"sign_differences", own.sign_differences},
            {"worst_normals", worst_json(compared, own.worst_normals)},
            {"worst_tangents", worst_json(compared, own.worst_tangents)}};
}

nlohmann::ordered_json json_of(const ComparedModels& compared) {
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (const ComparedPart& part : compared.a.parts) {
        nlohmann::ordered_json json = {
            {"name", part.name}, {"triangles", part.triangle_count}, {"only_in_a", part.unmatched}};
        json.update(json_of(compared, part.comparison));
        parts.push_back(std::move(json));
    }
    const CornerMatch& match = compared.match;
    nlohmann::ordered_json result = {
        {"a", compared.a.file.string()},
        {"b", compared.b.file.string()},
        {"world_space", compared.in_world_space},
        {"by_texture_coordinate", match.by_texcoord},
        {"tolerance", compared.options.position_tolerance},
        {"uv_tolerance", compared.options.texcoord_tolerance},
        {"triangles",
         {{"equal", match.exact},
          {"near", match.near},
          {"ambiguous", match.ambiguous},
          {"only_in_a", match.only_a.size()},
          {"only_in_b", match.only_b.size()}}},
    };
    result.update(json_of(compared, compared.all));
    result["primitives"] = std::move(parts);
    return result;
}

struct CompareOptions {
    CompareRequest request;
    std::optional<double> max_angle;
    bool json = false;
    bool strict = false;
    GeneralOptions general;
};

/// Returns the differences above the limit.
std::string above_limit(const FrameComparison& all, double max_angle) {
    std::vector<std::string> words;
    const auto add = [&](const AngleDistribution& angles, const char* what) {
        if (angles.max > max_angle)
            words.push_back(fmt::format("{} by {:.4g} degrees", what, angles.max));
        if (angles.undefined != 0)
            words.push_back(fmt::format("{} {} without direction", angles.undefined, what));
    };
    add(all.normals, "normals");
    add(all.tangents, "tangents");
    if (all.sign_differences != 0) words.push_back(counted(all.sign_differences, "tangent sign"));
    return fmt::format("{}", fmt::join(words, ", "));
}

ExitCode judge(const CLI::App& app, const CompareOptions& options, const ComparedModels& compared) {
    const auto fail = [&](const std::string& problem) {
        complain(app, fmt::format("{}: {}", options.request.b.string(), problem));
        return ExitCode::failed;
    };
    if (compared.all.corners == 0) {
        return fail(fmt::format(
            "has no triangle in common with {} (try --world, --tolerance, --uv-tolerance, "
            "--ignore-uv)",
            options.request.a.string()));
    }
    if (options.max_angle && !compared.has_directions()) {
        return fail(
            fmt::format("has neither normals nor tangents in common with {}, so --max-angle cannot "
                        "be checked (relief-mesh process computes them)",
                        options.request.a.string()));
    }
    if (options.max_angle && !compared.is_within(*options.max_angle)) {
        return fail(fmt::format("differs from {} by more than {} degrees: {}",
                                options.request.a.string(), *options.max_angle,
                                above_limit(compared.all, *options.max_angle)));
    }
    if (options.strict && !compared.is_complete()) {
        warn(app, "not all corners could be compared (exit code 3, because of --strict)");
        return ExitCode::fell_back;
    }
    return ExitCode::done;
}

ExitCode run(const CLI::App& app, const CompareOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    if (options.request.ignore_uv && options.request.uv_tolerance)
        throw UsageError("--ignore-uv and --uv-tolerance contradict each other");
    readable_format(options.request.a);
    readable_format(options.request.b);
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    const ComparedModels compared =
        stages.run("compare", [&] { return compare_models(options.request); });
    if (options.json) {
        nlohmann::ordered_json json = {{"tool", "relief-mesh compare"}, {"version", version()}};
        json.update(json_of(compared));
        json["max_angle"] = options.max_angle ? nlohmann::ordered_json(*options.max_angle)
                                              : nlohmann::ordered_json();
        json["within"] = options.max_angle
                             ? nlohmann::ordered_json(compared.is_within(*options.max_angle))
                             : nlohmann::ordered_json();
        json["complete"] = compared.is_complete();
        print_json(json);
    } else if (!options.general.quiet) {
        print_text(compared);
    }
    return judge(app, options, compared);
}

void add_matching_options(CLI::App& app, CompareRequest& request) {
    const char* group = "Matching";
    const Range distance{0.0, std::numeric_limits<double>::max(), "units"};
    add_number(app, "--tolerance", "DISTANCE", request.tolerance, distance,
               "The maximum distance of matching positions, in the unit of the models; equal "
               "positions match first, then the nearest. Default: 1e-5 of the model's size, the "
               "precision of six digits.")
        .group(group);
    add_number(app, "--uv-tolerance", "DISTANCE", request.uv_tolerance, distance,
               "The same for texture coordinates. Default: 1e-6, multiplied by the largest "
               "coordinate if that is above 1.")
        .group(group);
    add_switch(app, "--world", request.in_world_space,
               "Compare in world space, once per instance, for files with different nodes "
               "(quantized, flattened, re-exported). Default: in the object space of each "
               "primitive if both files are glTF.")
        .group(group);
    add_switch(app, "--ignore-uv", request.ignore_uv,
               "Match by position only. This is the default if a file has no texture coordinates.")
        .group(group);
}

}  // namespace

Command add_compare_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "compare",
                       "Measures the differences between the normals and tangents of two models.");
    const auto options = std::make_shared<CompareOptions>();
    add_file(app, "A", options->request.a, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_file(app, "B", options->request.b, "Model to compare with A; formats may differ.");
    add_number(app, "--max-angle", "DEG", options->max_angle, {0.0, 180.0, "degrees"},
               "Exit with 1 if a normal or tangent differs by more, if the sign of a tangent "
               "differs, or if there are none to compare.")
        .group("Verdict");
    add_switch(app, "--strict", options->strict,
               "Exit with 3 if a triangle has no match or several, if normals or tangents are in "
               "only one file, or if a direction is zero or not finite.")
        .group("Verdict");
    add_matching_options(app, options->request);
    add_switch(app, "--json", options->json,
               "Print one JSON object: tool, version, a, b, world_space, by_texture_coordinate, "
               "tolerance, uv_tolerance, triangles {equal, near, ambiguous, only_in_a, only_in_b}, "
               "corners, normals and tangents {corners, undefined, rms, mean, p99, max, histogram "
               "[up_to, corners]} in degrees, sign_differences, worst_normals and worst_tangents "
               "[degrees, position, primitive, triangle, corner, triangle_of_b, corner_of_b], "
               "primitives [name, triangles, only_in_a, and the same again], max_angle, within, "
               "complete.");
    add_general_options(app, options->general);
    set_examples(app,
                 {"relief-mesh process data/vase.obj out/vase.glb --tangents mikktspace",
                  "relief-mesh process data/vase.obj out/vase-area.glb --tangents area-weighted",
                  "relief-mesh compare out/vase.glb out/vase-area.glb",
                  "relief-mesh compare out/vase.glb out/vase-area.glb --max-angle 5 --strict",
                  "relief-mesh compare out/vase.glb data/vase.obj --ignore-uv --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
