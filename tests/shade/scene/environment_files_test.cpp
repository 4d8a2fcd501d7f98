// SPDX-License-Identifier: Apache-2.0
// Six faces in a folder are found by the ends of their names, or the one that is not is named.
#include "relief/shade/environment_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "relief/mesh/error.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::filesystem::path& folder) {
    try {
        (void)cube_faces_in(folder);
    } catch (const FileError& error) {
        return error.what();
    }
    return "no error";
}

TEST(CubeFaces, AreFoundInAFolderByTheEndsOfTheirNames) {
    const test::TemporaryDirectory folder;
    const std::vector<std::string> ends = {"posx", "negx", "posy", "negy", "posz", "negz"};
    for (const std::string& end : ends)
        std::ofstream(folder / ("xmas_" + end + ".png")) << "";
    std::ofstream(folder / "readme.txt") << "";
    const CubeFaces faces = cube_faces_in(folder.path());
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(std::get<std::filesystem::path>(faces.faces[i].source),
                  folder / ("xmas_" + ends[i] + ".png"));
    }
    std::ofstream(folder / "other_negy.jpg") << "";
    EXPECT_THAT(error_of(folder.path()),
                HasSubstr("both other_negy.jpg and xmas_negy.png end in negy"));
    std::filesystem::remove(folder / "other_negy.jpg");
    std::filesystem::remove(folder / "xmas_posz.png");
    EXPECT_THAT(error_of(folder.path()), HasSubstr("no file whose name ends in posz"));
    EXPECT_THAT(error_of(folder / "nowhere"), HasSubstr("cannot be read as a folder"));
}

}  // namespace
}  // namespace relief
