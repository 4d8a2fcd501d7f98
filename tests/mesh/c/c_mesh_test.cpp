// SPDX-License-Identifier: Apache-2.0
// The C interface of meshes: the results of C++, structs of other versions, and wrong use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "mesh/c/c_usage.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/unwrap.h"
#include "relief/relief.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::HasSubstr;

/// An interleaved vertex, as engines store it.
struct CVertex {
    float position[3], normal[3], texcoord[2], tangent[4], weight;
};

struct CReport {
    std::unique_ptr<relief_report, void (*)(relief_report*)> report{relief_report_create(),
                                                                    relief_report_destroy};
    operator relief_report*() const { return report.get(); }

    /// All findings, one a line.
    [[nodiscard]] std::string text() const {
        std::string lines;
        relief_finding finding{};
        relief_finding_init(&finding, sizeof(finding));
        for (std::size_t i = 0; i < relief_report_count(*this); ++i) {
            EXPECT_EQ(relief_report_finding(*this, i, &finding), RELIEF_OK);
            lines += std::string(finding.text) + "\n";
        }
        return lines;
    }
};

std::string text_of_findings(const Report& report) {
    std::string lines;
    for (const Finding& finding : report.findings())
        lines += to_string(finding) + "\n";
    return lines;
}

/// A mesh in the memory of an engine.
struct EngineMesh {
    explicit EngineMesh(const Mesh& mesh) {
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            CVertex vertex{};
            std::memcpy(vertex.position, &mesh.positions[v], sizeof(vertex.position));
            std::memcpy(vertex.normal, &mesh.normals[v], sizeof(vertex.normal));
            std::memcpy(vertex.texcoord, &mesh.texcoords[v], sizeof(vertex.texcoord));
            vertex.weight = 0.5F;
            vertices.push_back(vertex);
        }
        for (const glm::uvec3& triangle : mesh.triangles) {
            for (int i = 0; i < 3; ++i)
                indices.push_back(static_cast<std::int32_t>(triangle[i]));
        }
        short_indices.assign(indices.begin(), indices.end());
        EXPECT_EQ(relief_mesh_init(&view, sizeof(view)), RELIEF_OK);
        view.vertex_count = vertices.size();
        vertices.emplace_back();  // Empty meshes have an address, too.
        view.triangle_count = mesh.triangles.size();
        view.positions = vertices.data()->position;
        view.normals = vertices.data()->normal;
        view.texcoords = vertices.data()->texcoord;
        view.position_stride = view.normal_stride = view.texcoord_stride = sizeof(CVertex);
        view.indices = indices.data();
        view.index_type = RELIEF_INDEX_INT32;
    }

    std::vector<CVertex> vertices;
    std::vector<std::int32_t> indices;
    std::vector<std::uint16_t> short_indices;
    relief_mesh view{};
};

template <typename Vector>
std::vector<Vector> as_vectors(const std::vector<float>& floats) {
    std::vector<Vector> vectors(floats.size() * sizeof(float) / sizeof(Vector));
    if (floats.empty()) return vectors;
    std::memcpy(static_cast<void*>(vectors.data()), floats.data(), floats.size() * sizeof(float));
    return vectors;
}

TEST(CInterface, IsUsedByStrictC99) {
    const char* const problem = problem_of_c_usage();
    EXPECT_EQ(problem, nullptr) << problem;
}

TEST(CInterface, NormalsAndTangentsHaveTheBitsAndFindingsOfCpp) {
    for (const auto& [name, mesh] : test::hard_meshes()) {
        SCOPED_TRACE(name);
        EngineMesh engine(mesh);
        Report report;
        const CReport c_report;
        const auto tangents = mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords,
                                                  mesh.triangles, report);
        std::vector<float> c_tangents(12 * mesh.triangles.size());
        ASSERT_EQ(relief_corner_tangents(&engine.view, nullptr, c_tangents.data(), c_report),
                  RELIEF_OK)
            << relief_last_error();
        EXPECT_TRUE(test::same_bits(as_vectors<glm::vec4>(c_tangents), tangents));

        std::vector<glm::vec4> by_vertex(mesh.positions.size());
        vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, by_vertex,
                        report);
        ASSERT_EQ(relief_vertex_tangents(&engine.view, nullptr, engine.vertices.data()->tangent,
                                         sizeof(CVertex), c_report),
                  RELIEF_OK);

        const auto normals =
            vertex_normals(mesh.positions, mesh.triangles, NormalOptions{}, report);
        engine.view.indices = engine.short_indices.data();
        engine.view.index_type = RELIEF_INDEX_UINT16;
        ASSERT_EQ(relief_vertex_normals(&engine.view, nullptr, nullptr,
                                        engine.vertices.data()->normal, sizeof(CVertex), c_report),
                  RELIEF_OK);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const CVertex& vertex = engine.vertices[v];
            ASSERT_EQ(std::memcmp(vertex.normal, &normals[v], sizeof(vertex.normal)), 0) << v;
            ASSERT_EQ(std::memcmp(vertex.tangent, &by_vertex[v], sizeof(vertex.tangent)), 0) << v;
            ASSERT_EQ(vertex.weight, 0.5F);
        }
        EXPECT_EQ(c_report.text(), text_of_findings(report));
        EXPECT_STREQ(relief_last_error(), "");
    }
}

TEST(CInterface, NormalOptionsAreThoseOfCpp) {
    const Mesh mesh = test::textured_from_above(test::uneven_cube());
    const EngineMesh engine(mesh);
    relief_normal_options options{};
    ASSERT_EQ(relief_normal_options_init(&options, sizeof(options)), RELIEF_OK);
    std::vector<float> found(3 * mesh.positions.size());
    options.weight = RELIEF_WEIGHT_AUTOMATIC;
    options.weld_tolerance = RELIEF_ABSENT;
    ASSERT_EQ(relief_vertex_normals(&engine.view, &options, nullptr, found.data(), 0, nullptr),
              RELIEF_OK);
    NormalOptions same;
    same.weld_tolerance = std::nullopt;
    EXPECT_TRUE(test::same_bits(as_vectors<glm::vec3>(found),
                                chosen_normals(mesh.positions, mesh.triangles, same).normals));

    options.weight = RELIEF_WEIGHT_AREA_ANGLE;
    options.arithmetic = RELIEF_ARITHMETIC_FLOAT32;
    same.weight = NormalWeight::area_angle;
    same.arithmetic = Arithmetic::float32;
    ASSERT_EQ(relief_vertex_normals(&engine.view, &options, nullptr, found.data(), 0, nullptr),
              RELIEF_OK);
    EXPECT_TRUE(test::same_bits(as_vectors<glm::vec3>(found),
                                vertex_normals(mesh.positions, mesh.triangles, same)));
}

TEST(CInterface, CornersBecomeVertices) {
    const Mesh mesh = test::textured_from_above(test::uneven_cube());
    EngineMesh engine(mesh);
    relief_normal_options options{};
    ASSERT_EQ(relief_normal_options_init(&options, sizeof(options)), RELIEF_OK);
    options.crease_angle = 1.0;
    std::vector<float> corners(9 * mesh.triangles.size());
    ASSERT_EQ(relief_corner_normals(&engine.view, &options, nullptr, corners.data(), nullptr),
              RELIEF_OK);
    HardEdges hard_edges;
    hard_edges.crease_angle = 1.0;
    const auto expected =
        corner_normals(mesh.positions, mesh.triangles, NormalWeight::angle, {}, hard_edges).normals;
    EXPECT_TRUE(test::same_bits(as_vectors<glm::vec3>(corners), expected));

    const VertexSplit split =
        split_where_corners_differ(mesh.positions.size(), mesh.triangles, expected);
    ASSERT_EQ(split.source_vertex.size(), 24U);
    std::size_t count = 0;
    std::vector<std::uint32_t> sources(mesh.positions.size());
    const std::vector<std::int32_t> before = engine.indices;
    auto* const indices = reinterpret_cast<std::uint32_t*>(engine.indices.data());
    EXPECT_EQ(relief_split_vertices(&engine.view, corners.data(), 3, indices, sources.data(),
                                    sources.size(), &count),
              RELIEF_INVALID_INPUT);
    EXPECT_STREQ(relief_last_error(), "the capacity is 8, but there are 24 vertices");
    EXPECT_EQ(engine.indices, before);
    sources.resize(count);
    ASSERT_EQ(relief_split_vertices(&engine.view, corners.data(), 3, indices, sources.data(),
                                    sources.size(), &count),
              RELIEF_OK);
    EXPECT_EQ(sources, split.source_vertex);
    EXPECT_EQ(
        std::memcmp(indices, split.triangles.data(), split.triangles.size() * sizeof(glm::uvec3)),
        0);
}

TEST(CInterface, UnwrapsAsCpp) {
    const Mesh mesh = test::textured_from_above(test::uneven_cube());
    const EngineMesh engine(mesh);
    relief_unwrap_options options{};
    ASSERT_EQ(relief_unwrap_options_init(&options, sizeof(options)), RELIEF_OK);
    options.width = 256;
    options.height = 128;
    options.padding = 2;
    options.flattening = RELIEF_FLATTENING_CONFORMAL;
    std::vector<float> texcoords(6 * mesh.triangles.size());
    std::vector<std::uint32_t> charts(mesh.triangles.size());
    relief_atlas_stats stats{};
    ASSERT_EQ(relief_atlas_stats_init(&stats, sizeof(stats)), RELIEF_OK);
    ASSERT_EQ(relief_unwrap(&engine.view, &options, nullptr, texcoords.data(), charts.data(),
                            &stats, nullptr),
              RELIEF_OK)
        << relief_last_error();
    UnwrapOptions same;
    same.flattening = Flattening::conformal;
    same.size = {256, 128};
    same.padding = 2;
    const Unwrapped expected = unwrap(mesh, same);
    EXPECT_TRUE(test::same_bits(as_vectors<glm::vec2>(texcoords), expected.corner_texcoords));
    for (std::size_t i = 0; i < charts.size(); ++i)
        EXPECT_EQ(charts[i], expected.chart[i].value_or(RELIEF_NO_CHART));
    EXPECT_EQ(stats.charts, expected.stats.charts);
    EXPECT_EQ(stats.used, expected.stats.used);
    EXPECT_EQ(stats.area, expected.stats.area);
    EXPECT_EQ(stats.size, sizeof(stats));
}

TEST(CInterface, EmptyMeshesAreValid) {
    relief_mesh mesh{};
    ASSERT_EQ(relief_mesh_init(&mesh, sizeof(mesh)), RELIEF_OK);
    EXPECT_EQ(relief_vertex_normals(&mesh, nullptr, nullptr, nullptr, 0, nullptr), RELIEF_OK);
    EXPECT_EQ(relief_corner_normals(&mesh, nullptr, nullptr, nullptr, nullptr), RELIEF_OK);
    EXPECT_EQ(relief_vertex_tangents(&mesh, nullptr, nullptr, 0, nullptr), RELIEF_OK);
    EXPECT_EQ(relief_corner_tangents(&mesh, nullptr, nullptr, nullptr), RELIEF_OK);
}

/// Calls relief_vertex_normals() on a changed mesh of 4 vertices and 2 triangles.
struct WrongMesh {
    const char* message;
    std::function<void(EngineMesh& engine, float*& normals, std::size_t& stride)> change;
};

TEST(CInterface, RefusesWrongMemory) {
    const WrongMesh rows[] = {
        {"the positions are NULL",
         [](auto& engine, auto&, auto&) { engine.view.positions = nullptr; }},
        {"the indices are NULL", [](auto& engine, auto&, auto&) { engine.view.indices = nullptr; }},
        {"the output normals are NULL", [](auto&, auto& normals, auto&) { normals = nullptr; }},
        {"the stride of the positions is 8 bytes, but must be at least 12, or 0 for contiguous "
         "elements",
         [](auto& engine, auto&, auto&) { engine.view.position_stride = 8; }},
        {"the stride of the output normals is 4 bytes, but must be at least 12, or 0 for "
         "contiguous elements",
         [](auto&, auto&, auto& stride) { stride = 4; }},
        {"with the stride 14, but both must be multiples of 4",
         [](auto& engine, auto&, auto&) { engine.view.position_stride = 14; }},
        {"but both must be multiples of 4",
         [](auto& engine, auto&, auto&) {
             const auto* const bytes = reinterpret_cast<const char*>(engine.view.positions);
             engine.view.positions = reinterpret_cast<const float*>(bytes + 1);
         }},
        {"positions do not fit into memory",
         [](auto& engine, auto&, auto&) {
             engine.view.vertex_count = std::numeric_limits<std::size_t>::max() / 8;
         }},
        {"triangles do not fit into memory",
         [](auto& engine, auto&, auto&) {
             engine.view.triangle_count = std::numeric_limits<std::size_t>::max() / 3;
         }},
        {"the output normals overlap the positions",
         [](auto& engine, auto& normals, auto& stride) {
             normals = engine.vertices.data()->position + 1;
             stride = sizeof(CVertex);
         }},
        {"the output normals overlap the positions",
         [](auto& engine, auto& normals, auto& stride) {
             normals = engine.vertices.data()->normal;
             stride = 0;
         }},
        {"the output normals overlap the indices",
         [](auto& engine, auto& normals, auto&) {
             normals = reinterpret_cast<float*>(engine.indices.data()) + 3;
         }},
        {"triangle 0 names vertex 4294967295 (-1 as a signed index), but there are only 4",
         [](auto& engine, auto&, auto&) { engine.indices[2] = -1; }},
        {"triangle 1 names vertex 4, but there are only 4",
         [](auto& engine, auto&, auto&) { engine.indices[4] = 4; }},
        {"index_type is 3, but must be within 0 to 2",
         [](auto& engine, auto&, auto&) { engine.view.index_type = 3; }},
        {"relief_mesh: the reserved field is 1, but must be 0",
         [](auto& engine, auto&, auto&) { engine.view.reserved = 1; }},
        {"relief_mesh: the size is 0, but must be at least",
         [](auto& engine, auto&, auto&) { engine.view.size = 0; }},
    };
    for (const WrongMesh& row : rows) {
        SCOPED_TRACE(row.message);
        EngineMesh engine(test::textured_from_above(test::square()));
        std::vector<float> memory(12);
        float* normals = memory.data();
        std::size_t stride = 0;
        row.change(engine, normals, stride);
        EXPECT_EQ(relief_vertex_normals(&engine.view, nullptr, nullptr, normals, stride, nullptr),
                  RELIEF_INVALID_INPUT);
        EXPECT_THAT(relief_last_error(), HasSubstr(row.message));
    }
    EXPECT_EQ(relief_vertex_normals(nullptr, nullptr, nullptr, nullptr, 0, nullptr),
              RELIEF_INVALID_INPUT);
    EXPECT_STREQ(relief_last_error(), "the mesh is NULL");
}

TEST(CInterface, RefusesWrongOptions) {
    const EngineMesh engine(test::textured_from_above(test::square()));
    std::vector<float> normals(12);
    const auto message_with = [&](const std::function<void(relief_normal_options&)>& change) {
        relief_normal_options options{};
        EXPECT_EQ(relief_normal_options_init(&options, sizeof(options)), RELIEF_OK);
        change(options);
        EXPECT_EQ(
            relief_vertex_normals(&engine.view, &options, nullptr, normals.data(), 0, nullptr),
            RELIEF_INVALID_INPUT);
        return std::string(relief_last_error());
    };
    EXPECT_EQ(message_with([](auto& options) { options.weight = 7; }),
              "weight is 7, but must be within 0 to 6");
    EXPECT_EQ(message_with([](auto& options) { options.arithmetic = RELIEF_ARITHMETIC_AUTOMATIC; }),
              "arithmetic is -1, but must be within 0 to 1");
    EXPECT_THAT(message_with([](auto& options) { options.weld_tolerance = std::nan(""); }),
                HasSubstr("nan"));
    EXPECT_THAT(message_with([](auto& options) { options.weld_tolerance = -2.0; }),
                HasSubstr("-2"));
    EXPECT_EQ(message_with([](auto& options) { options.crease_angle = 0.5; }),
              "crease_angle: a vertex has one normal here (use relief_corner_normals())");
    relief_mesh bare = engine.view;
    bare.texcoords = nullptr;
    std::vector<float> tangents(24);
    EXPECT_EQ(relief_corner_tangents(&bare, nullptr, tangents.data(), nullptr),
              RELIEF_INVALID_INPUT);
    EXPECT_STREQ(relief_last_error(), "the texture coordinates are NULL");
    std::size_t count = 0;
    EXPECT_EQ(relief_split_vertices(&engine.view, normals.data(), 5, nullptr, nullptr, 0, &count),
              RELIEF_INVALID_INPUT);
    EXPECT_STREQ(relief_last_error(), "components is 5, but must be within 2 to 4");
    relief_unwrap_options unwrap_options{};
    ASSERT_EQ(relief_unwrap_options_init(&unwrap_options, sizeof(unwrap_options)), RELIEF_OK);
    unwrap_options.max_stretch = std::nan("");
    EXPECT_EQ(relief_unwrap(&engine.view, &unwrap_options, nullptr, tangents.data(), nullptr,
                            nullptr, nullptr),
              RELIEF_INVALID_INPUT);
    EXPECT_EQ(relief_report_finding(nullptr, 0, nullptr), RELIEF_INVALID_INPUT);
    relief_report_clear(nullptr);
    relief_report_destroy(nullptr);
    EXPECT_EQ(relief_report_count(nullptr), 0U);
}

TEST(CInterface, AcceptsStructsOfOtherVersions) {
    struct LaterOptions {
        relief_normal_options options;
        double later;
    };
    const EngineMesh engine(test::textured_from_above(test::square()));
    std::vector<float> normals(12);
    LaterOptions later{};
    std::memset(static_cast<void*>(&later), 0xff, sizeof(later));
    ASSERT_EQ(relief_normal_options_init(&later.options, sizeof(later)), RELIEF_OK);
    EXPECT_EQ(later.options.size, sizeof(later));
    EXPECT_EQ(later.later, 0.0);
    EXPECT_EQ(
        relief_vertex_normals(&engine.view, &later.options, nullptr, normals.data(), 0, nullptr),
        RELIEF_OK);
    later.later = 1.0;
    EXPECT_EQ(
        relief_vertex_normals(&engine.view, &later.options, nullptr, normals.data(), 0, nullptr),
        RELIEF_INVALID_INPUT);
    EXPECT_STREQ(relief_last_error(),
                 "relief_normal_options: a field is set that version " RELIEF_VERSION
                 " does not have");
    EXPECT_EQ(relief_normal_options_init(&later.options, sizeof(later.options) - 1),
              RELIEF_INVALID_INPUT);
    EXPECT_EQ(relief_normal_options_init(&later.options, 5000), RELIEF_INVALID_INPUT);
    EXPECT_EQ(relief_normal_options_init(nullptr, sizeof(later)), RELIEF_INVALID_INPUT);
}

// A struct that grows needs its former size as `first_size` in c_call.h.
TEST(CInterface, StructsHaveTheSizesOfTheFirstVersion) {
    if (sizeof(void*) != 8) GTEST_SKIP() << "for 64-bit pointers";
    EXPECT_EQ(sizeof(relief_finding), 64U);
    EXPECT_EQ(sizeof(relief_execution), 32U);
    EXPECT_EQ(sizeof(relief_mesh), 104U);
    EXPECT_EQ(sizeof(relief_normal_options), 32U);
    EXPECT_EQ(sizeof(relief_unwrap_options), 56U);
    EXPECT_EQ(sizeof(relief_atlas_stats), 64U);
    EXPECT_EQ(sizeof(relief_image), 32U);
    EXPECT_EQ(sizeof(relief_output_image), 32U);
    EXPECT_EQ(sizeof(relief_bump_options), 64U);
    // These have grown.
    EXPECT_EQ(offsetof(relief_bake_options, thickness_distance), 96U);
    EXPECT_EQ(offsetof(relief_bake_maps, bent_normals), 112U);
    EXPECT_EQ(offsetof(relief_bake_result, occlusion_rays), 64U);
}

TEST(CInterface, ProgressCancels) {
    const EngineMesh engine(test::textured_from_above(test::sphere(64, 32)));
    std::vector<float> normals(3 * engine.view.vertex_count);
    struct Calls {
        int count = 0;
        std::int32_t answer = 0;
        std::string stage;
    } calls;
    relief_execution execution{};
    ASSERT_EQ(relief_execution_init(&execution, sizeof(execution)), RELIEF_OK);
    execution.threads = 1;
    execution.user = &calls;
    execution.progress = [](void* user, const char* stage, double) {
        Calls& called = *static_cast<Calls*>(user);
        ++called.count;
        if (*stage != '\0') called.stage = stage;
        return called.answer;
    };
    EXPECT_EQ(relief_vertex_normals(&engine.view, nullptr, &execution, normals.data(), 0, nullptr),
              RELIEF_OK);
    EXPECT_GT(calls.count, 0);
    EXPECT_EQ(calls.stage, "normals");
    calls.answer = 1;
    EXPECT_EQ(relief_vertex_normals(&engine.view, nullptr, &execution, normals.data(), 0, nullptr),
              RELIEF_CANCELLED);
    EXPECT_STREQ(relief_last_error(), "cancelled");
}

TEST(CInterface, MessagesBelongToTheThread) {
    EXPECT_EQ(relief_mesh_init(nullptr, 0), RELIEF_INVALID_INPUT);
    std::string of_other = "unset";
    std::thread([&] { of_other = relief_last_error(); }).join();
    EXPECT_EQ(of_other, "");
    EXPECT_STREQ(relief_last_error(), "relief_mesh is NULL");
    relief_mesh mesh{};
    EXPECT_EQ(relief_mesh_init(&mesh, sizeof(mesh)), RELIEF_OK);
    EXPECT_STREQ(relief_last_error(), "");
}

}  // namespace
}  // namespace relief
