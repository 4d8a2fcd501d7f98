// SPDX-License-Identifier: Apache-2.0
// From an environment's images to a cube map and a skybox. World space, looked up by direction as
// it is. Unreadable images throw FileError, ones that do not fit together InvalidInput. Tests:
// tests/shade/render/environment_test.cpp.
#include "render/environment.h"

#include <cmath>

#include "effects/shader_source.h"
#include "effects/surface_program.h"
#include "parallel.h"
#include "render/program_cache.h"
#include "scene/image_source.h"

namespace relief {

namespace {

std::span<const ImageSource> sources_of(const Environment& environment) {
    return std::visit(
        [](const auto& source) -> std::span<const ImageSource> {
            if constexpr (std::is_same_v<std::decay_t<decltype(source)>, CubeFaces>) {
                return source.faces;
            } else {
                return {&source.image, 1};
            }
        },
        environment.source);
}

gl::LinkedProgram skybox_program(const gl::Api& api, OutputCoding output) {
    const ShaderSteps steps{{"output", output_file(output)}};
    return link(api, "skybox", assemble("skybox.vert.glsl", steps, {}),
                assemble("skybox.frag.glsl", steps, {}));
}

}  // namespace

std::vector<Image> decode_environment(const Environment& environment) {
    const std::span<const ImageSource> sources = sources_of(environment);
    std::vector<Image> images(sources.size());
    parallel_for(sources.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            images[i] = decode(sources[i], ImageUse::color);
    });
    return images;
}

gl::CubeMap make_environment(const gl::Api& api, const Environment& environment,
                             std::span<const Image> images, Report& report) {
    const std::string& name = sources_of(environment).front().name;
    if (std::holds_alternative<CubeFaces>(environment.source)) {
        return gl::make_cube_map(api, images, name, report);
    }
    return gl::make_cube_map_from_panorama(api, images.front(), name, report);
}

gl::CubeMap make_black_environment(const gl::Api& api) {
    const std::vector<Image> faces(6, make_image(1, 1, 3, 32, ColorSpace::linear));
    Report nothing_to_find;
    return gl::make_cube_map(api, faces, "black", nothing_to_find);
}

Skybox::Skybox(const gl::Api& api, OutputCoding output, float intensity)
    : program_(skybox_program(api, output)), nothing_(api), intensity_(intensity) {}

void Skybox::draw(const gl::Api& api, const Camera& camera, float aspect) const {
    const float y = std::tan(camera.vertical_fov * 0.5F);
    const glm::mat3 world_from_view(camera.world_from_view);
    const glm::mat3 world_from_screen(world_from_view[0] * (y * aspect), world_from_view[1] * y,
                                      -world_from_view[2]);
    program_.use();
    program_.set("world_from_screen", world_from_screen);
    program_.set("environment_intensity", intensity_);
    api->BindVertexArray(nothing_.name());
    api->DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace relief
