// SPDX-License-Identifier: Apache-2.0
// The peak memory of normals and tangents. The program is separate because it replaces operator
// new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <utility>

#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace {

FILE_LABELS(alone);

std::atomic<std::size_t> in_use{0};
std::atomic<std::size_t> max_used{0};

// Each block begins with its size. The header keeps the alignment of the data.
constexpr std::size_t header = 64;

void* counted_new(std::size_t size) {
    void* block = std::aligned_alloc(header, (size + 2 * header - 1) / header * header);
    if (block == nullptr) throw std::bad_alloc();
    *static_cast<std::size_t*>(block) = size;
    const std::size_t now = in_use += size;
    std::size_t most = max_used;
    while (now > most && !max_used.compare_exchange_weak(most, now)) {
    }
    return static_cast<std::byte*>(block) + header;
}

void counted_delete(void* memory) noexcept {
    if (memory == nullptr) return;
    void* block = static_cast<std::byte*>(memory) - header;
    in_use -= *static_cast<std::size_t*>(block);
    std::free(block);
}

}  // namespace

void* operator new(std::size_t size) {
    return counted_new(size);
}
// For alignments up to that of the data.
void* operator new(std::size_t size, std::align_val_t) {
    return counted_new(size);
}
void operator delete(void* memory) noexcept {
    counted_delete(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    counted_delete(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    counted_delete(memory);
}

namespace relief {
namespace {

std::size_t bytes_of(const Mesh& mesh) {
    return mesh.positions.size() * (2 * sizeof(glm::vec3) + sizeof(glm::vec2)) +
           mesh.triangles.size() * sizeof(glm::uvec3);
}

/// Returns the peak memory of input, output and temporary data, divided by that of input and
/// output.
double peak_ratio(const Mesh& mesh) {
    const std::size_t before = in_use;
    max_used = before;
    Report report;
    const auto tangents =
        mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
    const std::size_t needed = bytes_of(mesh) + tangents.size() * sizeof(glm::vec4);
    return static_cast<double>(bytes_of(mesh) + max_used - before) / static_cast<double>(needed);
}

/// Returns the peak memory of a call in bytes, without what was in use before.
template <typename Call>
std::size_t peak_of(const Call& call) {
    const std::size_t before = in_use;
    max_used = before;
    call();
    return max_used - before;
}

TEST(BufferMemory, InterleavedVerticesAndShortIndicesAreNotCopied) {
    struct Vertex {
        glm::vec3 position;
        glm::vec3 normal;
        glm::vec2 texcoord;
        glm::vec4 tangent;
    };
    const Mesh mesh = test::grid(250);
    std::vector<Vertex> vertices;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        vertices.push_back({mesh.positions[v], mesh.normals[v], mesh.texcoords[v], {}});
    std::vector<std::uint16_t> indices;
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            indices.push_back(static_cast<std::uint16_t>(triangle[i]));
    }
    const std::size_t count = vertices.size();
    const TriangleSpan triangles{std::span<const std::uint16_t>(indices)};
    const StridedSpan<const glm::vec3> positions(&vertices[0].position, count, sizeof(Vertex));
    const StridedSpan<glm::vec3> normals(&vertices[0].normal, count, sizeof(Vertex));
    const StridedSpan<const glm::vec2> texcoords(&vertices[0].texcoord, count, sizeof(Vertex));
    const StridedSpan<glm::vec4> tangents(&vertices[0].tangent, count, sizeof(Vertex));
    Report report;
    set_thread_limit(1);

    // Arrays of relief's own layout need no conversion. The results of these calls are vectors,
    // which the others do without.
    const NormalOptions options;
    const std::size_t normals_peak =
        peak_of([&] { (void)vertex_normals(mesh.positions, mesh.triangles, options, report); });
    EXPECT_LE(peak_of([&] { vertex_normals(positions, triangles, options, normals); }),
              normals_peak - count * sizeof(glm::vec3));
    const std::size_t tangents_peak = peak_of([&] {
        (void)mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                  report);
    });
    EXPECT_LE(peak_of([&] { vertex_tangents(positions, normals, texcoords, triangles, tangents); }),
              tangents_peak);
    EXPECT_EQ(vertices[count / 2].tangent, glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
    set_thread_limit(0);
}

TEST(BufferMemory, FramesNeedLessMemoryThanTangentsOfCorners) {
    Mesh mesh = test::grid(400);
    const std::size_t triangles = mesh.triangles.size();
    const std::size_t corner_tangents = 3 * triangles * sizeof(glm::vec4);
    Report report;
    set_thread_limit(1);
    // The tangents of vertices, the corners at each, and the contributions of a slice.
    EXPECT_LT(peak_of([&] {
                  (void)with_frames(
                      std::move(mesh),
                      {NormalMode::keep, NormalWeight::angle, TangentMethod::mikktspace}, report);
              }),
              corner_tangents * 3 / 4);
    set_thread_limit(0);
}

TEST(BufferMemory, AWorkspaceServesTheNextCall) {
    const Mesh mesh = test::grid(150);
    std::vector<glm::vec3> normals(mesh.positions.size());
    std::vector<glm::vec4> of_corners(3 * mesh.triangles.size());
    std::vector<glm::vec4> of_vertices(mesh.positions.size());
    Workspace workspace;
    const auto compute = [&] {
        const ExecutionOptions execution{.threads = 1};
        const WorkspaceScope scope(workspace);
        Report report;
        vertex_normals(mesh.positions, mesh.triangles, {}, normals, report, execution);
        corner_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, of_corners,
                        report, execution);
        vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, of_vertices,
                        report, execution);
    };
    const std::size_t first = peak_of(compute);
    EXPECT_GT(first, of_corners.size() * sizeof(glm::vec4)) << "those of vertex_tangents()";
    // Blocks of memory are exchanged for larger ones at first.
    compute();
    compute();
    // Only small arrays remain: kinds of triangles, classes and ranges.
    EXPECT_LT(peak_of(compute), first / 10);
}

TEST_LABELS(not_sanitized);
TEST(TangentMemory, IsAtMostHalfAsMuchAgainAsInputAndOutput) {
    Mesh welded = test::grid(320);
    // A single duplicate vertex makes triangles over welded vertices necessary.
    welded.positions.push_back(welded.positions[0]);
    welded.normals.push_back(welded.normals[0]);
    welded.texcoords.push_back(welded.texcoords[0]);
    for (const unsigned threads : {1U, 2U}) {
        set_thread_limit(threads);
        // Bytes per triangle by hand: input 28, output 48, and 34 more at the peak: 12 for welded
        // triangles, 12 for corners by vertex, 1 for kinds, 2 for the first corners of vertices,
        // and 2 more for the counts of each thread.
        EXPECT_LT(peak_ratio(welded), 1.45);
        EXPECT_GT(peak_ratio(welded), 1.3) << "the count counts";
        EXPECT_LT(peak_ratio(test::soup(test::grid(320))), 1.5);
    }
    set_thread_limit(0);
}

}  // namespace
}  // namespace relief
