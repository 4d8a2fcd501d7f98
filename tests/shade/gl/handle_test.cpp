// SPDX-License-Identifier: Apache-2.0
// Owners of GL names: one deletes exactly what it made, once.
#include "gl/api.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "support/gl_environment.h"

namespace relief::gl {
namespace {

class Handles : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(Handles);

/// A buffer is one for OpenGL only once it has been bound.
GLuint bound(const Api& api, const Buffer& buffer) {
    api->BindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
    api->BindBuffer(GL_COPY_WRITE_BUFFER, 0);
    return buffer.name();
}

TEST_P(Handles, AnEmptyOneHoldsZeroAndDeletesNothing) {
    const Texture empty;
    EXPECT_EQ(empty.name(), 0U);
    EXPECT_FALSE(empty);
    EXPECT_EQ(api().live_names(), 0U);
}

TEST_P(Handles, TheNameIsDeletedAtTheEndOfLife) {
    GLuint name = 0;
    {
        const Buffer buffer(api());
        name = bound(api(), buffer);
        EXPECT_EQ(api()->IsBuffer(name), GL_TRUE);
        EXPECT_EQ(api().live_names(), 1U);
    }
    EXPECT_EQ(api()->IsBuffer(name), GL_FALSE);
}

TEST_P(Handles, MovingLeavesTheSourceEmptyAndTheNameAlive) {
    Buffer source(api());
    const GLuint name = bound(api(), source);
    Buffer target(std::move(source));
    EXPECT_FALSE(source);  // NOLINT(bugprone-use-after-move): what it promises.
    EXPECT_EQ(target.name(), name);
    EXPECT_EQ(api()->IsBuffer(name), GL_TRUE);
    EXPECT_EQ(api().live_names(), 1U);
}

TEST_P(Handles, MoveAssignmentDeletesWhatWasHeldBefore) {
    Buffer first(api());
    Buffer second(api());
    const GLuint first_name = bound(api(), first);
    const GLuint second_name = bound(api(), second);
    first = std::move(second);
    EXPECT_EQ(first.name(), second_name);
    EXPECT_EQ(api()->IsBuffer(first_name), GL_FALSE);
    EXPECT_EQ(api()->IsBuffer(second_name), GL_TRUE);
    Buffer& same = first;
    first = std::move(same);
    EXPECT_EQ(first.name(), second_name);
    EXPECT_EQ(api()->IsBuffer(second_name), GL_TRUE);
    first.reset();
    first.reset();
    EXPECT_EQ(api()->IsBuffer(second_name), GL_FALSE);
}

TEST_P(Handles, EveryKindIsMadeAndDeleted) {
    {
        const Buffer buffer(api());
        const Texture texture(api());
        const Sampler sampler(api());
        const VertexArray vertex_array(api());
        const Framebuffer framebuffer(api());
        const Renderbuffer renderbuffer(api());
        const Program program(api());
        const Shader shader(api(), GLenum{GL_VERTEX_SHADER});
        EXPECT_TRUE(buffer && texture && sampler && vertex_array && framebuffer && renderbuffer);
        EXPECT_EQ(api()->IsProgram(program.name()), GL_TRUE);
        EXPECT_EQ(api()->IsShader(shader.name()), GL_TRUE);
        EXPECT_EQ(api().live_names(), 8U);
    }
    EXPECT_EQ(api().live_names(), 0U);
}

TEST_P(Handles, AVectorThatGrowsKeepsItsNames) {
    std::vector<Buffer> buffers;
    std::vector<GLuint> names;
    for (int i = 0; i < 40; ++i) {
        buffers.emplace_back(api());
        names.push_back(bound(api(), buffers.back()));
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(buffers[i].name(), names[i]);
        EXPECT_EQ(api()->IsBuffer(names[i]), GL_TRUE);
    }
}

}  // namespace
}  // namespace relief::gl
