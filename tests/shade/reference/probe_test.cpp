// SPDX-License-Identifier: Apache-2.0
// The probe of a pixel: hand-computed terms, vectors and footprints; pixels without a surface;
// the names of its tables; and the outcome of surfaces that add no light.
#include "relief/shade/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "relief/shade/effects.h"
#include "shade/reference/traced.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::storage_rounding;

const ProbeTerm& term_of(const Probe& probe, ProbeTermKind kind) {
    const auto found = std::find_if(probe.terms.begin(), probe.terms.end(),
                                    [&](const ProbeTerm& term) { return term.kind == kind; });
    if (found == probe.terms.end())
        throw std::runtime_error("no term " + std::string(probe_term_info(kind).name));
    return *found;
}

glm::dvec3 value_of(const std::vector<ProbeFactor>& factors, std::string_view symbol) {
    for (const ProbeFactor& factor : factors) {
        if (factor.symbol == symbol) return factor.value;
    }
    throw std::runtime_error("no factor " + std::string(symbol));
}

const ProbeVector& vector_of(const ProbeLayer& layer, std::string_view symbol) {
    for (const ProbeVector& vector : layer.vectors) {
        if (vector.symbol == symbol && !vector.corner) return vector;
    }
    throw std::runtime_error("no vector " + std::string(symbol));
}

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], tolerance) << i;
}

/// A plane under one directional light, with all terms of Phong's model but the environment.
Scene lit_plane() {
    Material material = test::black_material();
    material.ambient = {0.5F, 0.25F, 0.125F};
    material.diffuse = {0.5F, 0.75F, 1.0F};
    material.specular = glm::vec3(0.25F);
    material.shininess = 2.0F;
    material.emission = {0.0F, 0.0F, 0.125F};
    Scene scene = test::square_scene(material);
    scene.ambient = glm::vec3(0.5F);
    // From the direction (3, 0, 4) / 5.
    scene.directional_lights = {{{-3, 0, -4}, {2, 2, 2}}};
    return scene;
}

/// The exact values of floats in double, and the camera's field of view.
constexpr double float_data = 1e-6;

TEST(Probe, HasTheTermsOfAPlaneUnderOneLight) {
    const Scene scene = lit_plane();
    const Probe probe = Prober(scene, {3, 3}).at(1, 1);
    ASSERT_EQ(probe.layers.size(), 1U);
    const ProbeLayer& layer = probe.layers[0];
    EXPECT_EQ(layer.outcome, ProbeOutcome::shown);
    expect_near(vector_of(layer, "n").world, {0, 0, 1}, float_data);
    expect_near(vector_of(layer, "v").world, {0, 0, 1}, float_data);
    expect_near(vector_of(layer, "l").world, {0.6, 0, 0.8}, float_data);
    expect_near(vector_of(layer, "r").world, {-0.6, 0, 0.8}, float_data);
    // h = (0.6, 0, 1.8) / sqrt(3.6), so that (n.h)^2 = 0.9.
    expect_near(vector_of(layer, "h").world, glm::dvec3(0.6, 0, 1.8) / std::sqrt(3.6), float_data);
    ASSERT_EQ(layer.lights.size(), 1U);
    EXPECT_NEAR(layer.lights[0].n_dot_l, 0.8, float_data);
    expect_near(layer.lights[0].irradiance, glm::dvec3(2.0), 0.0);

    expect_near(term_of(probe, ProbeTermKind::ambient).value, {0.25, 0.125, 0.0625}, float_data);
    const ProbeTerm& diffuse = term_of(probe, ProbeTermKind::diffuse);
    expect_near(diffuse.value, {0.8, 1.2, 1.6}, float_data);
    EXPECT_EQ(diffuse.light, 0U);
    EXPECT_NEAR(value_of(diffuse.factors, "n.l").x, 0.8, float_data);
    expect_near(value_of(diffuse.factors, "kd"), {0.5, 0.75, 1.0}, 0.0);
    const ProbeTerm& highlight = term_of(probe, ProbeTermKind::highlight);
    EXPECT_NEAR(value_of(highlight.quantities, "n.h").x, std::sqrt(0.9), float_data);
    EXPECT_NEAR(value_of(highlight.factors, "s").x, 0.9, float_data);
    expect_near(highlight.value, glm::dvec3(2 * 0.9 * 0.25), float_data);
    expect_near(term_of(probe, ProbeTermKind::emission).value, {0, 0, 0.125}, 0.0);
    expect_near(probe.radiance, {0.25 + 0.8 + 0.45, 0.125 + 1.2 + 0.45, 0.0625 + 1.6 + 0.575},
                float_data);
    EXPECT_EQ(probe.alpha, 1.0);
}

TEST(Probe, FollowsThePictureToItsCode) {
    Scene scene = lit_plane();
    scene.exposure = 0.25F;
    scene.tone_mapping = ToneMapping::reinhard;
    const Probe probe = Prober(scene, {3, 3}).at(1, 1);
    const double exposed = 0.25 * 1.5;
    EXPECT_NEAR(probe.picture.exposed.r, exposed, float_data);
    const double toned = exposed / (1.0 + exposed);
    EXPECT_NEAR(probe.picture.toned.r, toned, float_data);
    EXPECT_NEAR(probe.picture.composed.r, toned, float_data);
    EXPECT_NEAR(probe.picture.codes.r, 255.0 * (1.055 * std::pow(toned, 1.0 / 2.4) - 0.055), 1e-3);
    EXPECT_EQ(probe.picture.codes.a, 255.0);
}

TEST(Probe, StatesVectorsInFourSpaces) {
    Scene scene = lit_plane();
    // Twice as wide, and rotated by 90 degrees about y, so that it faces +x.
    scene.instances[0].world_from_object =
        glm::mat4(0, 0, -2, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1);
    scene.camera->world_from_view = glm::mat4(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 3, 0, 0, 1);
    scene.directional_lights = {{{-4, 0, -3}, {1, 1, 1}}};
    const Probe probe = Prober(scene, {3, 3}).at(1, 1);
    ASSERT_EQ(probe.layers.size(), 1U);
    const ProbeLayer& layer = probe.layers[0];
    const ProbeVector& n = vector_of(layer, "n");
    expect_near(n.world, {1, 0, 0}, float_data);
    expect_near(n.object, {0, 0, 1}, float_data);
    expect_near(n.camera, {0, 0, 1}, float_data);
    ASSERT_TRUE(n.tangent);
    expect_near(*n.tangent, {0, 0, 1}, float_data);
    // The object is twice as wide in its x, which is the world's -z.
    const ProbeVector& l = vector_of(layer, "l");
    expect_near(l.world, {0.8, 0, 0.6}, float_data);
    expect_near(l.object, glm::normalize(glm::dvec3(-0.3, 0, 0.8)), float_data);
    expect_near(l.camera, {-0.6, 0, 0.8}, float_data);
    expect_near(*l.tangent, {-0.6, 0, 0.8}, float_data);
    expect_near(vector_of(layer, "b").world, {0, 1, 0}, float_data);
}

TEST(Probe, TransformsNormalsAsNormals) {
    Scene scene = lit_plane();
    // A shear: x grows with z, so normals and directions differ.
    scene.instances[0].world_from_object =
        glm::mat4(1, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0, 1, 0, 0, 0, 0, 1);
    const ProbeLayer layer = Prober(scene, {3, 3}).at(1, 1).layers.at(0);
    // The plane's normal stays (0, 0, 1) in both spaces; the eye's direction does not.
    expect_near(vector_of(layer, "n").world, {0, 0, 1}, float_data);
    expect_near(vector_of(layer, "n").object, {0, 0, 1}, float_data);
    expect_near(vector_of(layer, "v").object, glm::normalize(glm::dvec3(-0.5, 0, 1)), float_data);
}

TEST(Probe, StatesTexturesWithTheirFootprint) {
    Scene scene = lit_plane();
    scene.materials[0].diffuse_texture = Texture{0};
    Image image = make_image(4, 8, 3, 32, ColorSpace::linear);
    std::fill(image.as<float>().begin(), image.as<float>().end(), 0.5F);
    scene.images = {{"halves", image}};
    // The camera sees 4 units of the square of 4 units: a pixel of 3 is a third of the texture.
    const Probe probe = Prober(scene, {3, 3}).at(1, 1);
    const ProbeLayer& layer = probe.layers.at(0);
    ASSERT_EQ(layer.lookups.size(), 1U);
    const ProbeLookup& lookup = layer.lookups[0];
    EXPECT_THAT(lookup.slots, testing::ElementsAre(TextureSlot::base_color));
    EXPECT_EQ(lookup.size, glm::ivec2(4, 8));
    EXPECT_NEAR(lookup.texcoord.x, 0.5, float_data);
    EXPECT_NEAR(lookup.texel.y, 4.0, float_data);
    EXPECT_NEAR(lookup.value.g, 0.5, 0.0);
    ASSERT_TRUE(lookup.texels_right && lookup.texels_down);
    const glm::dvec2 footprint = lookup.footprint();
    EXPECT_NEAR(footprint.x, 8.0 / 3, 1e-5);
    EXPECT_NEAR(footprint.y, 4.0 / 3, 1e-5);
    EXPECT_NEAR(lookup.texels_down->y, 8.0 / 3, 1e-5);
    expect_near(value_of(term_of(probe, ProbeTermKind::diffuse).factors, "tint"), glm::dvec3(0.5),
                0.0);
}

TEST(Probe, OfTheBackgroundHasNoTerms) {
    Scene scene = lit_plane();
    scene.meshes[0] = Mesh{};
    scene.background = {0.25F, 0.5F, 1.0F, 1.0F};
    const Probe probe = Prober(scene, {3, 3}).at(0, 2);
    EXPECT_TRUE(probe.layers.empty());
    EXPECT_TRUE(probe.terms.empty());
    EXPECT_EQ(probe.alpha, 0.0);
    EXPECT_EQ(probe.picture.composed, glm::dvec4(0.25, 0.5, 1.0, 1.0));
    scene.environment = test::constant_environment({0.5F, 1.0F, 2.0F}, true);
    const Probe sky = Prober(scene, {3, 3}).at(1, 1);
    ASSERT_EQ(sky.terms.size(), 1U);
    EXPECT_EQ(sky.terms[0].kind, ProbeTermKind::skybox);
    EXPECT_FALSE(sky.terms[0].layer);
    expect_near(sky.radiance, {0.5, 1.0, 2.0}, storage_rounding);
    expect_near(sky.direction_world, {0, 0, -1}, float_data);
}

TEST(Probe, RefusesPixelsOutsideAndViewsOfData) {
    const Scene scene = lit_plane();
    const Prober prober(scene, {4, 3});
    EXPECT_NO_THROW((void)prober.at(3, 2));
    for (const auto& [x, y] : {std::pair(4, 0), {0, 3}, {-1, 0}, {0, -1}})
        EXPECT_THROW((void)prober.at(x, y), InvalidInput) << x << "," << y;
    EXPECT_THROW((void)prober.at(0, 0, DebugView::shading_normal), InvalidInput);
    EXPECT_THROW((void)prober.at(0, 0, DebugView::overdraw), InvalidInput);
    EXPECT_THROW((void)Prober(scene, {4, 3, -1.0}), InvalidInput);
}

TEST(Probe, ExplainsSurfacesThatAddNoLight) {
    Scene scene = lit_plane();
    Material behind = scene.materials[0];
    behind.name = "behind";
    scene.materials.push_back(behind);
    Mesh far = test::facing_square();
    far.material_ranges = {{0, static_cast<std::uint32_t>(far.triangles.size()), 1}};
    scene.meshes.push_back(far);
    Instance moved;
    moved.mesh = 1;
    moved.world_from_object[3] = {0, 0, -1, 1};
    scene.instances.push_back(moved);
    Material& front = scene.materials[0];
    front.alpha_mode = AlphaMode::mask;
    front.opacity = 0.25F;
    Probe probe = Prober(scene, {3, 3}).at(1, 1);
    ASSERT_EQ(probe.layers.size(), 2U);
    EXPECT_EQ(probe.layers[0].outcome, ProbeOutcome::cut_out);
    EXPECT_EQ(probe.layers[0].alpha, 0.25);
    EXPECT_EQ(probe.layers[0].share, 0.0);
    EXPECT_EQ(probe.layers[1].outcome, ProbeOutcome::shown);
    for (const ProbeTerm& term : probe.terms)
        EXPECT_EQ(term.layer, 1U);

    front.alpha_mode = AlphaMode::blend;
    probe = Prober(scene, {3, 3}).at(1, 1);
    EXPECT_EQ(probe.layers.at(0).share, 0.25);
    EXPECT_EQ(probe.layers.at(1).share, 0.75);
    expect_near(term_of(probe, ProbeTermKind::diffuse).value, 0.25 * glm::dvec3(0.8, 1.2, 1.6),
                float_data);

    front.opacity = 0.0F;
    EXPECT_EQ(Prober(scene, {3, 3}).at(1, 1).layers.at(0).outcome, ProbeOutcome::transparent);

    scene.instances[0].world_from_object =
        glm::mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
    EXPECT_EQ(Prober(scene, {3, 3}).at(1, 1).layers.at(0).outcome, ProbeOutcome::culled);
}

TEST(Probe, OfABlendedSurfaceBeforeNothingIsNotDividedByItsAlpha) {
    Scene scene = lit_plane();
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].opacity = 0.25F;
    const Probe probe = Prober(scene, {3, 3}).at(1, 1);
    EXPECT_EQ(probe.alpha, 0.25);
    expect_near(term_of(probe, ProbeTermKind::diffuse).value, {0.8, 1.2, 1.6}, float_data);
}

TEST(Probe, OfATermViewHasItsTermsOnly) {
    Scene scene = lit_plane();
    scene.environment = test::constant_environment({0.5F, 1.0F, 2.0F}, true);
    const Probe probe = Prober(scene, {3, 3}).at(1, 1, DebugView::diffuse);
    ASSERT_EQ(probe.terms.size(), 1U);
    expect_near(probe.radiance, {0.8, 1.2, 1.6}, float_data);
    scene.meshes[0] = Mesh{};
    const Probe empty = Prober(scene, {3, 3}).at(1, 1, DebugView::diffuse);
    EXPECT_TRUE(empty.terms.empty());
    EXPECT_EQ(empty.alpha, 0.0);
}

TEST(Probe, OfGouraudShadingHasTheLightOfTheCorners) {
    Scene scene = lit_plane();
    scene.materials[0].interpolation = Interpolation::gouraud;
    const Probe probe = Prober(scene, {5, 5}).at(1, 2);
    double weights = 0.0;
    int terms = 0;
    for (const ProbeTerm& term : probe.terms) {
        if (term.kind != ProbeTermKind::diffuse) continue;
        ++terms;
        weights += value_of(term.factors, "weight").x;
        EXPECT_TRUE(probe.layers.at(0).lights.at(term.light.value()).corner);
    }
    EXPECT_EQ(terms, 3);
    EXPECT_NEAR(weights, 1.0, 1e-12);
}

TEST(Probe, ShowsClampsAsFactors) {
    Scene scene = lit_plane();
    scene.clamp_terms = true;
    const Probe probe = Prober(scene, {3, 3}).at(1, 1);
    const ProbeTerm& diffuse = term_of(probe, ProbeTermKind::diffuse);
    expect_near(diffuse.value, {0.8, 1.0, 1.0}, float_data);
    expect_near(value_of(diffuse.factors, "clamp"), {1.0, 1 / 1.2, 1 / 1.6}, float_data);
}

TEST(ProbeTables, HaveUniqueNames) {
    std::set<std::string_view> names;
    for (const ProbeTermInfo& term : probe_terms()) {
        EXPECT_TRUE(names.insert(term.name).second) << term.name;
        EXPECT_TRUE(term.view == DebugView::picture || is_term(term.view)) << term.name;
    }
    std::set<std::string_view> symbols;
    for (const ProbeSymbol& symbol : probe_symbols()) {
        EXPECT_TRUE(symbols.insert(symbol.symbol).second) << symbol.symbol;
        EXPECT_FALSE(symbol.meaning.empty()) << symbol.symbol;
    }
}

/// A new effect needs a row in probe_effects(), and if it adds light, a term.
TEST(ProbeTables, KnowEveryEffect) {
    std::set<std::string_view> names;
    for (const ProbeEffect& row : probe_effects())
        EXPECT_TRUE(names.insert(row.effect).second) << row.effect;
    for (const Effect& effect : effects())
        EXPECT_EQ(names.erase(effect.name), 1U) << effect.name << " has no row in the probe";
    EXPECT_THAT(names, testing::IsEmpty()) << "the planner has no such effects";
}

TEST(ProbeTables, NameTermsSymbolsAndSlotsThatExist) {
    for (const ProbeEffect& row : probe_effects()) {
        SCOPED_TRACE(row.effect);
        bool is_known = row.what.empty();
        switch (row.role) {
            case ProbeRole::term:
                for (const ProbeTermInfo& term : probe_terms())
                    is_known |= term.name == row.what;
                break;
            case ProbeRole::factor:
            case ProbeRole::vector:
                for (const ProbeSymbol& symbol : probe_symbols())
                    is_known |= symbol.symbol == row.what;
                break;
            case ProbeRole::lookup:
                for (const TextureSlotInfo& slot : texture_slots)
                    is_known |= slot.name == row.what;
                break;
            default:
                break;
        }
        EXPECT_TRUE(is_known) << row.what;
    }
}

}  // namespace
}  // namespace relief
