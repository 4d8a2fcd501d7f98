// SPDX-License-Identifier: Apache-2.0
// Render targets of a picture and the pass that averages and codes samples. Linear light; sRGB
// codes by IEC 61966-2-1. Bad sizes throw as RenderTarget says. Tests:
// tests/shade/render/renderer_test.cpp.
#include "render/picture.h"

#include <algorithm>

#include "effects/shader_source.h"
#include "effects/surface_program.h"
#include "render/program_cache.h"

namespace relief {

namespace {

gl::ColorFormat format_of(OutputCoding coding, int samples) {
    if (coding == OutputCoding::srgb) return gl::ColorFormat::rgba8;
    // Half floats keep [0,1] finer than 8-bit codes can tell, at half the memory.
    const bool for_codes = coding == OutputCoding::clamped && samples > 1;
    return for_codes ? gl::ColorFormat::rgba16f : gl::ColorFormat::rgba32f;
}

/// The background as a shader would have written it.
glm::vec4 coded(const glm::vec4& background, OutputCoding coding) {
    glm::vec3 color(background);
    if (coding != OutputCoding::linear) color = glm::min(color, glm::vec3(1.0F));
    if (coding == OutputCoding::srgb) {
        for (int i = 0; i < 3; ++i)
            color[i] = srgb_from_linear(color[i]);
    }
    return {color, background.a};
}

gl::LinkedProgram coding_program(const gl::Api& api, OutputCoding output) {
    const ShaderSteps steps{{"output", output_file(output)}};
    return link(api, "resolve", assemble("resolve.vert.glsl", steps, {}),
                assemble("resolve.frag.glsl", steps, {}));
}

}  // namespace

OutputCoding Picture::drawn_coding(const FrameSettings& settings) {
    const bool codes_later = settings.samples > 1 && settings.output == OutputCoding::srgb;
    return codes_later ? OutputCoding::clamped : settings.output;
}

Picture::Picture(const gl::Api& api, const FrameSettings& settings)
    : api_(&api),
      drawn_(drawn_coding(settings)),
      output_(settings.output),
      samples_(api, settings.width, settings.height, format_of(drawn_, settings.samples),
               settings.samples),
      nothing_(api) {
    if (settings.samples == 1) return;
    coded_.emplace(api, settings.width, settings.height, format_of(output_, 1), 1);
    coding_.emplace(coding_program(api, output_));
}

void Picture::begin(const glm::vec4& background) const {
    samples_.bind();
    glm::vec4 color = coded(background, drawn_);
    if (averages()) color = {glm::vec3(color) * color.a, color.a};
    const gl::Api& gl = *api_;
    gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->DepthMask(GL_TRUE);
    gl->ClearColor(color.r, color.g, color.b, color.a);
    gl->ClearDepth(1.0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Picture::finish() const {
    const gl::Api& gl = *api_;
    if (averages()) {
        samples_.resolve();
        coded_->bind();
        gl->Disable(GL_DEPTH_TEST);
        gl->Disable(GL_CULL_FACE);
        coding_->use();
        gl->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(TextureUnit::averaged));
        gl->BindTexture(GL_TEXTURE_2D, samples_.color().name());
        gl->BindSampler(static_cast<GLuint>(TextureUnit::averaged), 0);
        gl->BindVertexArray(nothing_.name());
        gl->DrawArrays(GL_TRIANGLES, 0, 3);
    }
    gl->Finish();
}

Image Picture::read() const {
    const ColorSpace space = output_ == OutputCoding::srgb ? ColorSpace::srgb : ColorSpace::linear;
    return (averages() ? *coded_ : samples_).read(space);
}

}  // namespace relief
