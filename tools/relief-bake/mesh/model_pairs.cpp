// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/model_pairs_test.cpp.
#include "mesh/model_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "common/command.h"

namespace relief::tools {
namespace {

constexpr std::string_view separators = "_-. ";
constexpr std::size_t most_named = 4;

/// An object of a part: what it is called, and its triangles, counted in the part.
struct Object {
    std::string shown;  ///< For messages.
    std::optional<std::string> name;
    std::vector<std::uint32_t> triangles;
};

std::vector<Object> objects_of(const NamedModel& model, const MapModelPart& part, PairSide side) {
    const std::string stem = model.file.stem().string();
    std::vector<Object> objects;
    for (const std::string& called : part.objects) {
        const std::optional<std::string> own = pair_name(called, side);
        objects.push_back({called.empty() ? stem : called, own ? own : pair_name(stem, side), {}});
    }
    if (objects.empty()) objects.push_back({stem, pair_name(stem, side), {}});
    for (std::uint32_t i = 0; i < part.mesh.triangles.size(); ++i)
        objects[part.object_of.empty() ? 0 : part.object_of[i]].triangles.push_back(i);
    std::erase_if(objects, [](const Object& object) { return object.triangles.empty(); });
    return objects;
}

/// Whether a low model has several names at all: else there is nothing to match.
bool has_names(const NamedModel& low) {
    std::set<std::string> names;
    for (const MapModelPart& part : low.model->parts) {
        if (part.objects.empty()) continue;
        for (const std::string& called : part.objects) {
            if (const auto name = pair_name(called, PairSide::low)) names.insert(*name);
        }
    }
    return names.size() > 1;
}

/// What is found under each name; those without one are under "".
class Pairing {
  public:
    void add_low(const NamedModel& low) {
        std::uint32_t first = 0;
        for (const MapModelPart& part : low.model->parts) {
            for (const Object& object : objects_of(low, part, PairSide::low)) {
                ModelPair& pair = pairs_[object.name.value_or("")];
                for (const std::uint32_t triangle : object.triangles)
                    pair.low.push_back(first + triangle);
                shown_low_[object.name.value_or("")].push_back(object.shown);
            }
            first += static_cast<std::uint32_t>(part.mesh.triangles.size());
        }
    }

    void add_high(const NamedModel& high, std::size_t model) {
        for (std::size_t part = 0; part < high.model->parts.size(); ++part) {
            for (Object& object : objects_of(high, high.model->parts[part], PairSide::high)) {
                pairs_[object.name.value_or("")].high.push_back(
                    {model, part, std::move(object.triangles)});
            }
        }
    }

    /// Whether each has a counterpart by name.
    [[nodiscard]] bool is_complete() const {
        return std::all_of(pairs_.begin(), pairs_.end(), [](const auto& entry) {
            return !entry.first.empty() && !entry.second.high.empty() && !entry.second.low.empty();
        });
    }

    void check_low(const NamedModel& low) const {
        std::vector<std::string> alone;
        for (const auto& [name, shown] : shown_low_) {
            if (!name.empty() && !pairs_.at(name).high.empty()) continue;
            alone.insert(alone.end(), shown.begin(), shown.end());
        }
        if (alone.empty()) return;
        const std::size_t count = alone.size();
        alone.resize(std::min(count, most_named));
        throw failure(low.file,
                      fmt::format("{} of its parts {} no high part of the same name: {}{}", count,
                                  count == 1 ? "has" : "have", fmt::join(alone, ", "),
                                  count > most_named ? ", ..." : ""),
                      "name them X_low and X_high, or use --match all");
    }

    ModelPairs finish() {
        ModelPairs result;
        for (auto& [name, pair] : pairs_) {
            if (name.empty() || pair.low.empty()) {
                for (const HighPiece& piece : pair.high)
                    result.report.add("high part without a low one", "part", piece.part,
                                      "is seen by none");
                continue;
            }
            std::sort(pair.low.begin(), pair.low.end());
            pair.name = name;
            result.pairs.push_back(std::move(pair));
        }
        return result;
    }

    /// Nothing is paired; those that stand alone are worth telling only where others do not.
    [[nodiscard]] ModelPairs finish_unpaired() const {
        ModelPairs result;
        bool is_any_paired = false;
        for (const auto& [name, pair] : pairs_) {
            const bool is_paired = !name.empty() && !pair.high.empty() && !pair.low.empty();
            is_any_paired |= is_paired;
            if (!is_paired) result.unpaired.push_back(name.empty() ? "parts without a name" : name);
        }
        if (!is_any_paired) result.unpaired.clear();
        return result;
    }

  private:
    std::map<std::string, ModelPair> pairs_;
    std::map<std::string, std::vector<std::string>> shown_low_;
};

}  // namespace

std::optional<std::string> pair_name(const std::string& name, PairSide side) {
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    const std::string_view word = side == PairSide::high ? "high" : "low";
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

ModelPairs pair_models(std::span<const NamedModel> high, const NamedModel& low,
                       MatchChoice choice) {
    if (choice == MatchChoice::all || (choice == MatchChoice::automatic && !has_names(low)))
        return {};
    Pairing pairing;
    pairing.add_low(low);
    for (std::size_t i = 0; i < high.size(); ++i)
        pairing.add_high(high[i], i);
    if (choice == MatchChoice::automatic && !pairing.is_complete())
        return pairing.finish_unpaired();
    pairing.check_low(low);
    return pairing.finish();
}

}  // namespace relief::tools
