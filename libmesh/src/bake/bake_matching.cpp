// SPDX-License-Identifier: Apache-2.0
// Pairs parts by name, explains boxes that do not fit, and estimates missed texels.
#include "relief/mesh/bake_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string_view>

#include "bake/bake_work.h"

namespace relief {
using namespace relief::detail;

namespace {

struct UnitPair {
    double ratio;  ///< One large unit in small units.
    const char* small;
    const char* large;
};
constexpr std::array unit_pairs = {
    UnitPair{2.54, "centimeters", "inches"},      UnitPair{3.2808399, "feet", "meters"},
    UnitPair{10.0, "millimeters", "centimeters"}, UnitPair{12.0, "inches", "feet"},
    UnitPair{25.4, "millimeters", "inches"},      UnitPair{30.48, "centimeters", "feet"},
    UnitPair{39.370079, "inches", "meters"},      UnitPair{100.0, "centimeters", "meters"},
    UnitPair{304.8, "millimeters", "feet"},       UnitPair{1000.0, "millimeters", "meters"}};

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return text;
}

std::string pair_name_of(const BakePartName& part, BakeSide side) {
    const std::optional<std::string> name = pair_name(part.object, side);
    return name ? *name : pair_name(part.file, side).value_or("");
}

/// Groups parts by a function of their names and their side. \return the groups, sorted by name
template <typename NameOf>
std::vector<BakeNameGroup> group_by(std::span<const BakePartName> high,
                                    std::span<const BakePartName> low, const NameOf& name_of) {
    std::map<std::string, BakeNameGroup> groups;
    for (std::size_t i = 0; i < high.size(); ++i)
        groups[name_of(high[i], BakeSide::high)].high.push_back(i);
    for (std::size_t i = 0; i < low.size(); ++i)
        groups[name_of(low[i], BakeSide::low)].low.push_back(i);
    std::vector<BakeNameGroup> sorted;
    for (auto& [name, group] : groups) {
        group.name = name;
        sorted.push_back(std::move(group));
    }
    return sorted;
}

}  // namespace

std::string detail::unit_cause(double size_ratio) {
    const double ratio = std::max(size_ratio, 1.0 / size_ratio);
    for (const UnitPair& pair : unit_pairs) {
        if (std::abs(std::log(ratio / pair.ratio)) > std::log(1.05)) continue;
        const bool high_is_larger = size_ratio > 1.0;
        return fmt::format("is the high model in {} and the low one in {}?",
                           high_is_larger ? pair.small : pair.large,
                           high_is_larger ? pair.large : pair.small);
    }
    return "";
}

std::optional<std::string> pair_name(const std::string& name, BakeSide side) {
    constexpr std::string_view separators = "_-. ";
    const std::string lower = lower_case(name);
    const std::string_view word = side == BakeSide::high ? "high" : "low";
    for (std::size_t at = lower.rfind(word); at != std::string::npos && at > 1;
         at = lower.rfind(word, at - 1)) {
        const std::size_t end = at + word.size();
        const bool begins = separators.find(lower[at - 1]) != std::string_view::npos;
        const bool ends =
            end == lower.size() || separators.find(lower[end]) != std::string_view::npos;
        if (begins && ends) return lower.substr(0, at - 1);
    }
    return std::nullopt;
}

std::vector<BakeNameGroup> group_by_pair_name(std::span<const BakePartName> high,
                                              std::span<const BakePartName> low) {
    return group_by(high, low, pair_name_of);
}

std::string part_name(const BakePartName& part, BakeSide side) {
    if (const auto name = pair_name(part.object, side)) return *name;
    if (!part.object.empty()) return lower_case(part.object);
    return pair_name(part.file, side).value_or(lower_case(part.file));
}

std::string likely_cause(const BakeFit& fit) {
    if (fit.low.empty() || fit.high.empty()) return "";
    const std::string units = unit_cause(fit.size_ratio);
    if (!units.empty()) return units;
    if (fit.fits_rotated) return "is one of them Y up and the other Z up?";
    const glm::dvec3 low_min(fit.low.min), low_max(fit.low.max);
    const glm::dvec3 moved =
        0.5 * (glm::dvec3(fit.high.max) + glm::dvec3(fit.high.min) - low_max - low_min);
    const bool is_similar = fit.size_ratio < 1.25 && fit.size_ratio > 0.8;
    if (glm::length(moved) > 0.1 * glm::length(low_max - low_min)) {
        return fmt::format(
            "the high model is moved by ({:.4g}, {:.4g}, {:.4g}){}: was one of them exported "
            "without its transform?",
            moved.x, moved.y, moved.z, is_similar ? ", and has the size of the low one" : "");
    }
    return fit.differs_in_size()
               ? "are they in different units, or was one exported without its scale?"
               : "";
}

MissedEstimate estimate_missed(const Baker& baker, const BakeMapOptions& map) {
    BakeMapOptions reduced = map;
    const double texels = static_cast<double>(map.width) * static_cast<double>(map.height);
    const double scale = std::min(std::sqrt(estimate_texels / texels), 1.0);
    reduced.width = std::max(static_cast<int>(std::lround(scale * map.width)), 1);
    reduced.height = std::max(static_cast<int>(std::lround(scale * map.height)), 1);
    reduced.samples = 1;
    reduced.sample_angle.reset();
    reduced.padding = 0;
    reduced.border_folder.reset();
    reduced.progress = nullptr;
    reduced.measures_missed = true;
    reduced.layers = {.normals = false, .heights = true};
    Report unused;
    return {reduced.width, reduced.height,
            baker.bake(
                reduced, [](const BakedRows&) {}, unused)};
}

namespace {

/// An object of a part: its names, and its triangles, counted in the part.
struct PartObject {
    std::size_t model = 0;
    std::size_t part = 0;
    BakePartName name;
    std::vector<std::uint32_t> triangles;

    [[nodiscard]] const std::string& shown_name() const {
        return name.object.empty() ? name.file : name.object;
    }
};

/// Appends the objects of a model that have triangles.
void add_objects(const NamedModel& model, std::size_t index, std::vector<PartObject>& objects) {
    const std::string stem = model.file.stem().string();
    for (std::size_t i = 0; i < model.model->parts.size(); ++i) {
        const MapModelPart& part = model.model->parts[i];
        std::vector<PartObject> of_part;
        for (const std::string& name : part.objects)
            of_part.push_back({index, i, {name, stem}, {}});
        if (of_part.empty()) of_part.push_back({index, i, {"", stem}, {}});
        for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t)
            of_part[part.object_of.empty() ? 0 : part.object_of[t]].triangles.push_back(t);
        std::erase_if(of_part, [](const PartObject& object) { return object.triangles.empty(); });
        std::ranges::move(of_part, std::back_inserter(objects));
    }
}

std::vector<BakePartName> names_of(const std::vector<PartObject>& objects) {
    std::vector<BakePartName> names;
    for (const PartObject& object : objects)
        names.push_back(object.name);
    return names;
}

/// Returns how many pair names the objects of a low model have; with one there is nothing to pair.
std::size_t count_pair_names(const NamedModel& low) {
    std::set<std::string> names;
    for (const MapModelPart& part : low.model->parts) {
        for (const std::string& object : part.objects) {
            if (const auto name = pair_name(object, BakeSide::low)) names.insert(*name);
        }
    }
    return names.size();
}

/// Groups objects by their names in lower case if there are several, all with counterparts;
/// otherwise there are no groups.
std::vector<BakeNameGroup> group_by_equal_names(std::span<const BakePartName> high,
                                                std::span<const BakePartName> low) {
    std::vector<BakeNameGroup> groups = group_by(
        high, low, [](const BakePartName& part, BakeSide) { return lower_case(part.object); });
    if (groups.size() < 2 || !std::ranges::all_of(groups, &BakeNameGroup::is_pair)) groups.clear();
    return groups;
}

/// The names without a counterpart, if there are also names with one.
std::vector<std::string> unpaired_names(const std::vector<BakeNameGroup>& groups) {
    if (std::ranges::none_of(groups, &BakeNameGroup::is_pair)) return {};
    std::vector<std::string> names;
    for (const BakeNameGroup& group : groups) {
        if (!group.is_pair())
            names.push_back(group.name.empty() ? "parts without a name" : group.name);
    }
    return names;
}

/// The index of the first triangle of each part in the joined model.
std::vector<std::uint32_t> first_triangles(const MapModel& model) {
    std::vector<std::uint32_t> first = {0};
    for (const MapModelPart& part : model.parts)
        first.push_back(first.back() + static_cast<std::uint32_t>(part.mesh.triangles.size()));
    return first;
}

}  // namespace

ModelPairs pair_parts(std::span<const NamedModel> high, const NamedModel& low,
                      PartMatching matching) {
    if (matching == PartMatching::all) return {};
    const std::size_t pair_names = count_pair_names(low);
    if (matching == PartMatching::automatic && pair_names == 1) return {};
    std::vector<PartObject> high_objects, low_objects;
    for (std::size_t i = 0; i < high.size(); ++i)
        add_objects(high[i], i, high_objects);
    add_objects(low, 0, low_objects);
    const std::vector<BakePartName> high_names = names_of(high_objects);
    const std::vector<BakePartName> low_names = names_of(low_objects);
    std::vector<BakeNameGroup> groups;
    if (pair_names == 0) groups = group_by_equal_names(high_names, low_names);
    if (matching == PartMatching::automatic && pair_names == 0 && groups.empty()) return {};
    if (groups.empty()) groups = group_by_pair_name(high_names, low_names);
    ModelPairs result;
    if (matching == PartMatching::automatic &&
        !std::ranges::all_of(groups, &BakeNameGroup::is_pair)) {
        result.unpaired = unpaired_names(groups);
        return result;
    }
    const std::vector<std::uint32_t> first = first_triangles(*low.model);
    for (const BakeNameGroup& group : groups) {
        ModelPair pair{group.name, {}, {}};
        for (const std::size_t i : group.high) {
            PartObject& object = high_objects[i];
            pair.high.push_back({object.model, object.part, std::move(object.triangles)});
        }
        for (const std::size_t i : group.low) {
            for (const std::uint32_t triangle : low_objects[i].triangles)
                pair.low.push_back(first[low_objects[i].part] + triangle);
        }
        std::ranges::sort(pair.low);
        if (group.is_pair()) {
            result.pairs.push_back(std::move(pair));
            continue;
        }
        for (const std::size_t i : group.low)
            result.unmatched_low.push_back(low_objects[i].shown_name());
        for (const HighPiece& piece : pair.high)
            result.report.add("high part without a low one", "part", piece.part,
                              "is not seen by any low part");
    }
    return result;
}

}  // namespace relief
