// SPDX-License-Identifier: Apache-2.0
#include "tools/workplace.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>

#include "relief/mesh/image_file.h"

namespace relief::test {

namespace fs = std::filesystem;

Workplace::Workplace() {
    fs::create_directory(folder_ / "out");
    fs::create_directory(folder_ / "build");
    fs::create_directory_symlink(source_directory() / "data", folder_ / "data");
    fs::create_directory_symlink(source_directory() / "conformance", folder_ / "conformance");
    fs::create_directory_symlink(source_directory() / "scripts", folder_ / "scripts");
    fs::create_directory_symlink(RELIEF_BUILD_DIRECTORY, folder_ / "build/release");
}

ProgramResult Workplace::run(const std::string& line) const {
    return run_line(line, folder_.path());
}

void Workplace::write(const fs::path& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Workplace::read(const fs::path& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void Workplace::write_square(const fs::path& name, bool plain) const {
    const std::string positions = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
    write(name, plain ? positions + "f 1 2 3\nf 1 3 4\n"
                      : positions +
                            "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                            "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
}

void Workplace::write_bricks(const fs::path& name) const {
    constexpr int side = 256;
    const Image whole = read_image(source_directory() / "data/bricks-height.png", ImageUse::data);
    Image part = make_image(side, side, 1, 16, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        const auto row = whole.as<std::uint16_t>().subspan(
            static_cast<std::size_t>(y) * static_cast<std::size_t>(whole.width), side);
        std::copy(row.begin(), row.end(), part.as<std::uint16_t>().begin() + y * side);
    }
    write_image(folder_ / name, part);
}

void Workplace::shrink_bricks() const {
    fs::remove(folder_ / "data");
    fs::create_directory(folder_ / "data");
    for (const auto& entry : fs::directory_iterator(source_directory() / "data")) {
        const fs::path name = entry.path().filename();
        if (name != "bricks-height.png") fs::create_symlink(entry.path(), folder_ / "data" / name);
    }
    write_bricks("data/bricks-height.png");
}

std::string Workplace::outputs() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "out"))
        names.insert(entry.path().filename().string());
    std::string list;
    for (const std::string& name : names)
        list += (list.empty() ? "" : " ") + name;
    return list;
}

}  // namespace relief::test
