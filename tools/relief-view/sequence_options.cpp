// SPDX-License-Identifier: Apache-2.0
#include "sequence_options.h"

#include <fmt/format.h>

#include "common/text.h"

namespace relief::tools {
namespace {

constexpr int most_frames = 100000;
constexpr std::size_t usual_digits = 4;

bool is_sequence(const ViewOptions& options) {
    return options.turntable || options.frames;
}

}  // namespace

void add_sequence_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Sequences";
    const auto add_count = [&](const char* name, std::optional<int>& target,
                               const char* description) {
        add_value(app, name, "N", description,
                  [&target](const std::string& subject, const std::string& text) {
                      target = parse_integer(subject, text, 1, most_frames);
                  })
            .group(group);
    };
    add_count("--turntable", options.turntable,
              "Draw N pictures in which the model turns once about its vertical axis. A .png or "
              ".exr output becomes numbered files (spin-0001.png, or # in the name for each "
              "digit), an .apng one an animation.");
    add_count("--frames", options.frames,
              "Draw N pictures of the scene's animation, evenly spaced in time.");
    add_number(app, "--seconds", "S", options.seconds, {1e-3, 1e6, ""},
               "How much of the animation --frames shows. Default: until all of it has run once.")
        .group(group);
    add_number(app, "--fps", "F", options.frames_per_second, {0.1, 1000, ""},
               "Pictures per second of an .apng animation. Default: 25.")
        .group(group);
    add_number(app, "--time", "T", options.time, {-1e6, 1e6, ""},
               "When in the scene's animation the picture is taken, in seconds. Default: 0.")
        .group(group);
}

void check_sequence(const ViewOptions& options) {
    const bool animated = options.output && extension_of(*options.output) == ".apng";
    refuse(options.turntable && options.frames, "--turntable",
           "contradicts --frames, as both say what changes", "leave one of them out");
    refuse(options.seconds && !options.frames, "--seconds", "says how much --frames shows",
           "give --frames too, or leave it out");
    refuse(options.frames_per_second && !animated, "--fps", "is said of an animation",
           "write an .apng, or leave it out");
    refuse(animated && !is_sequence(options), "--output " + options.output.value_or("").string(),
           "an animation of one picture", "add --turntable or --frames, or write a .png");
    refuse(options.time && options.frames, "--time", "contradicts --frames, which shows many times",
           "leave one of them out");
    refuse(is_sequence(options) && options.reference, "--reference",
           "is one picture, and a sequence is many", "leave one of them out");
    refuse(is_sequence(options) && !options.output, options.turntable ? "--turntable" : "--frames",
           "there is no --output to write the pictures to", "name one");
}

int picture_count(const ViewOptions& options) {
    return options.turntable.value_or(options.frames.value_or(1));
}

std::filesystem::path numbered_file(const std::filesystem::path& output, int index) {
    std::string name = output.filename().string();
    const std::size_t first = name.find('#');
    if (first == std::string::npos) {
        return output.parent_path() / fmt::format("{}-{:0{}}{}", output.stem().string(), index,
                                                  usual_digits, output.extension().string());
    }
    const std::size_t end = std::min(name.find_first_not_of('#', first), name.size());
    name.replace(first, end - first, fmt::format("{:0{}}", index, end - first));
    return output.parent_path() / name;
}

}  // namespace relief::tools
