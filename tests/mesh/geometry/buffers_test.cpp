// SPDX-License-Identifier: Apache-2.0
// Normals and tangents on the caller's memory: interleaved vertices, indices of 16 and 32 bits.
#include "relief/mesh/buffers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "relief/mesh/bump.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
namespace {

/// A vertex as engines store it, with fields that are not relief's.
struct Vertex {
    std::uint32_t color = 0xff00ff00U;
    glm::vec3 position;
    glm::vec2 texcoord;
    glm::vec3 normal;
    glm::vec4 tangent{};
    float weight = 0.25F;
};

struct VertexBuffer {
    explicit VertexBuffer(const Mesh& mesh) {
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            vertices.push_back({.position = mesh.positions[v],
                                .texcoord = mesh.texcoords[v],
                                .normal = mesh.normals[v]});
        }
        for (const glm::uvec3& triangle : mesh.triangles) {
            for (int i = 0; i < 3; ++i)
                indices.push_back(static_cast<std::uint16_t>(triangle[i]));
        }
    }
    template <typename Value>
    StridedSpan<Value> all(Value Vertex::*field) {
        return {&(vertices.data()->*field), vertices.size(), sizeof(Vertex)};
    }
    [[nodiscard]] TriangleSpan triangles() const {
        return TriangleSpan(std::span<const std::uint16_t>(indices));
    }

    std::vector<Vertex> vertices;
    std::vector<std::uint16_t> indices;
};

template <typename Value>
std::vector<Value> copied(StridedSpan<Value> values) {
    std::vector<Value> copy;
    for (std::size_t i = 0; i < values.size(); ++i)
        copy.push_back(values[i]);
    return copy;
}

std::string text_of(const Report& report) {
    std::string text;
    for (const Finding& finding : report.findings())
        text += finding.kind + " " + std::to_string(finding.count) + "\n";
    return text;
}

TEST(Buffers, InterleavedVerticesAndShortIndicesGiveTheSameBitsAndFindings) {
    for (const auto& [name, mesh] : test::hard_meshes()) {
        SCOPED_TRACE(name);
        ASSERT_LT(mesh.positions.size(), 65536U);
        VertexBuffer buffer(mesh);
        Report report, buffer_report;
        const auto tangents = mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords,
                                                  mesh.triangles, report);
        EXPECT_TRUE(test::same_bits(
            tangents,
            mikktspace_tangents(buffer.all(&Vertex::position), buffer.all(&Vertex::normal),
                                buffer.all(&Vertex::texcoord), buffer.triangles(), buffer_report)));
        for (const NormalWeight weight : {NormalWeight::area, NormalWeight::angle}) {
            NormalOptions options;
            options.weight = weight;
            const auto normals = vertex_normals(mesh.positions, mesh.triangles, options, report);
            vertex_normals(buffer.all(&Vertex::position), buffer.triangles(), options,
                           buffer.all(&Vertex::normal), buffer_report);
            EXPECT_TRUE(test::same_bits(normals, copied(buffer.all(&Vertex::normal))));
        }
        EXPECT_EQ(text_of(buffer_report), text_of(report));
        for (const Vertex& vertex : buffer.vertices) {
            ASSERT_EQ(vertex.color, 0xff00ff00U);
            ASSERT_EQ(vertex.weight, 0.25F);
        }
    }
}

TEST(Buffers, LargeMeshesWithShortIndicesGiveTheSameBits) {
    // Full blocks of triangles take another path than the last ones.
    const Mesh mesh = test::sphere(200, 150);
    ASSERT_LT(mesh.positions.size(), 65536U);
    VertexBuffer buffer(mesh);
    Report report;
    const auto normals = vertex_normals(mesh.positions, mesh.triangles, NormalWeight::max, report);
    NormalOptions options;
    options.weight = NormalWeight::max;
    vertex_normals(buffer.all(&Vertex::position), buffer.triangles(), options,
                   buffer.all(&Vertex::normal));
    EXPECT_TRUE(test::same_bits(normals, copied(buffer.all(&Vertex::normal))));
}

TEST(Buffers, PlainFloatsAndSignedIndicesGiveTheSameBits) {
    const Mesh mesh = test::sphere(20, 15);
    VertexBuffer buffer(mesh);
    const std::vector<std::int32_t> indices(buffer.indices.begin(), buffer.indices.end());
    const TriangleSpan triangles{std::span<const std::int32_t>(indices)};
    const float* const positions = &buffer.vertices[0].position.x;
    float* const normals = &buffer.vertices[0].normal.x;
    const std::size_t count = buffer.vertices.size();
    vertex_normals({positions, count, sizeof(Vertex)}, triangles, NormalOptions{},
                   {normals, count, sizeof(Vertex)});
    const auto expected = vertex_normals(mesh.positions, mesh.triangles, NormalOptions{});
    EXPECT_TRUE(test::same_bits(expected, copied(buffer.all(&Vertex::normal))));

    using Positions = StridedSpan<const glm::vec3>;
    EXPECT_EQ(Positions(positions, count, sizeof(Vertex))[1], buffer.vertices[1].position);
    EXPECT_EQ(Positions(&mesh.positions[0].x, count).stride(), sizeof(glm::vec3));
    static_assert(std::is_constructible_v<Positions, float*, std::size_t>);
    static_assert(!std::is_constructible_v<StridedSpan<glm::vec3>, const float*, std::size_t>);
    static_assert(!std::is_constructible_v<Positions, const double*, std::size_t>);
    static_assert(!std::is_constructible_v<StridedSpan<int>, float*, std::size_t>);
}

TEST(Buffers, VertexTangentsAreThoseOfTheCorners) {
    const Mesh mesh = test::grid(8);
    VertexBuffer buffer(mesh);
    Report report;
    vertex_tangents(buffer.all(&Vertex::position), buffer.all(&Vertex::normal),
                    buffer.all(&Vertex::texcoord), buffer.triangles(), buffer.all(&Vertex::tangent),
                    report);
    EXPECT_TRUE(report.empty());
    EXPECT_THAT(copied(buffer.all(&Vertex::tangent)),
                testing::Each(glm::vec4(1.0F, 0.0F, 0.0F, 1.0F)));
}

TEST(Buffers, VertexTangentsReportCornersThatDiffer) {
    // Two triangles with upright texture and one with mirrored texture share vertex 0.
    Mesh mesh = test::mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                                {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0F, 0.0F, 1.0F));
    mesh.texcoords.clear();
    for (const glm::vec3& position : mesh.positions)
        mesh.texcoords.emplace_back(position.x, -position.y);
    // The third triangle gets vertices of its own on the rim, with u mirrored.
    for (int i = 1; i < 3; ++i) {
        const std::uint32_t from = mesh.triangles[2][i];
        mesh.triangles[2][i] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(mesh.positions[from]);
        mesh.normals.push_back(mesh.normals[from]);
        mesh.texcoords.emplace_back(-mesh.texcoords[from].x, mesh.texcoords[from].y);
    }
    // A vertex without a triangle, beside vertex 4.
    mesh.positions.emplace_back(9.0F);
    mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    mesh.texcoords.emplace_back(0.0F);

    std::vector<glm::vec4> tangents(mesh.positions.size());
    Report report;
    vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, tangents, report);
    EXPECT_EQ(tangents[mesh.triangles[0].x], glm::vec4(1.0F, 0.0F, 0.0F, 1.0F))
        << "two of three corners";
    EXPECT_EQ(tangents[mesh.triangles[2].y], glm::vec4(-1.0F, 0.0F, 0.0F, -1.0F));
    EXPECT_EQ(tangents.back(), glm::vec4(1.0F, 0.0F, 0.0F, -1.0F));
    EXPECT_EQ(text_of(report),
              "vertex whose corners have different tangents 1\nisolated vertex 2\n");
}

TEST(Buffers, RefuseMemoryOfAnotherSizeAndIndicesBeyondTheVertices) {
    const Mesh mesh = test::grid(1);
    std::vector<glm::vec3> normals(mesh.positions.size() - 1);
    std::vector<glm::vec4> tangents(mesh.positions.size() + 1);
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  vertex_normals(mesh.positions, mesh.triangles, NormalOptions{}, normals);
              }),
              "there is memory for 3 normals, but there are 4 positions");
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                  tangents);
              }),
              "there is memory for 5 tangents, but there are 4 positions");
    const std::vector<std::uint16_t> indices = {0, 1, 2, 2, 1, 4};
    normals.resize(mesh.positions.size());
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  vertex_normals(mesh.positions,
                                 TriangleSpan(std::span<const std::uint16_t>(indices)),
                                 NormalOptions{}, normals);
              }),
              "triangle 1 names vertex 4, but there are only 4");
    const std::vector<std::int32_t> negative = {0, 1, 2, 2, -3, 0};
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  vertex_normals(mesh.positions,
                                 TriangleSpan(std::span<const std::int32_t>(negative)),
                                 NormalOptions{}, normals);
              }),
              "triangle 1 names vertex 4294967293 (-3 as a signed index), but there are only 4");
}

TEST(Buffers, IgnoreSurplusIndicesAndAcceptNoTriangles) {
    const std::vector<std::uint32_t> indices = {7, 8, 9, 1};
    const TriangleSpan triangles{std::span<const std::uint32_t>(indices)};
    ASSERT_EQ(triangles.size(), 1U);
    EXPECT_EQ(triangles[0], glm::uvec3(7, 8, 9));
    EXPECT_TRUE(triangles.subspan(1, 0).empty());
    const std::vector<glm::vec3> positions(2);
    std::vector<glm::vec3> normals(2);
    vertex_normals(positions, TriangleSpan(), NormalOptions{}, normals);
    EXPECT_EQ(normals[1], glm::vec3(0.0F, 0.0F, 1.0F));
}

/// Codes of an image with four bytes of padding after each row, and the top row last in memory.
template <typename Sample>
struct PaddedPixels {
    explicit PaddedPixels(const Image& image)
        : row_size(static_cast<std::size_t>(image.width * image.channels) + 4 / sizeof(Sample)),
          samples(row_size * static_cast<std::size_t>(image.height), Sample(7)),
          width(image.width),
          height(image.height),
          channels(image.channels) {
        const MutableImageView rows = view();
        for (int y = 0; y < height; ++y)
            std::copy_n(ImageView(image).row<Sample>(y), width * channels, rows.row<Sample>(y));
    }
    MutableImageView view() {
        return {&samples[row_size * static_cast<std::size_t>(height - 1)], width, height, channels,
                -static_cast<std::ptrdiff_t>(row_size * sizeof(Sample))};
    }
    ImageView read_only() {
        return {
            static_cast<const Sample*>(&samples[row_size * static_cast<std::size_t>(height - 1)]),
            width, height, channels, -static_cast<std::ptrdiff_t>(row_size * sizeof(Sample))};
    }
    [[nodiscard]] bool is_padding_unchanged() const {
        for (int y = 0; y < height; ++y) {
            const std::size_t end =
                static_cast<std::size_t>(y) * row_size + static_cast<std::size_t>(width * channels);
            for (std::size_t i = end; i < static_cast<std::size_t>(y + 1) * row_size; ++i) {
                if (samples[i] != Sample(7)) return false;
            }
        }
        return true;
    }

    std::size_t row_size;
    std::vector<Sample> samples;
    int width, height, channels;
};

Image waves(int bits) {
    Image image = make_image(150, 90, 1, bits, ColorSpace::data);
    const double most = bits == 8 ? 255.0 : 1.0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double value = most * (0.5 + 0.2 * std::sin(0.2 * x + 0.13 * y) +
                                         0.2 * std::cos(0.3 * y - 0.11 * x));
            if (bits == 8)
                MutableImageView(image).row<std::uint8_t>(y)[x] = static_cast<std::uint8_t>(value);
            else
                MutableImageView(image).row<float>(y)[x] = static_cast<float>(value);
        }
    }
    return image;
}

TEST(Views, PaddedPixelsConvertLikeImages) {
    NormalMapFormat format;
    format.bits = 8;
    Report report;
    for (const bool is_chosen : {false, true}) {
        BumpOptions options;
        options.strength = 9.0;
        if (is_chosen) {
            options.kernel = Kernel::scharr5;
            options.wrap = Wrap::clamp;
        }
        const Image heights = waves(8);
        const Image map = normal_map_from_height(heights, options, format, report);
        PaddedPixels<std::uint8_t> from(heights);
        PaddedPixels<std::uint8_t> to(make_image(150, 90, 3, 8, ColorSpace::data));
        normal_map_from_height(from.read_only(), options, format, to.view(), report,
                               {.threads = 2});
        EXPECT_EQ(part_of(to.read_only(), {0, 0, 150, 90}).samples, map.samples);
        EXPECT_TRUE(to.is_padding_unchanged());
    }
    EXPECT_TRUE(report.empty());
}

TEST(Views, NonFiniteHeightsConvertWithFindings) {
    Image heights = waves(32);
    heights.as<float>()[150 * 40 + 30] = std::numeric_limits<float>::quiet_NaN();
    NormalMapFormat format;
    format.bits = 16;
    Report report, of_view;
    const Image map = normal_map_from_height(heights, {}, format, report);
    PaddedPixels<float> from(heights);
    Image result = make_image(150, 90, 3, 16, ColorSpace::data);
    normal_map_from_height(from.read_only(), {}, format, MutableImageView(result), of_view);
    EXPECT_EQ(result.samples, map.samples);
    EXPECT_EQ(text_of(of_view), text_of(report));
    EXPECT_FALSE(report.empty());
}

TEST(Views, ResultsOfAnotherFormatAreRefused) {
    const Image heights = waves(8);
    NormalMapFormat format;
    format.bits = 16;
    Image result = make_image(150, 90, 3, 8, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  normal_map_from_height(ImageView(heights), {}, format, MutableImageView(result));
              }),
              "the memory for the normal map has 150 x 90 texels of 3 channels with 8 bits, but "
              "must have 150 x 90 of 2 to 4 with 16");
}

/// Returns the texels of three channels with two or four: x and y, or with an opaque alpha.
template <typename Sample>
std::vector<Sample> spread(const Image& map, int channels, Sample opaque) {
    std::vector<Sample> samples;
    const std::span<const Sample> threes = map.as<Sample>();
    for (std::size_t i = 0; i < threes.size(); i += 3) {
        samples.insert(samples.end(), threes.begin() + static_cast<std::ptrdiff_t>(i),
                       threes.begin() + static_cast<std::ptrdiff_t>(i + (channels == 2 ? 2 : 3)));
        if (channels == 4) samples.push_back(opaque);
    }
    return samples;
}

template <typename Sample>
void expect_codes_of_three_channels(const NormalMapFormat& format, Sample opaque) {
    const Image heights = waves(32);
    BumpOptions options;
    options.kernel = Kernel::sobel3;
    options.wrap = Wrap::clamp;
    options.strength = 9.0;
    const Image normals = normals_from_height(heights, options);
    const Image map = normal_map_from_height(heights, options, format);
    const Image encoded = encode_normal_map(normals, format);
    for (const int channels : {2, 4}) {
        SCOPED_TRACE(channels);
        Image result = make_image(150, 90, channels, format.bits, ColorSpace::data);
        normal_map_from_height(ImageView(heights), options, format, MutableImageView(result));
        EXPECT_EQ(std::get<std::vector<Sample>>(result.samples), spread(map, channels, opaque));
        encode_normal_map(normals, format, MutableImageView(result));
        EXPECT_EQ(std::get<std::vector<Sample>>(result.samples), spread(encoded, channels, opaque));
    }
}

TEST(Views, NormalMapsOfTwoAndFourChannelsHaveTheCodesOfThree) {
    expect_codes_of_three_channels<std::uint8_t>({.bits = 8}, 255);
    expect_codes_of_three_channels<std::uint8_t>(
        {.bits = 8, .green = Green::down, .dither = Dither::blue_noise}, 255);
    expect_codes_of_three_channels<std::uint16_t>({.bits = 16}, 65535);
    expect_codes_of_three_channels<float>({.bits = 32}, 1.0F);
}

TEST(Views, PaddedPixelsAreCheckedLikeImages) {
    Report report;
    NormalMapFormat format;
    format.bits = 8;
    format.green = Green::down;
    BumpOptions options;
    options.kernel = Kernel::sobel3;
    const Image map = normal_map_from_height(waves(32), options, format, report);
    const NormalMapCheck expected = check_normal_map(map);
    PaddedPixels<std::uint8_t> pixels(map);
    const NormalMapCheck check = check_normal_map(pixels.read_only());
    EXPECT_EQ(check.green.green, Green::down);
    EXPECT_EQ(check.green.correlation, expected.green.correlation);
    EXPECT_EQ(check.lengths.rms_deviation, expected.lengths.rms_deviation);
    EXPECT_EQ(check.tiling.seam_x, expected.tiling.seam_x);
    EXPECT_EQ(check.bits, expected.bits);
    EXPECT_EQ(text_of(to_report(check)), text_of(to_report(expected)));
}

TEST(Views, PaddedPixelsAreCodedLikeImages) {
    BumpOptions options;
    options.kernel = Kernel::sobel3;
    options.strength = 9.0;
    Image normals = normals_from_height(waves(32), options);
    normals.as<float>()[3 * (150 * 40 + 30) + 2] = std::numeric_limits<float>::quiet_NaN();
    for (const Dither dither : {Dither::none, Dither::ordered}) {
        const NormalMapFormat format{.bits = 8, .green = Green::down, .dither = dither};
        Report of_image, of_view;
        const Image map = encode_normal_map(normals, format, of_image);
        const Image decoded =
            decode_normal_map(map, Green::down, FlatCode::half, of_image, FlatTexels::exact);
        PaddedPixels<float> from(normals);
        PaddedPixels<std::uint8_t> codes(make_image(150, 90, 3, 8, ColorSpace::data));
        encode_normal_map(from.read_only(), format, codes.view(), of_view, {.threads = 2});
        EXPECT_EQ(part_of(codes.read_only(), {0, 0, 150, 90}).samples, map.samples);
        PaddedPixels<float> to(make_image(150, 90, 3, 32, ColorSpace::data));
        decode_normal_map(codes.read_only(), Green::down, FlatCode::half, to.view(), of_view,
                          FlatTexels::exact);
        EXPECT_EQ(part_of(to.read_only(), {0, 0, 150, 90}).samples, decoded.samples);
        EXPECT_TRUE(codes.is_padding_unchanged());
        EXPECT_TRUE(to.is_padding_unchanged());
        EXPECT_EQ(text_of(of_view), text_of(of_image));
        EXPECT_EQ(of_view.count("normal without direction"), 1U);
    }
    Image narrow = make_image(149, 90, 3, 8, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>(
                  [&] { encode_normal_map(normals, {.bits = 8}, MutableImageView(narrow)); }),
              "the memory for the normal map has 149 x 90 texels of 3 channels with 8 bits, but "
              "must have 150 x 90 of 2 to 4 with 8");
    EXPECT_THROW(decode_normal_map(normals, Green::up, FlatCode::half, MutableImageView(narrow)),
                 InvalidInput);
}

TEST(Views, ReportsAreOptional) {
    const Mesh mesh = make_torus();
    Report report;
    EXPECT_EQ(vertex_normals(mesh.positions, mesh.triangles, NormalWeight::area),
              vertex_normals(mesh.positions, mesh.triangles, NormalWeight::area, report));
    EXPECT_EQ(
        mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles),
        mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report));
}

}  // namespace
}  // namespace relief
