// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/variant_test.cpp.
#include "variant.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/choices.h"
#include "field_options.h"

namespace relief::tools {
namespace {

template <typename Value>
VariantTopic topic(const std::string& name, const std::string& what,
                   const Choices<Value>& choices) {
    VariantTopic result{name, what, {}};
    for (const auto& [word, value] : choices)
        result.choices.emplace_back(std::string(word), Variant(value));
    return result;
}

/// All but to keep what is there, which is no change.
Choices<NormalMode> computed_normals() {
    Choices<NormalMode> choices = normal_choices();
    std::erase_if(choices, [](const auto& choice) { return choice.second == NormalMode::keep; });
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
        topic("interpolation", "Where light is computed", enum_choices<Interpolation>()),
        topic("map", "What bends the normals",
              Choices<MapUse>{{"none", MapUse::none},
                              {"bump_map", MapUse::bump_map},
                              {"normal_map", MapUse::normal_map}}),
        topic("kernel", "How slopes are taken from the heights", kernel_choices()),
        topic("tangents", "Where the maps' frames come from",
              Choices<TangentBasis>{{"stored", TangentBasis::stored},
                                    {"mikktspace", TangentBasis::mikktspace},
                                    {"area-weighted", TangentBasis::area_weighted},
                                    {"lengyel", TangentBasis::lengyel},
                                    {"derivatives", TangentBasis::derivatives}}),
        topic("bits", "Of the normal map's codes",
              Choices<MapBits>{{"8", MapBits::eight}, {"16", MapBits::sixteen}}),
        topic("normals", "How the vertices' normals are averaged", computed_normals()),
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

}  // namespace relief::tools
