// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/tangent_methods_test.cpp.
#include "tangents/tangent_methods.h"

#include "relief/mesh/direction_error.h"
#include "relief/mesh/tangents.h"

namespace relief {
namespace {

using TangentFunction = CornerTangents (*)(std::span<const glm::vec3>, std::span<const glm::vec3>,
                                           std::span<const glm::vec2>, std::span<const glm::uvec3>,
                                           Report&);

TangentMethod stored(const char* name, TangentFunction function) {
    return {name, [function](const Mesh& mesh) {
                Report report;
                return function(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                report);
            }};
}

/// Adds up angles between directions.
class Angles {
  public:
    void add(const glm::dvec3& found, const glm::dvec3& expected) {
        degrees_.push_back(static_cast<float>(degrees_between(found, expected)));
    }
    [[nodiscard]] AngleDistribution distribution() && {
        return angle_distribution(std::move(degrees_));
    }

  private:
    std::vector<float> degrees_;
};

}  // namespace

CornerTangents TangentMethod::tangents_of(const Mesh& mesh) const {
    return tangents ? tangents(mesh) : CornerTangents{};
}

std::vector<TangentMethod> tangent_methods() {
    return {stored("mikktspace", mikktspace_tangents),
            stored("area-weighted", area_weighted_tangents),
            stored("lengyel", lengyel_tangents),
            {"screen-space", {}, ShaderBasis::derived}};
}

TangentMethod made_unit(TangentMethod method) {
    method.name += ", made unit";
    method.basis = ShaderBasis::made_unit;
    return method;
}

AngleDistribution texel_errors(const TexturedMesh& truth, const CornerTangents& tangents,
                               ShaderBasis basis) {
    Angles angles;
    for (const Sample& sample : samples_of(truth)) {
        const glm::dmat3 found = basis_at(truth.mesh, tangents, basis, sample);
        const glm::dmat3 expected = true_basis_at(truth, sample);
        for (const glm::dvec3& texel : tilted_texels)
            angles.add(found * texel, expected * texel);
    }
    return std::move(angles).distribution();
}

AngleDistribution inner_tangent_errors(const TexturedMesh& truth, const CornerTangents& tangents,
                                       ShaderBasis basis) {
    Angles angles;
    for (const Sample& sample : samples_of(truth)) {
        angles.add(basis_at(truth.mesh, tangents, basis, sample)[0],
                   true_basis_at(truth, sample)[0]);
    }
    return std::move(angles).distribution();
}

AngleDistribution corner_tangent_errors(const TexturedMesh& truth, const CornerTangents& tangents) {
    const CornerTangents expected = true_tangents(truth);
    Angles angles;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::uint32_t vertex = truth.mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (truth.inner[vertex] == 0) continue;
        angles.add(glm::dvec3(tangents[corner]), glm::dvec3(expected[corner]));
    }
    return std::move(angles).distribution();
}

AngleDistribution mismatch_errors(const TexturedMesh& truth, const TangentMethod& baker,
                                  const TangentMethod& reader) {
    const CornerTangents baked = baker.tangents_of(truth.mesh);
    const CornerTangents read = reader.tangents_of(truth.mesh);
    Angles angles;
    for (const Sample& sample : samples_of(truth)) {
        const glm::dmat3 expected = true_basis_at(truth, sample);
        const glm::dmat3 to_texel = glm::inverse(basis_at(truth.mesh, baked, baker.basis, sample));
        const glm::dmat3 from_texel = basis_at(truth.mesh, read, reader.basis, sample);
        for (const glm::dvec3& tilt : tilted_texels) {
            const glm::dvec3 normal = expected * tilt;
            angles.add(from_texel * glm::normalize(to_texel * normal), normal);
        }
    }
    return std::move(angles).distribution();
}

}  // namespace relief
