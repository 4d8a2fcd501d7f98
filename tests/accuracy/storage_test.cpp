// SPDX-License-Identifier: Apache-2.0
// Experiments on storage against the library's own judgement of its encodings.
#include "storage/storage_experiments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/frame_encoding.h"

namespace relief {
namespace {

TEST(FrameCodesExperiment, ErrorsAreThoseOfTheEncodings) {
    RunOptions options;
    options.is_quick = true;
    options.is_timed = false;
    const Experiment experiment = frame_codes_experiment(options);
    ASSERT_EQ(experiment.measurements.size(), all_frame_encodings.size());
    for (const Measurement& one : experiment.measurements) {
        SCOPED_TRACE(one.method);
        EXPECT_EQ(one.error.count, 2 * static_cast<std::size_t>(experiment.items));
        EXPECT_EQ(one.error.undefined, 0U);
        EXPECT_FALSE(one.cost.one_thread);
        // A sphere has 41253 square degrees. In 2 x 8 bits a code has about 0.63 of them: a square
        // of 0.79 degrees, whose points are 0.79 / sqrt(6) = 0.32 off, RMS; the tangent's has one
        // bit less. Octahedral codes are not all of a size, hence the factor.
        const double bits = one.method.ends_with("16") ? 16 : one.method.ends_with("10") ? 10 : 8;
        if (one.method.starts_with("octahedral")) {
            EXPECT_NEAR(one.error.rms, 0.4 * std::pow(2.0, 8.0 - bits),
                        0.15 * std::pow(2.0, 8.0 - bits));
        }
        if (one.method == "float32") {
            EXPECT_LT(one.error.max, 1e-5);
            EXPECT_GT(one.error.max, 1e-7) << "float has an error too";
        }
    }
}

TEST(FrameCodesExperiment, SaysWhatIsNearestInSoManyBytes) {
    RunOptions options;
    options.is_quick = true;
    options.is_timed = false;
    const std::string finding = frame_codes_experiment(options).finding;
    EXPECT_NE(finding.find("in 4 bytes angle10 is nearest: 0.08"), std::string::npos) << finding;
    EXPECT_NE(finding.find("in 8 bytes angle16 is nearest: 0.001"), std::string::npos) << finding;
}

}  // namespace
}  // namespace relief
