// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bytes on the GPU: vertices, indices, uniform blocks, light lists.
/// Tests: tests/shade/gl/buffer_test.cpp.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "gl/handle.h"

namespace relief::gl {

/// A buffer holding a copy of these bytes; it can be bound to any target.
///
/// \param usage  GL_STATIC_DRAW, or GL_DYNAMIC_DRAW for what changes every frame
/// \throws GpuError if memory runs out
///
/// Leaves vertex array and element bindings alone: it works through GL_COPY_WRITE_BUFFER.
Buffer make_buffer(const Api& api, std::span<const std::byte> bytes, std::string_view name,
                   GLenum usage = GL_STATIC_DRAW);

template <typename T>
Buffer make_buffer(const Api& api, std::span<const T> elements, std::string_view name,
                   GLenum usage = GL_STATIC_DRAW) {
    return make_buffer(api, std::as_bytes(elements), name, usage);
}

template <typename T>
Buffer make_buffer(const Api& api, const std::vector<T>& elements, std::string_view name,
                   GLenum usage = GL_STATIC_DRAW) {
    return make_buffer(api, std::as_bytes(std::span(elements)), name, usage);
}

/// Replaces the whole content, whatever its size was. \throws GpuError if memory runs out
void replace_content(const Api& api, const Buffer& buffer, std::span<const std::byte> bytes,
                     std::string_view name, GLenum usage = GL_DYNAMIC_DRAW);

/// What the buffer holds now.
std::vector<std::byte> read_buffer(const Api& api, const Buffer& buffer);

}  // namespace relief::gl
