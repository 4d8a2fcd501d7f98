// SPDX-License-Identifier: Apache-2.0
// The samples in data/ are reproducible byte for byte, tile without seams, and are closed and
// undistorted.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/glm.hpp>
#include <map>
#include <tuple>

#include "relief/mesh/diagnose.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/texel_coverage.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
namespace {

FILE_LABELS(not_sanitized);

const std::filesystem::path data = test::source_directory() / "data";

TEST_LABELS(slow);
TEST(SampleData, TheProgramWritesTheSameFilesAgain) {
    const test::TemporaryDirectory folder;
    const std::string command = fmt::format("{} {}", RELIEF_MAKE_DATA, folder.path().string());
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::size_t compared = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
        if (!entry.is_regular_file()) continue;
        const std::filesystem::path name = entry.path().lexically_relative(folder.path());
        EXPECT_TRUE(test::read_bytes(entry.path()) == test::read_bytes(data / name)) << name;
        ++compared;
    }
    EXPECT_EQ(compared, 16U);
}

/// Returns the mean difference of adjacent columns (or rows): across the seam, and the largest one
/// inside.
std::pair<double, double> steps(const Image& image, bool turned) {
    const Image heights = to_float(image);
    const int columns = turned ? image.height : image.width;
    const int rows = turned ? image.width : image.height;
    const auto step = [&](int from, int to) {
        double sum = 0.0;
        for (int row = 0; row < rows; ++row) {
            for (int channel = 0; channel < image.channels; ++channel) {
                const auto at = [&](int column) {
                    const int x = turned ? row : column;
                    const int y = turned ? column : row;
                    return heights.as<float>()[static_cast<std::size_t>(
                        (y * image.width + x) * image.channels + channel)];
                };
                sum += std::abs(at(from) - at(to));
            }
        }
        return sum;
    };
    double inside = 0.0;
    for (int column = 0; column + 1 < columns; ++column)
        inside = std::max(inside, step(column, column + 1));
    return {step(columns - 1, 0), inside};
}

TEST(SampleData, TheBricksTileBothWays) {
    for (const char* name : {"bricks-height.png", "bricks-diffuse.png"}) {
        const Image image = read_image(data / name, ImageUse::data);
        for (const bool turned : {false, true}) {
            const auto [seam, inside] = steps(image, turned);
            EXPECT_LT(seam, inside) << name;
        }
    }
}

TEST(SampleData, HeightsAre16BitGrayAndUseTheirRange) {
    const Image image = read_image(data / "bricks-height.png", ImageUse::data);
    EXPECT_EQ(image.width, 1024);
    EXPECT_EQ(image.height, 1024);
    EXPECT_EQ(image.channels, 1);
    EXPECT_EQ(image.bits(), 16);
    const auto [low, high] =
        std::minmax_element(image.as<std::uint16_t>().begin(), image.as<std::uint16_t>().end());
    EXPECT_LT(*low, 12000);
    EXPECT_GT(*high, 60000);
}

struct FacePoint {
    int face;
    double s, t;  ///< From -1 to 1, right and down.
};

glm::dvec3 direction_of(FacePoint p) {
    const glm::dvec3 directions[] = {{1, -p.t, -p.s}, {-1, -p.t, p.s}, {p.s, 1, p.t},
                                     {p.s, -1, -p.t}, {p.s, -p.t, 1},  {-p.s, -p.t, -1}};
    return directions[p.face];
}

/// The table of OpenGL: the major axis selects the face, and the other two give s and t.
FacePoint point_of(glm::dvec3 d) {
    const glm::dvec3 a = glm::abs(d);
    if (a.x >= a.y && a.x >= a.z)
        return {d.x > 0 ? 0 : 1, (d.x > 0 ? -d.z : d.z) / a.x, -d.y / a.x};
    if (a.y >= a.z) return {d.y > 0 ? 2 : 3, d.x / a.y, (d.y > 0 ? d.z : -d.z) / a.y};
    return {d.z > 0 ? 4 : 5, (d.z > 0 ? d.x : -d.x) / a.z, -d.y / a.z};
}

TEST(SampleData, TheFacesOfTheSkyMeetWithoutASeam) {
    std::vector<Image> faces;
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"})
        faces.push_back(read_image(data / "sky" / (std::string(name) + ".jpg"), ImageUse::color));
    const int size = faces[0].width;
    const auto color = [&](int face, int column, int row) {
        const std::span<const std::uint8_t> all =
            std::as_const(faces[static_cast<std::size_t>(face)]).as<std::uint8_t>();
        const auto first = static_cast<std::size_t>((row * size + column) * 3);
        return glm::dvec3(all[first], all[first + 1], all[first + 2]);
    };
    const auto across = [&](int face, int column, int row) {
        const FacePoint beyond = point_of(direction_of(
            {face, 2.0 * (column + 0.5) / size - 1.0, 2.0 * (row + 0.5) / size - 1.0}));
        const auto texel = [&](double at) {
            return std::clamp(static_cast<int>((at + 1.0) / 2.0 * size), 0, size - 1);
        };
        return color(beyond.face, texel(beyond.s), texel(beyond.t));
    };
    for (int face = 0; face < 6; ++face) {
        EXPECT_EQ(faces[static_cast<std::size_t>(face)].height, size);
        double seam = 0.0;
        for (int at = 0; at < size; ++at) {
            seam += glm::length(color(face, 0, at) - across(face, -1, at));
            seam += glm::length(color(face, size - 1, at) - across(face, size, at));
            seam += glm::length(color(face, at, 0) - across(face, at, -1));
            seam += glm::length(color(face, at, size - 1) - across(face, at, size));
        }
        // Neighbors differ by 1 to 3 codes, and the blocks of JPEG by as much again. A rotated or
        // mirrored face would differ by more than 20.
        EXPECT_LT(seam / (4.0 * size), 6.0) << face;
    }
}

/// Checks that every edge has two triangles with opposite directions. \return the volume
double enclosed(const Mesh& mesh) {
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> directed;
    const auto point = [&](std::uint32_t vertex) {
        const glm::vec3 p = mesh.positions[vertex];
        return Point{p.x, p.y, p.z};
    };
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            ++directed[{point(triangle[corner]), point(triangle[(corner + 1) % 3])}];
    }
    std::size_t open = 0;
    for (const auto& [edge, count] : directed) {
        if (count != 1 || !directed.contains({edge.second, edge.first})) ++open;
    }
    EXPECT_EQ(open, 0U);
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles)
        volume +=
            glm::dot(glm::dvec3(mesh.positions[t.x]),
                     glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
            6.0;
    return volume;
}

TEST(SampleData, TheVaseIsClosedAndConsistentlyWound) {
    Report report;
    const Mesh mesh = read_mesh(data / "vase.obj", report).mesh;
    EXPECT_TRUE(report.empty());
    EXPECT_GT(mesh.triangles.size(), 3000U);
    EXPECT_LT(mesh.triangles.size(), 8000U);
    // The triangles are counter-clockwise from outside: the enclosed volume is positive.
    EXPECT_GT(enclosed(mesh), 0.05);
}

TEST(SampleData, TheUrnsAreClosedAndOneShape) {
    Report report;
    const Mesh high = read_mesh(data / "urn-high.ply", report).mesh;
    const Mesh low = read_mesh(data / "urn-low.obj", report).mesh;
    EXPECT_TRUE(report.empty());
    EXPECT_EQ(high.triangles.size(), 26800U);
    EXPECT_EQ(low.triangles.size(), 720U);
    // Carvings of at most 0.03 on a body of radius 0.5 add a few hundredths, and facets remove
    // some.
    const double plain = enclosed(low);
    EXPECT_GT(plain, 0.4);
    EXPECT_GT(enclosed(high), plain);
    EXPECT_LT(enclosed(high), 1.1 * plain);
}

TEST(SampleData, TheFossilIsAClosedScanWithColors) {
    Report report;
    const Mesh mesh = read_mesh(data / "fossil.ply", report).mesh;
    EXPECT_TRUE(report.empty());
    EXPECT_EQ(mesh.triangles.size(), 300304U);
    EXPECT_TRUE(mesh.texcoords.empty());
    EXPECT_EQ(mesh.colors.size(), mesh.positions.size());
    // A pillow of 1.12 x 0.23 x 0.96, of which the shells cover a part.
    EXPECT_GT(enclosed(mesh), 0.1);
    EXPECT_LT(enclosed(mesh), 0.2);
    EXPECT_TRUE(diagnose(mesh).conditions.empty());
}

TEST(SampleData, TheUrnsChartsLieApart) {
    Report report;
    const Mesh low = read_mesh(data / "urn-low.obj", report).mesh;
    constexpr int side = 256;
    const Coverage coverage = cover_texels(
        low.texcoords, low.triangles, {.width = side, .height = side}, [](int, auto) {}, report);
    EXPECT_EQ(coverage.shared, 0U);
    EXPECT_TRUE(report.empty());
    EXPECT_GT(coverage.inside, std::size_t{side * side * 7 / 10});
    for (const glm::uvec3& t : low.triangles) {
        const glm::dvec2 a = low.texcoords[t.y] - low.texcoords[t.x];
        const glm::dvec2 b = low.texcoords[t.z] - low.texcoords[t.x];
        EXPECT_LT(a.x * b.y - a.y * b.x, 0.0) << "mirrored";
    }
}

TEST(SampleData, TheVaseNeverStretchesNorMirrorsItsTexture) {
    Report report;
    const Mesh mesh = read_mesh(data / "vase.obj", report).mesh;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.y] - mesh.positions[t.x];
        const glm::dvec3 b = mesh.positions[t.z] - mesh.positions[t.x];
        const glm::dvec3 x = glm::normalize(a);
        const glm::dvec3 y = glm::normalize(glm::cross(glm::cross(a, b), a));
        const glm::dmat2 surface(glm::length(a), 0.0, glm::dot(b, x), glm::dot(b, y));
        const glm::dmat2 texture(mesh.texcoords[t.y] - mesh.texcoords[t.x],
                                 mesh.texcoords[t.z] - mesh.texcoords[t.x]);
        const glm::dmat2 mapping = texture * glm::inverse(surface);
        // v grows downwards, so an unmirrored texture has a negative determinant.
        EXPECT_LT(glm::determinant(mapping), 0.0);
        // The two singular values are equal if (p, q) below is zero.
        const double p = mapping[0][0] + mapping[1][1];
        const double q = mapping[0][1] - mapping[1][0];
        const double r = mapping[0][0] - mapping[1][1];
        const double s = mapping[0][1] + mapping[1][0];
        const double sum = std::hypot(r, s);
        const double difference = std::hypot(p, q);
        EXPECT_LT((sum + difference) / (sum - difference), 1.15);
    }
}

// The inner wall must not come through the outer one, where it would be seen at the silhouette.
TEST(SampleData, VaseHasAThickWall) {
    Report report;
    const Mesh mesh = read_mesh(data / "vase.obj", report).mesh;
    // The profile from the foot up the outside, over the lip and down the inside, at u = 0.
    std::vector<glm::vec2> outside;
    std::vector<glm::vec2> inside;
    float highest = 0.0F;
    bool is_inside = false;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3& position = mesh.positions[v];
        if (mesh.texcoords[v].x != 0.0F || position.x != 0.0F) continue;
        is_inside = is_inside || position.y < highest;
        highest = std::max(highest, position.y);
        (is_inside ? inside : outside).emplace_back(position.z, position.y);
    }
    std::size_t compared = 0;
    for (const glm::vec2& point : inside) {
        for (std::size_t i = 1; i < outside.size(); ++i) {
            const glm::vec2& low = outside[i - 1];
            const glm::vec2& high = outside[i];
            if (!(low.y <= point.y && point.y < high.y)) continue;
            const float radius = glm::mix(low.x, high.x, (point.y - low.y) / (high.y - low.y));
            EXPECT_GT(radius - point.x, 0.01F) << point.y;
            ++compared;
        }
    }
    EXPECT_GT(compared, 15U);
}

TEST(SampleData, VaseNamesItsTexture) {
    Report report;
    const MeshFile file = read_mesh(data / "vase.obj", report);
    ASSERT_EQ(file.materials.size(), 1U);
    ASSERT_TRUE(file.materials[0].diffuse_map.has_value());
    EXPECT_TRUE(
        std::filesystem::equivalent(*file.materials[0].diffuse_map, data / "bricks-diffuse.png"));
}

}  // namespace
}  // namespace relief
