// SPDX-License-Identifier: Apache-2.0
// URIs: what is inside a folder, and what data URIs hold.
#include "io/gltf/gltf_uri.h"

#include <gtest/gtest.h>

#include <fstream>

#include "relief/mesh/error.h"
#include "support/shared_data.h"

namespace relief {
namespace {

TEST(GltfUri, OnlyRelativeNamesThatStayBelowAreInside) {
    const std::filesystem::path folder = "/models";
    EXPECT_EQ(path_inside(folder, "a.bin"), "/models/a.bin");
    EXPECT_EQ(path_inside(folder, "./sub/../a%20b%C3%A9.bin"), "/models/a b\xC3\xA9.bin");
    EXPECT_EQ(path_inside(folder, "..a/b"), "/models/..a/b");
    for (const char* uri : {"../a", "sub/../../a", "/a", "%2Fetc/passwd", "..", "%2e%2e/a", "",
                            "file:a", "https://example.org/a.bin", "C:\\a.bin", "a%00b"}) {
        EXPECT_EQ(path_inside(folder, uri), std::nullopt) << uri;
    }
}

TEST(GltfUri, NamesWithUnencodedPercentSignsAreFound) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "100%25.bin") << "x";
    EXPECT_EQ(path_inside(folder.path(), "100%25.bin"), folder / "100%25.bin");
    std::ofstream(folder / "100%.bin") << "x";
    EXPECT_EQ(path_inside(folder.path(), "100%.bin"), folder / "100%.bin");
    EXPECT_EQ(path_inside(folder.path(), "100%25.bin"), folder / "100%.bin");
}

TEST(GltfUri, FileNamesComeBackFromTheirUris) {
    const std::string name = "a b%\xE2\x9D\xA4#?.bin";
    EXPECT_EQ(uri_of(name), "a%20b%25%E2%9D%A4%23%3F.bin");
    EXPECT_EQ(path_inside("/m", uri_of(name)), std::filesystem::path("/m") / name);
}

TEST(GltfUri, DataUrisAreDecoded) {
    // The test vectors of RFC 4648.
    const std::pair<const char*, const char*> vectors[] = {
        {"", ""},    {"Zg==", "f"},        {"Zm8=", "fo"},        {"Zm9v", "foo"},
        {"Zg", "f"}, {"Zm9vYg==", "foob"}, {"Zm9vYmE=", "fooba"}, {"Zm9vYmFy", "foobar"},
    };
    for (const auto& [text, bytes] : vectors) {
        const DataUri data = decode_data_uri(std::string("data:image/png;base64,") + text);
        EXPECT_EQ(data.bytes, bytes);
        EXPECT_EQ(data.media_type, "image/png");
    }
    EXPECT_EQ(decode_data_uri("data:,a%20b").bytes, "a b");
    EXPECT_THROW(decode_data_uri("data:;base64,Zm9vY"), InvalidInput);
    EXPECT_THROW(decode_data_uri("data:;base64,Zm 9"), InvalidInput);
    EXPECT_THROW(decode_data_uri("data:nothing"), InvalidInput);
}

}  // namespace
}  // namespace relief
