// SPDX-License-Identifier: Apache-2.0
// Codes of normals against known errors and published figures, and errors of tangent frames that
// are rotated by known angles.
#include "storage_experiments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <span>
#include <vector>

#include "experiment_parts.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

NormalCode code_named(const std::string& name) {
    for (const NormalCode& code : normal_codes()) {
        if (code.name == name) return code;
    }
    throw std::runtime_error("no code " + name);
}

/// Normals that lean along x, more and more from left to right, rotated by an angle in degrees.
std::vector<glm::dvec3> leaning(double degrees) {
    std::vector<glm::dvec3> normals;
    for (int i = 0; i < 16 * 16; ++i) {
        const double angle = (i % 16 + degrees) * std::numbers::pi / 180.0;
        normals.emplace_back(std::sin(angle), 0.0, std::cos(angle));
    }
    return normals;
}

TEST(PatchErrors, RotatedNormalsHaveTheAngleForAnyPatch) {
    const Image ground_truth = image_of_normals(leaning(0.0), 16);
    const Image turned = image_of_normals(leaning(1.0), 16);
    for (const int block : {1, 2, 4, 8, 16}) {
        const ErrorStats errors = patch_errors(turned, ground_truth, block);
        EXPECT_EQ(errors.count, static_cast<std::size_t>(256 / (block * block)));
        EXPECT_NEAR(errors.rms, 1.0, 1e-5);  // Normals are rounded to float.
        EXPECT_NEAR(errors.max, 1.0, 1e-5);
        EXPECT_EQ(patch_errors(ground_truth, ground_truth, block).max, 0.0);
    }
    EXPECT_THROW(image_of_normals(leaning(0.0), 15), InvalidInput);
}

std::string choice_of(const NormalCode& code, const std::string& name) {
    for (const auto& [key, value] : code.choices) {
        if (key == name) return value;
    }
    return {};
}

TEST(NormalCodes, FlatIsExactIfZeroIsACode) {
    const std::vector<glm::dvec3> flat(16, glm::dvec3(0.0, 0.0, 1.0));
    const Image normals = image_of_normals(flat, 4);
    for (const NormalCode& code : normal_codes()) {
        const double error = map_errors(stored(code, normals), flat).max;
        const std::string zero = choice_of(code, "zero");
        // Half a code in x and y, which are written as 128 and read as 127.5, or the opposite.
        if (zero == "127.5" || zero == "128, read as 127.5")
            EXPECT_NEAR(error, 0.318, 1e-3) << code.name;
        else if (zero == "32767.5" || zero == "32768, read as 32767.5")
            EXPECT_NEAR(error, 0.00124, 1e-5) << code.name;
        else
            EXPECT_EQ(error, 0.0) << code.name;
    }
}

/// Decodes an 8-bit texture as glTF 2.0 and engines do: 2 c / 255 - 1.
ErrorStats errors_by_gltf(const Image& codes, std::span<const glm::dvec3> ground_truth) {
    Image read = make_image(codes.width, codes.height, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < read.sample_count(); ++i)
        read.as<float>()[i] =
            2.0F * static_cast<float>(codes.as<std::uint8_t>()[i]) / 255.0F - 1.0F;
    return map_errors(read, ground_truth);
}

TEST(NormalCodes, RowsCoverBothDecoders) {
    const std::vector<glm::dvec3> directions = upper_directions(256 * 256);
    const Image normals = image_of_normals(directions, 256);
    const auto row = [&](const char* name) {
        return map_errors(stored(code_named(name), normals), directions);
    };
    Report report;
    const ErrorStats by_default =
        errors_by_gltf(encode_normal_map(normals, {.bits = 8}, report), directions);
    EXPECT_NEAR(row("xyz 8 bit").rms, by_default.rms, 1e-5);
    EXPECT_NEAR(by_default.rms, 0.184, 0.002);
    EXPECT_LT(by_default.max, 0.40);
    const ErrorStats misread = errors_by_gltf(
        encode_normal_map(normals, {.bits = 8, .flat = FlatCode::middle}, report), directions);
    EXPECT_NEAR(row("xyz 8 bit, zero at 128, read as glTF does").rms, misread.rms, 1e-5);
    EXPECT_NEAR(misread.rms, 0.368, 0.004);
    EXPECT_NEAR(misread.max, 0.739, 0.03);
    // The opposite mistake has the same error; the matching decoder has half of it.
    EXPECT_NEAR(row("xyz 8 bit, read with zero at 128").rms, misread.rms, 0.005);
    EXPECT_NEAR(row("xyz 8 bit, zero at 128").rms, by_default.rms, 0.005);
    EXPECT_NEAR(row("xyz 16 bit, zero at 32768, read as glTF does").rms,
                2.0 * row("xyz 16 bit").rms, 5e-5);
}

struct Published {
    const char* code;
    double mean;
    double max;
};

TEST(NormalCodes, ErrAsPublished) {
    // Measured by another program on random directions. The largest errors depend on the
    // directions, and if z is computed from x and y, on their distance from the horizon.
    constexpr int sheet_side = 512;
    const std::vector<glm::dvec3> directions = upper_directions(sheet_side * sheet_side);
    const Image normals = image_of_normals(directions, sheet_side);
    for (const Published& row : {Published{"xyz 8 bit", 0.170, 0.386},
                                 {"xyz 16 bit", 0.0007, 0.0015},

                                 {"octahedral 2 x 8 bit", 0.337, 0.949},
                                 {"octahedral 2 x 10 bit", 0.084, 0.236},
                                 {"octahedral 2 x 12 bit", 0.021, 0.059},
                                 {"octahedral 2 x 16 bit", 0.0013, 0.0037},
                                 {"xy 8 bit", 0.468, 5.89}}) {
        const ErrorStats errors = map_errors(stored(code_named(row.code), normals), directions);
        EXPECT_NEAR(errors.mean, row.mean, 0.04 * row.mean + 5e-5) << row.code;
        EXPECT_NEAR(errors.max, row.max, 0.1 * row.max) << row.code;
        EXPECT_EQ(errors.undefined, 0U);
    }
}

TEST(NormalCodes, HalvesHaveTheErrorsOfTheFilesThatAreWritten) {
    // (n + 1) / 2 is in 0.5 to 1, where half floats are 2^-11 apart, so n has steps of 2^-10.
    const std::vector<glm::dvec3> directions = upper_directions(256 * 256);
    const Image normals = image_of_normals(directions, 256);
    const ErrorStats errors = map_errors(stored(code_named("xyz half"), normals), directions);
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / "relief_normal_codes_half.exr";
    Report report;
    write_image(file, encode_normal_map(normals, {.bits = 32}, report), {}, {.half = true});
    const Image read = read_image(file, ImageUse::data);
    std::filesystem::remove(file);
    const ErrorStats written =
        map_errors(decode_normal_map(read, Green::up, FlatCode::half, report), directions);
    // Numbers halfway between two half floats are rounded up here and to even in files.
    EXPECT_NEAR(errors.rms, written.rms, 1e-4 * written.rms);
    EXPECT_NEAR(errors.max, written.max, 1e-4 * written.max);
    // Half a step in each of three components: rounding errors along the two directions that rotate
    // the normal.
    const double turn = std::sqrt(2.0) * 0x1p-11 * 180.0 / std::numbers::pi;
    EXPECT_GT(errors.max, 0.95 * turn);
    EXPECT_LT(errors.max, 1.25 * turn);
    EXPECT_NEAR(errors.rms, 0.0195, 0.0002);
    EXPECT_TRUE(report.empty());
}

/// Rounding to float: 2^-24 of a component, 3.4e-6 degrees each.
constexpr double float_rounding = 1e-5;

/// Frames that are rotated about their normals.
Frames turned(const SampleFrames& ground_truth, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    Frames found{ground_truth.float_normals, ground_truth.float_tangents};
    for (std::size_t i = 0; i < found.normals.size(); ++i) {
        const glm::dvec3 bitangent = glm::cross(ground_truth.normals[i], ground_truth.tangents[i]);
        const glm::dvec3 tangent =
            std::cos(angle) * ground_truth.tangents[i] + std::sin(angle) * bitangent;
        found.tangents[i] = glm::vec4(glm::vec3(tangent), ground_truth.float_tangents[i].w);
    }
    return found;
}

TEST(SampleFrames, EvenOnesAreFramesSpreadEvenly) {
    const SampleFrames frames = even_frames(1000);
    glm::dvec3 sum(0.0);
    glm::dmat3 moments(0.0);
    for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_NEAR(glm::length(frames.normals[i]), 1.0, 1e-14);
        EXPECT_NEAR(glm::length(frames.tangents[i]), 1.0, 1e-14);
        EXPECT_NEAR(glm::dot(frames.normals[i], frames.tangents[i]), 0.0, 1e-14);
        sum += frames.normals[i];
        moments += glm::outerProduct(frames.normals[i], frames.normals[i]) / 1000.0;
    }
    EXPECT_LE(glm::length(sum), 1.0);  // Of 1000 directions.
    // The squares of evenly spread directions are distributed equally over the axes.
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(moments[i][i], 1.0 / 3.0, 1e-3);
    EXPECT_EQ(frames.float_tangents[0].w, 1.0F);
    EXPECT_EQ(frames.float_tangents[1].w, -1.0F);
}

TEST(FrameErrors, RotatedFramesHaveTheAngleOfRotation) {
    const SampleFrames ground_truth = even_frames(500);
    EXPECT_LE(frame_errors(ground_truth, turned(ground_truth, 0.0)).both.max, float_rounding);
    const FrameCodeErrors errors = frame_errors(ground_truth, turned(ground_truth, 1.0));
    EXPECT_LE(errors.normal.max, float_rounding);
    EXPECT_NEAR(errors.tangent.rms, 1.0, float_rounding);
    EXPECT_NEAR(errors.tangent.max, 1.0, float_rounding);
    EXPECT_NEAR(errors.both.rms, std::sqrt(0.5), float_rounding);
    // A direction at 30 degrees to the axis moves on a circle of half the radius.
    const double half = std::numbers::pi / 360.0;
    const double texel = 2.0 * std::asin(0.5 * std::sin(half)) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(errors.texel.rms, texel, float_rounding);
    EXPECT_EQ(errors.flipped_frames, 0U);
}

TEST(FrameErrors, CountHandsThatAreLost) {
    const SampleFrames ground_truth = even_frames(10);
    Frames found = turned(ground_truth, 0.0);
    found.tangents[3].w = -found.tangents[3].w;
    found.tangents[4].w = -found.tangents[4].w;
    EXPECT_EQ(frame_errors(ground_truth, found).flipped_frames, 2U);
}

}  // namespace
}  // namespace relief::test
