// SPDX-License-Identifier: Apache-2.0
// Cube maps, prefiltered maps and irradiance of environments, and the skybox. Directions are in
// world space. Tests: tests/shade/render/environment_test.cpp.
#include "render/environment.h"

#include <algorithm>
#include <cmath>

#include "effects/features.h"
#include "effects/shader_source.h"
#include "environment/convolution.h"
#include "environment/environment_images.h"
#include "gl/cube_map.h"
#include "gl/resources.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/shade/scene_file.h"
#include "render/draw_values.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {
using namespace relief::detail;

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

gl::CubeMap black_cube_map(const gl::Api& api) {
    const std::vector<Image> faces(6, make_image(1, 1, 3, 32, ColorSpace::linear));
    Report ignored;
    return gl::make_cube_map(api, faces, "black", ignored);
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

/// Returns the irradiance of an environment.
IrradianceSh irradiance_of(const gl::Api& api, const gl::CubeMap& environment) {
    // Spherical harmonics of second order do not resolve details of 1.5 degrees.
    constexpr int max_size = 64;
    int level = 0;
    while (environment.size >> level > max_size)
        ++level;
    return irradiance_sh(read_faces(api, environment, level));
}

/// Returns the coefficients times the intensity, padded to the layout of the shader.
std::array<glm::vec4, 9> padded(const IrradianceSh& sh, float intensity) {
    std::array<glm::vec4, 9> rows{};
    for (std::size_t i = 0; i < sh.size(); ++i)
        rows.at(i) = glm::vec4(intensity * sh.at(i), 0.0F);
    return rows;
}

/// Returns the albedo table of environment/convolution.h: columns are sqrt(n.v), rows are
/// roughness; red is A, green is B.
gl::Texture brdf_texture(const gl::Api& api) {
    constexpr int size = 64;
    gl::Texture texture =
        gl::make_texture(api, environment_brdf_table(size), "albedo of GGX", false);
    api->BindTexture(GL_TEXTURE_2D, texture.name());
    gl::set_sampling(api, GL_TEXTURE_2D,
                     {GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE, GL_LINEAR, GL_LINEAR, 1.0F});
    // Other textures of two channels are gray and alpha.
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_G, GL_GREEN);
    api->BindTexture(GL_TEXTURE_2D, 0);
    return texture;
}

bool is_left_handed(const Environment& environment) {
    const auto* faces = std::get_if<CubeFaces>(&environment.source);
    return faces != nullptr && faces->left_handed;
}

std::vector<Image> decoded(const Environment& environment) {
    const std::span<const ImageSource> sources = sources_of(environment);
    std::vector<Image> images(sources.size());
    ProgressStage stage("environment", sources.size());
    parallel_for(sources.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            images[i] = decode(sources[i], ImageUse::color);
            stage.advance(1);
        }
    });
    return images;
}

}  // namespace

bool EnvironmentCache::Entry::is(const Environment& environment) const {
    const std::span<const ImageSource> sources = sources_of(environment);
    if (layout != environment.source.index() || left_handed != is_left_handed(environment) ||
        images.size() != sources.size())
        return false;
    return std::equal(
        images.begin(), images.end(), sources.begin(),
        [](const ImageIdentity& image, const ImageSource& source) { return image.is(source); });
}

std::shared_ptr<GpuEnvironment> EnvironmentCache::find(const Environment& environment) const {
    const auto entry = std::find_if(environments_.begin(), environments_.end(),
                                    [&](const Entry& known) { return known.is(environment); });
    return entry == environments_.end() ? nullptr : entry->maps;
}

void EnvironmentCache::decode(const Environment& environment) {
    decoded_.clear();
    for (const ImageSource& source : sources_of(environment))
        note_image_file(source);
    if (!find(environment)) decoded_ = decoded(environment);
}

std::shared_ptr<GpuEnvironment> EnvironmentCache::get(const Environment& environment,
                                                      Report& report) {
    std::shared_ptr<GpuEnvironment> maps = find(environment);
    if (!maps) {
        maps = std::make_shared<GpuEnvironment>();
        maps->sharp = cube_map_of(*api_, environment, decoded_, maps->findings);
        decoded_.clear();
        Entry entry{{}, environment.source.index(), is_left_handed(environment), maps};
        for (const ImageSource& source : sources_of(environment))
            entry.images.emplace_back(source);
        environments_.push_back(std::move(entry));
    }
    report.merge(maps->findings);
    return maps;
}

std::shared_ptr<GpuEnvironment> EnvironmentCache::black() {
    if (!black_) {
        black_ = std::make_shared<GpuEnvironment>();
        black_->sharp = black_cube_map(*api_);
        black_->blurred = black_cube_map(*api_);
        black_->irradiance.emplace();
    }
    return black_;
}

std::shared_ptr<const gl::Texture> EnvironmentCache::brdf() {
    if (!brdf_) brdf_ = std::make_shared<const gl::Texture>(brdf_texture(*api_));
    return brdf_;
}

void EnvironmentCache::drop_unused() {
    std::erase_if(environments_, [](const Entry& entry) { return entry.maps.use_count() == 1; });
}

EnvironmentMaps::EnvironmentMaps(const gl::Api& api, EnvironmentCache& cache, const Scene& scene,
                                 const FramePlan& plan, bool is_shown, Report& report) {
    const EnvironmentNeeds needs = environment_needs(plan);
    if (is_shown) {
        maps_ = cache.get(*scene.environment, report);
    } else if (needs.any() || plan.skybox) {
        maps_ = cache.black();
    }
    if (needs.brdf) brdf_ = cache.brdf();
    if (!maps_) return;
    has_blurred_ = needs.blurred;
    if (needs.blurred && !maps_->blurred) maps_->blurred = make_prefiltered(api, maps_->sharp);
    if (needs.irradiance) {
        if (!maps_->irradiance) maps_->irradiance = irradiance_of(api, maps_->sharp);
        irradiance_sh_ = is_shown
                             ? padded(rotated(*maps_->irradiance,
                                              static_cast<double>(scene.environment->rotation)),
                                      scene.environment->intensity)
                             : padded(*maps_->irradiance, 0.0F);
    }
}

void EnvironmentMaps::bind(const gl::Api& api) const {
    const auto bind_to = [&](TextureUnit unit, GLenum target, const gl::Texture& texture) {
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        api->BindTexture(target, texture.name());
        api->BindSampler(static_cast<GLuint>(unit), 0);
    };
    if (maps_) bind_to(TextureUnit::environment, GL_TEXTURE_CUBE_MAP, maps_->sharp.texture);
    if (has_blurred_) {
        bind_to(TextureUnit::blurred_environment, GL_TEXTURE_CUBE_MAP, maps_->blurred->texture);
    }
    if (brdf_) bind_to(TextureUnit::environment_brdf, GL_TEXTURE_2D, *brdf_);
}

std::size_t EnvironmentMaps::texture_count() const {
    return static_cast<std::size_t>(maps_ != nullptr) + static_cast<std::size_t>(has_blurred_) +
           static_cast<std::size_t>(brdf_ != nullptr);
}

float EnvironmentMaps::blurred_levels() const {
    return has_blurred_ ? static_cast<float>(maps_->blurred->levels - 1) : 0.0F;
}

Skybox::Skybox(const gl::Api& api, ProgramCache& programs, const Scene& scene, OutputCoding output,
               float blurred_levels)
    : program_(programs.get("skybox", skybox_steps(output, scene))),
      empty_vertices_(api),
      intensity_(scene.environment ? scene.environment->intensity : 0.0F),
      turn_(scene.environment ? environment_turn(*scene.environment) : glm::vec2(1.0F, 0.0F)),
      exposure_(scene.exposure),
      blur_(scene.environment ? scene.environment->skybox_blur : 0.0F),
      blurred_levels_(blurred_levels) {}

void Skybox::draw(const gl::Api& api, const Camera& camera, float aspect) const {
    // All rays of an orthographic camera have the same direction.
    const float y = camera.orthographic_height ? 0.0F : static_cast<float>(half_height(camera));
    const glm::mat3 world_from_view(camera.world_from_view);
    const glm::mat3 world_from_screen(world_from_view[0] * (y * aspect), world_from_view[1] * y,
                                      -world_from_view[2]);
    program_->use();
    program_->set("world_from_screen", world_from_screen);
    program_->set("environment_intensity", intensity_);
    program_->set("environment_turn", turn_);
    program_->set("exposure", exposure_);
    program_->set("skybox_blur", blur_);
    program_->set("blurred_levels", blurred_levels_);
    api->BindVertexArray(empty_vertices_.name());
    api->DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace relief::shade::detail
