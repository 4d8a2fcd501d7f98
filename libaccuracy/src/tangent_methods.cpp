// SPDX-License-Identifier: Apache-2.0
// Evaluates tangent bases at points inside triangles, as a fragment shader does, and compares them
// with the frames of the surface in closed form.
#include "experiment_parts.h"

#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"

namespace relief::accuracy::detail {
namespace {

template <typename Values>
auto interpolated(const Values& values, const glm::uvec3& corners, const glm::dvec3& weights) {
    using Value = std::decay_t<decltype(values[0])>;
    using Double = glm::vec<Value::length(), double>;
    return Double(values[corners.x]) * weights.x + Double(values[corners.y]) * weights.y +
           Double(values[corners.z]) * weights.z;
}

/// Implements shaders/tangent_frame.glsl#derivatives with two edges of the triangle instead of the
/// screen's axes. Any two directions in the plane of the triangle give the same result.
glm::dmat3 derived_basis(const Mesh& mesh, const glm::uvec3& corners, const glm::dvec3& normal) {
    const auto edge = [&](std::uint32_t to) {
        return glm::dvec3(mesh.positions[to]) - glm::dvec3(mesh.positions[corners.x]);
    };
    const auto step = [&](std::uint32_t to) {
        return glm::dvec2(mesh.texcoords[to]) - glm::dvec2(mesh.texcoords[corners.x]);
    };
    const glm::dvec3 right = edge(corners.y), up = edge(corners.z);
    const glm::dvec2 right_texture = step(corners.y), up_texture = step(corners.z);
    const double area = right_texture.x * up_texture.y - right_texture.y * up_texture.x;
    const double sign = area < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 along_u = (right * up_texture.y - up * right_texture.y) * sign;
    const glm::dvec3 tangent = glm::normalize(along_u - n * glm::dot(n, along_u));
    const double turned = sign * (glm::dot(n, glm::cross(right, up)) < 0.0 ? -1.0 : 1.0);
    return {tangent, -turned * glm::cross(n, tangent), n};
}

glm::dmat3 matrix_of(const SurfaceFrame& frame) {
    return {frame.tangent, frame.handedness * glm::cross(frame.normal, frame.tangent),
            frame.normal};
}

}  // namespace

std::vector<Sample> samples_of(const TexturedMesh& ground_truth) {
    std::vector<Sample> samples;
    const auto count = static_cast<std::uint32_t>(ground_truth.mesh.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::uvec3& corners = ground_truth.mesh.triangles[t];
        if (ground_truth.inner[corners.x] + ground_truth.inner[corners.y] +
                ground_truth.inner[corners.z] <
            3)
            continue;
        samples.push_back({t, glm::dvec3(1.0 / 3.0)});
        for (int corner = 0; corner < 3; ++corner) {
            Sample sample{t, glm::dvec3(1.0 / 6.0)};
            sample.barycentric[corner] = 2.0 / 3.0;
            samples.push_back(sample);
        }
    }
    return samples;
}

glm::dmat3 basis_at(const Mesh& mesh, const TangentFrames& frames, const Sample& sample) {
    const glm::uvec3& corners = mesh.triangles[sample.triangle];
    glm::dvec3 normal = interpolated(mesh.normals, corners, sample.barycentric);
    if (frames.basis == ShaderBasis::derived) return derived_basis(mesh, corners, normal);
    const glm::uvec3 first = glm::uvec3(0, 1, 2) + 3 * sample.triangle;
    const glm::dvec4 stored = interpolated(frames.tangents, first, sample.barycentric);
    glm::dvec3 tangent(stored);
    if (frames.basis == ShaderBasis::made_unit) {
        normal = glm::normalize(normal);
        tangent = glm::normalize(tangent);
    }
    return {tangent, stored.w * glm::cross(normal, tangent), normal};
}

glm::dmat3 exact_basis_at(const TexturedMesh& ground_truth, const Sample& sample) {
    const glm::uvec3& corners = ground_truth.mesh.triangles[sample.triangle];
    return matrix_of(
        ground_truth.frame_at(interpolated(ground_truth.parameters, corners, sample.barycentric)));
}

CornerTangents exact_tangents(const TexturedMesh& ground_truth) {
    CornerTangents tangents;
    for (std::uint32_t t = 0; t < ground_truth.mesh.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            // Stay slightly inside the triangle: a mirrored texture has two frames at its edge.
            Sample sample{t, glm::dvec3(1e-9)};
            sample.barycentric[corner] = 1.0 - 2e-9;
            const glm::uvec3& corners = ground_truth.mesh.triangles[t];
            const SurfaceFrame frame = ground_truth.frame_at(
                interpolated(ground_truth.parameters, corners, sample.barycentric));
            tangents.emplace_back(glm::vec3(frame.tangent), static_cast<float>(frame.handedness));
        }
    }
    return tangents;
}

namespace {

using TangentFunction = decltype(&mikktspace_tangents);

FrameMethod stored(const char* name, TangentFunction function) {
    return {.name = name,
            .choices = {{"frames", name}, {"shader", "as interpolated"}},
            .compute =
                [function](const Mesh& mesh) {
                    Report report;
                    return TangentFrames{function(mesh.positions, mesh.normals, mesh.texcoords,
                                                  mesh.triangles, report)};
                },
            .stored_bytes = 28.0};  // Normal, tangent and w as floats.
}

}  // namespace

std::vector<FrameMethod> tangent_methods() {
    return {stored("mikktspace", mikktspace_tangents),
            stored("area-weighted", area_weighted_tangents),
            stored("lengyel", lengyel_tangents),
            {.name = "screen-space",
             .choices = {{"frames", "screen-space"}, {"shader", "derived"}},
             .compute =
                 [](const Mesh&) {
                     return TangentFrames{{}, ShaderBasis::derived};
                 },
             .has_work = false,
             .stored_bytes = 12.0,  // The normal.
             .note = "No work for the mesh: shaders derive the frame of each pixel. tangents/drawn "
                     "measures the time of that."}};
}

FrameMethod made_unit(const FrameMethod& method) {
    FrameMethod unit = method;
    unit.name += ", made unit";
    unit.choices.back().second = "made unit";
    unit.compute = [compute = method.compute](const Mesh& mesh) {
        return TangentFrames{compute(mesh).tangents, ShaderBasis::made_unit};
    };
    return unit;
}

ErrorStats texel_errors(const TexturedMesh& ground_truth, const TangentFrames& frames) {
    std::vector<float> degrees;
    for (const Sample& sample : samples_of(ground_truth)) {
        const glm::dmat3 actual = basis_at(ground_truth.mesh, frames, sample);
        const glm::dmat3 expected = exact_basis_at(ground_truth, sample);
        for (const glm::dvec3& texel : tilted_texels)
            degrees.push_back(angle_of(actual * texel, expected * texel));
    }
    return error_stats(std::move(degrees));
}

ErrorStats inner_tangent_errors(const TexturedMesh& ground_truth, const TangentFrames& frames) {
    std::vector<float> degrees;
    for (const Sample& sample : samples_of(ground_truth)) {
        degrees.push_back(angle_of(basis_at(ground_truth.mesh, frames, sample)[0],
                                   exact_basis_at(ground_truth, sample)[0]));
    }
    return error_stats(std::move(degrees));
}

std::vector<float> corner_tangent_angles(const TexturedMesh& ground_truth,
                                         const CornerTangents& tangents) {
    const CornerTangents expected = exact_tangents(ground_truth);
    std::vector<float> degrees;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::uint32_t vertex =
            ground_truth.mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (ground_truth.inner[vertex] == 0) continue;
        degrees.push_back(angle_of(glm::dvec3(tangents[corner]), glm::dvec3(expected[corner])));
    }
    return degrees;
}

ErrorStats mismatch_errors(const TexturedMesh& ground_truth, const FrameMethod& baker,
                           const FrameMethod& reader) {
    const TangentFrames baked = baker.compute(ground_truth.mesh);
    const TangentFrames read = reader.compute(ground_truth.mesh);
    std::vector<float> degrees;
    for (const Sample& sample : samples_of(ground_truth)) {
        const glm::dmat3 expected = exact_basis_at(ground_truth, sample);
        const glm::dmat3 to_texel = glm::inverse(basis_at(ground_truth.mesh, baked, sample));
        const glm::dmat3 from_texel = basis_at(ground_truth.mesh, read, sample);
        for (const glm::dvec3& tilt : tilted_texels) {
            const glm::dvec3 normal = expected * tilt;
            degrees.push_back(angle_of(from_texel * glm::normalize(to_texel * normal), normal));
        }
    }
    return error_stats(std::move(degrees));
}

namespace {

TexturedCase case_of(AnalyticSurface surface, Triangulation triangulation, TextureLayout layout) {
    constexpr std::uint32_t seed = 1;
    TexturedCase one;
    one.id = name_of(surface) + "-" + name_of(triangulation);
    one.name = name_of(surface) + ", " + name_of(triangulation);
    one.triangulation = triangulation;
    if (layout == TextureLayout::upright) {
        one.is_quick = triangulation == Triangulation::anisotropic
                           ? surface == AnalyticSurface::cubic
                           : surface == AnalyticSurface::torus;
    } else {
        const std::string word = layout == TextureLayout::sheared ? "sheared" : "mirrored";
        one.id += "-" + word;
        one.name += ", image " + word;
        one.is_quick = layout == TextureLayout::mirrored;
    }
    one.mesh = [=](int cells) {
        return textured_mesh(surface, triangulation, layout, cells, seed);
    };
    return one;
}

}  // namespace

std::vector<TexturedCase> textured_cases() {
    std::vector<TexturedCase> cases;
    for (const Triangulation triangulation :
         {Triangulation::regular, Triangulation::jittered, Triangulation::anisotropic}) {
        for (const AnalyticSurface surface : all_surfaces)
            cases.push_back(case_of(surface, triangulation, TextureLayout::upright));
    }
    for (const TextureLayout layout : {TextureLayout::sheared, TextureLayout::mirrored})
        cases.push_back(case_of(AnalyticSurface::torus, Triangulation::jittered, layout));
    cases.push_back({.id = "plate",
                     .name = "plate with thin bevels and a sheared image on them",
                     .is_quick = true,
                     .mesh = [](int) { return beveled_plate(0.02); }});
    return cases;
}

}  // namespace relief::accuracy::detail
