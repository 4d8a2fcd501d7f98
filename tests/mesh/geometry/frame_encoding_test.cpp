// SPDX-License-Identifier: Apache-2.0
// Encoded tangent frames: layouts by hand, errors over random and special frames, handedness for
// every frame and code, and invalid frames.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <string>

#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::degrees_between;
using test::random_frames;
using test::ReferenceFrames;
using enum FrameEncoding;
using enum FrameRounding;

constexpr std::array all_roundings = {nearest, best};

/// The frames of all rotations by 180 degrees about these axes, where the real part of a quaternion
/// is zero, and by slightly smaller and larger angles; and of all rotations that map axes to axes,
/// where octahedral codes are at corners, edges and folds. Both handednesses occur.
ReferenceFrames special_frames() {
    ReferenceFrames frames;
    const auto add = [&](const glm::dvec3& normal, const glm::dvec3& tangent) {
        for (const float w : {1.0F, -1.0F})
            frames.add(normal, tangent, w);
    };
    for (int n = 0; n < 6; ++n) {
        for (int t = 0; t < 6; ++t) {
            if (n % 3 == t % 3) continue;
            glm::dvec3 normal(0.0), tangent(0.0);
            normal[n % 3] = n < 3 ? 1.0 : -1.0;
            tangent[t % 3] = t < 3 ? 1.0 : -1.0;
            add(normal, tangent);
        }
    }
    for (int x = -2; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y) {
            for (int z = -2; z <= 2; ++z) {
                if (x == 0 && y == 0 && z == 0) continue;
                const glm::dvec3 axis = glm::normalize(glm::dvec3(x, y, z));
                for (const double off : {0.0, 1e-9, -1e-9, 1e-4, -1e-4, 0.01, -0.01}) {
                    const double angle = std::acos(-1.0) + off;
                    const auto turned = [&](const glm::dvec3& v) {
                        return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
                               axis * glm::dot(axis, v) * (1.0 - std::cos(angle));
                    };
                    add(turned({0.0, 0.0, 1.0}), turned({1.0, 0.0, 0.0}));
                }
            }
        }
    }
    return frames;
}

struct RoundTrip {
    ErrorStats normal;
    ErrorStats tangent;
    std::size_t wrong_hands = 0;
    double worst_length = 0.0;
    double worst_cosine = 0.0;
};

void judge(const Frames& frames, RoundTrip& result) {
    for (std::size_t i = 0; i < frames.normals.size(); ++i) {
        const glm::dvec3 normal(frames.normals[i]);
        const glm::dvec3 tangent(frames.tangents[i]);
        for (const glm::dvec3& vector : {normal, tangent}) {
            // The condition also fails for NaN.
            const double off = std::abs(glm::length(vector) - 1.0);
            if (!(off <= result.worst_length)) result.worst_length = off;
        }
        const double cosine = std::abs(glm::dot(normal, tangent));
        if (!(cosine <= result.worst_cosine)) result.worst_cosine = cosine;
    }
}

RoundTrip round_trip(const ReferenceFrames& reference, FrameEncoding encoding,
                     FrameRounding rounding) {
    Report report;
    const std::vector<std::uint32_t> words = encode_frames(
        reference.float_normals, reference.float_tangents, encoding, rounding, report);
    EXPECT_EQ(words.size(), reference.normals.size() * words_per_frame(encoding));
    const Frames frames = decode_frames(words, encoding, report);
    EXPECT_TRUE(report.empty()) << to_string(report.findings().front());
    RoundTrip result;
    judge(frames, result);
    std::vector<glm::vec3> tangents;
    for (std::size_t i = 0; i < reference.normals.size(); ++i) {
        tangents.emplace_back(frames.tangents[i]);
        result.wrong_hands += frames.tangents[i].w == reference.float_tangents[i].w ? 0U : 1U;
    }
    result.normal = direction_error(frames.normals, reference.normals);
    result.tangent = direction_error(tangents, reference.tangents);
    return result;
}

/// Unit vectors in floats: each of three components has an error of up to 3e-8.
constexpr double float_unit = 2e-7;

struct Expected {
    FrameEncoding encoding;
    FrameRounding rounding;
    double normal_mean, normal_max, tangent_mean, tangent_max;
};

// In degrees, over random frames. The normals of octahedral8 and 10 nearest have the known errors
// of unit vectors (0.337 / 0.949, 0.084 / 0.236, 0.0013 / 0.0037).
constexpr std::array expected_errors = {
    Expected{float32, nearest, 7.5e-7, 3.05e-6, 9.6e-7, 4.3e-6},
    Expected{float32, best, 7.5e-7, 3.05e-6, 9.6e-7, 4.3e-6},
    Expected{octahedral8, nearest, 0.337, 0.94, 0.434, 1.42},
    Expected{octahedral8, best, 0.315, 0.63, 0.320, 1.02},
    Expected{octahedral10, nearest, 0.0836, 0.234, 0.0831, 0.25},
    Expected{octahedral10, best, 0.0782, 0.157, 0.0643, 0.170},
    Expected{octahedral16, nearest, 0.00131, 0.0036, 0.00168, 0.0056},
    Expected{octahedral16, best, 0.00122, 0.00244, 0.00124, 0.0040},
    Expected{quaternion8, nearest, 0.339, 1.06, 0.339, 1.08},
    Expected{quaternion8, best, 0.116, 0.93, 0.116, 0.91},
    Expected{quaternion16, nearest, 0.00131, 0.0033, 0.00131, 0.0033},
    Expected{quaternion16, best, 0.00044, 0.00276, 0.00044, 0.0029},
    Expected{angle10, nearest, 0.0836, 0.234, 0.076, 0.253},
    Expected{angle10, best, 0.0782, 0.157, 0.0737, 0.18},
    Expected{angle16, nearest, 0.00131, 0.0036, 0.00083, 0.0035},
    Expected{angle16, best, 0.00122, 0.00244, 0.00078, 0.00243},
};

TEST_LABELS(not_sanitized);
TEST(FrameEncoding, HasTheStatedErrorAndKeepsHandedness) {
    const ReferenceFrames reference = random_frames(100000);
    for (const Expected& expected : expected_errors) {
        const RoundTrip found = round_trip(reference, expected.encoding, expected.rounding);
        const std::string what = "encoding " + std::to_string(static_cast<int>(expected.encoding)) +
                                 ", rounding " +
                                 std::to_string(static_cast<int>(expected.rounding));
        EXPECT_NEAR(found.normal.mean, expected.normal_mean, 0.02 * expected.normal_mean) << what;
        EXPECT_NEAR(found.normal.max, expected.normal_max, 0.05 * expected.normal_max) << what;
        EXPECT_NEAR(found.tangent.mean, expected.tangent_mean, 0.02 * expected.tangent_mean)
            << what;
        EXPECT_NEAR(found.tangent.max, expected.tangent_max, 0.07 * expected.tangent_max) << what;
        EXPECT_EQ(found.wrong_hands, 0U) << what;
        EXPECT_LE(found.worst_length, float_unit) << what;
        EXPECT_LE(found.worst_cosine, float_unit) << what;
    }
}

TEST(FrameEncoding, SpecialFramesErrNoMoreThanOthersAndKeepTheirHand) {
    const ReferenceFrames reference = special_frames();
    for (const Expected& expected : expected_errors) {
        const RoundTrip found = round_trip(reference, expected.encoding, expected.rounding);
        const std::string what = "encoding " + std::to_string(static_cast<int>(expected.encoding)) +
                                 ", rounding " +
                                 std::to_string(static_cast<int>(expected.rounding));
        // At 180 degrees, the real part is 1 of 127 or 32767 instead of 0: in radians.
        const double half_turn = expected.encoding == quaternion8    ? 2.0 / 127.0
                                 : expected.encoding == quaternion16 ? 2.0 / 32767.0
                                                                     : 0.0;
        const double biased = 1.06 * glm::degrees(half_turn);
        EXPECT_LE(found.normal.max, std::max(1.1 * expected.normal_max, biased)) << what;
        EXPECT_LE(found.tangent.max, std::max(1.1 * expected.tangent_max, biased)) << what;
        EXPECT_EQ(found.wrong_hands, 0U) << what;
        EXPECT_LE(found.worst_length, float_unit) << what;
        EXPECT_LE(found.worst_cosine, float_unit) << what;
    }
}

TEST(FrameEncoding, LayoutsAreAsDescribed) {
    struct Case {
        FrameEncoding encoding;
        std::vector<std::uint32_t> upright, mirrored;
    };
    const std::vector<Case> cases = {
        {float32,
         {0, 0, 0x3f800000, 0x3f800000, 0, 0, 0x3f800000},
         {0, 0, 0x3f800000, 0x3f800000, 0, 0, 0xbf800000}},
        // The odd code next to (127, 0) is on the lower half of the octahedron, 126 : 0 : -1.
        {octahedral8, {0x007f0000}, {0x017f0000}},
        {octahedral10, {0, 0x400001ff}, {0, 0xc00001ff}},
        {octahedral16, {0, 0x00007fff}, {0, 0x00017fff}},
        {quaternion8, {0x7f000000}, {0x81000000}},
        {quaternion16, {0, 0x7fff0000}, {0, 0x80010000}},
        {angle10, {0}, {0x80000000}},
        {angle16, {0, 0}, {0, 0x80000000}},
    };
    const std::vector<glm::vec3> normal{{0.0F, 0.0F, 1.0F}};
    for (const Case& one : cases) {
        Report report;
        const auto encoded = [&](float w) {
            return encode_frames(normal, std::vector<glm::vec4>{{1.0F, 0.0F, 0.0F, w}},
                                 one.encoding, nearest, report);
        };
        EXPECT_EQ(encoded(1.0F), one.upright) << static_cast<int>(one.encoding);
        EXPECT_EQ(encoded(-1.0F), one.mirrored) << static_cast<int>(one.encoding);
        for (const auto& words : {one.upright, one.mirrored}) {
            const Frames frames = decode_frames(words, one.encoding, report);
            EXPECT_EQ(frames.normals.front(), normal.front());
            EXPECT_EQ(glm::vec3(frames.tangents.front()), glm::vec3(1.0F, 0.0F, 0.0F));
        }
        EXPECT_TRUE(report.empty());
    }
}

TEST(FrameEncoding, ComponentsFollowTheLayout) {
    Report report;
    // By hand: an octahedral normal (0.8, 0, 0.6) has x = 0.8 / 1.4 = 0.5714 of 127 = 72.57. Its
    // tangent (0, 1, 0) is at (0, 127): odd, so the frame is left-handed; with y = 126 it is
    // right-handed.
    const std::vector<glm::vec3> normal{{0.8F, 0.0F, 0.6F}};
    const auto encoded = [&](float w, FrameEncoding encoding) {
        return encode_frames(normal, std::vector<glm::vec4>{{0.0F, 1.0F, 0.0F, w}}, encoding,
                             nearest, report);
    };
    EXPECT_EQ(encoded(-1.0F, octahedral8), (std::vector<std::uint32_t>{0x7f000049}));
    EXPECT_EQ(encoded(1.0F, octahedral8), (std::vector<std::uint32_t>{0x7e000049}));
    EXPECT_EQ(encoded(1.0F, octahedral10), (std::vector<std::uint32_t>{292, 0x4007fc00}));
    EXPECT_EQ(encoded(-1.0F, octahedral16), (std::vector<std::uint32_t>{18724, 0x7fff0000}));
    // The axes of this normal: a = -1/1.6, first (1 - 0.64 / 1.6, 0, -0.8), second (0, 1, 0). The
    // tangent is at a quarter of the turn.
    EXPECT_EQ(encoded(1.0F, angle10), (std::vector<std::uint32_t>{292 | 512U << 20U}));
    EXPECT_EQ(encoded(-1.0F, angle16), (std::vector<std::uint32_t>{18724, 0xa0000000}));
    // A quarter turn about z, then its mirror image: (0, 0, 0.7071, 0.7071) of 127 and 32767.
    const std::vector<glm::vec3> up{{0.0F, 0.0F, 1.0F}};
    const auto quarter = [&](float w, FrameEncoding encoding) {
        return encode_frames(up, std::vector<glm::vec4>{{0.0F, 1.0F, 0.0F, w}}, encoding, nearest,
                             report);
    };
    EXPECT_EQ(quarter(1.0F, quaternion8), (std::vector<std::uint32_t>{0x5a5a0000}));
    EXPECT_EQ(quarter(-1.0F, quaternion8), (std::vector<std::uint32_t>{0xa6a60000}));
    EXPECT_EQ(quarter(1.0F, quaternion16), (std::vector<std::uint32_t>{0, 0x5a825a82}));
}

TEST(FrameEncoding, BestIsNeverWorseThanNearestForTheNormal) {
    const ReferenceFrames reference = random_frames(2000);
    for (const FrameEncoding encoding : all_frame_encodings) {
        Report report;
        std::array<Frames, 2> frames;
        for (const FrameRounding rounding : all_roundings) {
            frames[static_cast<std::size_t>(rounding)] =
                decode_frames(encode_frames(reference.float_normals, reference.float_tangents,
                                            encoding, rounding, report),
                              encoding, report);
        }
        for (std::size_t i = 0; i < reference.normals.size(); ++i) {
            const auto error = [&](const Frames& some) {
                // A quaternion minimizes the angle of the whole rotation, not that of each axis.
                const double normal =
                    degrees_between(glm::dvec3(some.normals[i]), reference.normals[i]);
                const double tangent =
                    degrees_between(glm::dvec3(some.tangents[i]), reference.tangents[i]);
                const double bitangent = degrees_between(
                    glm::cross(glm::dvec3(some.normals[i]), glm::dvec3(some.tangents[i])),
                    glm::cross(reference.normals[i], reference.tangents[i]));
                const bool turn = encoding == quaternion8 || encoding == quaternion16;
                return turn ? std::hypot(normal, tangent, bitangent) : normal;
            };
            EXPECT_LE(error(frames[1]), error(frames[0]) * 1.02 + 1e-5)
                << static_cast<int>(encoding) << " frame " << i;
        }
    }
}

/// Decoded frames must give the same codes and handedness when they are encoded again.
void expect_codes_to_stay(const std::vector<std::uint32_t>& words, FrameEncoding encoding,
                          double tolerance) {
    Report report;
    const Frames once = decode_frames(words, encoding, report);
    ASSERT_TRUE(report.empty()) << to_string(report.findings().front());
    for (const FrameRounding rounding : all_roundings) {
        const Frames twice =
            decode_frames(encode_frames(once.normals, once.tangents, encoding, rounding, report),
                          encoding, report);
        std::size_t lost = 0;
        double worst = 0.0;
        for (std::size_t i = 0; i < once.normals.size(); ++i) {
            lost += once.tangents[i].w == twice.tangents[i].w ? 0U : 1U;
            worst = std::max(
                {worst, degrees_between(glm::dvec3(once.normals[i]), glm::dvec3(twice.normals[i])),
                 degrees_between(glm::dvec3(once.tangents[i]), glm::dvec3(twice.tangents[i]))});
        }
        EXPECT_EQ(lost, 0U) << static_cast<int>(encoding);
        EXPECT_LE(worst, tolerance) << static_cast<int>(encoding);
    }
    EXPECT_TRUE(report.empty());
}

TEST_LABELS(not_sanitized);
TEST(FrameEncoding, EverySmallCodeComesBackWithItsHand) {
    // All 8-bit tangents with all normals of a coarse grid of codes, except tangents close to the
    // normal.
    std::vector<std::uint32_t> octahedral;
    Report none;
    for (std::uint32_t normal = 0; normal < 65536; normal += 1187) {
        for (std::uint32_t tangent = 0; tangent < 65536; tangent += 3)
            octahedral.push_back(normal | tangent << 16U);
    }
    const std::size_t before = octahedral.size();
    std::erase_if(octahedral, [&](std::uint32_t word) {
        Report report;
        decode_frames(std::span(&word, 1), octahedral8, report);
        return !report.empty();
    });
    EXPECT_GT(octahedral.size(), before * 99 / 100);
    // A tangent that is not perpendicular cannot stay, but its change is within the error of a
    // code.
    expect_codes_to_stay(octahedral, octahedral8, 1.6);

    // All quaternions of small components: their handedness depends on the last bit.
    std::vector<std::uint32_t> quaternions;
    for (std::uint32_t x = 0; x < 256; x += 5) {
        for (std::uint32_t y = 0; y < 256; y += 5) {
            for (std::uint32_t z = 0; z < 256; z += 5) {
                for (const std::uint32_t w : {1U, 2U, 3U, 127U, 129U, 253U, 254U, 255U})
                    quaternions.push_back(x | y << 8U | z << 16U | w << 24U);
            }
        }
    }
    // The direction of a short code may lie anywhere between two long ones.
    expect_codes_to_stay(quaternions, quaternion8, 1.1);

    // All directions in the plane, for normals of every face, edge and corner.
    std::vector<std::uint32_t> angles;
    for (const int x : {-511, -300, -1, 0, 1, 211, 511}) {
        for (const int y : {-511, -211, -1, 0, 1, 300, 511}) {
            for (std::uint32_t rest = 0; rest < 4096; ++rest) {
                angles.push_back((static_cast<std::uint32_t>(x) & 1023U) |
                                 (static_cast<std::uint32_t>(y) & 1023U) << 10U | rest << 20U);
            }
        }
    }
    expect_codes_to_stay(angles, angle10, 1e-4);
}

TEST(FrameEncoding, DecodesAnyWordsToFrames) {
    std::mt19937 random(3);
    std::vector<std::uint32_t> words(7 * 20000);
    for (std::uint32_t& word : words) {
        // Random bits, and runs of zeros and ones.
        const std::uint32_t kind = random() % 8;
        word = kind == 0   ? 0U
               : kind == 1 ? 0xffffffffU
               : kind == 2 ? 0x80808080U
                           : static_cast<std::uint32_t>(random());
    }
    for (const FrameEncoding encoding : all_frame_encodings) {
        Report report;
        RoundTrip result;
        const Frames frames =
            decode_frames(std::span(words).first(words.size() / 14 * 14), encoding, report);
        judge(frames, result);
        EXPECT_LE(result.worst_length, float_unit) << static_cast<int>(encoding);
        EXPECT_LE(result.worst_cosine, float_unit) << static_cast<int>(encoding);
        for (const glm::vec4& tangent : frames.tangents)
            ASSERT_EQ(std::abs(tangent.w), 1.0F);
    }
}

TEST(FrameEncoding, CountsInvalidWords) {
    Report report;
    Frames frames = decode_frames(std::vector<std::uint32_t>{0, 0x00000001}, quaternion8, report);
    EXPECT_EQ(report.count("quaternion of length 0"), 1U);
    EXPECT_EQ(report.count("quaternion without handedness"), 1U);
    EXPECT_EQ(frames.normals[0], glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(frames.tangents[0], glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
    // A rotation by 180 degrees about x.
    EXPECT_EQ(frames.normals[1], glm::vec3(0.0F, 0.0F, -1.0F));
    EXPECT_EQ(frames.tangents[1].w, 1.0F);

    frames = decode_frames(std::vector<std::uint32_t>{0, 0x40000000}, octahedral10, report);
    EXPECT_EQ(report.count("tangent along its normal"), 1U);
    EXPECT_EQ(frames.tangents[0], glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));

    frames = decode_frames(std::vector<std::uint32_t>(7, 0x7fc00000), float32, report);
    EXPECT_EQ(report.count("normal without direction"), 1U);
    EXPECT_EQ(report.count("tangent without direction"), 1U);
    EXPECT_EQ(report.count("tangent without handedness"), 1U);
    EXPECT_EQ(frames.normals[0], glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(report.findings().size(), 6U);
}

TEST(FrameEncoding, RepairsInvalidFramesAndCountsThem) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    struct Case {
        glm::vec3 normal;
        glm::vec4 tangent;
        std::set<std::string> kinds;
        glm::vec3 normal_after;
        glm::vec4 tangent_after;
    };
    const glm::vec3 x(1.0F, 0.0F, 0.0F), y(0.0F, 1.0F, 0.0F), z(0.0F, 0.0F, 1.0F);
    const std::vector<Case> cases = {
        {2.0F * z, {x, 1.0F}, {"normal not of unit length"}, z, {x, 1.0F}},
        {1e30F * z,
         {1e-30F * x, 1.0F},
         {"normal not of unit length", "tangent not of unit length"},
         z,
         {x, 1.0F}},
        {1.006F * z, {x, -1.0F}, {}, z, {x, -1.0F}},
        {z, {0.6F, 0.0F, 0.8F, 1.0F}, {"tangent not perpendicular to its normal"}, z, {x, 1.0F}},
        {z, {0.99985F, 0.0F, 0.0175F, 1.0F}, {}, z, {x, 1.0F}},
        {z, {-z, -1.0F}, {"tangent along its normal"}, z, {x, -1.0F}},
        {x, {x, 1.0F}, {"tangent along its normal"}, x, {y, 1.0F}},
        {z, {0.0F, 0.0F, 0.0F, 1.0F}, {"tangent without direction"}, z, {x, 1.0F}},
        {z, {nan, 1.0F, 0.0F, 1.0F}, {"tangent without direction"}, z, {x, 1.0F}},
        {z, {inf, 0.0F, 0.0F, -1.0F}, {"tangent without direction"}, z, {x, -1.0F}},
        {{0.0F, 0.0F, 0.0F}, {z, 1.0F}, {"normal without direction"}, x, {z, 1.0F}},
        {{nan, 0.0F, 1.0F}, {x, 1.0F}, {"normal without direction"}, y, {x, 1.0F}},
        {{0.0F, 0.0F, 0.0F},
         {0.0F, 0.0F, 0.0F, 1.0F},
         {"normal without direction", "tangent without direction"},
         z,
         {x, 1.0F}},
        {z, {x, 0.5F}, {"tangent without handedness"}, z, {x, 1.0F}},
        {z, {x, -2.0F}, {"tangent without handedness"}, z, {x, -1.0F}},
        {z, {x, 0.0F}, {"tangent without handedness"}, z, {x, 1.0F}},
        {z, {x, nan}, {"tangent without handedness"}, z, {x, 1.0F}},
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& one = cases[i];
        for (const FrameEncoding encoding : all_frame_encodings) {
            Report report;
            const auto words = encode_frames(std::vector{one.normal}, std::vector{one.tangent},
                                             encoding, nearest, report);
            std::set<std::string> kinds;
            for (const Finding& finding : report.findings()) {
                kinds.insert(finding.kind);
                EXPECT_EQ(finding.first, std::vector<std::size_t>{0});
            }
            EXPECT_EQ(kinds, one.kinds) << "case " << i;
            Report none;
            const Frames frames = decode_frames(words, encoding, none);
            EXPECT_TRUE(none.empty()) << "case " << i;
            EXPECT_LE(degrees_between(glm::dvec3(frames.normals[0]), glm::dvec3(one.normal_after)),
                      1.0)
                << "case " << i;
            EXPECT_LE(
                degrees_between(glm::dvec3(frames.tangents[0]), glm::dvec3(one.tangent_after)), 1.0)
                << "case " << i;
            EXPECT_EQ(frames.tangents[0].w, one.tangent_after.w) << "case " << i;
        }
    }
}

TEST(FrameEncoding, IsTheSameForAnyNumberOfThreads) {
    const ReferenceFrames reference = random_frames(20000);
    for (const FrameEncoding encoding : all_frame_encodings) {
        const auto with_threads = [&](unsigned threads) {
            set_thread_limit(threads);
            Report report;
            auto words = encode_frames(reference.float_normals, reference.float_tangents, encoding,
                                       best, report);
            Frames frames = decode_frames(words, encoding, report);
            set_thread_limit(0);
            return std::pair(std::move(words), std::move(frames));
        };
        const auto alone = with_threads(1);
        const auto together = with_threads(0);
        EXPECT_EQ(alone.first, together.first);
        EXPECT_TRUE(test::same_bits(alone.second.normals, together.second.normals));
        EXPECT_TRUE(test::same_bits(alone.second.tangents, together.second.tangents));
    }
}

TEST(FrameEncoding, ErrorsAreThoseOfTheFramesAtHand) {
    const ReferenceFrames reference = random_frames(20000);
    const FrameEncodingError error =
        frame_encoding_error(reference.float_normals, reference.float_tangents, angle10, best);
    EXPECT_NEAR(error.normal.mean, 0.0782, 0.001);
    EXPECT_NEAR(error.tangent.mean, 0.0737, 0.001);
    EXPECT_EQ(error.normal.count, 20000U);
    // Axes come back exactly. Oblique directions are compared with the perpendicular ones.
    const std::vector<glm::vec3> up{{0.0F, 0.0F, 1.0F}};
    const FrameEncodingError none = frame_encoding_error(
        up, std::vector<glm::vec4>{{0.6F, 0.0F, 0.8F, -1.0F}}, angle10, nearest);
    EXPECT_EQ(none.normal.max, 0.0);
    EXPECT_EQ(none.tangent.max, 0.0);
    EXPECT_THROW(frame_encoding_error(up, {}, angle10, nearest), InvalidInput);
}

TEST(FrameEncoding, TheSmallestWithinABoundIsChosen) {
    const ReferenceFrames reference = random_frames(20000);
    const auto chosen = [&](double degrees, FrameRounding rounding) {
        return smallest_encoding_within(degrees, reference.float_normals, reference.float_tangents,
                                        rounding);
    };
    // With four bytes, angle10 has an error of at most 0.18; with eight, angle16 has 0.0024, the
    // smallest of all.
    EXPECT_EQ(chosen(180.0, best).encoding, angle10);
    EXPECT_EQ(chosen(0.2, best).encoding, angle10);
    EXPECT_EQ(chosen(0.2, nearest).encoding, quaternion16);
    EXPECT_EQ(chosen(0.1, best).encoding, angle16);
    EXPECT_EQ(chosen(0.0025, best).encoding, angle16);
    EXPECT_EQ(chosen(0.001, best).encoding, float32);
    EXPECT_EQ(chosen(0.0, best).encoding, float32);
    EXPECT_NEAR(chosen(0.2, best).error.tangent.max, 0.18, 0.01);
    // Frames along the axes have no error in any encoding, except those that cannot represent 180
    // degrees.
    const std::vector<glm::vec3> down{{0.0F, 0.0F, -1.0F}};
    const std::vector<glm::vec4> along{{1.0F, 0.0F, 0.0F, 1.0F}};
    const ChosenEncoding exact = smallest_encoding_within(0.0, down, along, best);
    EXPECT_EQ(words_per_frame(exact.encoding), 1U);
    EXPECT_NE(exact.encoding, quaternion8);
    EXPECT_THROW(chosen(-1.0, best), InvalidInput);
    EXPECT_THROW(chosen(std::numeric_limits<double>::quiet_NaN(), best), InvalidInput);
}

TEST(FrameEncoding, HasTheSameBitsForAnyCompiler) {
    // FNV-1a over codes and decoded frames. GCC 12 and Clang 14 give the same value at every
    // optimization level.
    const ReferenceFrames reference = random_frames(50000);
    std::uint64_t hash = 0xcbf29ce484222325U;
    const auto mix = [&](const auto& values) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
        for (std::size_t i = 0; i < values.size() * sizeof(values[0]); ++i)
            hash = (hash ^ bytes[i]) * 0x100000001b3U;
    };
    for (const FrameEncoding encoding : all_frame_encodings) {
        for (const FrameRounding rounding : all_roundings) {
            Report report;
            const auto words = encode_frames(reference.float_normals, reference.float_tangents,
                                             encoding, rounding, report);
            const Frames frames = decode_frames(words, encoding, report);
            mix(words);
            mix(frames.normals);
            mix(frames.tangents);
        }
    }
    EXPECT_EQ(hash, 0x169544ea729d2337U);
}

TEST(FrameEncoding, LengthsMustAgree) {
    Report report;
    EXPECT_THROW(encode_frames(std::vector<glm::vec3>(2), std::vector<glm::vec4>(3), angle10,
                               nearest, report),
                 InvalidInput);
    EXPECT_THROW(decode_frames(std::vector<std::uint32_t>(3), angle16, report), InvalidInput);
    EXPECT_TRUE(encode_frames({}, {}, quaternion8, best, report).empty());
    EXPECT_TRUE(decode_frames({}, quaternion8, report).normals.empty());
}

}  // namespace
}  // namespace relief
