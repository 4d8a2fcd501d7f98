// SPDX-License-Identifier: Apache-2.0
// `relief-mesh decimate IN OUT` and `relief-mesh subdivide IN OUT` give a model other triangles.
// Tests: tests/tools/reshaping_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model.h"
#include "relief/mesh/topology.h"
#include "reshape.h"

namespace relief::tools {
namespace {

/// Adds the distances of a mesh to those of other meshes. Means and rms stay sums over area.
void add_distances(DistanceStats& all, const DistanceStats& one) {
    all.area += one.area;
    all.mean += one.mean * one.area;
    all.rms += one.rms * one.rms * one.area;
    all.mean_degrees += one.mean_degrees * one.area;
    all.max = std::max(all.max, one.max);
    all.max_degrees = std::max(all.max_degrees, one.max_degrees);
    all.omitted += one.omitted;
}

/// Returns the number of samples on all meshes that those of the meshes are at least, each for its
/// part of the area.
std::size_t joined_samples(const std::vector<SurfaceDistance>& distances,
                           DistanceStats SurfaceDistance::*side) {
    double area = 0.0;
    for (const SurfaceDistance& one : distances)
        area += (one.*side).area;
    double samples = std::numeric_limits<double>::infinity();
    for (const SurfaceDistance& one : distances) {
        const DistanceStats& stats = one.*side;
        if (stats.area > 0.0)
            samples = std::min(samples, static_cast<double>(stats.samples) * area / stats.area);
    }
    // Numbers that were rounded up for areas must not be below the whole number again.
    constexpr double rounding = 1e-9;
    return std::isfinite(samples) ? static_cast<std::size_t>(samples * (1.0 + rounding)) : 0;
}

/// Converts distances of a mesh to those in the scene.
SurfaceDistance scaled(SurfaceDistance distance, double scale) {
    for (DistanceStats* stats : {&distance.from_a, &distance.from_b}) {
        for (double* length : {&stats->mean, &stats->rms, &stats->max})
            *length *= scale;
        stats->area *= scale * scale;
    }
    return distance;
}

}  // namespace

Mesh without_attributes(const Mesh& mesh) {
    Mesh surface;
    surface.positions = mesh.positions;
    surface.triangles = mesh.triangles;
    return surface;
}

SurfaceDistance joined_distance(const std::vector<SurfaceDistance>& distances) {
    if (distances.size() == 1) return distances.front();  // Without the rounding of a mean.
    SurfaceDistance all;
    for (const SurfaceDistance& one : distances) {
        add_distances(all.from_a, one.from_a);
        add_distances(all.from_b, one.from_b);
    }
    all.from_a.samples = joined_samples(distances, &SurfaceDistance::from_a);
    all.from_b.samples = joined_samples(distances, &SurfaceDistance::from_b);
    for (DistanceStats* stats : {&all.from_a, &all.from_b}) {
        if (!(stats->area > 0.0)) continue;
        stats->mean /= stats->area;
        stats->rms = std::sqrt(stats->rms / stats->area);
        stats->mean_degrees /= stats->area;
    }
    return all;
}

Json distance_json(const DistanceStats& stats) {
    return {{"mean", stats.mean},
            {"rms", stats.rms},
            {"max", stats.max},
            {"mean_degrees", stats.mean_degrees},
            {"max_degrees", stats.max_degrees},
            {"samples", stats.samples},
            {"omitted", stats.omitted}};
}

namespace {

/// The numbers of a condition in all meshes, before and after.
using ConditionCounts = std::map<MeshCondition, std::pair<std::size_t, std::size_t>>;

void add_conditions(const Mesh& mesh, std::size_t std::pair<std::size_t, std::size_t>::*side,
                    ConditionCounts& counts) {
    DiagnoseOptions options;
    options.texture_overlap = false;
    options.listed = 0;
    for (const MeshConditionCount& found : diagnose(without_attributes(mesh), options).conditions)
        counts[found.condition].*side += found.count;
}

struct Reshaped {
    ChangedModel changed;
    Measuring measuring = Measuring::none;
    std::optional<SurfaceDistance> distance;
    /// The error that --max-normal-error limits, in degrees; absent if all vertices are new.
    std::optional<double> corner_angle;
    bool with_conditions = false;
    ConditionCounts conditions;
    Summary results;                   ///< Of the change.
    std::vector<std::string> omitted;  ///< Content that the output format cannot store.
    Findings findings;
    /// The input has at most as many triangles as --triangles, so that nothing was removed.
    bool is_small = false;
};

/// Returns the area of the triangles with finite corners.
double area_of(const Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const double twice = glm::length(
            glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
        if (std::isfinite(twice)) area += twice / 2.0;
    }
    return area;
}

/// A mesh without attributes, before and after a change.
struct SurfacePair {
    Mesh before;
    FramedMesh after;
    double scale = 1.0;  ///< The length of its unit in the scene.
};

/// The confidence that is stated for random samples.
constexpr double confidence = 0.95;

/// Measures the distances at random samples. Their number depends on the number of triangles of
/// the input alone, so that measuring takes less time than the decimation.
std::vector<SurfaceDistance> quick_distances(std::span<const SurfacePair> pairs) {
    std::size_t triangles = 0;
    double area_before = 0.0;
    double area_after = 0.0;
    for (const SurfacePair& pair : pairs) {
        triangles += pair.before.triangles.size();
        area_before += pair.scale * pair.scale * area_of(pair.before);
        area_after += pair.scale * pair.scale * area_of(pair.after.mesh);
    }
    const std::size_t samples = std::clamp<std::size_t>(triangles / 16, 1'000, 20'000);
    std::vector<SurfaceDistance> distances;
    for (const SurfacePair& pair : pairs) {
        const auto share = [&](const Mesh& mesh, double area_of_all) {
            const double area = pair.scale * pair.scale * area_of(mesh);
            return area > 0.0 ? static_cast<std::size_t>(
                                    std::ceil(static_cast<double>(samples) * area / area_of_all))
                              : std::size_t{0};
        };
        distances.push_back(
            scaled(sampled_distance(pair.before, pair.after.mesh, share(pair.before, area_before),
                                    share(pair.after.mesh, area_after),
                                    static_cast<std::uint32_t>(distances.size())),
                   pair.scale));
    }
    return distances;
}

std::vector<SurfaceDistance> full_distances(std::span<const SurfacePair> pairs) {
    std::vector<SurfaceDistance> distances;
    for (const SurfacePair& pair : pairs)
        distances.push_back(scaled(surface_distance(pair.before, pair.after.mesh), pair.scale));
    return distances;
}

/// The operation of a command on each model.
struct Reshaping {
    std::string verb;  ///< "decimate", the name of the stage.
    NormalMode normals = NormalMode::keep;
    SummarizedChange change;
    Measuring measuring = Measuring::none;
    std::optional<std::size_t> max_triangles{};  ///< --triangles
    bool with_conditions = false;                ///< Counts them before and after.
};

/// Reads, changes and writes a model.
Reshaped run(const Job& job, const Reshaping& reshaping, Stages& stages) {
    Reshaped done;
    Report read_report;
    Model model = stages.run("read", [&] { return read_model(job.input, read_report); });
    done.findings.add("", read_report);
    done.measuring = reshaping.measuring;
    done.with_conditions = reshaping.with_conditions;
    std::vector<SurfacePair> pairs;
    const ModelChange kept_change = [&](std::span<const TriangleInput> meshes,
                                        std::span<Report> reports, Report& whole) {
        std::vector<FramedMesh> changed = reshaping.change(meshes, reports, whole, done.results);
        for (std::size_t i = 0; i < meshes.size() && reshaping.with_conditions; ++i) {
            using Counts = std::pair<std::size_t, std::size_t>;
            add_conditions(meshes[i].mesh, &Counts::first, done.conditions);
            add_conditions(changed[i].mesh, &Counts::second, done.conditions);
        }
        for (std::size_t i = 0; i < meshes.size() && reshaping.measuring != Measuring::none; ++i)
            pairs.push_back({without_attributes(meshes[i].mesh),
                             {without_attributes(changed[i].mesh), changed[i].source_vertex},
                             meshes[i].scale});
        return changed;
    };
    done.changed = stages.run(reshaping.verb, [&] {
        return about(job.input,
                     [&] { return change_triangles(model, reshaping.normals, kept_change); });
    });
    for (const PartReport& part : done.changed.reports)
        done.findings.add(part.part, part.report);
    done.is_small =
        reshaping.max_triangles && done.changed.triangles_read <= *reshaping.max_triangles;
    if (reshaping.measuring != Measuring::none)
        done.distance = stages.run("measure", [&] {
            for (const SurfacePair& pair : pairs) {
                if (pair.after.source_vertex.empty()) continue;
                const double angle = max_corner_angle(pair.before, pair.after);
                done.corner_angle =
                    std::max(done.corner_angle.value_or(0.0), angle * 180.0 / std::numbers::pi);
            }
            return joined_distance(reshaping.measuring == Measuring::quick ? quick_distances(pairs)
                                                                           : full_distances(pairs));
        });
    Report write_report;
    stages.run("write", [&] {
        done.omitted =
            write_model(job.output, model, job.input, done.changed.has_tangents, write_report);
    });
    done.findings.add("", write_report);
    return done;
}

/// Returns a percentage with two digits, rounded up: "0.051 %".
std::string percent_text(double part) {
    const double percent = 100.0 * part;
    double unit = 10.0;
    while (10.0 * unit > percent)
        unit /= 10.0;
    return fmt::format("{:.3g} %", unit * std::ceil(percent / unit));
}

/// States how much of the area may be farther than the maximum of random samples.
std::string confidence_text(const SurfaceDistance& distance) {
    const std::size_t samples = std::min(distance.from_a.samples, distance.from_b.samples);
    return fmt::format(
        "max is that of {} random samples on each: with {:.0f} % confidence, at most {} of its "
        "area is farther",
        samples, 100.0 * confidence, percent_text(max_farther_part(samples, confidence)));
}

void add_distance(Summary& summary, const Reshaped& done) {
    const SurfaceDistance& distance = *done.distance;
    const auto length = [](const DistanceStats& stats) {
        const std::string omitted =
            stats.omitted == 0 ? ""
                               : fmt::format(" without {} vertices and triangles", stats.omitted);
        return fmt::format("mean {:.3g}, max {:.3g}{}", stats.mean, stats.max, omitted);
    };
    const auto angle = [](const DistanceStats& stats) {
        return fmt::format("mean {:.3g}, max {:.3g}", stats.mean_degrees, stats.max_degrees);
    };
    std::vector<std::string> lines = {
        fmt::format("of IN from OUT: {}", length(distance.from_a)),
        fmt::format("of OUT from IN: {} (unit of the scene)", length(distance.from_b))};
    Json json = {{"of_input", distance_json(distance.from_a)},
                 {"of_output", distance_json(distance.from_b)}};
    if (done.measuring == Measuring::quick) {
        lines.push_back(confidence_text(distance));
        json["confidence"] = confidence;
        json["of_input"]["max_farther_part"] =
            max_farther_part(distance.from_a.samples, confidence);
        json["of_output"]["max_farther_part"] =
            max_farther_part(distance.from_b.samples, confidence);
    }
    summary.add("distance", lines, {{"distance", std::move(json)}});
    std::vector<std::string> angles = {
        fmt::format("between normals of IN and OUT: {}; of OUT and IN: {} degrees",
                    angle(distance.from_a), angle(distance.from_b))};
    Json angles_json = Json::object();
    if (done.corner_angle) {
        angles.push_back(
            fmt::format("at corners of OUT, as --max-normal-error limits it: max {:.3g} degrees",
                        *done.corner_angle));
        angles_json["max_corner_degrees"] = *done.corner_angle;
    }
    summary.add("angle", angles, std::move(angles_json));
}

/// Adds the conditions that `relief-mesh check` counts, before and after.
void add_conditions(Summary& summary, const ConditionCounts& counts) {
    std::vector<std::string> lines;
    Json json = Json::array();
    for (const auto& [condition, count] : counts) {
        const MeshConditionInfo& info = condition_info(condition);
        lines.push_back(fmt::format("{}: {} -> {}", info.word, count.first, count.second));
        json.push_back({{"kind", info.word}, {"before", count.first}, {"after", count.second}});
    }
    if (lines.empty()) lines.emplace_back("none");
    summary.add("checked", lines, {{"conditions", std::move(json)}});
}

Summary summary_of(const Job& job, const Reshaped& done, const Stages& stages) {
    const auto& changed = done.changed;
    Summary summary;
    summary.add(
        "read",
        fmt::format("{}: {}, {}, {}", job.input.string(), format_name(readable_format(job.input)),
                    counted(changed.triangles_read, "triangle"),
                    counted(changed.vertices_read, "vertex", "vertices")),
        {{"triangles_read", changed.triangles_read}, {"vertices_read", changed.vertices_read}});
    summary.add("result",
                fmt::format("{}, {}{}", counted(changed.triangles_written, "triangle"),
                            counted(changed.vertices_written, "vertex", "vertices"),
                            done.is_small ? " (the input is within --triangles)" : ""),
                {{"triangles_written", changed.triangles_written},
                 {"vertices_written", changed.vertices_written}});
    summary.add_part("", done.results);
    if (done.distance) add_distance(summary, done);
    if (done.with_conditions) add_conditions(summary, done.conditions);
    summary.add_findings(done.findings);
    add_omitted(summary, done.omitted, job.output);
    summary.add_times(stages);
    summary.add("wrote", file_and_size(job.output));
    return summary;
}

std::string line_of(const Job& job, const Reshaped& done, const Stages& stages) {
    return fmt::format(
        "{}: {} -> {}{}, {}, {}{}, {}", job.output.string(), done.changed.triangles_read,
        counted(done.changed.triangles_written, "triangle"),
        done.is_small ? " (within --triangles)" : "",
        counted(done.changed.vertices_written, "vertex", "vertices"), done.findings.count_text(),
        done.omitted.empty() ? "" : fmt::format(", left out: {}", fmt::join(done.omitted, ", ")),
        duration(stages.milliseconds()));
}

/// Checks the files before the first is read. \throws UsageError, FileError
void check_files(const ReshapeRequest& request, const JobList& list) {
    std::vector<std::filesystem::path> files;
    for (const Job& job : list.jobs) {
        readable_format(job.input);
        writable_format(job.output);
        files.insert(files.end(), {job.input, job.output});
    }
    if (list.folder) make_folder(*list.folder);
    check(request.report, files);
    require_folder_of(list.jobs.front().output);
}

/// Changes one model, and prints its summary.
ExitCode reshape_one(const CLI::App& app, const ReshapeRequest& request, const Job& job,
                     const Reshaping& reshaping, Json head) {
    Stages stages(request.general.quiet);
    const Reshaped done = run(job, reshaping, stages);
    const Summary summary = summary_of(job, done, stages);
    if (!request.general.quiet) summary.print();
    head["input"] = job.input.string();
    head["output"] = job.output.string();
    head.update(summary.json());
    return finish(app, request.report, job.input, done.findings, head);
}

/// Changes several models, and prints a line for each. Distances are measured for the report only.
ExitCode reshape_all(const CLI::App& app, const ReshapeRequest& request, const JobList& list,
                     Reshaping reshaping, Json head) {
    if (!request.report.file) reshaping.measuring = Measuring::none;
    Batch batch;
    batch.jobs = list.jobs;
    batch.one_by_one = may_share_companions(list.jobs);
    batch.head = std::move(head);
    batch.work = [&](std::size_t index) -> FileOutcome {
        const Job& job = list.jobs[index];
        Stages stages(true);
        const Reshaped done = run(job, reshaping, stages);
        return {line_of(job, done, stages), done.findings, summary_of(job, done, stages)};
    };
    return run_batch(app, batch, request.report, request.general);
}

/// \throws UsageError if --measure is given, but nothing that is measured would be reported
void check_measuring(const ReshapeRequest& request, bool is_single) {
    const bool is_reported = request.report.file || (is_single && !request.general.quiet);
    if (is_reported || request.measuring.value_or(Measuring::none) == Measuring::none) return;
    throw UsageError(fmt::format("--measure {}: has no effect {} without --report",
                                 name_of(*request.measuring, measuring_words),
                                 is_single ? "with --quiet" : "on several models"),
                     "leave it out, or add --report");
}

}  // namespace

void add_reshape_options(CLI::App& app, ReshapeRequest& request, const std::string& about_normals) {
    add_model_files(app, request.words, request.format);
    if (!about_normals.empty())
        add_choice(app, "--normals", request.normals, enum_choices<NormalMode>(), about_normals)
            .group("Frames");
    add_report_options(app, request.report);
    add_general_options(app, request.general);
}

Measuring measuring_of(const ReshapeRequest& request) {
    if (request.general.quiet && !request.report.file) return Measuring::none;
    return request.measuring.value_or(Measuring::quick);
}

ExitCode reshape(const CLI::App& app, const ReshapeRequest& request, const ModelChange& change,
                 Measuring measuring, const Json& options, std::optional<std::size_t> max_triangles,
                 bool with_conditions) {
    const SummarizedChange without_lines =
        [&change](std::span<const TriangleInput> meshes, std::span<Report> reports, Report& whole,
                  Summary&) { return change(meshes, reports, whole); };
    return reshape(app, request, without_lines, measuring, options, max_triangles, with_conditions);
}

ExitCode reshape(const CLI::App& app, const ReshapeRequest& request, const SummarizedChange& change,
                 Measuring measuring, const Json& options, std::optional<std::size_t> max_triangles,
                 bool with_conditions) {
    const JobList list = model_jobs_of(request.words, request.format);
    check_measuring(request, list.is_single());
    check_files(request, list);
    set_thread_limit(request.general.threads);
    const Reshaping reshaping{command_name(app), request.normals, change,
                              measuring,         max_triangles,   with_conditions};
    const Json head = {
        {"tool", "relief-mesh " + command_name(app)}, {"version", version()}, {"options", options}};
    return list.is_single() ? reshape_one(app, request, list.jobs.front(), reshaping, head)
                            : reshape_all(app, request, list, reshaping, head);
}

namespace {

struct DecimateCommand {
    ReshapeRequest request;
    DecimateOptions options = default_options();  ///< `triangles` is that of all meshes.
    std::optional<double> ratio;
    std::optional<double> max_normal_degrees;  ///< --max-normal-error
    std::optional<DecimateGoal> goal;          ///< --for
    bool has_normal_weight = false;            ///< --weights names normals.

    static DecimateOptions default_options() {
        DecimateOptions options;
        options.fit_positions = true;
        return options;
    }
};

/// The attributes of --weights.
struct WeightWord {
    std::string_view word;
    double AttributeWeights::*weight;
};

constexpr std::array weight_words = {WeightWord{"texcoords", &AttributeWeights::texcoord},
                                     WeightWord{"normals", &AttributeWeights::normal},
                                     WeightWord{"colors", &AttributeWeights::color},
                                     WeightWord{"joints", &AttributeWeights::joint},
                                     WeightWord{"targets", &AttributeWeights::target}};

/// Parses "normals=0.1,colors=0.01". Attributes that are not named keep their weight.
void parse_weights(const std::string& subject, const std::string& text, DecimateCommand& command) {
    AttributeWeights& weights = command.options.weights;
    weights = {};
    std::vector<std::string_view> given;
    for (const std::string& part : split(text, ',')) {
        const std::string here = fmt::format("{}: '{}'", subject, part);
        const std::size_t equals = part.find('=');
        if (equals == std::string::npos)
            throw UsageError(here + ": not NAME=WEIGHT", "for example normals=0.1,colors=0.01");
        const std::string name = part.substr(0, equals);
        const auto known =
            std::find_if(weight_words.begin(), weight_words.end(),
                         [&](const WeightWord& candidate) { return candidate.word == name; });
        if (known == weight_words.end())
            throw UsageError(here + ": not one of texcoords, normals, colors, joints, targets");
        if (std::find(given.begin(), given.end(), known->word) != given.end())
            throw UsageError(fmt::format("{}: {} is given twice", subject, name));
        given.push_back(known->word);
        weights.*(known->weight) =
            parse_number(here, part.substr(equals + 1), {0.0, Range().max, ""});
    }
    command.has_normal_weight = std::find(given.begin(), given.end(), "normals") != given.end();
}

/// Parses "0.5" or "50%".
double parse_ratio(const std::string& subject, const std::string& text) {
    if (!text.ends_with('%')) return parse_number(subject, text, {0.0, 1.0, ""});
    const std::string_view percent = std::string_view(text).substr(0, text.size() - 1);
    return parse_number(subject, percent, {0.0, 100.0, "%"}) / 100.0;
}

void check_limits(const DecimateCommand& command) {
    if (command.options.triangles && command.ratio)
        throw UsageError("--triangles and --ratio contradict each other", "give one of them");
    if (!command.options.triangles && !command.ratio && !command.options.max_error)
        throw UsageError("no limit is given", "give --triangles N, --ratio R or --max-error E");
    if (command.has_normal_weight && command.options.weights.normal > 0.0 &&
        command.request.normals != NormalMode::keep) {
        throw UsageError(
            fmt::format("--weights normals: has no effect with --normals {}, which replaces them",
                        enum_name(command.request.normals)),
            "leave one of them out");
    }
}

Json options_json(const DecimateCommand& command) {
    const DecimateOptions& options = command.options;
    Json json = Json::object();
    if (options.triangles) json["triangles"] = *options.triangles;
    if (command.ratio) json["ratio"] = *command.ratio;
    if (options.max_error) json["max_error"] = *options.max_error;
    if (command.max_normal_degrees) json["max_normal_error"] = *command.max_normal_degrees;
    if (options.drop_parts > 0.0) json["drop_parts"] = options.drop_parts;
    json["for"] = enum_name(options.goal);
    json["keep_borders"] = options.keep_borders;
    json["keep_seams"] = options.keep_seams;
    json["keep_positions"] = !options.fit_positions;
    Json weights = Json::object();
    for (const WeightWord& entry : weight_words)
        weights[std::string(entry.word)] = options.weights.*(entry.weight);
    json["weights"] = std::move(weights);
    json["normals"] = enum_name(command.request.normals);
    json["measure"] = name_of(measuring_of(command.request), measuring_words);
    return json;
}

/// Sets the goal: distances if they are limited and nothing else is requested.
DecimateCommand with_goal(DecimateCommand command) {
    command.options.goal = command.goal.value_or(command.options.max_error ? DecimateGoal::distance
                                                                           : DecimateGoal::picture);
    if (command.options.goal != DecimateGoal::picture && !command.has_normal_weight)
        command.options.weights.normal = 0.0;
    return command;
}

ExitCode decimate(const CLI::App& app, const DecimateCommand& given) {
    check_limits(given);
    const DecimateCommand command = with_goal(given);
    const ModelChange change = [&](std::span<const TriangleInput> meshes, std::span<Report> reports,
                                   Report& whole) {
        std::vector<SceneMesh> scene;
        std::size_t triangles = 0;
        for (const TriangleInput& input : meshes) {
            scene.push_back({input.mesh, input.deformation, input.scale});
            triangles += input.mesh.triangles.size();
        }
        DecimateOptions options = command.options;
        if (command.ratio)
            options.triangles = static_cast<std::size_t>(
                std::max(std::round(*command.ratio * static_cast<double>(triangles)), 1.0));
        options.frames.normals = command.request.normals;
        if (command.max_normal_degrees)
            options.max_normal_error = *command.max_normal_degrees * std::numbers::pi / 180.0;
        return decimated(scene, options, reports, whole);
    };
    return reshape(app, command.request, change, measuring_of(command.request),
                   options_json(command), command.options.triangles);
}

void add_decimate_options(CLI::App& app, DecimateCommand& command) {
    add_reshape_options(
        app, command.request,
        "Normals: those of the file at the remaining vertices (keep), with hard edges preserved "
        "like seams, or recomputed, with hard edges ignored. Default: keep.");
    const std::string limits = "Limits; the first one reached ends the decimation";
    add_value(app, "--triangles", "N",
              "Stop at N triangles in the file. They are left where they are needed most, in "
              "the scale of the scene.",
              [&command](const std::string& subject, const std::string& text) {
                  command.options.triangles = static_cast<std::size_t>(
                      parse_integer(subject, text, 1, std::numeric_limits<int>::max()));
              })
        .group(limits);
    add_value(app, "--ratio", "R",
              "Stop at this fraction of the triangles of the file: 0 to 1, or 0% to 100%.",
              [&command](const std::string& subject, const std::string& text) {
                  command.ratio = parse_ratio(subject, text);
              })
        .group(limits);
    add_number(
        app, "--max-error", "E", command.options.max_error, {0.0, Range().max, ""},
        "Maximum distance: stop while no point of IN is farther than E from OUT, and no point "
        "of OUT farther than E from IN, in the unit of the scene (relief-mesh info prints "
        "its size). The distance is measured several times, so this takes longer.")
        .group(limits);
    add_choice(
        app, "--for", command.goal, enum_choices<DecimateGoal>(),
        "What OUT is to resemble IN in: in pictures of the scene, where normals count too, "
        "in distances, or in the largest distance, which takes longer. Default: distance with "
        "--max-error, otherwise picture.")
        .group("What is preserved");
    const std::string preserved = "What is preserved";
    add_number(app, "--drop-parts", "SIZE", command.options.drop_parts, {0.0, Range().max, ""},
               "Remove connected parts whose bounding box has a diagonal shorter than this, in the "
               "unit of the scene. Default: no part is removed.")
        .group(preserved);
    add_number(
        app, "--max-normal-error", "DEGREES", command.max_normal_degrees, {0.001, 180.0, "degrees"},
        "Omit collapses that would turn a triangle by more than this angle from the triangles "
        "of IN at one of its corners, 0.001 to 180.")
        .group(preserved);
    add_switch(app, "--keep-borders", command.options.keep_borders,
               "Keep all vertices of boundaries. Default: boundaries are simplified.")
        .group(preserved);
    add_switch(app, "--keep-seams", command.options.keep_seams,
               "Keep all vertices of texture seams, hard edges and borders between materials, "
               "colors, joints or morph targets. Default: they are simplified.")
        .group(preserved);
    add_switch(
        app, "--keep-positions",
        "Keep the positions of the vertices that remain. Default: they move to where OUT fits "
        "IN best, which about halves the distance on curved surfaces.",
        [&command] { command.options.fit_positions = false; })
        .group(preserved);
    add_value(
        app, "--weights", "NAME=W,...",
        "How much differences of attributes count, each at least 0: texcoords, in lengths on "
        "the surface (default: 1); normals, colors and joints (the weights of skins), as the "
        "fraction of the model's size that a difference of 1 counts (default: 0.02, or 0 with "
        "--for distance; 0.01 and 0.01); targets, displacements by morph targets, as lengths "
        "(default: 1).",
        [&command](const std::string& subject, const std::string& text) {
            parse_weights(subject, text, command);
        })
        .group(preserved);
    add_choice(
        app, "--measure", command.request.measuring, measuring_words,
        "The distances between IN and OUT: at random samples, with the part of the area that "
        "may be farther, in less time than the decimation (quick); also at all vertices and "
        "inside triangles, which takes several times as long (full); or none. Default: "
        "quick.")
        .group("Measuring");
    set_examples(
        app,
        {"relief-mesh decimate data/vase.obj out/vase-1000.glb --triangles 1000",
         "relief-mesh decimate data/vase.obj out/vase-tenth.obj --ratio 0.1 --normals angle",
         "relief-mesh decimate data/vase.obj out/vase-near.glb --max-error 0.01 --measure full",
         "relief-mesh decimate data/*.obj -o out/small/ --format glb --ratio 0.5",
         "relief-mesh decimate data/vase.obj out/vase-smooth.glb --ratio 0.2 "
         "--max-normal-error 30 --weights normals=0.1 --keep-seams"});
}

struct SubdivideCommand {
    ReshapeRequest request;
    int levels = 1;
};

ExitCode subdivide(const CLI::App& app, const SubdivideCommand& command) {
    const ModelChange change = [&](std::span<const TriangleInput> meshes, std::span<Report> reports,
                                   Report&) {
        std::vector<FramedMesh> results;
        for (std::size_t i = 0; i < meshes.size(); ++i)
            results.push_back({subdivided(meshes[i].mesh, command.levels,
                                          {.normals = command.request.normals}, reports[i]),
                               {}});
        return results;
    };
    return reshape(app, command.request, change, Measuring::none,
                   {{"levels", command.levels}, {"normals", enum_name(command.request.normals)}});
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
                       "relief-mesh subdivide data/*.obj -o out/fine/ --format glb",
                       "relief-mesh subdivide data/vase.obj out/vase-finer.ply --levels 2"});
}

}  // namespace

Command add_decimate_command(CLI::App& tool) {
    return add_command<DecimateCommand>(
        tool, "decimate",
        "Reduces the number of triangles; texture seams, materials and borders are kept.",
        add_decimate_options, decimate);
}

Command add_subdivide_command(CLI::App& tool) {
    return add_command<SubdivideCommand>(
        tool, "subdivide",
        "Refines and smooths a model by Loop subdivision; the texture mapping is kept.",
        add_subdivide_options, subdivide);
}

}  // namespace relief::tools
