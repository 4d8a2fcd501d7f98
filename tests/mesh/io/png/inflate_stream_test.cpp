// SPDX-License-Identifier: Apache-2.0
// zlib streams in pieces: whatever the pieces of input and output, the same bytes; damage is
// noticed.
#include "io/png/inflate_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "module_reference.h"

namespace relief {
namespace {

/// Inflates to `size` bytes, `given` of the stream and `taken` of the result at a time; nothing
/// where it cannot.
std::string inflated(const std::string& stream, std::size_t size, std::size_t given,
                     std::size_t taken) {
    std::size_t at = 0;
    InflateStream inflate([&] {
        const std::size_t first = at;
        at = std::min(at + given, stream.size());
        return std::as_bytes(std::span(stream).subspan(first, at - first));
    });
    std::string bytes(size, '\0');
    for (std::size_t to = 0; to < size; to += taken) {
        const std::size_t count = std::min(taken, size - to);
        if (!inflate.fill(std::as_writable_bytes(std::span(bytes).subspan(to, count)))) return {};
    }
    return inflate.is_complete() ? bytes : "";
}

std::string text() {
    std::string all;
    for (int i = 0; i < 20000; ++i)
        all += std::to_string(i * i % 977);
    return all;
}

TEST(InflateStream, GivesTheSameBytesHoweverItIsFed) {
    const std::string bytes = text();
    const std::string stream = test::zlib_stream(bytes);
    for (const std::size_t given :
         {std::size_t{1}, std::size_t{7}, std::size_t{5000}, stream.size()})
        for (const std::size_t taken : {std::size_t{1}, std::size_t{1000}, bytes.size()})
            EXPECT_TRUE(inflated(stream, bytes.size(), given, taken) == bytes);
}

TEST(InflateStream, NoticesDamageAndAnotherLength) {
    const std::string bytes = text();
    const std::string stream = test::zlib_stream(bytes);
    EXPECT_EQ(inflated(stream, bytes.size() + 1, 5000, 5000), "");
    EXPECT_EQ(inflated(stream, bytes.size() - 1, 5000, 5000), "");
    EXPECT_EQ(inflated(stream.substr(0, stream.size() - 1), bytes.size(), 5000, 5000), "");
    EXPECT_EQ(inflated("", bytes.size(), 5000, 5000), "");
    for (std::size_t at = 0; at < stream.size(); at += stream.size() / 40) {
        std::string changed = stream;
        changed[at] ^= 4;
        EXPECT_EQ(inflated(changed, bytes.size(), 5000, 5000), "") << at;
    }
}

}  // namespace
}  // namespace relief
