// SPDX-License-Identifier: Apache-2.0
#include "conformance.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/command.h"
#include "common/options.h"
#include "relief/mesh/compare.h"
#include "relief/mesh/error_stats.h"
#include "relief/mesh/gltf_document.h"

namespace relief::tools {
namespace {

const Choices<KitGroup> kit_groups = {{"conformance", KitGroup::conformance},
                                      {"defect", KitGroup::defect},
                                      {"stability", KitGroup::stability}};

std::vector<glm::vec4> read_expected(const std::filesystem::path& file, std::size_t corners) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<glm::vec4> expected(corners);
    const auto bytes = static_cast<std::streamsize>(corners * sizeof(glm::vec4));
    stream.read(reinterpret_cast<char*>(expected.data()), bytes);
    if (stream.gcount() != bytes || stream.peek() != std::ifstream::traits_type::eof())
        throw FileError(file, fmt::format("does not hold {} tangents of 16 bytes", corners));
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
    kit.group = parse_choice("group", entry.at("group").get<std::string>(), kit_groups);
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
        throw FileError(file, error.what());
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
    judgment.degrees = angle_distribution(std::move(degrees));
    return judgment;
}

}  // namespace relief::tools
