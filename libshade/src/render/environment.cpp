// SPDX-License-Identifier: Apache-2.0
// From an environment's images to a cube map and a skybox. World space, looked up by direction as
// it is. Unreadable images throw FileError, ones that do not fit together InvalidInput. Tests:
// tests/shade/render/environment_test.cpp.
#include "render/environment.h"

#include <algorithm>
#include <cmath>

#include "effects/environment_needs.h"
#include "effects/shader_source.h"
#include "effects/surface_program.h"
#include "environment/cube_faces.h"
#include "environment/environment_brdf.h"
#include "environment/irradiance_sh.h"
#include "gl/prefilter.h"
#include "gl/texture.h"
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

gl::LinkedProgram skybox_program(const gl::Api& api, const Scene& scene, OutputCoding output) {
    const ShaderSteps steps = output_steps(output, scene);
    return link(api, "skybox", assemble("skybox.vert.glsl", steps, {}),
                assemble("skybox.frag.glsl", steps, {}));
}

gl::CubeMap black_cube_map(const gl::Api& api) {
    const std::vector<Image> faces(6, make_image(1, 1, 3, 32, ColorSpace::linear));
    Report nothing_to_find;
    return gl::make_cube_map(api, faces, "black", nothing_to_find);
}

gl::CubeMap cube_map_of(const gl::Api& api, const Environment& environment,
                        std::span<const Image> images, Report& report) {
    const std::string& name = sources_of(environment).front().name;
    if (const auto* faces = std::get_if<CubeFaces>(&environment.source)) {
        if (!faces->left_handed) return gl::make_cube_map(api, images, name, report);
        check_faces(images, name);
        return gl::make_cube_map(api, other_handed(images), name, report);
    }
    if (std::holds_alternative<CubeCross>(environment.source))
        return gl::make_cube_map(api, faces_of_cross(images.front(), name), name, report);
    if (std::holds_alternative<AngularMap>(environment.source))
        return gl::make_cube_map_from_angular_map(api, images.front(), name, report);
    return gl::make_cube_map_from_panorama(api, images.front(), name, report);
}

/// What the surroundings shed, times their intensity, padded as the shader wants it.
std::array<glm::vec4, 9> irradiance_of(const gl::Api& api, const gl::CubeMap& environment,
                                       float intensity) {
    // The harmonics are as wide as the sphere: details of a degree and a half do not matter.
    constexpr int enough_texels = 64;
    int level = 0;
    while (environment.size >> level > enough_texels)
        ++level;
    const IrradianceSh sh = irradiance_sh(read_faces(api, environment, level));
    std::array<glm::vec4, 9> padded{};
    for (std::size_t i = 0; i < sh.size(); ++i)
        padded.at(i) = glm::vec4(intensity * sh.at(i), 0.0F);
    return padded;
}

/// Column for the root of n.v, row for roughness; red is A, green B
/// (environment/environment_brdf.h).
gl::Texture brdf_texture(const gl::Api& api) {
    constexpr int size = 64;
    gl::Texture texture =
        gl::make_texture(api, environment_brdf_table(size), "albedo of GGX", false);
    api->BindTexture(GL_TEXTURE_2D, texture.name());
    gl::set_sampling(api, GL_TEXTURE_2D,
                     {GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE, GL_LINEAR, GL_LINEAR, 1.0F});
    // Two channels stand for grey and alpha elsewhere.
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_G, GL_GREEN);
    api->BindTexture(GL_TEXTURE_2D, 0);
    return texture;
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

EnvironmentMaps::EnvironmentMaps(const gl::Api& api, const Scene& scene, const FramePlan& plan,
                                 std::span<const Image> images, Report& report) {
    const EnvironmentNeeds needs = environment_needs(plan);
    if (!images.empty()) {
        sharp_ = cube_map_of(api, *scene.environment, images, report);
    } else if (needs.any() || plan.skybox) {
        sharp_ = black_cube_map(api);
    }
    if (needs.brdf) brdf_ = brdf_texture(api);
    if (needs.blurred) {
        blurred_ = images.empty() ? black_cube_map(api) : make_prefiltered(api, *sharp_);
    }
    if (needs.irradiance && !images.empty())
        irradiance_sh_ = irradiance_of(api, *sharp_, scene.environment->intensity);
}

void EnvironmentMaps::bind(const gl::Api& api) const {
    const auto bind_to = [&](TextureUnit unit, GLenum target, const gl::Texture& texture) {
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        api->BindTexture(target, texture.name());
        api->BindSampler(static_cast<GLuint>(unit), 0);
    };
    if (sharp_) bind_to(TextureUnit::environment, GL_TEXTURE_CUBE_MAP, sharp_->texture);
    if (blurred_) {
        bind_to(TextureUnit::blurred_environment, GL_TEXTURE_CUBE_MAP, blurred_->texture);
    }
    if (brdf_) bind_to(TextureUnit::environment_brdf, GL_TEXTURE_2D, *brdf_);
}

std::size_t EnvironmentMaps::texture_count() const {
    return static_cast<std::size_t>(sharp_.has_value()) +
           static_cast<std::size_t>(blurred_.has_value()) +
           static_cast<std::size_t>(brdf_.has_value());
}

float EnvironmentMaps::blurred_levels() const {
    return blurred_ ? static_cast<float>(blurred_->levels - 1) : 0.0F;
}

Skybox::Skybox(const gl::Api& api, const Scene& scene, OutputCoding output)
    : program_(skybox_program(api, scene, output)),
      nothing_(api),
      intensity_(scene.environment ? scene.environment->intensity : 0.0F),
      exposure_(scene.exposure) {}

void Skybox::draw(const gl::Api& api, const Camera& camera, float aspect) const {
    const float y = std::tan(camera.vertical_fov * 0.5F);
    const glm::mat3 world_from_view(camera.world_from_view);
    const glm::mat3 world_from_screen(world_from_view[0] * (y * aspect), world_from_view[1] * y,
                                      -world_from_view[2]);
    program_.use();
    program_.set("world_from_screen", world_from_screen);
    program_.set("environment_intensity", intensity_);
    program_.set("exposure", exposure_);
    api->BindVertexArray(nothing_.name());
    api->DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace relief
