// SPDX-License-Identifier: Apache-2.0
// Vertex normals in the caller's memory and with a Workspace, interleaved with a naive loop, with
// other libraries, and with a triad over memory: `relief-normals-bench [TRIANGLES [ROUNDS]]` prints
// a table in Markdown.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench_support.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/statistics.h"

#ifdef RELIEF_HAS_OPENMESH
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#endif
#ifdef RELIEF_HAS_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Surface_mesh.h>
#endif

namespace relief::bench {
namespace {

/// A naive method: area-weighted sums in float. It overflows, underflows, does not average across
/// seams, depends on the order of triangles, and gives NaN for vertices of collapsed triangles.
void naive_area_normals(const Mesh& mesh, std::span<glm::vec3> normals) {
    std::fill(normals.begin(), normals.end(), glm::vec3(0.0F));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::vec3& origin = mesh.positions[triangle[0]];
        const glm::vec3 area_normal =
            glm::cross(mesh.positions[triangle[1]] - origin, mesh.positions[triangle[2]] - origin);
        for (int corner = 0; corner < 3; ++corner)
            normals[triangle[corner]] += area_normal;
    }
    for (glm::vec3& normal : normals)
        normal = glm::normalize(normal);
}

/// The memory that all contenders share, for the result and for intermediate results.
struct Memory {
    std::vector<glm::vec3> normals;
    Workspace workspace;
};

Contender ours(const Mesh& mesh, Memory& memory, std::string name, NormalOptions options,
               unsigned threads) {
    return {fmt::format("relief, {}{}", name, threads == 1 ? "" : ", 2 threads"),
            [&mesh, &memory, options, threads] {
                const WorkspaceScope scope(memory.workspace);
                vertex_normals(mesh.positions, mesh.triangles, options, memory.normals,
                               IgnoredReport(), {.threads = threads});
            },
            {}};
}

#ifdef RELIEF_HAS_OPENMESH
/// update_normals() computes face normals, then vertex normals with uniform weights. The half-edges
/// are part of the setup.
Contender open_mesh(const Mesh& mesh) {
    using Halfedges = OpenMesh::TriMesh_ArrayKernelT<>;
    const auto peer = std::make_shared<Halfedges>();
    std::vector<OpenMesh::VertexHandle> handles;
    for (const glm::vec3& p : mesh.positions)
        handles.push_back(peer->add_vertex({p.x, p.y, p.z}));
    for (const glm::uvec3& t : mesh.triangles)
        peer->add_face(handles[t.x], handles[t.y], handles[t.z]);
    peer->request_face_normals();
    peer->request_vertex_normals();
    return {"OpenMesh update_normals, uniform", [peer] { peer->update_normals(); }, {}};
}
#endif

#ifdef RELIEF_HAS_CGAL
Contender cgal(const Mesh& mesh) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
    const auto peer = std::make_shared<Surface>();
    std::vector<Surface::Vertex_index> handles;
    for (const glm::vec3& p : mesh.positions)
        handles.push_back(peer->add_vertex({p.x, p.y, p.z}));
    for (const glm::uvec3& t : mesh.triangles)
        peer->add_face(handles[t.x], handles[t.y], handles[t.z]);
    auto normals = peer->add_property_map<Surface::Vertex_index, Kernel::Vector_3>("v:n").first;
    return {"CGAL compute_vertex_normals", [peer, normals] {
                CGAL::Polygon_mesh_processing::compute_vertex_normals(*peer, normals);
            }};
}
#endif

/// The same work by other libraries that were found at build time. The setup is not timed. The mesh
/// must outlive the result.
std::vector<Contender> normal_peers([[maybe_unused]] const Mesh& mesh) {
    std::vector<Contender> peers;
#ifdef RELIEF_HAS_OPENMESH
    peers.push_back(open_mesh(mesh));
#endif
#ifdef RELIEF_HAS_CGAL
    peers.push_back(cgal(mesh));
#endif
    return peers;
}

/// The first three are those of the targets: the naive loop, and area on one and on two threads.
std::vector<Contender> contenders(const Mesh& mesh, Memory& memory, Triad& triad) {
    const NormalOptions area{NormalWeight::area, Arithmetic::float64, std::nullopt};
    std::vector<Contender> all;
    all.push_back(
        {"naive loop, area, float", [&] { naive_area_normals(mesh, memory.normals); }, {}});
    for (const unsigned threads : {1U, 2U})
        all.push_back(ours(mesh, memory, "area, vertices as they are", area, threads));
    for (const unsigned threads : {1U, 2U}) {
        all.push_back(ours(mesh, memory, "area", {NormalWeight::area}, threads));
        all.push_back(ours(mesh, memory, "angle", {NormalWeight::angle}, threads));
        all.push_back(ours(mesh, memory, "max", {NormalWeight::max}, threads));
    }
    all.push_back(ours(mesh, memory, "area, float",
                       {NormalWeight::area, Arithmetic::float32, std::nullopt}, 1));
    all.push_back(
        ours(mesh, memory, "angle, float", {NormalWeight::angle, Arithmetic::float32}, 1));
    all.push_back({"relief, area, vertices as they are, new memory",
                   [&mesh, area] {
                       const ExecutionScope scope({.threads = 1});
                       (void)vertex_normals(mesh.positions, mesh.triangles, area);
                   },
                   {}});
    all.push_back({"relief, auto, new memory",
                   [&mesh] {
                       const ExecutionScope scope({.threads = 1});
                       (void)chosen_normals(mesh.positions, mesh.triangles, {});
                   },
                   {}});
    for (Contender& peer : normal_peers(mesh))
        all.push_back(std::move(peer));
    all.push_back({"triad, 192 MB", [&] { triad.run(); }, {}});
    return all;
}

int run(int argc, char** argv) {
    const std::size_t triangles = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1'000'000;
    const std::size_t rounds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 15;
    const Mesh mesh = bumpy_sphere(triangles);
    Memory memory{std::vector<glm::vec3>(mesh.positions.size()), {}};
    Triad triad;
    std::vector<Contender> all = contenders(mesh, memory, triad);
    measure(all, rounds);

    fmt::print("{} triangles, {} vertices; {} interleaved rounds\n\n", mesh.triangles.size(),
               mesh.positions.size(), rounds);
    fmt::print("| who | ns/triangle, least | median | times the naive loop |\n|---|---|---|---|\n");
    const double naive = least(all[0]);
    const auto count = static_cast<double>(mesh.triangles.size());
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        fmt::print("| {} | {:.1f} | {:.1f} | {:.2f} |\n", all[i].name, least(all[i]) / count,
                   time_statistics(all[i].nanoseconds).median / count, least(all[i]) / naive);
    }
    fmt::print(
        "\nArea, vertices as they are: {:.2f} times the naive loop (target 1.5), and {:.2f} times "
        "faster on two threads (target 1.7).\n",
        least(all[1]) / naive, least(all[1]) / least(all[2]));
    const double bandwidth = Triad::bytes / least(all.back());
    // Indices and positions are read once, and normals are written once.
    const double bytes = 12.0 * count + 24.0 * static_cast<double>(mesh.positions.size());
    fmt::print(
        "Triad: {:.1f} GB/s. Indices, positions and normals moved once: {:.2f} ns/triangle.\n",
        bandwidth, bytes / bandwidth / count);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    return relief::bench::run(argc, argv);
}
