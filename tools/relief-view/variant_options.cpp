// SPDX-License-Identifier: Apache-2.0
#include "variant_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "common/options.h"
#include "material_options.h"
#include "relief/mesh/report.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

template <typename Value>
VariantTopic topic(const std::string& name, const std::string& what,
                   const Choices<Value>& choices) {
    VariantTopic result{name, what, {}};
    for (const auto& [word, value] : choices)
        result.choices.emplace_back(std::string(word), Variant(value));
    return result;
}

/// All modes except keeping the normals.
Choices<NormalMode> computed_normals() {
    Choices<NormalMode> choices = enum_choices<NormalMode>();
    std::erase_if(choices, [](const auto& choice) { return choice.second == NormalMode::keep; });
    return choices;
}

/// The mesh's tangents, computed ones, and none: the shader then derives frames.
Choices<TangentMethod> displayed_tangents() {
    Choices<TangentMethod> choices = {{"stored", TangentMethod::keep}};
    for (const auto& [name, method] : tangent_choices()) {
        if (computes_tangents(method)) choices.emplace_back(name, method);
    }
    choices.emplace_back("derivatives", TangentMethod::none);
    return choices;
}

std::string unknown(const VariantTopic& topic) {
    std::vector<std::string> words;
    for (const auto& [word, variant] : topic.choices)
        words.push_back(word);
    return fmt::format("{}: not one of {}", topic.name, fmt::join(words, ", "));
}

}  // namespace

const std::vector<VariantTopic>& variant_topics() {
    static const std::vector<VariantTopic> topics = {
        topic("interpolation", "Where the lighting is computed", enum_choices<Interpolation>()),
        topic("map", "The map that perturbs the normals",
              Choices<MapUse>{{"none", MapUse::none},
                              {"bump_map", MapUse::bump_map},
                              {"normal_map", MapUse::normal_map}}),
        topic("kernel", "The kernel that computes slopes from heights", enum_choices<Kernel>()),
        topic("tangents", "The tangent frames of the maps", displayed_tangents()),
        topic("bits", "Bits per channel of the normal map",
              Choices<MapBits>{{"8", MapBits::eight}, {"16", MapBits::sixteen}}),
        topic("normals", "The weights of vertex normals", computed_normals()),
    };
    return topics;
}

Variant parse_variant(const std::string& subject, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    std::vector<std::string> names;
    for (const VariantTopic& topic : variant_topics()) {
        names.push_back(topic.name + "=");
        if (topic.name != name || equals == text.size()) continue;
        for (const auto& [word, variant] : topic.choices) {
            if (word == text.substr(equals + 1)) return variant;
        }
        throw UsageError(subject + ": " + unknown(topic));
    }
    throw UsageError(fmt::format("{}: not one of {}", subject, fmt::join(names, ", ")));
}

std::string to_text(const Variant& variant) {
    for (const VariantTopic& topic : variant_topics()) {
        for (const auto& [word, value] : topic.choices) {
            if (value == variant) return topic.name + "=" + word;
        }
    }
    return "";
}

PreparedVariant prepare(const Variant& variant, const Scene& scene, const ViewOptions& options,
                        Report& report) {
    using Lack = UnchangedScene::Lack;
    try {
        return prepare_variant(variant, scene, scene_heights(options), report);
    } catch (const UnchangedScene& error) {
        throw UsageError("--compare " + to_text(variant) + ": " + error.what(),
                         error.lack == Lack::nothing   ? "choose another one"
                         : error.lack == Lack::heights ? "give --height-map"
                                                       : "give --normal-map or --height-map");
    }
}

}  // namespace relief::tools
