// SPDX-License-Identifier: Apache-2.0
// Measures normals, tangents and stored frames on a user's mesh. No formula of the surface is
// known: the ground truth is a fitted surface, the file's own normals, or the direction of the
// texture.
#include "asset_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <optional>
#include <span>

#include "experiment_parts.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/fitted_normals.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "storage_experiments.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;

namespace {

/// A smaller crease angle means that the mesh is stored as facets; it says nothing about its edges.
constexpr double min_degrees_of_normals = 15.0;

CreaseRule by_angle(double degrees, const std::string& why) {
    CreaseRule creases;
    creases.edges.crease_angle = glm::radians(degrees);
    creases.description = fmt::format("edges sharper than {:g} degrees are hard{}", degrees, why);
    creases.option = fmt::format(" --crease {:g}", degrees);
    return creases;
}

CreaseRule by_normals(const Mesh& mesh) {
    CreaseRule none;
    none.description = "no edge is hard";
    const InferredCreases stored = inferred_creases(mesh);
    if (stored.hard == 0) return none;
    const double degrees = std::round(glm::degrees(stored.crease_angle));
    if (degrees < min_degrees_of_normals) {
        none.description += " (the mesh has face normals, which do not show hard edges)";
        return none;
    }
    return by_angle(degrees,
                    fmt::format(", which agrees with the stored normals at {:.3g}% of the edges",
                                100.0 * (1.0 - static_cast<double>(stored.misclassified) /
                                                   static_cast<double>(stored.edges))));
}

}  // namespace

CreaseRule detail::crease_rule(const Mesh& mesh, const std::optional<double>& crease_angle) {
    CreaseRule none;
    none.description = "no edge is hard";
    if (crease_angle) {
        const bool has_any = *crease_angle < std::numbers::pi;
        // A given angle overrides the smoothing groups of the file.
        const std::string option =
            mesh.smoothing_groups.empty() ? "" : " --ignore-smoothing-groups";
        CreaseRule creases = has_any ? by_angle(glm::degrees(*crease_angle), "") : none;
        creases.option += option;
        return creases;
    }
    if (std::any_of(mesh.smoothing_groups.begin(), mesh.smoothing_groups.end(),
                    [](std::uint32_t group) { return group != 0; })) {
        CreaseRule groups;
        groups.edges.smoothing_groups = mesh.smoothing_groups;
        groups.description = "edges between the file's smoothing groups are hard";
        return groups;
    }
    return mesh.normals.empty() ? none : by_normals(mesh);
}

namespace {

/// Normals that the methods are compared with.
struct CornerGroundTruth {
    std::vector<std::uint32_t> corners;
    std::vector<glm::dvec3> normals;
    std::optional<double> expected_error{};  ///< Of the normals, in degrees, if they are estimates.
    std::string description;
    double unjudged = 0.0;  ///< Share of the examined corners without a known normal.
    bool is_enough = true;  ///< Whether there are enough normals for a recommendation.
};

CornerGroundTruth by_surface(const Mesh& mesh, const CreaseRule& creases) {
    FitOptions fit;
    fit.hard_edges = creases.edges;
    FittedNormals fitted = fitted_normals(mesh, fit);
    CornerGroundTruth ground_truth;
    ground_truth.description = fmt::format(
        "A smooth surface fitted through the vertices (degree 4, three rings of triangles; {}). It "
        "is known at {} of {} examined vertices; the others have too few neighbors or no smooth "
        "surface. Its expected error is {:.2g} degrees RMS. It assumes that the vertices lie on "
        "the surface, and is not valid for models whose vertices do not.",
        creases.description, fitted.corners.size(), fitted.examined_fans, fitted.reference_degrees);
    constexpr std::size_t fewest = 16;
    ground_truth.is_enough = fitted.corners.size() >= std::max(fewest, fitted.examined_fans / 10);
    ground_truth.expected_error = fitted.reference_degrees;
    if (fitted.examined_fans > 0) {
        ground_truth.unjudged = 1.0 - static_cast<double>(fitted.corners.size()) /
                                          static_cast<double>(fitted.examined_fans);
    }
    ground_truth.corners = std::move(fitted.corners);
    ground_truth.normals = std::move(fitted.normals);
    return ground_truth;
}

/// The file's normal of each vertex that a triangle uses, at its first corner.
CornerGroundTruth by_file(const Mesh& mesh, const CreaseRule& creases) {
    if (mesh.normals.empty()) throw InvalidInput("the mesh has no normals to compare with");
    CornerGroundTruth ground_truth;
    ground_truth.description = fmt::format(
        "The normals of the file ({}). They show which method is closest to the one that computed "
        "them, not which is closest to a surface.",
        creases.description);
    std::vector<unsigned char> is_seen(mesh.positions.size(), 0);
    for (std::uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner) {
        const std::uint32_t vertex = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (is_seen[vertex]++ > 0) continue;
        ground_truth.corners.push_back(corner);
        ground_truth.normals.emplace_back(mesh.normals[vertex]);
        is_seen[vertex] = 1;
    }
    return ground_truth;
}

/// \param normals  one per corner, or one per vertex
ErrorStats errors_of(const std::vector<glm::vec3>& normals, bool are_by_corner, const Mesh& mesh,
                     const CornerGroundTruth& ground_truth) {
    std::vector<float> degrees;
    for (std::size_t i = 0; i < ground_truth.corners.size(); ++i) {
        const std::uint32_t corner = ground_truth.corners[i];
        const glm::vec3& actual =
            are_by_corner ? normals[corner]
                          : normals[mesh.triangles[corner / 3][static_cast<int>(corner % 3)]];
        degrees.push_back(angle_of(glm::dvec3(actual), ground_truth.normals[i]));
    }
    return error_stats(std::move(degrees));
}

/// Returns one normal per position, or per corner if there are hard edges.
std::vector<glm::vec3> with_creases(const NormalWeighting& weighting, const Mesh& mesh,
                                    const CreaseRule& creases) {
    // Double, because relief-mesh has no option for another arithmetic.
    if (!creases.has_any()) return normals_by(weighting.value, Arithmetic::float64, mesh);
    Report report;
    NormalOptions how;
    how.arithmetic = Arithmetic::float64;
    return corner_normals(mesh.positions, mesh.triangles, weighting.value, how, creases.edges,
                          report)
        .normals;
}

std::vector<Method> methods_on(const Mesh& mesh, const CreaseRule& creases,
                               const CornerGroundTruth& ground_truth, const AssetOptions& options) {
    std::vector<Method> methods;
    for (const NormalWeighting& weighting : normal_weightings()) {
        const auto normals = [weighting, &mesh, &creases] {
            return with_creases(weighting, mesh, creases);
        };
        methods.push_back(
            {.name = weighting.name,
             .choices = {{"weighting", weighting.name}},
             .error =
                 [=, &mesh, &creases, &ground_truth] {
                     return errors_of(normals(), creases.has_any(), mesh, ground_truth);
                 },
             .work = [normals] { normals(); },
             .command = fmt::format("relief-mesh process {} -o OUT.glb --normals {}{}",
                                    options.arguments, weighting.name, creases.option)});
    }
    return methods;
}

/// Names the methods that the reference cannot distinguish from the recommended one, and the share
/// of vertices at which no method could be judged.
void add_caveats(AssetExperiment& asset, const CornerGroundTruth& ground_truth,
                 const CreaseRule& creases) {
    if (!asset.recommendation.method) return;
    std::string& words = asset.recommendation.description;
    const std::size_t taken = *asset.recommendation.method;
    const std::vector<Measurement>& all = asset.experiment.measurements;
    std::vector<std::string> alike;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double difference = std::abs(all[i].error.rms - all[taken].error.rms);
        if (i != taken && !asset.commands[i].empty() &&
            difference < ground_truth.expected_error.value_or(0.0))
            alike.push_back(all[i].method);
    }
    if (!alike.empty()) {
        words += fmt::format(
            "; not told apart from {}, whose errors differ from it by less than the {:.2g} degrees "
            "RMS of the fitted surface itself",
            fmt::join(alike, ", "), *ground_truth.expected_error);
    }
    constexpr double min_share_reported = 0.05;
    if (ground_truth.unjudged < min_share_reported) return;
    words += fmt::format(
        "; {:.0f} % of the vertices are not judged, because no smooth surface fits "
        "them",
        100.0 * ground_truth.unjudged);
    if (!creases.has_any()) words += " (if the mesh has hard edges, try --crease 40)";
}

/// Compares all weightings.
/// \param whole  describes the selection of triangles: ", eight runs of the mesh's 3000000"
AssetExperiment measure_normals(const Mesh& mesh, const std::string& whole,
                                const AssetMeshOptions& mesh_options, const AssetOptions& options) {
    AssetExperiment asset = asset_experiment(Subject::normals, "normals", "Normals", options);
    const CreaseRule creases = crease_rule(mesh, mesh_options.crease_angle);
    const bool is_file = mesh_options.ground_truth == NormalReference::file;
    const CornerGroundTruth ground_truth =
        is_file ? by_file(mesh, creases) : by_surface(mesh, creases);
    Experiment& experiment = asset.experiment;
    experiment.question = is_file ? "Which weighting is closest to the normals of this file?"
                                  : "Which weighting is closest to the normals of the surface that "
                                    "this mesh approximates, and what does it cost?";
    experiment.ground_truth = ground_truth.description;
    experiment.input = fmt::format("{} triangles{}", mesh.triangles.size(), whole);
    experiment.item = "triangle";
    experiment.items = static_cast<double>(mesh.triangles.size());
    std::vector<Method> methods = methods_on(mesh, creases, ground_truth, options);
    if (!is_file && !mesh.normals.empty()) {
        methods.push_back({.name = "the file's own",
                           .choices = {{"weighting", "file"}},
                           .error = known_error(errors_of(mesh.normals, false, mesh, ground_truth)),
                           .note = "The stored normals; there is no work to time."});
    }
    if (!ground_truth.is_enough) {
        for (Method& method : methods)
            method.command.clear();
    }
    experiment.reference_error = ground_truth.expected_error;
    finish(asset, methods, {.reference = "the fitted surface itself"}, options);
    if (ground_truth.is_enough) {
        add_caveats(asset, ground_truth, creases);
    } else {
        asset.recommendation.description =
            "no recommendation: the mesh is too coarse or too rough to fit a smooth surface; "
            "--truth file compares with its stored normals instead";
    }
    set_finding(asset);
    return asset;
}

constexpr std::size_t max_sampled_triangles = 50'000;
constexpr std::size_t max_frames = 100'000;

bool is_finite(const glm::dmat3& basis) {
    return std::isfinite(basis[0].x + basis[0].y + basis[0].z + basis[1].x + basis[2].x);
}

/// Points in triangles whose texture has a direction, with the derived basis there.
struct SamplePoints {
    std::vector<Sample> samples;
    std::vector<glm::dmat3> derived;
    std::size_t triangles = 0;
    std::size_t left_out = 0;
};

SamplePoints sample_points(const Mesh& mesh) {
    SamplePoints points;
    const std::size_t count = mesh.triangles.size();
    points.triangles = std::min(count, max_sampled_triangles);
    for (std::size_t i = 0; i < points.triangles; ++i) {
        const auto triangle = static_cast<std::uint32_t>(i * count / points.triangles);
        const std::array<Sample, 4> samples = samples_in(triangle);
        for (const Sample& sample : samples) {
            const glm::dmat3 derived = basis_at(mesh, {{}, ShaderBasis::derived}, sample);
            if (!is_finite(derived)) {
                if (&sample == &samples.front()) ++points.left_out;
                break;
            }
            points.samples.push_back(sample);
            points.derived.push_back(derived);
        }
    }
    return points;
}

/// A method and its frames. The first one is the basis that bakers and renderers agree on.
struct Basis {
    Method method;  ///< Without its error.
    TangentFrames frames;
};

std::vector<Basis> bases_of(const Mesh& mesh, const std::vector<glm::vec4>& stored,
                            const AssetOptions& options) {
    std::vector<Basis> bases;
    const auto add = [&](const std::string& name, TangentFrames frames) -> Method& {
        Method method{
            .name = name, .choices = {{"basis", name}}, .note = "There is no work to time."};
        return bases.emplace_back(Basis{std::move(method), std::move(frames)}).method;
    };
    for (const FrameMethod& one : tangent_methods()) {
        Method& method = add(one.name, one.compute(mesh));
        if (!one.has_work) continue;
        method.note.clear();
        method.work = [one, &mesh] { one.compute(mesh); };
        method.command = fmt::format("relief-mesh process {} -o OUT.glb --tangents {}",
                                     options.arguments, one.name);
    }
    if (stored.empty()) return bases;
    TangentFrames file_frames;
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            file_frames.tangents.push_back(stored[triangle[corner]]);
    }
    add("the file's own", std::move(file_frames));
    return bases;
}

Method with_error(Method method, std::vector<float> degrees) {
    method.error = known_error(error_stats(std::move(degrees)));
    return method;
}

void describe(Experiment& experiment, const Mesh& mesh, const SamplePoints& points,
              const std::string& whole) {
    experiment.input =
        fmt::format("{} triangles{}; four points in {} of them", mesh.triangles.size(), whole,
                    points.triangles - points.left_out);
    if (points.left_out > 0)
        experiment.input += fmt::format(" ({} have no texture gradient)", points.left_out);
    experiment.item = "triangle";
    experiment.items = static_cast<double>(mesh.triangles.size());
}

/// The angles between tangents and the direction of growing u on each triangle.
AssetExperiment from_gradients(const Mesh& mesh, const std::vector<Basis>& bases,
                               const SamplePoints& points, const std::string& whole,
                               const AssetOptions& options) {
    AssetExperiment asset = asset_experiment(Subject::tangents, "tangents", "Tangents", options);
    Experiment& experiment = asset.experiment;
    experiment.question = "How much do averaged tangents differ from the texture gradient?";
    experiment.ground_truth =
        "The direction of increasing u on each triangle, in the plane of the interpolated normal. "
        "It shows the effect of averaging on the frame, not the basis in which a normal map was "
        "baked: use that basis regardless of its error here.";
    describe(experiment, mesh, points, whole);
    std::vector<Method> methods;
    for (const Basis& basis : bases) {
        if (basis.frames.basis == ShaderBasis::derived) continue;  // It is the ground truth.
        std::vector<float> degrees;
        for (std::size_t i = 0; i < points.samples.size(); ++i) {
            const glm::dmat3 actual = basis_at(mesh, basis.frames, points.samples[i]);
            degrees.push_back(angle_of(actual[0], points.derived[i][0]));
        }
        methods.push_back(with_error(basis.method, std::move(degrees)));
        // A better average is no reason to leave the basis that bakers and renderers agree on.
        if (methods.size() > 1) methods.back().command.clear();
    }
    finish(asset, methods, {}, options);
    if (asset.recommendation.method) {
        const Measurement& taken = experiment.measurements[*asset.recommendation.method];
        asset.recommendation.description = fmt::format(
            "mikktspace: {:.3g} degrees RMS; bakers and renderers agree on it, and another "
            "average would show seams",
            taken.error.rms);
        set_finding(asset);
    }
    return asset;
}

/// The errors of maps that were baked for MikkTSpace and are read in another basis.
AssetExperiment from_mikktspace(const Mesh& mesh, const std::vector<Basis>& bases,
                                const SamplePoints& points, const std::string& whole,
                                const AssetOptions& options) {
    AssetExperiment asset =
        asset_experiment(Subject::tangents, "tangent-basis", "Tangent basis", options);
    Experiment& experiment = asset.experiment;
    experiment.question =
        "What is the error of a normal map that was baked for MikkTSpace in another basis?";
    experiment.ground_truth =
        "The normals of texels tilted by 30 degrees in MikkTSpace's frames, for which most bakers "
        "write maps. A map that was baked in another basis is exact in that basis instead.";
    describe(experiment, mesh, points, whole);
    const Basis& convention = bases.front();
    std::vector<Method> methods;
    for (const Basis& basis : bases) {
        std::vector<float> degrees;
        for (const Sample& sample : points.samples) {
            add_texel_angles(degrees, basis_at(mesh, basis.frames, sample),
                             basis_at(mesh, convention.frames, sample));
        }
        methods.push_back(with_error(basis.method, std::move(degrees)));
    }
    finish(asset, methods, {}, options);
    const Measurement* nearest = nullptr;
    for (const Measurement& one : std::span(experiment.measurements).subspan(1)) {
        if (one.error.undefined > 0) continue;
        if (nearest == nullptr || one.error.rms < nearest->error.rms) nearest = &one;
    }
    if (asset.recommendation.method && nearest != nullptr) {
        asset.recommendation.description = fmt::format(
            "mikktspace for a map that was baked for it; {} has an error of {:.2g} degrees RMS, "
            "{:.2g} at most",
            nearest->method, nearest->error.rms, nearest->error.max);
        set_finding(asset);
    }
    return asset;
}

/// Evenly spread frames of the mesh.
SampleFrames frames_of(const Mesh& mesh, const CornerTangents& tangents) {
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec3> along_u;
    const std::size_t count = std::min(tangents.size(), max_frames);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t corner = i * tangents.size() / count;
        const std::uint32_t vertex = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        const glm::dvec3 normal = glm::normalize(glm::dvec3(mesh.normals[vertex]));
        const glm::dvec3 tangent(tangents[corner]);
        const glm::dvec3 flat = glm::normalize(tangent - normal * glm::dot(normal, tangent));
        if (!std::isfinite(flat.x + flat.y + flat.z)) continue;
        normals.push_back(normal);
        along_u.push_back(flat);
    }
    return sample_frames(normals, along_u);
}

AssetExperiment stored_frames(const Mesh& mesh, const CornerTangents& tangents,
                              const AssetOptions& options) {
    AssetExperiment asset =
        asset_experiment(Subject::storage, "frames", "Frames in few bytes", options);
    const auto frames = std::make_shared<const SampleFrames>(frames_of(mesh, tangents));
    Experiment& experiment = asset.experiment;
    experiment.question = "How many bytes do this mesh's tangent frames need?";
    experiment.ground_truth =
        "The mesh's normals and MikkTSpace's tangents in double, alternately right- and "
        "left-handed.";
    experiment.input = fmt::format("{} frames", frames->normals.size());
    experiment.item = "frame";
    experiment.items = static_cast<double>(frames->normals.size());
    std::vector<Method> methods = frame_methods(frames, StorageWork::encode);
    for (Method& method : methods) {
        method.command = fmt::format(
            "encode_frames(normals, tangents, FrameEncoding::{}, FrameRounding::{}, report)",
            method.choices[0].second, method.choices[1].second);
    }
    finish(asset, methods, {.cost = CostKind::bytes, .negligible_error = invisible_degrees},
           options);
    return asset;
}

/// Compares tangent methods and the storage of their frames. A mesh without normals gets averaged
/// ones.
/// \param mesh  has texture coordinates
std::vector<AssetExperiment> measure_tangents(Mesh mesh, const std::string& whole,
                                              const AssetOptions& options) {
    const std::vector<glm::vec4> stored = mesh.tangents;
    FrameOptions frames;
    frames.repair = true;
    frames.tangents = TangentMethod::none;
    Report report;
    mesh = with_frames(std::move(mesh), frames, report).mesh;
    const std::vector<Basis> bases = bases_of(mesh, stored, options);
    const SamplePoints points = sample_points(mesh);
    std::vector<AssetExperiment> all;
    all.push_back(from_gradients(mesh, bases, points, whole, options));
    all.push_back(from_mikktspace(mesh, bases, points, whole, options));
    all.push_back(stored_frames(mesh, bases.front().frames.tangents, options));
    return all;
}

}  // namespace

std::vector<AssetExperiment> measure_asset_mesh(const Mesh& mesh,
                                                const AssetMeshOptions& mesh_options,
                                                const AssetOptions& options) {
    validate(mesh);
    if (mesh.triangles.empty()) throw InvalidInput("the mesh has no triangle to measure on");
    const Mesh part = part_to_measure(mesh, mesh_options.max_triangles);
    const std::string whole =
        part.triangles.size() == mesh.triangles.size()
            ? ""
            : fmt::format(", eight ranges of the {} of the mesh", mesh.triangles.size());
    std::vector<AssetExperiment> all;
    all.push_back(measure_normals(part, whole, mesh_options, options));
    if (!mesh.texcoords.empty()) {
        for (AssetExperiment& one : measure_tangents(part, whole, options))
            all.push_back(std::move(one));
    }
    return all;
}

}  // namespace relief::accuracy
