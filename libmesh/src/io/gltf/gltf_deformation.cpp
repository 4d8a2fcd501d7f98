// SPDX-License-Identifier: Apache-2.0
// Projects the joint weights and the morph targets of a primitive to a few numbers per vertex.
// Tests: tests/mesh/io/gltf/gltf_deformation_test.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Returns the vector that stands for a joint. The vectors of a low-discrepancy sequence differ
/// most between joints of close numbers, which mostly are neighbors. Each component has the
/// variance 1/4, so two weights of 1 have an expected distance of sqrt(2), as with one number for
/// each joint.
glm::dvec4 joint_vector(double joint) {
    // The inverse powers of the root of x^5 = x + 1.
    constexpr std::array steps = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                  0.5385972572236101};
    constexpr double half_width = 0.8660254037844386;  // sqrt(3) / 2
    glm::dvec4 result;
    for (int i = 0; i < 4; ++i) {
        const double place = 0.5 + steps[static_cast<std::size_t>(i)] * joint;
        result[i] = half_width * (2.0 * (place - std::floor(place)) - 1.0);
    }
    return result;
}

/// Returns the factor of a morph target in a sum of displacements. Up to as many targets as sums
/// have a sum each; more are mixed with signs that look random.
double target_factor(std::size_t target, std::size_t sum, std::size_t targets) {
    constexpr std::size_t sums = std::tuple_size_v<decltype(Deformation::displacements)>;
    if (targets <= sums) return target == sum ? 1.0 : 0.0;
    // The finalizer of splitmix64.
    std::uint64_t bits = (target * sums + sum + 1) * 0x9E3779B97F4A7C15U;
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9U;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBU;
    constexpr double size = 0.5773502691896258;  // 1 / sqrt(sums)
    static_assert(sums == 3);
    return ((bits ^ (bits >> 31)) & 1) != 0 ? size : -size;
}

template <typename Vector>
bool has_type(const GltfContents& contents, std::size_t accessor) {
    const std::string type = text_in(contents.root["accessors"][accessor], "type");
    return type == (Vector::length() == 4 ? "VEC4" : "VEC3");
}

std::vector<glm::dvec4> joint_sums(const GltfContents& contents, const Json& attributes) {
    std::vector<glm::dvec4> sums;
    for (int set = 0;; ++set) {
        const auto joints = index_in(attributes, fmt::format("JOINTS_{}", set).c_str());
        const auto weights = index_in(attributes, fmt::format("WEIGHTS_{}", set).c_str());
        if (!joints || !weights) return sums;
        if (!has_type<glm::vec4>(contents, *joints) || !has_type<glm::vec4>(contents, *weights))
            continue;
        const auto joint = float_elements<glm::vec4>(contents, *joints);
        const auto weight = float_elements<glm::vec4>(contents, *weights);
        sums.resize(joint.size(), glm::dvec4(0.0));
        for (std::size_t v = 0; v < sums.size(); ++v) {
            for (int i = 0; i < 4; ++i) {
                if (weight[v][i] != 0.0F)
                    sums[v] += double(weight[v][i]) * joint_vector(joint[v][i]);
            }
        }
    }
}

template <typename Result, typename Sum>
std::vector<Result> rounded(const std::vector<Sum>& sums, const GltfTriangles& triangles) {
    std::vector<Result> result;
    if (sums.empty()) return result;
    if (!triangles.used) {
        for (const Sum& sum : sums)
            result.emplace_back(sum);
        return result;
    }
    for (const std::uint32_t vertex : *triangles.used)
        result.emplace_back(sums[vertex]);
    return result;
}

}  // namespace

Deformation GltfDocument::deformation_sums(GltfPrimitiveId id) const {
    const GltfContents& contents = contents_->data;
    const Json& primitive = primitive_json(contents, id);
    const Json& targets = array_in(primitive, "targets");
    Deformation result;
    const bool has_joints = primitive["attributes"].contains("JOINTS_0");
    if (!has_joints && targets.empty()) return result;
    try {
        const GltfTriangles triangles = read_triangles(contents, id);
        result.joints =
            rounded<glm::vec4>(joint_sums(contents, primitive["attributes"]), triangles);
        std::array<std::vector<glm::dvec3>, 3> sums;
        for (std::size_t target = 0; target < targets.size(); ++target) {
            const auto accessor = index_in(targets[target], "POSITION");
            if (!accessor || !has_type<glm::vec3>(contents, *accessor)) continue;
            const auto displacements = float_elements<glm::vec3>(contents, *accessor);
            for (std::size_t i = 0; i < sums.size(); ++i) {
                const double factor = target_factor(target, i, targets.size());
                if (factor == 0.0) continue;
                sums[i].resize(displacements.size(), glm::dvec3(0.0));
                for (std::size_t v = 0; v < displacements.size(); ++v)
                    sums[i][v] += factor * glm::dvec3(displacements[v]);
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
            result.displacements[i] = rounded<glm::vec3>(sums[i], triangles);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("{}: {}", describe_primitive(contents, id), error.what()));
    }
    return result;
}

}  // namespace relief
