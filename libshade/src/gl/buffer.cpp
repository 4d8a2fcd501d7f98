// SPDX-License-Identifier: Apache-2.0
// Bytes to the GPU and back. See buffer.h. Tests: tests/shade/gl/buffer_test.cpp.
#include "gl/buffer.h"

#include <fmt/format.h>

namespace relief::gl {

Buffer make_buffer(const Api& api, std::span<const std::byte> bytes, std::string_view name,
                   GLenum usage) {
    Buffer buffer(api);
    replace_content(api, buffer, bytes, name, usage);
    return buffer;
}

void replace_content(const Api& api, const Buffer& buffer, std::span<const std::byte> bytes,
                     std::string_view name, GLenum usage) {
    api->BindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
    api->BufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes.size()),
                    bytes.empty() ? nullptr : bytes.data(), usage);
    api->BindBuffer(GL_COPY_WRITE_BUFFER, 0);
    api.check(fmt::format("uploading {} bytes of {}", bytes.size(), name));
}

std::vector<std::byte> read_buffer(const Api& api, const Buffer& buffer) {
    api->BindBuffer(GL_COPY_READ_BUFFER, buffer.name());
    GLint64 size = 0;
    api->GetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &size);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    if (size > 0) {
        api->GetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(size), bytes.data());
    }
    api->BindBuffer(GL_COPY_READ_BUFFER, 0);
    api.check("reading a buffer back");
    return bytes;
}

}  // namespace relief::gl
