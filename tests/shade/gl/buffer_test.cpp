// SPDX-License-Identifier: Apache-2.0
// Bytes go to the GPU and come back unchanged, and nobody else's bindings move.
#include "gl/resources.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "support/gl_environment.h"

namespace relief::gl {
namespace {

class Buffers : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(Buffers);

std::vector<std::byte> bytes_of(const std::vector<float>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

TEST_P(Buffers, KeepEveryByte) {
    std::vector<float> values(1001);
    std::iota(values.begin(), values.end(), -500.25F);
    EXPECT_EQ(read_buffer(api(), make_buffer(api(), values, "values")), bytes_of(values));
}

TEST_P(Buffers, OfNothingAreEmpty) {
    EXPECT_TRUE(read_buffer(api(), make_buffer(api(), std::vector<float>{}, "nothing")).empty());
}

TEST_P(Buffers, ReplacedContentMayBeLargerOrSmaller) {
    const Buffer buffer =
        make_buffer(api(), std::vector<float>{1, 2, 3}, "values", GL_DYNAMIC_DRAW);
    for (const std::vector<float>& values : {std::vector<float>{4, 5, 6, 7}, {8}, {}}) {
        replace_content(api(), buffer, std::as_bytes(std::span(values)), "values");
        EXPECT_EQ(read_buffer(api(), buffer), bytes_of(values));
    }
}

TEST_P(Buffers, UploadingLeavesTheVertexArrayAlone) {
    const VertexArray vertex_array(api());
    const Buffer indices = make_buffer(api(), std::vector<GLuint>{0, 1, 2}, "indices");
    api()->BindVertexArray(vertex_array.name());
    api()->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.name());
    const Buffer other = make_buffer(api(), std::vector<float>{1.0F}, "other");
    GLint element_binding = 0;
    api()->GetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &element_binding);
    EXPECT_EQ(static_cast<GLuint>(element_binding), indices.name());
    api()->BindVertexArray(0);
}

}  // namespace
}  // namespace relief::gl
