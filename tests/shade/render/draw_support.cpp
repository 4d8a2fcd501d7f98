// SPDX-License-Identifier: Apache-2.0
#include "shade/render/draw_support.h"

#include <cmath>
#include <cstring>

#include "support/shapes.h"

namespace relief::test {
using namespace relief::shade;

void DrawTest::SetUp() {
    context_ = shared_context(default_backend());
    if (context_ == nullptr) context_ = shared_context(Backend::egl);
    if (context_ == nullptr) GTEST_SKIP() << "neither OSMesa nor EGL is installed";
}

void DrawTest::TearDown() {
    if (context_ != nullptr) expect_clean_context();
}

Frame DrawTest::render(const Scene& scene, const FrameSettings& settings) const {
    Report report;
    return Renderer(*context_, scene, settings, report).draw(*scene.camera);
}

Frame DrawTest::render(const Scene& scene, const FramePlan& plan,
                       const FrameSettings& settings) const {
    Report report;
    return Renderer(*context_, scene, plan, settings, report).draw(*scene.camera);
}

Image DrawTest::radiance(const Scene& scene, int width, int height) const {
    return render(scene, {width, height, 1, OutputCoding::linear}).image;
}

glm::dvec4 pixel(const Image& image, int x, int y) {
    const auto first = (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x)) *
                       static_cast<std::size_t>(image.channels);
    return std::visit(
        [&](const auto& samples) {
            glm::dvec4 color(0, 0, 0, 1);
            for (int i = 0; i < image.channels; ++i) {
                color[i] = static_cast<double>(samples.at(first + static_cast<std::size_t>(i)));
            }
            return color;
        },
        image.samples);
}

Camera front_camera() {
    Camera camera;
    camera.world_from_view[3] = glm::vec4(0, 0, 3, 1);
    camera.vertical_fov = 2.0F * std::atan(2.0F / 3.0F);
    camera.near = 0.1F;
    camera.far = 10.0F;
    return camera;
}

Material black_material() {
    Material material;
    material.name = "test";
    material.ambient = material.diffuse = glm::vec3(0.0F);
    return material;
}

Scene scene_of(Mesh mesh, const Material& material) {
    Scene scene;
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}};
    scene.meshes = {std::move(mesh)};
    scene.materials = {material};
    scene.instances = {{0, glm::mat4(1.0F), "test"}};
    scene.camera = front_camera();
    return scene;
}

Mesh facing_square() {
    Mesh mesh = grid(1);
    mesh.name = "square";
    for (glm::vec3& position : mesh.positions) {
        position = (position - glm::vec3(0.5F, 0.5F, 0.0F)) * 4.0F;
    }
    return mesh;
}

Scene square_scene(const Material& material) {
    return scene_of(facing_square(), material);
}

Image constant_image(const glm::vec4& color, int channels, int bits, ColorSpace space) {
    Image image = make_image(2, 2, channels, bits, space);
    std::visit(
        [&](auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            const float largest =
                bits == 32 ? 1.0F : static_cast<float>(std::numeric_limits<Sample>::max());
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const auto channel = static_cast<int>(i % static_cast<std::size_t>(channels));
                const float value = color[channel] * largest;
                samples[i] = static_cast<Sample>(bits == 32 ? value : std::round(value));
            }
        },
        image.samples);
    return image;
}

Environment constant_environment(const glm::vec3& radiance, bool skybox) {
    CubeFaces faces;
    for (ImageSource& face : faces.faces) {
        face = {"face", constant_image(glm::vec4(radiance, 1), 3, 32, ColorSpace::linear)};
    }
    return {faces, 1.0F, skybox};
}

bool same_bits(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels) return false;
    if (a.samples.index() != b.samples.index()) return false;
    return std::visit(
        [&](const auto& samples) {
            using Samples = std::decay_t<decltype(samples)>;
            const auto& others = std::get<Samples>(b.samples);
            return std::memcmp(samples.data(), others.data(),
                               samples.size() * sizeof(typename Samples::value_type)) == 0;
        },
        a.samples);
}

}  // namespace relief::test
