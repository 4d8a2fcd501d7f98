// SPDX-License-Identifier: Apache-2.0
// gl_fingerprint BACKEND: draws textured, filtered and multisampled pictures and prints one hash
// line for each, then the loaded libraries. context_test.cpp runs it.
#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <string_view>

#include "gl/cube_map.h"
#include "gl/program.h"
#include "gl/resources.h"
#include "relief/shade/renderer.h"
#include "support/gl_environment.h"

namespace {
using namespace relief::shade;

using namespace relief;
using namespace relief::shade;

/// A smooth panorama with a bright spot, and a noisy image.
Image panorama() {
    Image image = make_image(64, 32, 3, 32, ColorSpace::linear);
    const auto samples = image.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = static_cast<float>((i * 7919U) % 1013U) / 500.0F;
    }
    samples[1234] = 900.0F;
    return image;
}

Image picture() {
    Image image = make_image(61, 37, 4, 8, ColorSpace::srgb);
    std::uint32_t state = 1;
    for (std::uint8_t& sample : image.as<std::uint8_t>()) {
        state = state * 1664525U + 1013904223U;
        sample = static_cast<std::uint8_t>(state >> 24U);
    }
    return image;
}

constexpr const char* shader = R"(
uniform sampler2D picture;
uniform samplerCube surroundings;
out vec4 color;
void main() {
    vec2 p = gl_FragCoord.xy / 97.0;
    vec3 n = normalize(vec3(sin(7.0 * p.x), cos(5.0 * p.y), 0.5 + p.x));
    float highlight = pow(max(dot(n, normalize(vec3(1.0, 2.0, 3.0))), 0.0), 20.0);
    vec3 base = texture(picture, vec2(p.x * 9.0, p.y / (0.1 + p.x))).rgb;
    vec3 mirrored = texture(surroundings, reflect(vec3(p - 0.5, -1.0), n)).rgb;
    color = vec4(0.3 * base + 0.1 * mirrored + highlight, 1.0);
}
)";

std::uint64_t fnv1a(const void* data, std::size_t size) {
    std::uint64_t hash = 14695981039346656037U;
    for (std::size_t i = 0; i < size; ++i) {
        hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 1099511628211U;
    }
    return hash;
}

void print_hash(const gl::Api& api, gl::ColorFormat format, int samples) {
    const gl::Texture texture = gl::make_texture(api, picture(), "picture");
    Report report;
    const gl::CubeMap cube = gl::make_cube_map_from_panorama(api, panorama(), "panorama", report);
    const gl::RenderTarget target(api, 97, 83, format, samples);
    api->ActiveTexture(GL_TEXTURE1);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, texture.name());
    test::cover(api, shader, [](const gl::LinkedProgram& program) {
        program.set("picture", 0);
        program.set("surroundings", 1);
    });
    const Image image = target.read(ColorSpace::linear);
    std::visit(
        [&](const auto& values) {
            fmt::print("{} bits, {} samples: {:016x}\n", image.bits(), samples,
                       fnv1a(values.data(), std::span(values).size_bytes()));
        },
        image.samples);
}

bool is_loaded(const char* library) {
    return dlopen(library, RTLD_LAZY | RTLD_NOLOAD) != nullptr;
}

}  // namespace

int main(int count, char** arguments) {
    const std::string_view name = count > 1 ? arguments[1] : "";
    try {
        const Context context(name == "egl" ? Backend::egl : Backend::osmesa);
        for (const gl::ColorFormat format : {gl::ColorFormat::rgba8, gl::ColorFormat::rgba32f}) {
            for (const int samples : {1, 4})
                print_hash(context.api(), format, samples);
        }
        fmt::print("loaded:{}{}\n", is_loaded("libOSMesa.so.8") ? " OSMesa" : "",
                   is_loaded("libEGL.so.1") ? " EGL" : "");
    } catch (const Error& error) {
        fmt::print("{}\n", error.what());
        return 1;
    }
    return 0;
}
