// SPDX-License-Identifier: Apache-2.0
// Filling to the border: as padding without a limit, to the bit, and no file is left.
#include "bake/edge_padding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"
#include "support/message_of.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::BakedImage;

/// A few baked texels, one in so many.
BakedImage sparse(std::size_t texels, unsigned one_in) {
    BakedImage image;
    std::mt19937 random(7);
    for (std::size_t i = 0; i < texels; ++i) {
        const bool is_baked = random() % one_in == 0;
        image.states.push_back(is_baked ? TexelState::baked : TexelState::empty);
        const float height = static_cast<float>(random() % 100);
        image.heights.push_back(is_baked ? height : 0.0F);
        const glm::vec3 normal = glm::normalize(glm::vec3(height, 1.0F, 50.0F));
        for (int axis = 0; axis < 3; ++axis)
            image.normals.push_back(is_baked ? normal[axis] : 0.0F);
    }
    return image;
}

/// Hands a map to something that fills it, some rows at a time.
template <typename Filler>
void push(BakedImage image, int width, int height, int rows_at_once, Filler& filler) {
    for (int row = 0; row < height; row += rows_at_once) {
        BakedRows rows;
        rows.first_row = row;
        rows.row_count = std::min(rows_at_once, height - row);
        const auto first = static_cast<std::size_t>(row * width);
        const auto count = static_cast<std::size_t>(rows.row_count * width);
        rows.normals = std::span(image.normals).subspan(3 * first, 3 * count);
        if (!image.heights.empty()) rows.heights = std::span(image.heights).subspan(first, count);
        rows.states = std::span(image.states).subspan(first, count);
        filler.push(rows);
    }
}

BakedImage filled(const BakedImage& image, int width, int height, int rows_at_once,
                  const test::TemporaryDirectory& folder) {
    BakedImage result;
    BorderFill fill(width, height, folder / ".", [&](const BakedRows& rows) {
        EXPECT_TRUE(rows.row_count == 64 || rows.first_row + rows.row_count == height);
        test::append(result, rows);
    });
    push(image, width, height, rows_at_once, fill);
    EXPECT_TRUE(std::filesystem::is_empty(folder / "."));
    return result;
}

TEST(BorderFill, IsPaddingWithoutALimit) {
    const test::TemporaryDirectory folder;
    for (const auto& [width, height, one_in] :
         {std::tuple(61, 150, 60U), {200, 300, 9000U}, {1, 130, 40U}, {90, 1, 30U}}) {
        const BakedImage image = sparse(static_cast<std::size_t>(width * height), one_in);
        ASSERT_GT(image.count(TexelState::baked), 0U);
        BakedImage padded;
        Dilation dilation(width, height, 1024,
                          [&](const BakedRows& rows) { test::append(padded, rows); });
        push(image, width, height, 64, dilation);
        const BakedImage result = filled(image, width, height, 64, folder);
        EXPECT_EQ(result.normals, padded.normals) << width;
        EXPECT_EQ(result.heights, padded.heights);
        EXPECT_EQ(result.states, padded.states);
        EXPECT_EQ(result.count(TexelState::empty), 0U);
        EXPECT_EQ(filled(image, width, height, 128, folder).normals, padded.normals);
    }
}

TEST(BorderFill, LayersThatThereAreNotStayEmptyAndNothingBakedStaysAsItIs) {
    const test::TemporaryDirectory folder;
    BakedImage image = sparse(64 * 70, 500);
    const BakedImage all = filled(image, 64, 70, 64, folder);
    image.heights.clear();
    const BakedImage without = filled(image, 64, 70, 64, folder);
    EXPECT_EQ(without.normals, all.normals);
    EXPECT_TRUE(without.heights.empty());
    image.states.assign(image.states.size(), TexelState::missed);
    const BakedImage none = filled(image, 64, 70, 64, folder);
    EXPECT_EQ(none.states, image.states);
    EXPECT_EQ(none.normals, image.normals);
}

TEST(BorderFill, OfABakeReachesTheBorder) {
    const test::TemporaryDirectory folder;
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord = glm::vec2(0.4F) + 0.1F * texcoord;
    Mesh high = make_quad();
    high.normals.assign(4, glm::normalize(glm::vec3(0.6F, 0, 0.8F)));
    BakeOptions options = test::sized(100, 90);
    options.border_folder = folder / ".";
    const BakedImage image = test::bake({high}, low, options);
    EXPECT_EQ(image.count(TexelState::baked), 90U);
    EXPECT_EQ(image.count(TexelState::padded), 100U * 90U - 90U);
    for (const std::size_t corner : {0UL, 99UL, 8900UL, 8999UL})
        EXPECT_NEAR(image.normal(corner).x, 0.6, 1e-6);
    options.padding = 1;
    EXPECT_EQ(test::message_of<InvalidInput>([&] { test::bake({high}, low, options); }),
              "a map that is filled to its border has no padding, and all rows");
    options = test::sized(40000, 1);
    options.border_folder = folder / ".";
    EXPECT_EQ(test::message_of<InvalidInput>([&] { test::bake({high}, low, options); }),
              "a map of 40000 x 1 texels is too large to be filled: 32768");
    options = test::sized(4, 4);
    options.border_folder = folder / "none";
    EXPECT_THAT(test::message_of<FileError>([&] { test::bake({high}, low, options); }),
                testing::HasSubstr("none: no temporary file can be made: No such file"));
}

}  // namespace
}  // namespace relief
