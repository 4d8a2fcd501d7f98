// SPDX-License-Identifier: Apache-2.0
// Rendered methods, the supersampled reference against closed forms, and the processor affinity.
#include "rendered_methods.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <numbers>
#include <thread>

#include "experiment_checks.h"
#include "experiment_driver.h"
#include "relief/mesh/mesh.h"
#include "shading_experiments.h"
#include "support/gl_environment.h"
#include "support/labels.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;
using namespace relief::shade;

namespace {

constexpr int drawn_size = 64;

Scene ball() {
    return lit_scene(make_sphere(), glossy_plastic());
}

RenderedMethod shown(const std::string& name, const Scene& scene) {
    return {name, {}, [scene](double) { return Rendering{scene}; }};
}

/// \param pictures  receives the images
Experiment render(const std::shared_ptr<const GlDevice>& device,
                  const std::vector<RenderedMethod>& methods, const RunOptions& options,
                  std::vector<RenderedImage>& pictures) {
    return measured(
        prepare_rendering(
            device, {.size = drawn_size,
                     .methods = methods,
                     .ground_truth = [] { return supersampled_reference(ball(), drawn_size, 1); },
                     .finish = [&](Experiment&, const Renderings& all) { pictures = all.images; }}),
        options);
}

TEST(RenderedMethods, DetectARotatedLight) {
    const auto device = std::make_shared<const GlDevice>();
    if (!device->is_available()) GTEST_SKIP() << "no OpenGL";
    Scene broken = ball();
    broken.directional_lights.front().direction_world *= -1.0F;
    std::vector<RenderedImage> pictures;
    const Experiment experiment = render(device, {shown("right", ball()), shown("broken", broken)},
                                         test::quick_untimed(), pictures);
    ASSERT_EQ(experiment.measurements.size(), 2U);
    EXPECT_LT(experiment.measurements[0].error.rms, 0.01);
    EXPECT_GT(experiment.measurements[0].error.psnr.value(), 45.0);
    EXPECT_GT(experiment.measurements[1].error.rms, 0.2);
    EXPECT_FALSE(experiment.measurements[0].cost.all_threads);
    EXPECT_EQ(pictures[0].picture.channels, 3);
    EXPECT_EQ(pictures[0].errors.width, drawn_size);
    EXPECT_NE(experiment.measurements[0].note.find(device->context().renderer_name()),
              std::string::npos);
}

TEST(RenderedMethods, AreTimedInTurnsInSeconds) {
    const auto device = std::make_shared<const GlDevice>();
    if (!device->is_available()) GTEST_SKIP() << "no OpenGL";
    RunOptions options;
    options.repeats = {.counted = 3, .warm_up = 1};
    std::vector<RenderedImage> pictures;
    const Experiment experiment =
        render(device, {shown("one", ball()), shown("other", ball())}, options, pictures);
    for (const Measurement& one : experiment.measurements) {
        ASSERT_TRUE(one.cost.all_threads);
        EXPECT_EQ(one.cost.all_threads->rounds.size(), 3U);
        EXPECT_GT(one.cost.all_threads->spread().median, 0.0);
        EXPECT_LT(one.cost.all_threads->spread().median, 10.0);
        // The threads of a software driver can be kept on one processor if the system allows it.
        const SingleProcessor kept;
        ASSERT_EQ(one.cost.one_thread.has_value(),
                  kept.is_active() && device->context().is_software());
        if (!one.cost.one_thread) continue;
        EXPECT_EQ(one.cost.one_thread->rounds.size(), 3U);
    }
}

TEST(RenderedMethods, ReportMissingOpenGL) {
    const test::ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", "libnone.so");
    const PlanOptions plan_options{true, SharedInput<GlDevice>([] {
                                       return std::make_shared<const GlDevice>(Backend::osmesa);
                                   })};
    ASSERT_FALSE(plan_options.device.get()->is_available());
    RunOptions options = test::quick_untimed();
    options.selects_experiment = [](const std::string& id) { return id == "shading/edges"; };
    const std::vector<Experiment> all =
        run_planned(shading_plan(plan_options), options, plan_options);
    ASSERT_EQ(all.size(), 1U);
    const Experiment& experiment = all.front();
    EXPECT_TRUE(experiment.measurements.empty());
    EXPECT_EQ(experiment.id, "shading/edges");
    EXPECT_NE(experiment.finding.find("needs OpenGL"), std::string::npos) << experiment.finding;
    EXPECT_NE(experiment.finding.find("libnone.so"), std::string::npos) << experiment.finding;
}

/// A camera on +z that looks at a unit sphere.
Camera camera_before(double distance, double vertical_fov) {
    Camera camera;
    camera.world_from_view[3] = glm::vec4(0.0F, 0.0F, static_cast<float>(distance), 1.0F);
    camera.vertical_fov = static_cast<float>(vertical_fov);
    return camera;
}

glm::dvec3 pixel(const Image& image, int x, int y) {
    const auto i = static_cast<std::size_t>(3 * (y * image.width + x));
    const std::span<const float> samples = image.as<float>();
    return {samples[i], samples[i + 1], samples[i + 2]};
}

/// The ambient, Lambert and Blinn terms of glossy_plastic() in lit_scene(), computed by hand.
glm::dvec3 radiance_on_sphere(const glm::dvec3& normal, const glm::dvec3& eye) {
    const Material material = glossy_plastic();
    const glm::dvec3 light = -glm::normalize(glm::dvec3(light_direction_world));
    const glm::dvec3 half = glm::normalize(light + glm::normalize(eye - normal));
    const double n_dot_l = glm::dot(normal, light);
    glm::dvec3 radiance = glm::dvec3(material.ambient) * double{lit_ambient};
    if (n_dot_l > 0.0) {
        radiance += double{light_irradiance} *
                    (glm::dvec3(material.diffuse) * n_dot_l +
                     glm::dvec3(material.specular) * std::pow(std::max(glm::dot(normal, half), 0.0),
                                                              double{material.shininess}));
    }
    return glm::min(radiance, 1.0);
}

TEST(ManySamples, OfASphereMatchTheClosedForm) {
    constexpr int size = 24;
    constexpr double distance = 3.0;
    constexpr double fov = 0.5;  // The whole image shows the sphere.
    // The light comes from the front left, so that a part is dark.
    Scene scene = lit_scene(make_sphere(1024, 512), glossy_plastic());
    scene.camera = camera_before(distance, fov);
    const Image picture = supersampled_reference(scene, size, 1);
    const glm::dvec3 eye(0.0, 0.0, distance);
    double brightest = 0.0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double top = std::tan(0.5 * double{scene.camera->vertical_fov});
            const glm::dvec3 ray = glm::normalize(glm::dvec3(
                ((x + 0.5) / size * 2.0 - 1.0) * top, (1.0 - (y + 0.5) / size * 2.0) * top, -1.0));
            const double along = glm::dot(eye, ray);
            const glm::dvec3 normal =
                eye + (-along - std::sqrt(along * along - distance * distance + 1.0)) * ray;
            const glm::dvec3 expected = radiance_on_sphere(normal, eye);
            brightest = std::max(brightest, expected.r);
            // The facets of the mesh are up to 2e-5 below the sphere.
            EXPECT_LT(glm::distance(pixel(picture, x, y), expected), 1e-3) << x << ", " << y;
        }
    }
    EXPECT_GT(brightest, 0.6) << "the highlight is in the picture";
}

TEST_LABELS(not_sanitized);
TEST(ManySamples, CoverTheAreaOfADisc) {
    constexpr int size = 24;
    constexpr double distance = 4.0;
    Material white;
    white.unlit = true;
    white.diffuse = glm::vec3(1.0F);
    Scene scene = lit_scene(make_sphere(1024, 512), white);
    scene.background = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    scene.camera = camera_before(distance, 0.7);
    const Image picture = supersampled_reference(scene, size, 16);
    double sum = 0.0;
    for (const float sample : picture.as<float>())
        sum += sample / 3.0;
    // The outline of the sphere is at the angle asin(1 / distance).
    const double radius = std::tan(std::asin(1.0 / distance)) / std::tan(0.35) * size / 2.0;
    const double expected = std::numbers::pi * radius * radius;
    EXPECT_NEAR(sum, expected, 0.002 * expected);
    // One ray per pixel counts whole pixels, which has a larger error.
    double counted = 0.0;
    const Image single = supersampled_reference(scene, size, 1);
    for (const float sample : single.as<float>())
        counted += sample / 3.0;
    EXPECT_NEAR(counted, std::round(counted), 1e-4);
}

TEST(ManySamples, AreCutBeforeTheyAreAveraged) {
    Material glaring;
    glaring.unlit = true;
    glaring.diffuse = glm::vec3(100.0F);
    Scene scene = lit_scene(make_quad(), glaring);
    // Its right half is beside the quad, which ends in the middle of the pixel.
    scene.background = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    scene.camera = camera_before(1.0, 2.0 * std::atan(1.0));
    scene.camera->world_from_view[3].x = 1.0F;
    const Image picture = supersampled_reference(scene, 1, 4);
    EXPECT_NEAR(pixel(picture, 0, 0).r, 0.5, 1e-6);
}

int processors_of_this_thread() {
    ::cpu_set_t allowed;
    CPU_ZERO(&allowed);
    EXPECT_EQ(::sched_getaffinity(0, sizeof allowed, &allowed), 0);
    return CPU_COUNT(&allowed);
}

/// A thread that existed before and reports its affinity on request.
class OtherThread {
  public:
    OtherThread()
        : thread_([this] {
              for (int asked = ask_.load(); asked >= 0; ask_.wait(asked), asked = ask_.load()) {
                  if (asked == answered_.load()) continue;
                  processors_ = processors_of_this_thread();
                  answered_ = asked;
                  answered_.notify_all();
              }
          }) {}
    ~OtherThread() {
        ask_ = -1;
        ask_.notify_all();
        thread_.join();
    }
    OtherThread(const OtherThread&) = delete;
    OtherThread& operator=(const OtherThread&) = delete;

    int processors() {
        const int question = ++ask_;
        ask_.notify_all();
        for (int last = answered_; last != question; last = answered_)
            answered_.wait(last);
        return processors_;
    }

  private:
    std::atomic<int> ask_ = 0;
    std::atomic<int> answered_ = 0;
    std::atomic<int> processors_ = 0;
    std::thread thread_;  // Last, because it uses the other members.
};

TEST(SingleProcessor, KeepsAllThreadsAndLetsThemGo) {
    const int before = processors_of_this_thread();
    OtherThread other;
    ASSERT_EQ(other.processors(), before);
    {
        const SingleProcessor one;
        if (!one.is_active()) GTEST_SKIP() << "this system does not let threads be placed";
        EXPECT_EQ(processors_of_this_thread(), 1);
        EXPECT_EQ(other.processors(), 1);
    }
    EXPECT_EQ(processors_of_this_thread(), before);
    EXPECT_EQ(other.processors(), before);
}

}  // namespace
}  // namespace relief
