// SPDX-License-Identifier: Apache-2.0
// `relief-mesh decimate IN OUT` and `relief-mesh subdivide IN OUT` give a model other triangles.
// The primitives of a glTF mesh are joined, with a material range each, so that no gap opens
// between materials; they are changed together and separated again.
// Tests: tests/tools/reshaping_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "common/choices.h"
#include "common/command.h"
#include "common/findings.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/text.h"
#include "relief/mesh/decimate.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "relief/mesh/split.h"
#include "relief/mesh/subdivide.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

/// Returns a mesh with other triangles. `source_vertex` of the result is empty if its vertices are
/// not copies of the given ones. `all_triangles` is the number of triangles of the whole model.
using MeshChange =
    std::function<FramedMesh(const Mesh& mesh, std::size_t all_triangles, Report& report)>;

struct ReshapeRequest {
    std::filesystem::path input;
    std::filesystem::path output;
    NormalMode normals = NormalMode::keep;
    ReportOptions report;
    GeneralOptions general;
};

struct Reshaped {
    std::size_t triangles_read = 0;
    std::size_t triangles_written = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;
    bool has_tangents = false;
    std::vector<std::string> omitted;  ///< Content that the output format cannot store.
    Findings findings;
};

/// The primitives of one glTF mesh as one mesh.
class JoinedPrimitives {
  public:
    JoinedPrimitives(const GltfDocument& document, std::vector<GltfPrimitiveId> ids);

    [[nodiscard]] const Mesh& mesh() const { return joined_; }
    [[nodiscard]] const std::vector<GltfPrimitiveId>& ids() const { return ids_; }

    /// Returns primitive `i` of the changed mesh, with indices into its own vertices.
    [[nodiscard]] FramedMesh part(const FramedMesh& changed, std::size_t i, NormalMode normals,
                                  Report& report) const;

  private:
    void add(Mesh primitive);
    FramedMesh with_new_tangents(FramedMesh part, const FramedMesh& changed, std::size_t i,
                                 Report& report) const;

    std::vector<GltfPrimitiveId> ids_;
    std::vector<Mesh> primitives_;
    /// By primitive: the texture coordinates of its tangents, or none.
    std::vector<std::vector<glm::vec2>> tangent_texcoords_;
    std::vector<std::uint32_t> first_vertex_;
    Mesh joined_;
};

/// Appends values. If only some primitives have values, `filler` completes the others.
template <typename T>
void append(std::vector<T>& values, const std::vector<T>& more, std::size_t before,
            std::size_t count, const T& filler) {
    if (values.empty() && more.empty()) return;
    values.resize(before, filler);
    values.insert(values.end(), more.begin(), more.end());
    values.resize(before + count, filler);
}

void JoinedPrimitives::add(Mesh primitive) {
    const std::size_t before = joined_.positions.size();
    const std::size_t count = primitive.positions.size();
    append(joined_.normals, primitive.normals, before, count, glm::vec3(0.0F));
    append(joined_.texcoords, primitive.texcoords, before, count, glm::vec2(0.0F));
    append(joined_.colors, primitive.colors, before, count, glm::vec4(1.0F));
    joined_.positions.insert(joined_.positions.end(), primitive.positions.begin(),
                             primitive.positions.end());
    const auto first = static_cast<std::uint32_t>(before);
    joined_.material_ranges.push_back({static_cast<std::uint32_t>(joined_.triangles.size()),
                                       static_cast<std::uint32_t>(primitive.triangles.size()),
                                       std::nullopt});
    for (const glm::uvec3& triangle : primitive.triangles)
        joined_.triangles.push_back(triangle + first);
    first_vertex_.push_back(first);
    primitives_.push_back(std::move(primitive));
}

JoinedPrimitives::JoinedPrimitives(const GltfDocument& document, std::vector<GltfPrimitiveId> ids)
    : ids_(std::move(ids)) {
    for (const GltfPrimitiveId id : ids_) {
        Mesh mesh = document.mesh(id);
        const int set = document.tangent_texcoords(id).set;
        const bool differs = !mesh.tangents.empty() && set != 0;
        tangent_texcoords_.push_back(differs ? document.mesh(id, set).texcoords : mesh.texcoords);
        add(std::move(mesh));
    }
    joined_.name = primitives_.front().name;
}

/// Returns the triangles of a range with the vertices that they use.
FramedMesh range_of(const Mesh& mesh, const MaterialRange& range) {
    VertexSplit used;
    const auto begin = mesh.triangles.begin() + range.first_triangle;
    used.triangles.assign(begin, begin + range.triangle_count);
    std::vector<bool> is_used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : used.triangles) {
        for (int k = 0; k < 3; ++k)
            is_used[triangle[k]] = true;
    }
    std::vector<std::uint32_t> place(mesh.positions.size(), 0);
    for (std::uint32_t v = 0; v < is_used.size(); ++v) {
        if (!is_used[v]) continue;
        place[v] = static_cast<std::uint32_t>(used.source_vertex.size());
        used.source_vertex.push_back(v);
    }
    for (glm::uvec3& triangle : used.triangles)
        triangle = {place[triangle.x], place[triangle.y], place[triangle.z]};
    FramedMesh part;
    part.mesh = carried(mesh, used);
    part.mesh.tangents.clear();  // They belong to the old triangles.
    part.mesh.material_ranges.clear();
    part.source_vertex = std::move(used.source_vertex);
    return part;
}

/// Computes new tangents from the texture coordinates of the old ones. Further texture coordinate
/// sets are kept for copied vertices; if there are new vertices, no primitive has further sets.
FramedMesh JoinedPrimitives::with_new_tangents(FramedMesh part, const FramedMesh& changed,
                                               std::size_t i, Report& report) const {
    if (!changed.source_vertex.empty()) {
        part.mesh.texcoords.clear();
        for (const std::uint32_t v : part.source_vertex) {
            part.mesh.texcoords.push_back(
                tangent_texcoords_[i][changed.source_vertex[v] - first_vertex_[i]]);
        }
    }
    FramedMesh framed =
        with_frames(std::move(part.mesh), {.tangents = TangentMode::mikktspace}, report);
    for (std::uint32_t& source : framed.source_vertex)
        source = part.source_vertex[source];
    return framed;
}

FramedMesh JoinedPrimitives::part(const FramedMesh& changed, std::size_t i, NormalMode normals,
                                  Report& report) const {
    const Mesh& before = primitives_[i];
    FramedMesh part = range_of(changed.mesh, changed.mesh.material_ranges[i]);
    if (before.normals.empty() && normals == NormalMode::keep) part.mesh.normals.clear();
    if (before.texcoords.empty()) part.mesh.texcoords.clear();
    if (before.colors.empty()) part.mesh.colors.clear();
    if (!before.tangents.empty()) {
        // glTF ignores tangents without normals.
        const bool possible = !tangent_texcoords_[i].empty() && !part.mesh.normals.empty();
        report.add("tangents of other triangles", "primitive", ids_[i].primitive,
                   possible ? "are recomputed" : "are removed");
        if (possible) part = with_new_tangents(std::move(part), changed, i, report);
    }
    for (std::uint32_t& source : part.source_vertex) {
        if (changed.source_vertex.empty()) break;
        source = changed.source_vertex[source] - first_vertex_[i];
        assert(source < before.positions.size());
    }
    return part;
}

/// Returns the primitives of a document by mesh.
std::vector<std::vector<GltfPrimitiveId>> primitives_by_mesh(const GltfDocument& document) {
    std::vector<std::vector<GltfPrimitiveId>> meshes;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        if (meshes.empty() || meshes.back().front().mesh != id.mesh) meshes.emplace_back();
        meshes.back().push_back(id);
    }
    return meshes;
}

void reshape_joined(GltfDocument& document, const JoinedPrimitives& joined,
                    const MeshChange& change, NormalMode normals, std::size_t all_triangles,
                    Reshaped& done) {
    Report report;
    const FramedMesh changed = change(joined.mesh(), all_triangles, report);
    for (std::size_t i = 0; i < joined.ids().size(); ++i) {
        const GltfPrimitiveId id = joined.ids()[i];
        if (changed.mesh.material_ranges[i].triangle_count == 0) {
            report.add("primitive without area", "primitive", id.primitive, "is unchanged");
            continue;
        }
        const FramedMesh part = joined.part(changed, i, normals, report);
        done.triangles_written += part.mesh.triangles.size();
        done.vertices_written += part.mesh.positions.size();
        done.has_tangents = done.has_tangents || !part.mesh.tangents.empty();
        if (changed.source_vertex.empty())
            document.set_geometry(id, part.mesh);
        else
            document.set_frames(id, part);
    }
    done.findings.add(document.describe(joined.ids().front()), report);
}

void reshape_document(const ReshapeRequest& request, GltfDocument& document,
                      const MeshChange& change, Reshaped& done) {
    std::vector<JoinedPrimitives> meshes;
    for (auto& ids : primitives_by_mesh(document))
        meshes.emplace_back(document, std::move(ids));
    if (meshes.empty()) throw FileError(request.input, "holds no triangles");
    for (const JoinedPrimitives& joined : meshes) {
        done.triangles_read += joined.mesh().triangles.size();
        done.vertices_read += joined.mesh().positions.size();
    }
    for (const JoinedPrimitives& joined : meshes)
        reshape_joined(document, joined, change, request.normals, done.triangles_read, done);
}

void reshape_mesh(const ReshapeRequest& request, Mesh& mesh, const MeshChange& change,
                  Reshaped& done) {
    Report report;
    done.triangles_read = mesh.triangles.size();
    done.vertices_read = mesh.positions.size();
    mesh = change(mesh, mesh.triangles.size(), report).mesh;
    if (mesh.triangles.empty()) throw FileError(request.input, "none of its triangles has an area");
    done.triangles_written = mesh.triangles.size();
    done.vertices_written = mesh.positions.size();
    done.has_tangents = !mesh.tangents.empty();
    done.findings.add("", report);
}

Reshaped run(const ReshapeRequest& request, const std::string& verb, const MeshChange& change,
             Stages& stages) {
    Reshaped done;
    Report read_report;
    Model model = stages.run("read", [&] { return read_model(request.input, read_report); });
    done.findings.add("", read_report);
    stages.run(verb, [&] {
        about(request.input, [&] {
            if (auto* document = std::get_if<GltfDocument>(&model))
                reshape_document(request, *document, change, done);
            else
                reshape_mesh(request, std::get<MeshFile>(model).mesh, change, done);
        });
    });
    Report write_report;
    stages.run("write", [&] {
        done.omitted =
            write_model(request.output, model, request.input, done.has_tangents, write_report);
    });
    done.findings.add("", write_report);
    return done;
}

void print_reshaped(const ReshapeRequest& request, const Reshaped& done, const Stages& stages) {
    print_entry("read", fmt::format("{}: {}, {}, {}", request.input.string(),
                                    format_name(readable_format(request.input)),
                                    counted(done.triangles_read, "triangle"),
                                    counted(done.vertices_read, "vertex", "vertices")));
    print_entry("result", fmt::format("{}, {}", counted(done.triangles_written, "triangle"),
                                      counted(done.vertices_written, "vertex", "vertices")));
    print_entry("findings",
                done.findings.empty() ? std::vector<std::string>{"none"} : done.findings.lines());
    if (!done.omitted.empty()) {
        print_entry("omitted",
                    fmt::format("{} (cannot be stored in {})", fmt::join(done.omitted, ", "),
                                extension_of(request.output)));
    }
    print_entry("time", durations(stages.finished()));
    print_entry("wrote", file_and_size(request.output));
}

nlohmann::ordered_json report_json(const std::string& command, const ReshapeRequest& request,
                                   const nlohmann::ordered_json& options, const Reshaped& done,
                                   const Stages& stages) {
    return {{"tool", "relief-mesh " + command},
            {"version", version()},
            {"input", request.input.string()},
            {"output", request.output.string()},
            {"options", options},
            {"triangles_read", done.triangles_read},
            {"triangles_written", done.triangles_written},
            {"vertices_read", done.vertices_read},
            {"vertices_written", done.vertices_written},
            {"findings", done.findings.json()},
            {"left_behind", done.omitted},
            {"milliseconds", durations_json(stages.finished())}};
}

/// Adds IN, OUT, --normals, --report, --strict, --threads and --quiet.
void add_reshape_options(CLI::App& app, ReshapeRequest& request, const std::string& about_normals) {
    add_file(app, "IN", request.input, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_file(app, "OUT", request.output, "Model to write: .glb .gltf .obj .ply. May be IN itself.");
    add_choice(app, "--normals", request.normals, normal_choices(), about_normals).group("Frames");
    add_report_options(app, request.report);
    add_general_options(app, request.general);
}

/// Runs a command: reads, changes and writes the model, and reports.
///
/// \param options  the command's options for the report
/// \throws UsageError, FileError; then no file is written
ExitCode reshape(const CLI::App& app, const ReshapeRequest& request, const MeshChange& change,
                 const nlohmann::ordered_json& options) {
    readable_format(request.input);
    writable_format(request.output);
    check(request.report, {request.input, request.output});
    require_folder_of(request.output);
    set_thread_limit(request.general.threads);
    Stages stages(request.general.quiet);
    const Reshaped done = run(request, command_name(app), change, stages);
    if (!request.general.quiet) print_reshaped(request, done, stages);
    return finish(app, request.report, request.input, done.findings,
                  report_json(command_name(app), request, options, done, stages));
}

struct DecimateCommand {
    ReshapeRequest request;
    std::optional<int> triangles;
    std::optional<double> ratio;
    std::optional<double> max_error;
};

void check_limits(const DecimateCommand& command) {
    if (command.triangles && command.ratio)
        throw UsageError("--triangles and --ratio contradict each other", "give one of them");
    if (!command.triangles && !command.ratio && !command.max_error)
        throw UsageError("no limit is given", "give --triangles N, --ratio R or --max-error E");
}

/// Returns the number of triangles for one of several meshes, in proportion to its size.
std::optional<std::size_t> wanted_triangles(const DecimateCommand& command, std::size_t count,
                                            std::size_t all) {
    if (!command.triangles && !command.ratio) return std::nullopt;
    const double ratio = command.ratio ? *command.ratio
                                       : static_cast<double>(*command.triangles) /
                                             static_cast<double>(std::max<std::size_t>(all, 1));
    const double wanted = std::round(ratio * static_cast<double>(count));
    return static_cast<std::size_t>(std::max(wanted, 1.0));
}

nlohmann::ordered_json options_json(const DecimateCommand& command) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    if (command.triangles) json["triangles"] = *command.triangles;
    if (command.ratio) json["ratio"] = *command.ratio;
    if (command.max_error) json["max_error"] = *command.max_error;
    json["normals"] = name_of(command.request.normals, normal_choices());
    return json;
}

ExitCode decimate(const CLI::App& app, const DecimateCommand& command) {
    check_limits(command);
    const auto change = [&](const Mesh& mesh, std::size_t all_triangles, Report& report) {
        DecimateOptions options;
        options.triangles = wanted_triangles(command, mesh.triangles.size(), all_triangles);
        options.max_error = command.max_error;
        options.frames.normals = command.request.normals;
        return decimated(mesh, options, report);
    };
    return reshape(app, command.request, change, options_json(command));
}

void add_decimate_options(CLI::App& app, DecimateCommand& command) {
    add_reshape_options(
        app, command.request,
        "Normals: those of the file at the remaining vertices (keep), with hard edges preserved "
        "like seams, or recomputed, with hard edges ignored. Default: keep.");
    const std::string limits = "Limits; the first one reached ends the decimation";
    add_value(app, "--triangles", "N",
              "Stop at N triangles in total. Several meshes are reduced by the same ratio.",
              [&command](const std::string& subject, const std::string& text) {
                  command.triangles =
                      parse_integer(subject, text, 1, std::numeric_limits<int>::max());
              })
        .group(limits);
    add_number(app, "--ratio", "R", command.ratio, {0.0, 1.0, ""},
               "Stop at this fraction of the triangles, 0 to 1.")
        .group(limits);
    add_number(app, "--max-error", "E", command.max_error, {0.0, Range().max, ""},
               "Stop before a vertex of IN would be farther than E from the result, in the unit of "
               "the model (relief-mesh info prints its size).")
        .group(limits);
    set_examples(
        app, {"relief-mesh decimate data/vase.obj out/vase-1000.glb --triangles 1000",
              "relief-mesh decimate data/vase.obj out/vase-tenth.obj --ratio 0.1 --normals angle",
              "relief-mesh decimate data/vase.obj out/vase-near.glb --max-error 0.01"});
}

struct SubdivideCommand {
    ReshapeRequest request;
    int levels = 1;
};

ExitCode subdivide(const CLI::App& app, const SubdivideCommand& command) {
    const auto change = [&](const Mesh& mesh, std::size_t, Report& report) {
        return FramedMesh{
            subdivided(mesh, command.levels, {.normals = command.request.normals}, report), {}};
    };
    return reshape(app, command.request, change,
                   {{"levels", command.levels},
                    {"normals", name_of(command.request.normals, normal_choices())}});
}

void add_subdivide_options(CLI::App& app, SubdivideCommand& command) {
    constexpr int max_levels = 12;
    add_reshape_options(
        app, command.request,
        "Normals of the result: one per triangle (flat), or averaged with the named weights. "
        "Default: keep, which recomputes them by angle if the file has normals.");
    add_value(app, "--levels", "N",
              "The number of steps, 1 to 12; each step makes four triangles of one. Default: 1.",
              [&command](const std::string& subject, const std::string& text) {
                  command.levels = parse_integer(subject, text, 1, max_levels);
              })
        .group("Shape");
    set_examples(app, {"relief-mesh subdivide data/vase.obj out/vase-fine.glb",
                       "relief-mesh subdivide data/vase.obj out/vase-finer.ply --levels 2"});
}

}  // namespace

Command add_decimate_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "decimate",
        "Reduces the number of triangles; texture seams, materials and borders are kept.");
    const auto command = std::make_shared<DecimateCommand>();
    add_decimate_options(app, *command);
    return {&app, [&app, command] { return decimate(app, *command); }};
}

Command add_subdivide_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "subdivide",
        "Refines and smooths a model by Loop subdivision; the texture mapping is kept.");
    const auto command = std::make_shared<SubdivideCommand>();
    add_subdivide_options(app, *command);
    return {&app, [&app, command] { return subdivide(app, *command); }};
}

}  // namespace relief::tools
