// SPDX-License-Identifier: Apache-2.0
// Codes of normals against known errors and published figures, and the results of the experiments.
#include "storage_experiments.h"

#include <gmock/gmock.h>
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
        const double error = map_errors(code.stored(normals), flat).max;
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
    std::vector<glm::dvec3> directions = even_directions(2 * 256 * 256);
    directions.resize(directions.size() / 2);
    const Image normals = image_of_normals(directions, 256);
    const auto row = [&](const char* name) {
        return map_errors(code_named(name).stored(normals), directions);
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
    constexpr int side = 512;
    std::vector<glm::dvec3> directions = even_directions(2 * side * side);
    directions.resize(directions.size() / 2);
    const Image normals = image_of_normals(directions, side);
    for (const Published& row : {Published{"xyz 8 bit", 0.170, 0.386},
                                 {"xyz 16 bit", 0.0007, 0.0015},

                                 {"octahedral 2 x 8 bit", 0.337, 0.949},
                                 {"octahedral 2 x 10 bit", 0.084, 0.236},
                                 {"octahedral 2 x 12 bit", 0.021, 0.059},
                                 {"octahedral 2 x 16 bit", 0.0013, 0.0037},
                                 {"xy 8 bit", 0.468, 5.89}}) {
        const ErrorStats errors = map_errors(code_named(row.code).stored(normals), directions);
        EXPECT_NEAR(errors.mean, row.mean, 0.04 * row.mean + 5e-5) << row.code;
        EXPECT_NEAR(errors.max, row.max, 0.1 * row.max) << row.code;
        EXPECT_EQ(errors.undefined, 0U);
    }
}

TEST(NormalCodes, HalvesHaveTheErrorsOfTheFilesThatAreWritten) {
    // (n + 1) / 2 is in 0.5 to 1, where half floats are 2^-11 apart, so n has steps of 2^-10.
    std::vector<glm::dvec3> directions = even_directions(2 * 256 * 256);
    directions.resize(directions.size() / 2);
    const Image normals = image_of_normals(directions, 256);
    const ErrorStats errors = map_errors(code_named("xyz half").stored(normals), directions);
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

}  // namespace
}  // namespace relief::test
