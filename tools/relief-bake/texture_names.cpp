// SPDX-License-Identifier: Apache-2.0
#include "texture_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace relief::tools {
namespace {

/// The meaning of a word in the name of a map.
struct MapWord {
    std::string_view word;
    std::optional<MapKind> kind;
    std::string_view problem = "";  ///< The reason why the kind is not certain.
    std::optional<Green> green = std::nullopt;
    bool is_smoothness = false;
    bool has_occlusion = true;
    bool is_unity_mask = false;
};

constexpr MapWord kind_of_word(std::string_view word, MapKind kind) {
    return {word, kind};
}
constexpr MapWord normal_word(std::string_view word, Green green) {
    return {word, MapKind::normal, "", green};
}
constexpr MapWord smooth_word(std::string_view word) {
    return {word, MapKind::roughness, "", std::nullopt, true};
}
constexpr MapWord unclear_word(std::string_view word, std::string_view problem) {
    return {word, std::nullopt, problem};
}

constexpr std::array map_words = {
    kind_of_word("n", MapKind::normal),
    kind_of_word("nor", MapKind::normal),
    kind_of_word("nrm", MapKind::normal),
    kind_of_word("nml", MapKind::normal),
    kind_of_word("norm", MapKind::normal),
    kind_of_word("normal", MapKind::normal),
    kind_of_word("normals", MapKind::normal),
    kind_of_word("normalmap", MapKind::normal),
    normal_word("normalgl", Green::up),
    normal_word("normalogl", Green::up),
    normal_word("normalopengl", Green::up),
    normal_word("normaldx", Green::down),
    normal_word("normaldirectx", Green::down),
    kind_of_word("d", MapKind::color),
    kind_of_word("bc", MapKind::color),
    kind_of_word("alb", MapKind::color),
    kind_of_word("albedo", MapKind::color),
    kind_of_word("basecolor", MapKind::color),
    kind_of_word("basemap", MapKind::color),
    kind_of_word("col", MapKind::color),
    kind_of_word("color", MapKind::color),
    kind_of_word("diff", MapKind::color),
    kind_of_word("diffuse", MapKind::color),
    kind_of_word("r", MapKind::roughness),
    kind_of_word("rgh", MapKind::roughness),
    kind_of_word("rough", MapKind::roughness),
    kind_of_word("roughness", MapKind::roughness),
    smooth_word("smoothness"),
    smooth_word("gloss"),
    smooth_word("glossiness"),
    kind_of_word("m", MapKind::metalness),
    kind_of_word("met", MapKind::metalness),
    kind_of_word("metal", MapKind::metalness),
    kind_of_word("metallic", MapKind::metalness),
    kind_of_word("metalness", MapKind::metalness),
    kind_of_word("ao", MapKind::occlusion),
    kind_of_word("occ", MapKind::occlusion),
    kind_of_word("occlusion", MapKind::occlusion),
    kind_of_word("ambientocclusion", MapKind::occlusion),
    kind_of_word("orm", MapKind::packed),
    kind_of_word("arm", MapKind::packed),
    kind_of_word("occlusionroughnessmetallic", MapKind::packed),
    MapWord{"metallicroughness", MapKind::packed, "", std::nullopt, false, false},
    MapWord{"roughnessmetallic", MapKind::packed, "", std::nullopt, false, false},
    MapWord{"metalrough", MapKind::packed, "", std::nullopt, false, false},
    MapWord{"maskmap", MapKind::packed, "", std::nullopt, false, true, true},
    kind_of_word("h", MapKind::height),
    kind_of_word("bump", MapKind::height),
    kind_of_word("disp", MapKind::height),
    kind_of_word("displacement", MapKind::height),
    kind_of_word("height", MapKind::height),
    kind_of_word("heightmap", MapKind::height),
    kind_of_word("e", MapKind::emission),
    kind_of_word("emit", MapKind::emission),
    kind_of_word("emission", MapKind::emission),
    kind_of_word("emissive", MapKind::emission),
    kind_of_word("glow", MapKind::emission),
    unclear_word("depth", "may be heights or the opposite of heights"),
    unclear_word("mask", "may be a mask of any kind, or Unity's mask map"),
    unclear_word("s", "may be specular color or smoothness"),
    unclear_word("spec", "is not a map of metallic-roughness materials"),
    unclear_word("specular", "is not a map of metallic-roughness materials"),
    unclear_word("g", "may be gloss or green"),
    unclear_word("a", "may be alpha, albedo or occlusion"),
    unclear_word("alpha", "is a mask, which belongs in the alpha of the base color"),
    unclear_word("opacity", "is a mask, which belongs in the alpha of the base color"),
    unclear_word("mra", "names channels in an order that is not known for certain"),
    unclear_word("rma", "names channels in an order that is not known for certain"),
    unclear_word("rmo", "names channels in an order that is not known for certain"),
};

bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}
bool is_upper(char c) {
    return c >= 'A' && c <= 'Z';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        c = is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
    return result;
}

/// A word and where it begins in the name.
struct NamePart {
    std::string word;
    std::size_t begin = 0;
};

std::vector<NamePart> parts_of_name(std::string_view stem) {
    std::vector<NamePart> parts;
    std::size_t begin = 0;
    const auto end_part = [&](std::size_t end) {
        if (end > begin) parts.push_back({lower(stem.substr(begin, end - begin)), begin});
    };
    for (std::size_t i = 0; i < stem.size(); ++i) {
        const char c = stem[i];
        if (c == '_' || c == '-' || c == '.' || c == ' ') {
            end_part(i);
            begin = i + 1;
        } else if (i > begin && is_upper(c) && is_lower(stem[i - 1])) {
            end_part(i);
            begin = i;
        }
    }
    end_part(stem.size());
    return parts;
}

/// Returns whether a word is a size or a file format: "1k", "2048", "png".
bool is_size_or_format(const std::string& word) {
    static constexpr std::array formats = {"png", "jpg", "jpeg", "tif", "tiff", "tga", "exr"};
    if (std::ranges::count(formats, word) > 0) return true;
    const std::string digits = word.ends_with('k') ? word.substr(0, word.size() - 1) : word;
    const bool is_number = !digits.empty() && std::ranges::all_of(digits, is_digit);
    return is_number && (word.ends_with('k') || digits.size() >= 3);
}

const MapWord* find_word(const std::string& word) {
    const auto found = std::ranges::find(map_words, word, &MapWord::word);
    return found == map_words.end() ? nullptr : &*found;
}

}  // namespace

NamedMap named_map(const std::string& stem) {
    std::vector<NamePart> parts = parts_of_name(stem);
    while (!parts.empty() && is_size_or_format(parts.back().word))
        parts.pop_back();
    NamedMap map;
    map.set = stem;
    // The longest phrase at the end: "ambient occlusion" before "occlusion".
    constexpr std::size_t max_words = 3;
    for (std::size_t count = std::min(parts.size(), max_words); count > 0; --count) {
        const std::size_t first = parts.size() - count;
        std::string phrase;
        for (std::size_t i = first; i < parts.size(); ++i)
            phrase += parts[i].word;
        const MapWord* const word = find_word(phrase);
        // A single letter that is the whole name says nothing.
        if (word == nullptr || (phrase.size() == 1 && first == 0)) continue;
        std::string set = stem.substr(0, parts[first].begin);
        while (!set.empty() &&
               (set.back() == '_' || set.back() == '-' || set.back() == '.' || set.back() == ' '))
            set.pop_back();
        std::vector<NamePart> rest = parts_of_name(set);
        while (!rest.empty() && is_size_or_format(rest.back().word)) {
            set.resize(rest.back().begin);
            while (!set.empty() && (set.back() == '_' || set.back() == '-'))
                set.pop_back();
            rest.pop_back();
        }
        map.kind = word->kind;
        map.green = word->green;
        map.is_smoothness = word->is_smoothness;
        map.has_occlusion = word->has_occlusion;
        map.is_unity_mask = word->is_unity_mask;
        map.set = set;
        if (!word->problem.empty())
            map.problem = fmt::format("the word '{}' {}", phrase, word->problem);
        return map;
    }
    map.problem = "its name does not say the kind of the map";
    return map;
}

}  // namespace relief::tools
