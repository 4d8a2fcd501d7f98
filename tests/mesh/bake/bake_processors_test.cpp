// SPDX-License-Identifier: Apache-2.0
// A bake has the same bytes on every processor: with each of Embree's instruction sets that this
// one has, each size of packets, each order of triangles. The models are the hard ones: each
// triangle has its own normal and color, and rays meet edges and vertices exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake_layers.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::sized;

/// An environment variable for a while.
class Environment {
  public:
    Environment(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        setenv(name, value.c_str(), 1);
    }
    ~Environment() {
        if (before_)
            setenv(name_, before_->c_str(), 1);
        else
            unsetenv(name_);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

  private:
    const char* name_;
    std::optional<std::string> before_;
};

std::vector<std::string> instruction_sets() {
    __builtin_cpu_init();
    std::vector<std::string> sets = {"sse2"};
    if (__builtin_cpu_supports("sse4.2")) sets.emplace_back("sse4.2");
    if (__builtin_cpu_supports("avx")) sets.emplace_back("avx");
    if (__builtin_cpu_supports("avx2")) sets.emplace_back("avx2");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
        sets.emplace_back("avx512");
    return sets;
}

/// Three vertices for each triangle, with its normal and a color of its own.
Mesh faceted(const Mesh& smooth, unsigned seed) {
    std::mt19937 random(seed);
    Mesh mesh;
    for (const glm::uvec3& triangle : smooth.triangles) {
        const glm::vec3& a = smooth.positions[triangle.x];
        const glm::vec3& b = smooth.positions[triangle.y];
        const glm::vec3& c = smooth.positions[triangle.z];
        const glm::vec3 cross = glm::cross(b - a, c - a);
        if (glm::length(cross) == 0.0F) continue;
        const glm::vec4 color(static_cast<float>(random() % 256) / 255.0F,
                              static_cast<float>(random() % 256) / 255.0F,
                              static_cast<float>(random() % 256) / 255.0F, 1.0F);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        for (const glm::vec3& corner : {a, b, c}) {
            mesh.positions.push_back(corner);
            mesh.normals.push_back(glm::normalize(cross));
            mesh.colors.push_back(color);
        }
    }
    return mesh;
}

/// The same triangles in another order.
Mesh shuffled(Mesh mesh, unsigned seed) {
    std::mt19937 random(seed);
    for (std::size_t i = mesh.triangles.size(); i > 1; --i)
        std::swap(mesh.triangles[i - 1], mesh.triangles[random() % i]);
    return mesh;
}

Mesh merged(Mesh mesh, const Mesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
    mesh.colors.insert(mesh.colors.end(), more.colors.begin(), more.colors.end());
    for (const glm::uvec3& triangle : more.triangles)
        mesh.triangles.push_back(triangle + first);
    return mesh;
}

/// Columns of different heights with upright walls, `cells` to a side of the square from -1 to 1.
Mesh steps(int cells) {
    Mesh mesh;
    const auto quad = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                          const glm::vec3& d) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    };
    const auto at = [&](int i) {
        return 2.0F * static_cast<float>(i) / static_cast<float>(cells) - 1.0F;
    };
    const auto height = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= cells || y >= cells) return -0.25F;
        return static_cast<float>((x * 5 + y * 3) % 4) / 30.0F;
    };
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            const float z = height(x, y);
            const float l = at(x), r = at(x + 1), b = at(y), t = at(y + 1);
            quad({l, b, z}, {r, b, z}, {r, t, z}, {l, t, z});
            const float right = height(x + 1, y), left = height(x - 1, y);
            const float above = height(x, y + 1), below = height(x, y - 1);
            if (right < z) quad({r, b, z}, {r, b, right}, {r, t, right}, {r, t, z});
            if (left < z) quad({l, t, z}, {l, t, left}, {l, b, left}, {l, b, z});
            if (above < z) quad({r, t, z}, {r, t, above}, {l, t, above}, {l, t, z});
            if (below < z) quad({l, b, z}, {l, b, below}, {r, b, below}, {r, b, z});
        }
    }
    return mesh;
}

struct Model {
    const char* name;
    Mesh high, low;
    int side;
};

/// In most of them, rows and columns of texel centers lie on edges, and some on vertices.
std::vector<Model> models() {
    std::vector<Model> all;
    all.push_back({"cube", faceted(make_cube(), 1), make_cube(), 24});
    all.push_back({"steps", faceted(steps(8), 2), make_quad(), 36});
    all.push_back({"steps whose corners are rounded", faceted(steps(6), 3), make_quad(), 30});
    all.push_back({"sphere", faceted(make_sphere(12, 6), 4), make_sphere(12, 6), 36});
    all.push_back(
        {"sphere in a finer one", faceted(make_sphere(16, 8), 5), make_sphere(24, 12), 40});
    const Mesh twice = merged(faceted(steps(4), 6), faceted(steps(4), 7));
    all.push_back({"steps, each triangle twice in other colors", twice, make_quad(), 20});
    Mesh turned = faceted(make_quad(4), 8);
    for (glm::uvec3& triangle : turned.triangles)
        std::swap(triangle.x, triangle.y);
    for (glm::vec3& normal : turned.normals)
        normal = -normal;
    all.push_back(
        {"sheet with two faces", merged(faceted(make_quad(4), 9), turned), make_quad(), 20});
    return all;
}

BakedImage baked(const Mesh& high, const Model& model, std::size_t map_count = 1) {
    BakeOptions options = sized(model.side, model.side);
    options.samples = 4;
    options.layers.occlusion = OcclusionOptions{.rays = 16, .distance = {}};
    options.layers.curvature = true;
    options.layers.positions = true;
    options.layers.colors = true;
    options.padding = 2;
    options.map_count = map_count;
    return bake({high}, model.low, options);
}

/// In words, which layers of two bakes differ.
std::string differences(const BakedImage& a, const BakedImage& b) {
    std::string all;
    if (a.normals != b.normals) all += " normals";
    if (a.heights != b.heights) all += " heights";
    if (a.occlusion != b.occlusion) all += " occlusion";
    if (a.curvature != b.curvature) all += " curvature";
    if (a.positions != b.positions) all += " positions";
    if (a.colors != b.colors) all += " colors";
    if (a.states != b.states) all += " states";
    return all;
}

TEST(BakeProcessors, EveryInstructionSetPacketAndOrderGivesTheSameBytes) {
    for (const Model& model : models()) {
        const BakedImage expected = baked(model.high, model);
        EXPECT_GT(expected.count(TexelState::baked), 100U) << model.name;
        for (const std::string& isa : instruction_sets()) {
            const Environment device("RELIEF_EMBREE", "isa=" + isa);
            for (const char* rays : {"1", "4", "8", "16"}) {
                const Environment packet("RELIEF_RAY_PACKET", rays);
                EXPECT_EQ(differences(baked(model.high, model), expected), "")
                    << model.name << ", " << isa << ", packets of " << rays;
            }
        }
    }
}

TEST(BakeProcessors, TheOrderOfTrianglesAndTheBuildOfTheSceneChangeNoByte) {
    for (const Model& model : models()) {
        const BakedImage expected = baked(model.high, model);
        for (const unsigned seed : {11U, 12U, 13U}) {
            EXPECT_EQ(differences(baked(shuffled(model.high, seed), model), expected), "")
                << model.name << ", " << seed;
        }
        EXPECT_EQ(differences(baked(model.high, model, 1'000'000), expected), "") << model.name;
    }
}

}  // namespace
}  // namespace relief
