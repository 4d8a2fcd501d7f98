// SPDX-License-Identifier: Apache-2.0
// What a frame takes by relief's planned program, by one written by hand for the scene, and by one
// that holds every effect behind branches on uniforms; six typical scenes, in turns in one run.
// A sphere of 99,856 triangles, 1280 x 720, one sample a pixel; milliseconds of wall clock.
//
//   relief-frame-bench [REPEATS]
//
// The hand-written and the branching shaders stand in for shaders/surface.* by way of
// $RELIEF_SHADER_DIR, so all three draw the same meshes with the same state.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "gl/api.h"
#include "relief/mesh/shapes.h"
#include "relief/shade/effect_forcing.h"
#include "relief/shade/frame_timing.h"
#include "relief/shade/framing.h"
#include "relief/shade/image_compare.h"

namespace relief::bench {
namespace {

const FrameSettings settings{1280, 720, 1, OutputCoding::srgb};

struct TypicalScene {
    const char* name;
    const char* minimal;            ///< Folder below bench/shade/minimal.
    std::vector<const char*> uses;  ///< Switches of the branching shader that are on.
    Scene scene;
};

/// Texels of noise; of a normal map, around flat.
Image noise(std::uint32_t seed, int size, bool around_flat, ColorSpace space) {
    std::mt19937 random(seed);
    Image image = make_image(size, size, 3, 8, space);
    const std::span<std::uint8_t> samples = image.as<std::uint8_t>();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const unsigned base = !around_flat ? 64 : (i % 3 == 2 ? 224 : 112);
        samples[i] = static_cast<std::uint8_t>(base + random() % (around_flat ? 32U : 160U));
    }
    return image;
}

Scene diffuse_scene() {
    Scene scene;
    Mesh mesh = make_sphere(316, 159);
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}};
    scene.meshes = {std::move(mesh)};
    Material material;
    material.name = "sphere";
    material.diffuse = {0.7F, 0.6F, 0.5F};
    scene.materials = {material};
    scene.instances = {{0, glm::mat4(1.0F), "sphere"}};
    scene.directional_lights = {{{-0.4F, -0.5F, -1.0F}, glm::vec3(0.9F)}};
    Camera camera;
    camera.world_from_view[3] = glm::vec4(0, 0, 3.0F, 1);
    scene.camera = camera;
    return scene;
}

Texture add_image(Scene& scene, const char* name, Image image) {
    scene.images.push_back({name, std::move(image)});
    return {scene.images.size() - 1};
}

void add_normal_map(Scene& scene) {
    scene.materials[0].normal_map =
        NormalMap{add_image(scene, "normal", noise(2, 1024, true, ColorSpace::data))};
}

std::vector<TypicalScene> typical_scenes() {
    Scene scene = diffuse_scene();
    std::vector<TypicalScene> all;
    all.push_back({"diffuse", "diffuse", {}, scene});
    scene.materials[0].specular = glm::vec3(0.5F);
    all.push_back({"Blinn-Phong", "blinn_phong", {"highlights"}, scene});
    scene.materials[0].diffuse_texture =
        add_image(scene, "diffuse", noise(1, 1024, false, ColorSpace::srgb));
    all.push_back(
        {"+ diffuse texture", "diffuse_texture", {"highlights", "diffuse_texture"}, scene});
    add_normal_map(scene);
    all.push_back(
        {"+ normal map", "normal_map", {"highlights", "diffuse_texture", "normal_map"}, scene});
    Scene physical = scene;
    CubeFaces faces;
    for (std::uint32_t i = 0; i < 6; ++i)
        faces.faces[i] = {"face", noise(10 + i, 512, false, ColorSpace::srgb)};
    scene.environment = Environment{faces, 1.0F, false};
    scene.materials[0].reflectivity = glm::vec3(0.3F);
    all.push_back({"+ reflection",
                   "reflection",
                   {"highlights", "diffuse_texture", "normal_map", "reflection"},
                   scene});
    Material& material = physical.materials[0];
    material.metallic_roughness = MetallicRoughness{};
    material.metallic_roughness->texture =
        add_image(physical, "metallic and roughness", noise(3, 1024, false, ColorSpace::data));
    all.push_back(
        {"metallic-roughness", "metallic_roughness", {"diffuse_texture", "normal_map"}, physical});
    return all;
}

/// Shaders of this folder go first; of none: those built in.
void use_shaders(const std::string& folder) {
    if (folder.empty()) {
        unsetenv("RELIEF_SHADER_DIR");
    } else {
        const std::string path = RELIEF_BENCH_DIRECTORY "/shade/" + folder;
        setenv("RELIEF_SHADER_DIR", path.c_str(), 1);
    }
}

/// Sets switches of the program that drew last: in these scenes the only one.
void switch_on(const Context& context, const std::vector<const char*>& uses) {
    const gl::Api& api = context.api();
    GLint program = 0;
    api->GetIntegerv(GL_CURRENT_PROGRAM, &program);
    for (const char* use : uses) {
        const std::string name = fmt::format("use_{}", use);
        const GLint place = api->GetUniformLocation(static_cast<GLuint>(program), name.c_str());
        api->Uniform1i(place, 1);
    }
}

/// The three programs of one scene.
struct Contenders {
    std::array<std::unique_ptr<Renderer>, 3> renderers;
    std::array<Image, 3> pictures;
};

Contenders contenders(const Context& context, const TypicalScene& typical) {
    Report report;
    const Scene& scene = typical.scene;
    const FramePlan plan = plan_effects(scene, settings);
    const FramePlan everything =
        force_effects(scene, settings, plan, {EffectBase::all_neutral, {}});
    Contenders result;
    const auto make = [&](std::size_t i, const std::string& folder, const FramePlan& frame_plan) {
        use_shaders(folder);
        result.renderers[i] =
            std::make_unique<Renderer>(context, scene, frame_plan, settings, report);
        result.pictures[i] = result.renderers[i]->draw(*scene.camera).image;
    };
    make(0, "", plan);
    make(1, std::string("minimal/") + typical.minimal, plan);
    make(2, "uber", everything);
    switch_on(context, typical.uses);
    result.pictures[2] = result.renderers[2]->draw(*scene.camera).image;
    return result;
}

void measure(const Context& context, const TypicalScene& typical, const Repeats& repeats) {
    const Contenders all = contenders(context, typical);
    const std::array<Renderer*, 3> renderers{all.renderers[0].get(), all.renderers[1].get(),
                                             all.renderers[2].get()};
    const std::vector<FrameSeries> series = time_frames(renderers, *typical.scene.camera, repeats);
    std::array<double, 3> medians{};
    for (std::size_t i = 0; i < medians.size(); ++i)
        medians[i] = spread_of(series[i].draw).median;
    const auto median_ratio = [&](std::size_t of, std::size_t to) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < series[of].draw.size(); ++i)
            ratios.push_back(series[of].draw[i] / series[to].draw[i]);
        return spread_of(ratios).median;
    };
    fmt::print("{:<20} {:8.2f} {:8.2f} {:8.2f}   {:5.3f}   {:5.2f}   {:3.0f} {:3.0f}\n",
               typical.name, medians[0], medians[1], medians[2], median_ratio(0, 1),
               median_ratio(2, 0), compare(all.pictures[0], all.pictures[1]).max,
               compare(all.pictures[0], all.pictures[2]).max);
}

int run(const Repeats& repeats) {
    const Context context(Backend::osmesa);
    fmt::print("{}, median of {} frames in turns, ms of drawing\n", context.renderer_name(),
               repeats.counted);
    fmt::print("{:<20} {:>8} {:>8} {:>8}   {}   {}   {}\n", "scene", "planned", "by hand",
               "branches", "planned/hand", "branches/planned", "largest differences of 255");
    for (const TypicalScene& typical : typical_scenes())
        measure(context, typical, repeats);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    relief::Repeats repeats{.counted = 31, .warm_up = 3};
    if (argc > 1) repeats.counted = static_cast<std::size_t>(std::atoi(argv[1]));
    return relief::bench::run(repeats);
}
