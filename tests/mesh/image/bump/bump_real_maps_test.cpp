// SPDX-License-Identifier: Apache-2.0
// Height maps of other people beside the normal maps that they made of them: our slopes must run
// with theirs, in the direction and by the factor that the collection's notes give.
#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "support/shared_data.h"

namespace relief {
namespace {

/// How well two series of slopes go together.
struct Agreement {
    double xx = 0.0, yy = 0.0, xy = 0.0;

    void add(double ours, double theirs) {
        xx += ours * ours;
        yy += theirs * theirs;
        xy += ours * theirs;
    }
    [[nodiscard]] double correlation() const { return xy / std::sqrt(xx * yy); }
    /// Their slope for one of ours, by least squares over ours.
    [[nodiscard]] double gain() const { return xy / xx; }
};

struct Pair {
    Agreement right, up;
};

/// Slopes of a height map of strength 1 beside those of its author's normal map. Slopes above 5 are
/// left out: there 8-bit codes no longer tell steep from steeper.
Pair compared(const std::filesystem::path& heights, int height_channel,
              const std::filesystem::path& normals, Green green, FlatCode flat) {
    Image height = to_float(read_image(heights, ImageUse::data));
    if (height_channel >= 0) {
        Image one = make_image(height.width, height.height, 1, 32, ColorSpace::data);
        for (std::size_t texel = 0; texel < one.sample_count(); ++texel)
            one.as<float>()[texel] =
                height.as<float>()[texel * static_cast<std::size_t>(height.channels) +
                                   static_cast<std::size_t>(height_channel)];
        height = one;
    }
    Report report;
    const Image ours =
        normals_from_height(height_field(height), {Kernel::central3, Wrap::repeat, 1.0}, report);
    const Image theirs =
        decode_normal_map(read_image(normals, ImageUse::data), green, flat, report);
    EXPECT_EQ(ours.width, theirs.width);
    EXPECT_EQ(ours.height, theirs.height);
    Pair pair;
    const std::span<const float> a = ours.as<float>();
    const std::span<const float> b = theirs.as<float>();
    for (std::size_t at = 0; at < a.size(); at += 3) {
        if (b[at + 2] < 0.196F) continue;
        pair.right.add(-a[at] / a[at + 2], -b[at] / b[at + 2]);
        pair.up.add(-a[at + 1] / a[at + 2], -b[at + 1] / b[at + 2]);
    }
    return pair;
}

TEST(BumpOnRealMaps, SandHasGreenDownAndTheKnownGain) {
    RELIEF_NEEDS_SHARED(folder, "data/textures/sand_ambientcg");
    const Pair pair = compared(folder / "sand_depth.png", -1, folder / "sand_normal.png",
                               Green::down, FlatCode::half);
    EXPECT_NEAR(pair.right.correlation(), 0.97, 0.02);
    EXPECT_NEAR(pair.up.correlation(), 0.97, 0.02);
    EXPECT_NEAR(pair.right.gain(), 66.5, 5.0);
    EXPECT_NEAR(pair.up.gain(), 66.5, 5.0);
}

TEST(BumpOnRealMaps, RockInAnAlphaChannelHasGreenUpAndTheKnownGain) {
    RELIEF_NEEDS_SHARED(folder, "data/textures/rock023_ambientcg");
    const Pair pair = compared(folder / "rock023_alb_ht.png", 3, folder / "rock023_nrm_rgh.png",
                               Green::up, FlatCode::half);
    EXPECT_NEAR(pair.right.correlation(), 0.87, 0.03);
    EXPECT_NEAR(pair.up.correlation(), 0.90, 0.03);
    EXPECT_NEAR(pair.right.gain(), 34.5, 4.0);
    EXPECT_NEAR(pair.up.gain(), 34.5, 4.0);
}

TEST(BumpOnRealMaps, CheeseIsADepthMapSoThatItsGainIsNegative) {
    RELIEF_NEEDS_SHARED(folder, "data/textures/cheese_godot");
    const Pair pair = compared(folder / "texture_cheese_depth.png", -1,
                               folder / "texture_cheese_normal.png", Green::up, FlatCode::half);
    EXPECT_NEAR(pair.right.correlation(), -0.98, 0.02);
    EXPECT_NEAR(pair.up.correlation(), -0.98, 0.02);
    EXPECT_NEAR(pair.right.gain(), -7.6, 0.6);
    EXPECT_NEAR(pair.up.gain(), -7.6, 0.6);
}

TEST(BumpOnRealMaps, AHalfFloatPairAgreesAlmostPerfectly) {
    RELIEF_NEEDS_SHARED(folder, "data/textures/oiio_bump_normal");
    const Pair pair =
        compared(folder / "bump.exr", -1, folder / "normal.exr", Green::down, FlatCode::middle);
    EXPECT_GT(pair.right.correlation(), 0.985);
    EXPECT_GT(pair.up.correlation(), 0.985);
    EXPECT_NEAR(pair.right.gain() / pair.up.gain(), 1.0, 0.05);
}

TEST(BumpOnRealMaps, A16BitMapThatTilesHasNoSeam) {
    RELIEF_NEEDS_SHARED(file, "data/textures/height_only/hexMap_height_1024_u16.png");
    const Image height = height_field(read_image(file, ImageUse::data));
    Report report;
    const Image normals = normals_from_height(height, {Kernel::sobel3, Wrap::repeat, 40.0}, report);
    EXPECT_TRUE(report.empty());
    // Mean change of the normal from one column to the next: across the seam as inside.
    const auto change = [&](std::size_t column, std::size_t next) {
        double sum = 0.0;
        for (std::size_t row = 0; row < 1024; ++row) {
            for (std::size_t part = 0; part < 3; ++part)
                sum += std::abs(normals.as<float>()[(row * 1024 + column) * 3 + part] -
                                normals.as<float>()[(row * 1024 + next) * 3 + part]);
        }
        return sum / 1024.0;
    };
    double inside = 0.0;
    for (std::size_t column = 0; column < 1023; ++column)
        inside = std::max(inside, change(column, column + 1));
    EXPECT_LT(change(1023, 0), inside);
}

}  // namespace
}  // namespace relief
