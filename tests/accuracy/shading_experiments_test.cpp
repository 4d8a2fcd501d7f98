// SPDX-License-Identifier: Apache-2.0
// The results of the experiments with rendered images.
#include "shading_experiments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "experiment_checks.h"
#include "experiment_driver.h"
#include "support/labels.h"

namespace relief {
using namespace relief::accuracy;

namespace {

FILE_LABELS(not_sanitized);

/// The RMS error of a method is less than that of another one, times a factor.
struct Rank {
    const char* experiment;
    const char* better;
    const char* worse;
    double factor = 1.0;
};
constexpr std::array ranks = {
    Rank{"shading/interpolation", "Phong, 2304 triangles", "Gouraud, 2304 triangles"},
    Rank{"shading/interpolation", "Gouraud, 2304 triangles", "flat, 2304 triangles"},
    Rank{"shading/interpolation", "flat, 36864 triangles", "flat, 144 triangles", 0.3},
    Rank{"shading/interpolation", "Phong, 36864 triangles", "Phong, 144 triangles", 0.3},
    Rank{"shading/highlights", "GGX", "Blinn-Phong", 0.2},
    Rank{"shading/highlights", "Blinn-Phong", "Blinn-Phong, Phong's exponent"},
    Rank{"shading/highlights", "Phong, a quarter of Blinn's exponent", "Phong, Blinn's exponent"},
    Rank{"shading/cube-map-size", "32 x 32 texels", "16 x 16 texels", 0.65},
    Rank{"shading/cube-map-size", "64 x 64 texels", "32 x 32 texels", 0.6},
    Rank{"shading/cube-map-size", "128 x 128 texels", "64 x 64 texels", 0.9},
    Rank{"shading/glossy-levels", "5 levels, 128 texels", "not blurred", 0.3},
    Rank{"shading/glossy-levels", "6 levels, 256 texels", "not blurred", 0.3},
    Rank{"shading/energy", "all bounces", "one bounce", 0.01},
    Rank{"shading/specular-antialiasing", "Toksvig", "averaged normals", 0.5},
    Rank{"shading/specular-antialiasing", "Toksvig, 2 x 2 pixels", "Toksvig"},
    Rank{"shading/specular-antialiasing", "averaged normals, 2 x 2 pixels", "averaged normals",
         0.6},
    Rank{"shading/specular-antialiasing", "averaged normals, 4 x 4 pixels", "Toksvig", 0.5},
    Rank{"shading/edges", "MSAA, 4 samples", "1 sample", 0.6},
    Rank{"shading/edges", "4 x 4 pixels", "2 x 2 pixels", 0.6},
    // Frames that jump between facets have a small visible error.
    Rank{"tangents/drawn", "stored, 576 triangles", "derived, 576 triangles", 0.995},
    Rank{"tangents/drawn", "stored, 147456 triangles", "stored, 576 triangles", 0.5},
    Rank{"tangents/drawn", "stored, 9216 triangles", "no normal map, 9216 triangles", 0.2}};

class RenderedExperiment : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        if (!accuracy::detail::GlDevice().is_available()) GTEST_SKIP() << "no OpenGL";
    }
};

TEST_P(RenderedExperiment, RanksItsMethods) {
    const Experiment experiment = test::run_one(GetParam());
    test::expect_whole({experiment}, experiment.subject);
    for (const Rank& rank : ranks) {
        if (experiment.id != rank.experiment) continue;
        EXPECT_LT(test::measurement_of(experiment, rank.better).error.rms,
                  rank.factor * test::measurement_of(experiment, rank.worse).error.rms)
            << rank.better << " against " << rank.worse;
    }
    // Images and heat maps have the size that the experiment states.
    for (const PicturePair& pair : experiment.pictures) {
        for (const Image& image : {pair.before, pair.after})
            EXPECT_EQ(static_cast<double>(image.width) * image.height, experiment.items);
    }
    for (const HeatMap& map : experiment.heat_maps)
        EXPECT_EQ(static_cast<double>(map.errors.width) * map.errors.height, experiment.items);
    if (experiment.id == "shading/energy") {
        // From the front, a white metal of roughness 1 mirrors 1 - log(2) of even light at once.
        EXPECT_NEAR(test::measurement_of(experiment, "one bounce").error.max, 69.3, 0.5);
    }
}

INSTANTIATE_TEST_SUITE_P(All, RenderedExperiment,
                         testing::Values("shading/interpolation", "shading/highlights",
                                         "shading/cube-map-size", "shading/glossy-levels",
                                         "shading/energy", "shading/specular-antialiasing",
                                         "shading/edges", "tangents/drawn"),
                         [](const testing::TestParamInfo<const char*>& tested) {
                             std::string name = tested.param;
                             std::replace_if(
                                 name.begin(), name.end(),
                                 [](char letter) { return letter == '/' || letter == '-'; }, '_');
                             return name;
                         });

}  // namespace
}  // namespace relief
