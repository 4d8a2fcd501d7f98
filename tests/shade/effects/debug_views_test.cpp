// SPDX-License-Identifier: Apache-2.0
// Debug views as plans: what each keeps of a draw, what it leaves out, and where it has no meaning.
#include "relief/shade/debug_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "all_features.h"
#include "effects/features.h"
#include "effects/surface_program.h"
#include "relief/mesh/error.h"
#include "support/message_of.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::HasSubstr;

TEST(DebugViews, HaveNamesOfTheirOwnAndAKind) {
    std::set<std::string_view> names;
    for (const DebugViewInfo& info : debug_views()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_FALSE(info.what.empty());
        EXPECT_EQ(&debug_view_info(info.view), &info);
        const bool counts = info.kind == DebugViewKind::count;
        EXPECT_EQ(is_data(info.view), info.kind == DebugViewKind::data || counts) << info.name;
        EXPECT_EQ(is_term(info.view), info.kind == DebugViewKind::term) << info.name;
    }
    EXPECT_EQ(names.size(), 17U);
}

TEST(DebugViews, OfAnySetOfEffectsAreCanonicalAndComeTogether) {
    std::size_t at = 0;
    test::for_random_features(4000, [&](const Features& random) {
        Features f = random;
        f.view = static_cast<DebugView>(++at %
                                        (static_cast<std::size_t>(DebugView::nothing_to_show) + 1));
        const Features once = canonical(f);
        EXPECT_EQ(canonical(once), once) << describe(f);
        ASSERT_NO_THROW((void)surface_program(once)) << describe(once);
    });
}

TEST(DebugViews, AreNoPartOfThePicturesPrograms) {
    const std::set<std::string> foreign = {"data.frag.glsl", "refraction.glsl#dimming"};
    for (const Features& f : test::covering_features()) {
        ASSERT_EQ(f.view, DebugView::picture);
        const SurfaceProgram program = surface_program(f);
        for (const ShaderSource& source : {program.vertex, program.fragment}) {
            for (const std::string& part : source.parts) {
                EXPECT_FALSE(part.starts_with("view.glsl") || foreign.contains(part))
                    << describe(f) << " holds " << part;
            }
        }
    }
}

TEST(DebugViews, OfDataHoldNoLightAndNoCoding) {
    Features f;
    f.directional_lights = 2;
    f.diffuse = f.diffuse_texture = f.ambient = f.exposure = true;
    f.tone_mapping = ToneMapping::aces;
    f.view = DebugView::texcoords;
    const PlannedInterface planned = planned_interface(canonical(f));
    EXPECT_EQ(planned.attributes, (std::vector<std::string>{"position_object", "texcoord"}));
    EXPECT_EQ(planned.uniforms, (std::vector<std::string>{"clip_from_object"}));
    EXPECT_TRUE(planned.samplers.empty());
}

TEST(DebugViews, KeepTheHolesOfAMaskAndNotTheColourOfBlending) {
    Features f;
    f.alpha = AlphaMode::mask;
    f.diffuse_texture = true;
    f.view = DebugView::geometric_normal;
    EXPECT_EQ(planned_interface(canonical(f)).samplers,
              (std::vector<std::string>{"diffuse_texture"}));
    f.alpha = AlphaMode::blend;
    EXPECT_TRUE(planned_interface(canonical(f)).samplers.empty());
    EXPECT_EQ(canonical(f).alpha, AlphaMode::opaque);
}

/// A square with and one without texture coordinates, plain.
Scene two_squares() {
    Scene scene;
    Mesh plain = test::grid(1);
    plain.name = "plain";
    plain.texcoords.clear();
    Mesh mapped = test::grid(1);
    mapped.name = "mapped";
    scene.meshes = {plain, mapped};
    scene.instances = {{0, glm::mat4(1.0F), "a"}, {1, glm::mat4(1.0F), "b"}};
    return scene;
}

FramePlan view_of(const Scene& scene, DebugView view, Report& report) {
    FrameSettings settings;
    settings.view = view;
    return plan_view(scene, settings, plan_effects(scene, settings), report);
}

TEST(PlanView, LeavesThePlanOfAPictureAsItIs) {
    Report report;
    const Scene scene = two_squares();
    const FrameSettings settings;
    const FramePlan plan = plan_effects(scene, settings);
    const FramePlan viewed = plan_view(scene, settings, plan, report);
    ASSERT_EQ(viewed.draws.size(), plan.draws.size());
    for (std::size_t i = 0; i < plan.draws.size(); ++i)
        EXPECT_EQ(viewed.draws[i].features, plan.draws[i].features);
    EXPECT_EQ(viewed.finishing_pass, plan.finishing_pass);
}

TEST(PlanView, HatchesAndCountsWhatHasNothingToShow) {
    Report report;
    const FramePlan plan = view_of(two_squares(), DebugView::tangent, report);
    EXPECT_EQ(plan.draws[0].features.view, DebugView::nothing_to_show);
    EXPECT_EQ(plan.draws[1].features.view, DebugView::tangent);
    EXPECT_FALSE(plan.draws[0].needs_tangents);
    EXPECT_TRUE(plan.draws[1].needs_tangents);
    EXPECT_FALSE(plan.finishing_pass) << "data is not averaged";
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(report.findings()[0].kind, "surface without what the view shows");
    EXPECT_EQ(report.findings()[0].first, (std::vector<std::size_t>{0}));
}

TEST(PlanView, OfAPlanThatIsTurnedAlreadyIsTheSame) {
    Report report;
    const Scene scene = two_squares();
    FrameSettings settings;
    settings.view = DebugView::tangent;
    const FramePlan once = view_of(scene, DebugView::tangent, report);
    const FramePlan twice = plan_view(scene, settings, once, report);
    for (std::size_t i = 0; i < once.draws.size(); ++i)
        EXPECT_EQ(twice.draws[i].features, once.draws[i].features);
    EXPECT_EQ(report.count("surface without what the view shows"), 1U);
}

TEST(PlanView, SaysWhyThereIsNothingToShow) {
    Report report;
    Scene scene = two_squares();
    const auto message = [&](DebugView view) {
        return test::message_of<InvalidInput>([&] { (void)view_of(scene, view, report); });
    };
    EXPECT_THAT(message(DebugView::height),
                HasSubstr("nothing to show of height: the default material has no bump map"));
    EXPECT_THAT(message(DebugView::normal_map), HasSubstr("has no normal map and no bump map"));
    EXPECT_THAT(message(DebugView::reflection),
                HasSubstr("reflection: the default material reflects nothing"));
    EXPECT_THAT(message(DebugView::diffuse), HasSubstr("nothing to show of diffuse"));
    EXPECT_THAT(message(DebugView::emission), HasSubstr("nothing to show of emission"));
    EXPECT_THAT(message(DebugView::nothing_to_show), HasSubstr("no view to ask for"));
    scene.meshes[1] = scene.meshes[0];
    EXPECT_THAT(message(DebugView::texcoords),
                HasSubstr("texcoords: mesh 'plain' has no texture coordinates"));
    EXPECT_THAT(message(DebugView::tangent), HasSubstr("no tangent frame"));
}

TEST(PlanView, OfATermDecodesNoEnvironmentThatOnlyDimsIt) {
    Features f;
    f.reflection = ReflectionTerm::mirror;
    f.refraction = f.ambient = true;
    f.view = DebugView::ambient;
    FramePlan plan;
    plan.draws.push_back({0, {}, canonical(f), {}, false});
    EXPECT_EQ(plan.draws[0].features.reflection, ReflectionTerm::mirror) << "it dims";
    EXPECT_FALSE(environment_needs(plan).any());
    EXPECT_TRUE(planned_interface(plan.draws[0].features).samplers.empty());
    f.view = DebugView::reflection;
    plan.draws[0].features = canonical(f);
    EXPECT_TRUE(environment_needs(plan).sharp);
    EXPECT_FALSE(plan.draws[0].features.refraction);
}

}  // namespace
}  // namespace relief
