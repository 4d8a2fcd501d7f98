// SPDX-License-Identifier: Apache-2.0
// `relief-mesh conformance OUTPUT_DIR` compares the tangents that a program computed for the
// conformance kit with MikkTSpace's, as text or JSON. Tests: tests/tools/conformance_test.cpp.
#include "conformance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "commands.h"
#include "common/command.h"
#include "common/options.h"
#include "common/summary.h"
#include "json_cursor.h"
#include "relief/mesh/compare.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {
using namespace relief::detail;

// The kit and the comparison.

namespace {

std::vector<glm::vec4> read_expected(const std::filesystem::path& file, std::size_t corners) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<glm::vec4> expected(corners);
    const auto bytes = static_cast<std::streamsize>(corners * sizeof(glm::vec4));
    stream.read(reinterpret_cast<char*>(expected.data()), bytes);
    if (stream.gcount() != bytes || stream.peek() != std::ifstream::traits_type::eof())
        throw FileError(file, fmt::format("does not contain {} tangents of 16 bytes", corners));
    return expected;
}

/// Appends a vertex attribute. A missing attribute becomes zeros.
template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more, std::size_t count) {
    all.insert(all.end(), more.begin(), more.end());
    all.resize(count, T(0.0F));
}

KitMesh read_entry(const nlohmann::json& entry, const std::filesystem::path& folder) {
    KitMesh kit;
    kit.name = entry.at("name").get<std::string>();
    kit.group =
        parse_choice("group", entry.at("group").get<std::string>(), enum_choices<KitGroup>());
    kit.about = entry.at("about").get<std::string>();
    kit.mesh = read_triangles(folder / (kit.name + ".glb"));
    if (kit.group != KitGroup::stability) {
        kit.expected = read_expected(folder / (kit.name + ".f32"), 3 * kit.mesh.triangles.size());
    }
    return kit;
}

std::uint32_t vertex_at(const Mesh& mesh, std::size_t corner) {
    return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

bool has_area(const Mesh& mesh, std::size_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::dvec3 origin(mesh.positions[t.x]);
    return glm::cross(glm::dvec3(mesh.positions[t.y]) - origin,
                      glm::dvec3(mesh.positions[t.z]) - origin) != glm::dvec3(0.0);
}

bool has_one_sign(const Mesh& mesh, std::size_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return mesh.tangents[t.x].w == mesh.tangents[t.y].w &&
           mesh.tangents[t.x].w == mesh.tangents[t.z].w;
}

/// Checks the requirements on any usable tangent.
void check_usable(const KitMesh& kit, std::size_t corner, const glm::vec4& tangent,
                  Judgment& judgment) {
    const double tolerance = tolerance_of(kit.group);
    const glm::dvec3 direction(tangent);
    const double length = glm::length(direction);
    if (!std::isfinite(length)) {
        ++judgment.not_finite;
        return;
    }
    if (std::abs(length - 1.0) > tolerance) ++judgment.not_unit;
    const glm::dvec3 normal(kit.mesh.normals[vertex_at(kit.mesh, corner)]);
    const double cosine = glm::dot(direction, normal) / glm::length(normal);
    if (std::abs(cosine) > tolerance) ++judgment.not_perpendicular;
    if (std::abs(tangent.w) != 1.0F) ++judgment.invalid_sign;
}

}  // namespace

std::vector<KitMesh> read_kit(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "kit.json";
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw failure(file, "cannot be read",
                      "--kit names the folder of the kit: conformance/kit of relief's sources");
    }
    try {
        const nlohmann::json list = nlohmann::json::parse(stream);
        if (list.at("format") != 1) throw FileError(file, "is of another format than 1");
        std::vector<KitMesh> kit;
        for (const nlohmann::json& entry : list.at("meshes"))
            kit.push_back(read_entry(entry, folder));
        if (kit.empty()) throw FileError(file, "names no meshes");
        return kit;
    } catch (const nlohmann::json::exception& error) {
        throw FileError(file, json_problem(error));
    } catch (const UsageError& error) {
        throw FileError(file, error.what());
    }
}

Mesh read_triangles(const std::filesystem::path& file) {
    Report ignored;
    const GltfDocument document = GltfDocument::read(file, ignored);
    Mesh all;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = about(file, [&] { return document.mesh(id); });
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        for (const glm::uvec3& triangle : mesh.triangles)
            all.triangles.push_back(triangle + first);
        all.positions.insert(all.positions.end(), mesh.positions.begin(), mesh.positions.end());
        append(all.normals, mesh.normals, all.positions.size());
        append(all.texcoords, mesh.texcoords, all.positions.size());
        append(all.tangents, mesh.tangents, all.positions.size());
    }
    return all;
}

double tolerance_of(KitGroup group) {
    // Conforming tangents may be stored in 16 bits. Usable ones must be unit with float precision.
    return group == KitGroup::stability ? 1e-6 : 1e-3;
}

bool Judgment::passes(KitGroup group) const {
    const bool is_usable = missing == 0 && extra == 0 && not_finite == 0 && not_unit == 0 &&
                           not_perpendicular == 0 && invalid_sign == 0 && mixed_signs == 0;
    return is_usable && (group == KitGroup::stability || (other_sign == 0 && too_far == 0));
}

Judgment judge(const KitMesh& kit, const Mesh& mesh) {
    const CornerMatch match = match_corners(kit.mesh, mesh);
    const bool is_compared = kit.group != KitGroup::stability;
    Judgment judgment;
    judgment.corners = 3 * kit.mesh.triangles.size();
    judgment.extra = 3 * match.only_b.size();
    std::vector<float> degrees;
    float worst = -1.0F;
    for (std::size_t corner = 0; corner < judgment.corners; ++corner) {
        const std::uint32_t mesh_corner = match.corners[corner];
        if (mesh_corner == no_corner_matched) {
            ++(has_area(kit.mesh, corner / 3) ? judgment.missing : judgment.omitted);
            continue;
        }
        if (is_compared && kit.expected[corner].w == 0.0F) continue;
        ++judgment.judged;
        const glm::vec4& tangent = mesh.tangents[vertex_at(mesh, mesh_corner)];
        check_usable(kit, corner, tangent, judgment);
        if (!has_one_sign(mesh, mesh_corner / 3)) ++judgment.mixed_signs;
        if (!is_compared) continue;
        const glm::vec4& expected = kit.expected[corner];
        if (tangent.w != expected.w) ++judgment.other_sign;
        const double off = degrees_between(glm::dvec3(tangent), glm::dvec3(expected));
        if (!(off <= conforming_degrees)) ++judgment.too_far;
        if (static_cast<float>(off) > worst) {
            worst = static_cast<float>(off);
            judgment.worst_corner = corner;
        }
        degrees.push_back(static_cast<float>(off));
    }
    judgment.degrees = error_stats(std::move(degrees));
    return judgment;
}

// The command.

namespace {

struct ConformanceOptions {
    std::filesystem::path results;
    std::filesystem::path kit = "conformance/kit";
    bool json = false;
    bool strict = false;
    bool quiet = false;
};

/// The result for a mesh of the kit.
struct Result {
    std::string name;
    KitGroup group = KitGroup::conformance;
    std::string error;  ///< The reason why there is no judgment, or empty.
    Judgment judgment;

    [[nodiscard]] bool passed() const { return error.empty() && judgment.passes(group); }
};

Result result_of(const KitMesh& kit, const std::filesystem::path& folder) {
    Result result{kit.name, kit.group, "", {}};
    std::filesystem::path file = folder / (kit.name + ".glb");
    if (!std::filesystem::exists(file)) file.replace_extension(".gltf");
    if (!std::filesystem::exists(file)) {
        result.error = fmt::format("there is no {0}.glb or {0}.gltf", kit.name);
        return result;
    }
    try {
        const Mesh mesh = read_triangles(file);
        const bool has_none = std::all_of(mesh.tangents.begin(), mesh.tangents.end(),
                                          [](const glm::vec4& t) { return t == glm::vec4(0.0F); });
        if (has_none)
            result.error = "has no tangents";
        else
            result.judgment = judge(kit, mesh);
    } catch (const FileError& error) {
        result.error = error.what();
    }
    return result;
}

/// "3 corners of other sign, 5 off by more than 0.01 degrees"
std::string faults(const Judgment& judgment) {
    std::vector<std::string> list;
    const auto add = [&](std::size_t count, const std::string& what) {
        if (count != 0) list.push_back(fmt::format("{} {}", count, what));
    };
    add(judgment.missing, "missing");
    add(judgment.extra, "not in this mesh");
    add(judgment.not_finite, "not finite");
    add(judgment.not_unit, "not unit");
    add(judgment.not_perpendicular, "not perpendicular");
    add(judgment.invalid_sign, "with w not 1 or -1");
    add(judgment.mixed_signs, "of triangles with both signs");
    if (judgment.other_sign == judgment.judged && judgment.judged != 0)
        list.emplace_back(
            "all with the opposite sign (is w computed for v upwards? In glTF, v points down)");
    else
        add(judgment.other_sign, "with the opposite sign");
    add(judgment.too_far, fmt::format("with an error above {} degrees", conforming_degrees));
    return list.empty() ? "" : fmt::format("; {}", fmt::join(list, ", "));
}

std::string verdict(const Result& result) {
    if (result.group == KitGroup::stability) return result.passed() ? "usable" : "UNUSABLE";
    if (result.group == KitGroup::defect)
        return result.passed() ? "defect corrected"
                               : "has the reference's defect, or a larger error";
    return result.passed() ? "conforms" : "DIFFERS";
}

std::string as_text(const Result& result) {
    if (!result.error.empty()) return "NOT COMPARED: " + result.error;
    const Judgment& j = result.judgment;
    std::string text = fmt::format("{}: {} of {} compared", verdict(result), j.judged,
                                   counted(j.corners, "corner"));
    if (result.group != KitGroup::stability && j.judged != 0) {
        text += fmt::format(", error in degrees: mean {:.2g}, 99 % within {:.2g}, maximum {:.2g}",
                            j.degrees.mean, j.degrees.p99, j.degrees.max);
    }
    return text + faults(j);
}

/// The number of meshes of a group, and of those that passed.
struct Score {
    std::size_t passed = 0;
    std::size_t meshes = 0;
};

Score score_of(const std::vector<Result>& results, KitGroup group) {
    Score score;
    for (const Result& result : results) {
        if (result.group != group) continue;
        ++score.meshes;
        score.passed += result.passed() ? 1U : 0U;
    }
    return score;
}

/// The scores of the two groups that decide the verdict.
struct Scores {
    Score conforming;
    Score usable;

    explicit Scores(const std::vector<Result>& results)
        : conforming(score_of(results, KitGroup::conformance)),
          usable(score_of(results, KitGroup::stability)) {}

    [[nodiscard]] bool conforms() const { return conforming.passed == conforming.meshes; }
    [[nodiscard]] bool is_stable() const { return usable.passed == usable.meshes; }
};

Json result_json(const Result& result) {
    Json json = {
        {"name", result.name}, {"group", enum_name(result.group)}, {"passed", result.passed()}};
    if (!result.error.empty()) {
        json["error"] = result.error;
        return json;
    }
    const Judgment& j = result.judgment;
    json.update({{"corners", j.corners},
                 {"judged", j.judged},
                 {"missing", j.missing},
                 {"left_out", j.omitted},
                 {"extra", j.extra},
                 {"not_finite", j.not_finite},
                 {"not_unit", j.not_unit},
                 {"not_perpendicular", j.not_perpendicular},
                 {"unhanded", j.invalid_sign},
                 {"mixed_handedness", j.mixed_signs}});
    if (result.group == KitGroup::stability) return json;
    json.update(
        {{"other_sign", j.other_sign},
         {"too_far", j.too_far},
         {"degrees", {{"mean", j.degrees.mean}, {"p99", j.degrees.p99}, {"max", j.degrees.max}}},
         {"worst_corner", j.worst_corner}});
    return json;
}

Summary summary_of(const std::vector<Result>& results, const Scores& scores) {
    std::size_t longest = 0;
    for (const Result& result : results)
        longest = std::max(longest, result.name.size());
    Summary::Lines lines;
    for (const Result& result : results)
        lines.push_back(fmt::format("{:<{}}  {}", result.name, longest, as_text(result)));
    const Score& conforming = scores.conforming;
    Summary summary;
    summary.add_tool("relief-mesh conformance");
    summary.add("meshes", lines, {{"meshes", json_list(results, result_json)}});
    summary.add(
        "verdict",
        fmt::format("{} on {} of {} meshes; usable tangents on {} of {} hard ones",
                    scores.conforms() ? "conforms" : "DIFFERS",
                    scores.conforms() ? conforming.passed : conforming.meshes - conforming.passed,
                    conforming.meshes, scores.usable.passed, scores.usable.meshes),
        {{"conforms", scores.conforms()}, {"stable", scores.is_stable()}});
    return summary;
}

ExitCode run(const CLI::App& app, const ConformanceOptions& options) {
    if (options.json && options.quiet) throw UsageError("--json and --quiet contradict each other");
    const std::vector<KitMesh> kit = read_kit(options.kit);
    if (!std::filesystem::is_directory(options.results)) {
        throw failure(
            options.results, "no such folder",
            "it must contain the program's output for each mesh of the kit, with the same names");
    }
    Stages stages(options.quiet);
    std::vector<Result> results;
    for (const KitMesh& mesh : kit) {
        results.push_back(stages.run("judge", "judge " + mesh.name,
                                     [&] { return result_of(mesh, options.results); }));
    }
    const Scores scores(results);
    const Summary summary = summary_of(results, scores);
    if (options.json)
        print_json(summary.json());
    else if (!options.quiet)
        summary.print();
    if (!scores.conforms()) return ExitCode::failed;
    if (!options.strict || scores.is_stable()) return ExitCode::done;
    warn(app, fmt::format("{} with unusable tangents (exit code 3, because of --strict)",
                          counted(scores.usable.meshes - scores.usable.passed, "mesh", "meshes")));
    return ExitCode::fell_back;
}

}  // namespace

Command add_conformance_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "conformance",
        "Compares any program's tangents for the conformance kit with those of MikkTSpace.");
    const auto options = std::make_shared<ConformanceOptions>();
    add_file(app, "OUTPUT_DIR", options->results,
             "Folder with the program's output for conformance/kit: NAME.glb or NAME.gltf with "
             "TANGENT for each NAME.glb of the kit");
    add_value(app, "--kit", "FOLDER",
              "Folder of the kit. Default: conformance/kit in the sources of relief.",
              [options](const std::string&, const std::string& text) { options->kit = text; });
    add_switch(app, "--json", options->json,
               "Print one JSON object: tool, version, conforms, stable, meshes [name, group, "
               "passed, error or: corners, judged, missing, left_out, extra, not_finite, not_unit, "
               "not_perpendicular, unhanded, mixed_handedness and, against the reference, "
               "other_sign, too_far, degrees {mean, p99, max}, worst_corner].");
    add_switch(app, "--strict", options->strict,
               "Exit with 3 if the tangents conform, but are unusable on the hard meshes of the "
               "stability group.");
    add_switch(app, "--quiet", options->quiet, "Print only errors; the exit code is the result.");
    set_examples(app,
                 {"relief-mesh process conformance/kit/*.glb -o out/kit/ --tangents mikktspace",
                  "relief-mesh conformance out/kit",
                  "relief-mesh conformance out/kit --kit conformance/kit --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
