// SPDX-License-Identifier: Apache-2.0
// Names of picture files, and writing them. Tests: tests/tools/accuracy_report_test.cpp.
#include "report_pictures.h"

#include <fmt/format.h>

#include "common/command.h"
#include "relief/mesh/heat_picture.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

const char* word_of(PictureRole role) {
    switch (role) {
        case PictureRole::heat:
            return "heat";
        case PictureRole::before:
            return "before";
        case PictureRole::after:
            break;
    }
    return "after";
}

}  // namespace

std::string picture_file(const Experiment& experiment, PictureRole role, std::size_t index) {
    std::string name = experiment.id;
    for (char& letter : name) {
        const bool is_plain = (letter >= 'a' && letter <= 'z') ||
                              (letter >= 'A' && letter <= 'Z') ||
                              (letter >= '0' && letter <= '9') || letter == '.';
        if (!is_plain) letter = '-';
    }
    return fmt::format("pictures/{}-{}-{}.png", name, word_of(role), index + 1);
}

void write_pictures(const std::filesystem::path& folder, const AccuracyReport& report) {
    const auto write = [&](const std::string& file, const Image& image) {
        make_folder(folder / "pictures");
        write_image(folder / file, image);
    };
    for (const Experiment& one : report.experiments) {
        for (std::size_t i = 0; i < one.heat_maps.size(); ++i) {
            const HeatMap& map = one.heat_maps[i];
            write(picture_file(one, PictureRole::heat, i), heat_picture(map.errors, map.brightest));
        }
        for (std::size_t i = 0; i < one.pictures.size(); ++i) {
            write(picture_file(one, PictureRole::before, i), one.pictures[i].before);
            write(picture_file(one, PictureRole::after, i), one.pictures[i].after);
        }
    }
}

}  // namespace relief::tools
