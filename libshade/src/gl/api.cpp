// SPDX-License-Identifier: Apache-2.0
// Loads the entry points of a context and collects the messages of its driver.
#include "gl/api.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "relief/shade/renderer.h"

namespace relief::shade::gl {

namespace {

/// The limit of stored messages: a frame that fails repeats its message for every draw.
constexpr std::size_t max_messages = 64;

void GLAD_API_PTR collect(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum /*severity*/,
                          GLsizei length, const GLchar* message, const void* user) {
    // The pointer is the vector of collect_messages(), which OpenGL passes as const.
    auto& messages = *static_cast<std::vector<DebugMessage>*>(const_cast<void*>(user));
    if (messages.size() >= max_messages) return;
    std::string text(message, length >= 0 ? static_cast<std::size_t>(length)
                                          : std::char_traits<char>::length(message));
    while (!text.empty() && (text.back() == '\n' || text.back() == '\0'))
        text.pop_back();
    messages.push_back({type == GL_DEBUG_TYPE_ERROR, std::move(text)});
}

int integer(const GladGLContext& table, GLenum name) {
    GLint value = 0;
    table.GetIntegerv(name, &value);
    return value;
}

}  // namespace

std::string error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        default:
            return fmt::format("OpenGL error 0x{:x}", error);
    }
}

Api::Api(Loader loader) {
    const int version = gladLoadGLContext(&table_, loader);
    if (table_.VERSION_3_3 == 0) {
        throw GpuError(fmt::format("it offers OpenGL {}.{}, but 3.3 is needed",
                                   GLAD_VERSION_MAJOR(version), GLAD_VERSION_MINOR(version)));
    }
    collect_messages();
    read_limits();
    table_.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    table_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    table_.PixelStorei(GL_PACK_ALIGNMENT, 1);
}

Api::~Api() {
    // The driver must not write into the vector of messages any more.
    if (has_debug_messages()) table_.DebugMessageCallback(nullptr, nullptr);
}

void Api::collect_messages() {
    if (!has_debug_messages()) return;
    table_.Enable(GL_DEBUG_OUTPUT);
    // Messages arrive on the calling thread before the call returns; otherwise check() would miss
    // them.
    table_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    table_.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    table_.DebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_PERFORMANCE, GL_DONT_CARE, 0, nullptr,
                               GL_FALSE);
    table_.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0,
                               nullptr, GL_FALSE);
    table_.DebugMessageCallback(collect, &messages_);
}

void Api::read_limits() {
    limits_.texture_size = integer(table_, GL_MAX_TEXTURE_SIZE);
    limits_.cube_size = integer(table_, GL_MAX_CUBE_MAP_TEXTURE_SIZE);
    limits_.renderbuffer_size = integer(table_, GL_MAX_RENDERBUFFER_SIZE);
    std::array<GLint, 2> viewport{};
    table_.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
    limits_.viewport_width = viewport[0];
    limits_.viewport_height = viewport[1];
    limits_.buffer_texels = integer(table_, GL_MAX_TEXTURE_BUFFER_SIZE);
    limits_.uniform_block_bytes = integer(table_, GL_MAX_UNIFORM_BLOCK_SIZE);
    limits_.texture_units = integer(table_, GL_MAX_TEXTURE_IMAGE_UNITS);
    limits_.samples = integer(table_, GL_MAX_SAMPLES);
    // Mesa's rasterizer applies the weights of its anisotropic filter even if a texture is
    // magnified, or looked up at a given level: texels 10 20 30 40, looked up in the center of the
    // first one, give 13.5. So anisotropic filtering is disabled there.
    const bool is_anisotropic =
        table_.ARB_texture_filter_anisotropic != 0 || table_.EXT_texture_filter_anisotropic != 0;
    if (is_anisotropic && !is_software()) {
        table_.GetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &limits_.anisotropy);
    }
}

std::string Api::text(GLenum name) const {
    const GLubyte* value = table_.GetString(name);
    return value == nullptr ? "" : reinterpret_cast<const char*>(value);
}

bool Api::is_software() const {
    const std::string name = renderer();
    const std::array<std::string_view, 4> rasterizers{"llvmpipe", "softpipe", "swrast", "SWR"};
    return std::ranges::any_of(rasterizers, [&](std::string_view rasterizer) {
        return name.find(rasterizer) != std::string::npos;
    });
}

std::vector<DebugMessage> Api::take_messages() const {
    // The loop is limited because a lost context reports errors forever.
    for (std::size_t i = 0; i < max_messages; ++i) {
        const GLenum error = table_.GetError();
        if (error == GL_NO_ERROR) break;
        // The callback has reported the error with more detail, unless the driver lacks KHR_debug.
        const bool is_reported = std::ranges::any_of(messages_, &DebugMessage::error);
        if (!is_reported) messages_.push_back({true, error_name(error)});
    }
    return std::exchange(messages_, {});
}

void Api::check(std::string_view doing) const {
    std::vector<DebugMessage> messages = take_messages();
    const auto error = std::ranges::find_if(messages, &DebugMessage::error);
    if (error != messages.end()) throw GpuError(fmt::format("{}: {}", doing, error->text));
    messages_ = std::move(messages);  // Warnings stay until take_messages().
}

}  // namespace relief::shade::gl
