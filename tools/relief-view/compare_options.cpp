// SPDX-License-Identifier: Apache-2.0
#include "compare_options.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/text.h"
#include "variant_scene.h"
#include "window/orbit_camera.h"

namespace relief::tools {

void add_compare_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Comparison";
    std::vector<std::string> topics;
    for (const VariantTopic& topic : variant_topics()) {
        std::vector<std::string> words;
        for (const auto& [word, variant] : topic.choices)
            words.push_back(word);
        topics.push_back(fmt::format("{}= {}", topic.name, fmt::join(words, ", ")));
    }
    add_value(app, "--compare", "WHAT=VALUE",
              fmt::format("Show the right half with one change, and say how far the two pictures "
                          "are apart. One of {}.",
                          fmt::join(topics, "; ")),
              [&](const std::string& subject, const std::string& text) {
                  options.compare.variant = parse_variant(subject, text);
              })
        .group(group);
    add_path(app, "--compare-to", options.compare.file,
             "Show another model or scene file in the right half, from the same eye; a model in "
             "the same light.")
        .group(group);
    add_number(app, "--split", "X", options.compare.split, {0, 1, ""},
               "Where the right side begins, from 0, all of the picture, to 1, nothing. "
               "Default: 0.5.")
        .group(group);
}

void check_compare_options(const ViewOptions& options) {
    const CompareChoices& choices = options.compare;
    refuse(choices.split && !choices.compares(), "--split", "says where --compare splits",
           "give --compare or --compare-to, or leave it out");
    if (!choices.compares()) return;
    const std::string option = choices.variant ? "--compare" : "--compare-to";
    refuse(choices.variant && choices.file, "--compare", "contradicts --compare-to",
           "leave one of them out");
    refuse(options.reference.has_value(), option, "contradicts --reference",
           "leave one of them out");
    refuse(options.turntable || options.frames, option, "shows one picture, not many",
           "leave --turntable or --frames out");
    refuse(options.effects.budget.has_value(), option,
           "shows one difference, and --budget would make more", "leave one of them out");
    refuse(!options.output && !options.wants_window(), option,
           "there is no --output to draw it into", "name one");
}

OtherSide side_of_file(const Scene& scene, const Camera& camera, const ViewOptions& options,
                       Scene other) {
    OtherSide side{extension_of(options.model) == ".json" ? std::move(other)
                                                          : in_light_of(scene, std::move(other)),
                   camera};
    side.camera = seeing(camera, ball_around(world_bounds(side.scene)));
    return side;
}

OtherSide other_side(const ViewOptions& options, const ComposedScene& composed, Stages& stages,
                     Report& report) {
    if (options.compare.variant) {
        const PreparedVariant prepared = stages.run("other side", [&] {
            return prepare(*options.compare.variant, composed.scene(), options, report);
        });
        return {with(composed.scene(), prepared), composed.camera};
    }
    ViewOptions other = options;
    other.model = *options.compare.file;
    ComposedScene read = compose_scene(other, stages, report);
    return side_of_file(composed.scene(), composed.camera, other, std::move(read.scene()));
}

std::string side_in_words(const CompareChoices& choices) {
    return choices.variant ? to_text(*choices.variant) : choices.file->filename().string();
}

nlohmann::ordered_json sides_json(const CompareChoices& choices,
                                  const PictureComparison& comparison) {
    nlohmann::ordered_json json = {
        {"with", choices.variant ? to_text(*choices.variant) : choices.file->string()},
        {"split", choices.split.value_or(usual_split)}};
    json.update(numbers_json(comparison));
    return json;
}

std::string command_line_of(const CompareChoices& choices) {
    if (!choices.compares()) return "";
    const std::string what = choices.variant ? " --compare " + to_text(*choices.variant)
                                             : " --compare-to " + choices.file->string();
    return what + (choices.split ? fmt::format(" --split {:.4g}", *choices.split) : "");
}

}  // namespace relief::tools
