// SPDX-License-Identifier: Apache-2.0
// Bases at points inside of triangles, in double, in degrees; triangles without a direction of
// their own in the image are left out. Tests: tests/accuracy/own_mesh_test.cpp.
#include "own/own_tangents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "own/own_experiment.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/frame_encoding.h"
#include "relief/mesh/frames.h"
#include "storage/frame_code_methods.h"
#include "tangents/tangent_methods.h"

namespace relief {
namespace {

constexpr std::size_t most_triangles_sampled = 50'000;
constexpr std::size_t most_frames = 100'000;

bool is_finite(const glm::dmat3& basis) {
    return std::isfinite(basis[0].x + basis[0].y + basis[0].z + basis[1].x + basis[2].x);
}

/// Points of triangles that have a direction of their own, with it.
struct Places {
    std::vector<Sample> samples;
    std::vector<glm::dmat3> derived;
    std::size_t triangles = 0;
    std::size_t left_out = 0;
};

Places places_on(const Mesh& mesh) {
    Places places;
    const std::size_t count = mesh.triangles.size();
    places.triangles = std::min(count, most_triangles_sampled);
    for (std::size_t i = 0; i < places.triangles; ++i) {
        const auto triangle = static_cast<std::uint32_t>(i * count / places.triangles);
        for (int corner = -1; corner < 3; ++corner) {
            Sample sample{triangle};
            if (corner >= 0) {
                sample.barycentric = glm::dvec3(1.0 / 6.0);
                sample.barycentric[corner] = 2.0 / 3.0;
            }
            const glm::dmat3 derived = basis_at(mesh, {}, ShaderBasis::derived, sample);
            if (!is_finite(derived)) {
                if (corner < 0) ++places.left_out;
                break;
            }
            places.samples.push_back(sample);
            places.derived.push_back(derived);
        }
    }
    return places;
}

/// A basis, and what makes it.
struct Basis {
    std::string name;
    CornerTangents tangents;
    ShaderBasis shader = ShaderBasis::as_interpolated;
    std::function<void()> work{};
    std::string command{};
};

std::vector<Basis> bases_of(const Mesh& mesh, const std::vector<glm::vec4>& stored,
                            const OwnOptions& options) {
    std::vector<Basis> bases;
    for (const TangentMethod& method : tangent_methods()) {
        Basis basis{method.name, method.tangents_of(mesh), method.basis};
        if (method.tangents) {
            basis.work = [method, &mesh] { method.tangents(mesh); };
            basis.command = fmt::format("relief-mesh process {} -o OUT.glb --tangents {}",
                                        options.arguments, method.name);
        }
        bases.push_back(std::move(basis));
    }
    if (stored.empty()) return bases;
    Basis own{"the file's own", {}};
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            own.tangents.push_back(stored[triangle[corner]]);
    }
    bases.push_back(std::move(own));
    return bases;
}

OwnMethod method_of(const Basis& basis, std::vector<float> degrees) {
    OwnMethod method;
    method.measured = {.name = basis.name,
                       .choices = {{"basis", basis.name}},
                       .error = figures_of(angle_distribution(std::move(degrees))),
                       .work = basis.work,
                       .note = basis.work ? "" : "no time of its own"};
    method.command = basis.command;
    return method;
}

void describe(Experiment& experiment, const Mesh& mesh, const Places& places,
              const std::string& whole) {
    experiment.input =
        fmt::format("{} triangles{}; four points in {} of them", mesh.triangles.size(), whole,
                    places.triangles - places.left_out);
    if (places.left_out > 0)
        experiment.input += fmt::format(" ({} have no direction in the image)", places.left_out);
    experiment.item = "triangle";
    experiment.items = static_cast<double>(mesh.triangles.size());
}

/// How far tangents are from where u grows on each triangle.
OwnExperiment from_gradients(const Mesh& mesh, const std::vector<Basis>& bases,
                             const Places& places, const std::string& whole,
                             const OwnOptions& options) {
    OwnExperiment own = own_experiment(Subject::tangents, "tangents", "Tangents", options);
    Experiment& experiment = own.experiment;
    experiment.question = "How far do averaged tangents turn from where the image runs?";
    experiment.truth =
        "Where u grows on each triangle, by its own texture coordinates, in the plane of the "
        "interpolated normal. It tells what averaging does to the frame, not which basis a normal "
        "map was baked in: that one must be taken, whatever it errs here.";
    describe(experiment, mesh, places, whole);
    std::vector<OwnMethod> methods;
    for (const Basis& basis : bases) {
        if (basis.shader == ShaderBasis::derived) continue;  // The truth itself.
        std::vector<float> degrees;
        for (std::size_t i = 0; i < places.samples.size(); ++i) {
            const glm::dmat3 found =
                basis_at(mesh, basis.tangents, basis.shader, places.samples[i]);
            degrees.push_back(static_cast<float>(degrees_between(found[0], places.derived[i][0])));
        }
        methods.push_back(method_of(basis, std::move(degrees)));
        // What bakers and renderers agree on is not given up for a better average.
        if (basis.name != "mikktspace") methods.back().command.clear();
    }
    finish(own, std::move(methods), {}, options);
    if (own.recommendation.method) {
        const Measurement& taken = experiment.measurements[*own.recommendation.method];
        own.recommendation.words = fmt::format(
            "mikktspace: {:.3g} degrees RMS; bakers and renderers agree on it, and no "
            "other average is worth a seam",
            taken.error.rms);
        tell_finding(own);
    }
    return own;
}

/// What maps baked for MikkTSpace show when they are read in another basis.
OwnExperiment from_mikktspace(const Mesh& mesh, const std::vector<Basis>& bases,
                              const Places& places, const std::string& whole,
                              const OwnOptions& options) {
    OwnExperiment own =
        own_experiment(Subject::tangents, "tangent-basis", "Tangent basis", options);
    Experiment& experiment = own.experiment;
    experiment.question = "What does a normal map baked for MikkTSpace show in another basis?";
    experiment.truth =
        "The normals that texels tilted by 30 degrees stand for in MikkTSpace's frames, which is "
        "what most bakers write. A map baked in another basis is right in that one instead.";
    describe(experiment, mesh, places, whole);
    const Basis& convention = bases.front();
    std::vector<OwnMethod> methods;
    for (const Basis& basis : bases) {
        std::vector<float> degrees;
        for (const Sample& sample : places.samples) {
            const glm::dmat3 meant = basis_at(mesh, convention.tangents, convention.shader, sample);
            const glm::dmat3 found = basis_at(mesh, basis.tangents, basis.shader, sample);
            for (const glm::dvec3& texel : tilted_texels)
                degrees.push_back(
                    static_cast<float>(degrees_between(found * texel, meant * texel)));
        }
        methods.push_back(method_of(basis, std::move(degrees)));
    }
    finish(own, std::move(methods), {}, options);
    const Measurement* nearest = nullptr;
    for (const Measurement& one : experiment.measurements) {
        if (one.method == convention.name || one.error.undefined > 0) continue;
        if (nearest == nullptr || one.error.rms < nearest->error.rms) nearest = &one;
    }
    if (own.recommendation.method && nearest != nullptr) {
        own.recommendation.words = fmt::format(
            "mikktspace for a map that was baked so; {} shows it {:.2g} degrees off, "
            "{:.2g} at most",
            nearest->method, nearest->error.rms, nearest->error.max);
        tell_finding(own);
    }
    return own;
}

/// Some of the mesh's frames, evenly spread.
SampleFrames frames_of(const Mesh& mesh, const CornerTangents& tangents) {
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec3> along_u;
    const std::size_t count = std::min(tangents.size(), most_frames);
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

OwnExperiment stored_frames(const Mesh& mesh, const CornerTangents& tangents,
                            const OwnOptions& options) {
    OwnExperiment own = own_experiment(Subject::storage, "frames", "Frames in few bytes", options);
    const SampleFrames frames = frames_of(mesh, tangents);
    Experiment& experiment = own.experiment;
    experiment.question = "How many bytes do this mesh's tangent frames need?";
    experiment.truth =
        "The mesh's normals and MikkTSpace's tangents in double, right- and left-handed by turns.";
    experiment.input = fmt::format("{} frames", frames.normals.size());
    experiment.item = "frame";
    experiment.items = static_cast<double>(frames.normals.size());
    std::vector<OwnMethod> methods;
    for (const FrameCode& code : all_frame_codes()) {
        OwnMethod method{code.measured(frames)};
        method.measured.work = [&frames, code] {
            Report report;
            encode_frames(frames.float_normals, frames.float_tangents, code.encoding, code.rounding,
                          report);
        };
        method.command = fmt::format(
            "encode_frames(normals, tangents, FrameEncoding::{}, FrameRounding::{}, report)",
            word_of(code.encoding), code.rounding_word());
        methods.push_back(std::move(method));
    }
    finish(own, std::move(methods), {CostKind::bytes, unseen_degrees}, options);
    return own;
}

}  // namespace

std::vector<OwnExperiment> own_tangents(Mesh mesh, const std::string& whole,
                                        const OwnOptions& options) {
    const std::vector<glm::vec4> stored = mesh.tangents;
    FrameOptions frames;
    frames.repair = true;
    frames.tangents = TangentMode::none;
    Report report;
    mesh = with_frames(std::move(mesh), frames, report).mesh;
    const std::vector<Basis> bases = bases_of(mesh, stored, options);
    const Places places = places_on(mesh);
    std::vector<OwnExperiment> all;
    all.push_back(from_gradients(mesh, bases, places, whole, options));
    all.push_back(from_mikktspace(mesh, bases, places, whole, options));
    all.push_back(stored_frames(mesh, bases.front().tangents, options));
    return all;
}

}  // namespace relief
