// SPDX-License-Identifier: Apache-2.0
// The probe against the reference's picture and OpenGL's: over random scenes, the scenes of data/
// and real glTF models, the terms of a pixel sum to the reference's radiance, and its codes are
// those of the reference's picture, which OpenGL's picture matches away from edges.
#include "relief/shade/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/scene_file.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/random_scene.h"
#include "shade/render/reference_agreement.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

/// The smallest normal float: threads of Embree flush smaller ones to 0. The slope of sRGB codes is
/// at most 12.92.
constexpr double flushed = 1.2e-38;

/// The terms with light, and the symbols, that probes contained.
struct Contents {
    std::set<std::string_view> terms;
    std::set<std::string_view> symbols;
};

/// Expects that the terms are products of their factors, and sum to the radiance.
void expect_consistent(const Probe& probe, Contents& contents) {
    glm::dvec3 sum(0.0);
    glm::dvec3 size(0.0);
    for (const ProbeTerm& term : probe.terms) {
        const std::string_view name = probe_term_info(term.kind).name;
        glm::dvec3 product(1.0);
        for (const ProbeFactor& factor : term.factors) {
            product *= factor.value;
            EXPECT_NO_THROW((void)probe_symbol(factor.symbol)) << factor.symbol;
            contents.symbols.insert(factor.symbol);
        }
        for (const ProbeFactor& quantity : term.quantities) {
            EXPECT_NO_THROW((void)probe_symbol(quantity.symbol)) << quantity.symbol;
            contents.symbols.insert(quantity.symbol);
        }
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(product[i], term.value[i], term_rounding * std::abs(term.value[i])) << name;
        }
        if (term.value != glm::dvec3(0.0)) contents.terms.insert(name);
        sum += term.value;
        size += glm::abs(term.value);
        if (term.light) {
            ASSERT_LT(*term.light, probe.layers.at(term.layer.value()).lights.size()) << name;
        }
    }
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(sum[i], probe.radiance[i], term_rounding * size[i]) << "channel " << i;
    for (const ProbeLayer& layer : probe.layers) {
        for (const ProbeVector& vector : layer.vectors) {
            EXPECT_NO_THROW((void)probe_symbol(vector.symbol)) << vector.symbol;
            contents.symbols.insert(vector.symbol);
            const double length = glm::length(vector.world);
            EXPECT_TRUE(length == 0.0 || std::abs(length - 1.0) < 1e-6)
                << vector.symbol << " " << length;
        }
        for (const ProbeLookup& lookup : layer.lookups)
            EXPECT_FALSE(lookup.slots.empty());
    }
}

class ProbeAgreement : public test::DrawTest {
  protected:
    /// Probes every `step`th pixel in both directions of a picture of size x size pixels.
    /// \param tolerance  in codes, of OpenGL's picture away from edges
    void expect_agreement(const Scene& scene, int size, int step, double tolerance) {
        Report report;
        const Prober prober(scene, {size, size}, report);
        const Reference reference = render_reference(scene, {size, size}, report);
        const Image expected = reference_picture(reference.radiance, scene, OutputCoding::srgb);
        const Image drawn = render(scene, {size, size, 1, OutputCoding::srgb}).image;
        for (int y = step / 2; y < size; y += step) {
            for (int x = step / 2; x < size; x += step) {
                SCOPED_TRACE(testing::Message() << "pixel " << x << ", " << y);
                const Probe probe = prober.at(x, y);
                expect_consistent(probe, contents_);
                const glm::dvec4 radiance = test::pixel(reference.radiance, x, y);
                const glm::vec4 stored(glm::vec3(probe.radiance), probe.alpha);
                EXPECT_EQ(probe.is_edge, test::pixel(reference.edges, x, y)[0] > 0.0);
                const glm::dvec4 codes = test::pixel(expected, x, y);
                const glm::dvec4 shown = test::pixel(drawn, x, y);
                for (int i = 0; i < 4; ++i) {
                    EXPECT_NEAR(static_cast<double>(stored[i]), radiance[i], flushed) << i;
                    EXPECT_NEAR(probe.picture.codes[i], 255.0 * codes[i], 255.0 * 13.0 * flushed)
                        << "channel " << i;
                    if (probe.is_edge) continue;
                    EXPECT_NEAR(probe.picture.codes[i], shown[i], tolerance) << "channel " << i;
                }
                if (HasFailure()) return;
                ++probed_;
            }
        }
    }

    Contents contents_;
    int probed_ = 0;
};

TEST_F(ProbeAgreement, OfRandomScenes) {
    constexpr int seeds = 30;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const Scene scene = test::random_scene(seed);
        const bool has_environment = scene.environment.has_value();
        expect_agreement(scene, test::reference_size, 9,
                         has_environment ? test::blurred_tolerance : test::agreement_tolerance);
        if (HasFailure()) return;
    }
    EXPECT_EQ(probed_, seeds * 16);
}

/// Every effect that adds light has a term, and every effect that changes a factor has it.
TEST(ProbeContents, HaveTheTermsAndFactorsOfAllEffects) {
    Contents contents;
    std::set<std::string_view> on;
    for (const Features& features : test::covering_features()) {
        const test::CallingScene calling = test::scene_calling_for(features);
        for (const Effect& effect : effects()) {
            if (effect.on(calling.expected)) on.insert(effect.name);
        }
        const Prober prober(calling.scene, {9, 9});
        for (const auto& [x, y] : {std::pair(4, 4), {3, 5}, {6, 3}, {0, 0}}) {
            SCOPED_TRACE(describe(features));
            expect_consistent(prober.at(x, y), contents);
            if (::testing::Test::HasFailure()) return;
        }
    }
    for (const ProbeTermInfo& term : probe_terms()) {
        if (term.kind == ProbeTermKind::limit) continue;  // Only beyond the numbers of pictures.
        EXPECT_TRUE(contents.terms.contains(term.name)) << term.name << " never occurred";
    }
    for (const ProbeEffect& row : probe_effects()) {
        if (!on.contains(row.effect)) continue;
        if (row.what == "clamp") continue;  // These scenes have no term above 1.
        if (row.role == ProbeRole::factor) {
            EXPECT_TRUE(contents.symbols.contains(row.what)) << row.effect << ": " << row.what;
        } else if (row.role == ProbeRole::term) {
            EXPECT_TRUE(contents.terms.contains(row.what)) << row.effect << ": " << row.what;
        }
    }
    EXPECT_GT(on.size(), 60U);
}

TEST_F(ProbeAgreement, OfTheScenesOfData) {
    for (const auto& entry :
         std::filesystem::directory_iterator(test::source_directory() / "data/scenes")) {
        if (entry.path().extension() != ".json") continue;
        SCOPED_TRACE(entry.path().filename().string());
        const Scene scene = load_scene(entry.path());
        ASSERT_TRUE(scene.camera);
        expect_agreement(scene, 48, 5, test::blurred_tolerance);
        if (HasFailure()) return;
    }
    EXPECT_GT(probed_, 500);
}

TEST_LABELS(slow);
TEST_F(ProbeAgreement, OfRealModels) {
    for (const char* name :
         {"gltf/Avocado/glTF/Avocado.gltf", "gltf/BoomBox/glTF/BoomBox.gltf",
          "gltf/ClearCoatTest/glTF-Binary/ClearCoatTest.glb", "gltf/Duck/glTF-Binary/Duck.glb",
          "gltf/SpecularTest/glTF-Binary/SpecularTest.glb",
          "gltf/UnlitTest/glTF-Binary/UnlitTest.glb",
          "gltf/AnisotropyStrengthTest/glTF-Binary/AnisotropyStrengthTest.glb",
          "gltf/NegativeScaleTest/glTF-Binary/NegativeScaleTest.glb"}) {
        RELIEF_NEEDS_SHARED(file, std::string("data/models/") + name);
        SCOPED_TRACE(name);
        Report report;
        Scene scene = load_scene(file, report);
        scene.directional_lights = {{{-0.5F, -1.0F, -0.8F}, glm::vec3(0.8F)}};
        scene.ambient = glm::vec3(0.1F);
        scene.camera = framed(world_bounds(scene), 0.5F, 0.3F, 0.6F, 1.0F);
        expect_agreement(scene, 96, 9, test::agreement_tolerance);
        if (HasFailure()) return;
    }
    EXPECT_GT(probed_, 800);
}

/// The views of terms show the sums of their terms.
TEST_F(ProbeAgreement, OfTermViews) {
    constexpr int size = test::reference_size;
    std::map<DebugView, int> lit;
    std::vector<Scene> scenes;
    for (std::uint64_t seed = 0; seed < 12; ++seed)
        scenes.push_back(test::random_scene(seed));
    Scene& glass = scenes.emplace_back(test::lit_sphere());
    glass.materials[0].transmission = 0.5F;
    glass.materials[0].emission = glm::vec3(0.25F);
    glass.environment = test::constant_environment({0.5F, 1.0F, 0.25F}, false);
    glass.environment->lights = true;
    for (std::size_t number = 0; number < scenes.size(); ++number) {
        const Scene& scene = scenes[number];
        const Prober prober(scene, {size, size});
        for (const DebugViewInfo& info : debug_views()) {
            if (!is_term(info.view)) continue;
            const FrameSettings settings{size, size, 1, OutputCoding::srgb, info.view};
            Image drawn;
            try {
                drawn = render(scene, settings).image;
            } catch (const InvalidInput&) {
                continue;  // Nothing has this term.
            }
            for (int y = 3; y < size; y += 9) {
                for (int x = 3; x < size; x += 9) {
                    const Probe probe = prober.at(x, y, info.view);
                    if (probe.is_edge) continue;
                    SCOPED_TRACE(testing::Message() << "scene " << number << ", " << info.name
                                                    << ", pixel " << x << ", " << y);
                    const glm::dvec4 shown = test::pixel(drawn, x, y);
                    for (int i = 0; i < 4; ++i)
                        EXPECT_NEAR(probe.picture.codes[i], shown[i], test::blurred_tolerance);
                    if (HasFailure()) return;
                    if (probe.radiance != glm::dvec3(0.0)) ++lit[info.view];
                }
            }
        }
    }
    for (const DebugViewInfo& info : debug_views()) {
        if (!is_term(info.view)) continue;
        EXPECT_GT(lit[info.view], 0) << info.name << " is black everywhere";
    }
}

}  // namespace
}  // namespace relief
