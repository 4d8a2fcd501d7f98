// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_project_test.cpp.
#include "check_project.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "check_walk.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "files.h"
#include "json_cursor.h"
#include "relief/mesh/report.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using relief::detail::JsonCursor;

/// Reads one text or a list of them.
std::vector<std::string> texts_of(const JsonCursor& json) {
    if (json.is_text()) return {json.text()};
    std::vector<std::string> texts;
    for (const JsonCursor& one : json.elements())
        texts.push_back(one.text());
    return texts;
}

CheckSeverity severity_of(const JsonCursor& json) {
    std::vector<std::string> names;
    for (const auto& entry : enum_names<CheckSeverity>) {
        if (entry.name == json.text()) return entry.value;
        names.emplace_back(entry.name);
    }
    json.fail_unknown(json.text(), names);
}

bool is_rule_of(std::string_view rule, const std::string& pattern) {
    return matches_pattern(rule, pattern == "*" ? "**" : pattern);
}

/// A pattern that fits no rule is a mistake. \throws InvalidInput
void require_rule(const std::string& pattern, const JsonCursor& json) {
    std::vector<std::string> names;
    for (const CheckRule& rule : check_rules()) {
        if (is_rule_of(rule.id, pattern)) return;
        names.emplace_back(rule.id);
    }
    json.fail_unknown(pattern, names);
}

std::optional<double> limit_of(const JsonCursor& budget, std::string_view key) {
    const auto value = budget.find(key);
    if (!value) return std::nullopt;
    const double limit = value->exact_number();
    if (!(limit >= 0.0)) value->fail("must not be negative");
    return limit;
}

CheckBudget budget_of(const JsonCursor& json) {
    json.allow(
        {"files", "triangles", "materials", "map_size", "memory", "file_size", "texel_density"});
    CheckBudget budget;
    const auto files = json.find("files");
    budget.files = files ? texts_of(*files) : std::vector<std::string>{"**"};
    budget.triangles = limit_of(json, "triangles");
    budget.materials = limit_of(json, "materials");
    budget.map_size = limit_of(json, "map_size");
    budget.memory = limit_of(json, "memory");
    budget.file_size = limit_of(json, "file_size");
    const auto density = json.find("texel_density");
    if (!density) return budget;
    const std::vector<float> range = density->numbers(2);
    if (range[0] > range[1]) density->fail("must be the minimum and the maximum");
    budget.min_density = range[0];
    budget.max_density = range[1];
    return budget;
}

CheckSuppression suppression_of(const JsonCursor& json) {
    json.allow({"rule", "files", "reason"});
    CheckSuppression suppression;
    suppression.rule = json.at("rule").text();
    require_rule(suppression.rule, json.at("rule"));
    const auto files = json.find("files");
    suppression.files = files ? texts_of(*files) : std::vector<std::string>{"**"};
    // A suppression without a reason is forgotten.
    if (json.at("reason").text().empty()) json.at("reason").fail("must not be empty");
    return suppression;
}

void add_to_baseline(const JsonCursor& json, CheckProject& project) {
    json.allow({"rule", "file", "place", "count"});
    const auto place = json.find("place");
    std::size_t& count =
        project
            .baseline[{json.at("rule").text(), json.at("file").text(), place ? place->text() : ""}];
    count = std::max(count, static_cast<std::size_t>(json.at("count").unsigned_number()));
}

template <typename Thing>
void read_list(const JsonCursor& root, std::string_view key, Thing (*thing_of)(const JsonCursor&),
               std::vector<Thing>& list) {
    const auto found = root.find(key);
    if (!found) return;
    for (const JsonCursor& one : found->elements())
        list.push_back(thing_of(one));
}

/// Reads the severities. Patterns with more letters come later, and win.
void read_severities(const JsonCursor& root, CheckProject& project) {
    const auto rules = root.find("rules");
    if (!rules) return;
    for (const auto& [pattern, severity] : rules->members()) {
        require_rule(pattern, severity);
        project.severities.emplace_back(pattern, severity_of(severity));
    }
    std::ranges::stable_sort(project.severities, {},
                             [](const auto& entry) { return entry.first.size(); });
}

bool matches_any(const std::string& name, const std::vector<std::string>& patterns) {
    return std::ranges::any_of(
        patterns, [&](const std::string& pattern) { return matches_pattern(name, pattern); });
}

// Budgets.

/// Returns the bytes of the image files and embedded images of a model on the GPU.
std::uint64_t image_bytes(const CheckedItem& item, const std::map<fs::path, ImageFigures>& images) {
    std::uint64_t bytes = 0;
    std::set<fs::path> seen;
    for (const UsedImage& used : item.images) {
        const auto found = images.find(identity_of(used.file));
        if (found != images.end() && seen.insert(found->first).second) bytes += found->second.bytes;
    }
    for (const ImageFigures& image : item.model.embedded)
        bytes += image.bytes;
    return bytes;
}

/// Bytes of the vertices (position, normal, tangent, texture coordinates) and indices on the GPU.
std::uint64_t geometry_bytes(const ModelFigures& model) {
    return model.vertices * 48 + model.triangles * 12;
}

class BudgetCheck {
  public:
    BudgetCheck(const CheckBudget& budget, const std::map<fs::path, ImageFigures>& images,
                CheckedItem& item)
        : budget_(budget), images_(images), item_(item) {}

    void run() {
        std::error_code error;
        const std::uintmax_t size = fs::file_size(item_.file, error);
        if (!error) exceeds("budget/file-size", "", budget_.file_size, size, "bytes");
        if (item_.kind == CheckedKind::image) {
            check_map("", item_.image);
            return;
        }
        exceeds("budget/triangles", "", budget_.triangles, item_.model.triangles, "triangles");
        exceeds("budget/materials", "", budget_.materials, item_.model.materials, "materials");
        // An image file is reported by itself.
        for (std::size_t i = 0; i < item_.model.embedded.size(); ++i)
            check_map(fmt::format("image {}", i), item_.model.embedded[i]);
        exceeds("budget/memory", "", budget_.memory,
                geometry_bytes(item_.model) + image_bytes(item_, images_), "bytes on the GPU");
        for (const MaterialFigures& surface : item_.model.surfaces)
            check_density(surface);
    }

  private:
    void exceeds(const char* id, const std::string& place, const std::optional<double>& limit,
                 std::uint64_t value, const char* unit) {
        if (!limit || static_cast<double>(value) <= *limit) return;
        item_.add(rule_named(id), place,
                  fmt::format("has {} {} of at most {}", value, unit, *limit),
                  static_cast<std::size_t>(value));
    }

    void check_map(const std::string& place, const ImageFigures& image) {
        if (!budget_.map_size || std::max(image.width, image.height) <= *budget_.map_size) return;
        item_.add(rule_named("budget/map-size"), place,
                  fmt::format("has {} x {} texels of at most {} along a side", image.width,
                              image.height, *budget_.map_size));
    }

    void check_density(const MaterialFigures& surface) {
        if (!budget_.min_density || surface.surface_area <= 0.0) return;
        ImageFigures image;
        if (surface.embedded && *surface.embedded < item_.model.embedded.size())
            image = item_.model.embedded[*surface.embedded];
        if (surface.file) {
            const auto found = images_.find(identity_of(*surface.file));
            if (found != images_.end()) image = found->second;
        }
        if (image.width == 0) return;
        const double texels = static_cast<double>(image.width) * image.height;
        const double density = std::sqrt(surface.texture_area * texels / surface.surface_area);
        if (density >= *budget_.min_density && density <= *budget_.max_density) return;
        const std::string place =
            surface.name.empty() ? "" : fmt::format("material '{}'", surface.name);
        item_.add(rule_named("budget/texel-density"), place,
                  fmt::format("has {:.4g} texels per unit, not {} to {}", density,
                              *budget_.min_density, *budget_.max_density));
    }

    const CheckBudget& budget_;
    const std::map<fs::path, ImageFigures>& images_;
    CheckedItem& item_;
};

bool is_in_baseline(const CheckProject& project, const std::string& name,
                    const CheckFinding& finding) {
    const auto entry = project.baseline.find({std::string(finding.rule->id), name, finding.place});
    return entry != project.baseline.end() && finding.count <= entry->second;
}

bool is_suppressed(const CheckProject& project, const std::string& name,
                   const CheckFinding& finding) {
    return std::ranges::any_of(project.suppressions, [&](const CheckSuppression& suppression) {
        return is_rule_of(finding.rule->id, suppression.rule) &&
               matches_any(name, suppression.files);
    });
}

}  // namespace

std::string CheckProject::name_of(const fs::path& path) const {
    std::error_code error;
    const fs::path base = fs::absolute(folder.empty() ? fs::path(".") : folder, error);
    const fs::path relative =
        fs::absolute(path, error).lexically_normal().lexically_relative(base.lexically_normal());
    const bool is_inside = !relative.empty() && *relative.begin() != "..";
    return (is_inside ? relative : path).generic_string();
}

bool CheckProject::excludes(const fs::path& path) const {
    return !exclude.empty() && matches_any(name_of(path), exclude);
}

CheckProject read_check_project(const fs::path& file) {
    CheckProject project;
    project.file = file;
    project.folder = file.parent_path();
    const std::string text = relief::detail::read_file(file);
    about(file, [&] {
        const JsonCursor root = JsonCursor::parse(text);
        root.allow({"exclude", "rules", "suppress", "budgets", "baseline"});
        if (const auto exclude = root.find("exclude")) project.exclude = texts_of(*exclude);
        read_severities(root, project);
        read_list(root, "suppress", suppression_of, project.suppressions);
        read_list(root, "budgets", budget_of, project.budgets);
        if (const auto baseline = root.find("baseline")) {
            for (const JsonCursor& entry : baseline->elements())
                add_to_baseline(entry, project);
        }
    });
    return project;
}

RemovedFindings apply(const CheckProject& project, const std::map<fs::path, ImageFigures>& images,
                      CheckedItem& item) {
    const std::string name = project.name_of(item.file);
    for (const CheckBudget& budget : project.budgets) {
        if (item.kind != CheckedKind::folder && !item.is_unreadable &&
            matches_any(name, budget.files))
            BudgetCheck(budget, images, item).run();
    }
    RemovedFindings removed;
    std::vector<CheckFinding> kept;
    for (CheckFinding& finding : item.findings) {
        for (const auto& [pattern, severity] : project.severities) {
            if (is_rule_of(finding.rule->id, pattern)) finding.severity = severity;
        }
        if (finding.severity == CheckSeverity::off) continue;
        if (is_suppressed(project, name, finding))
            ++removed.suppressed;
        else if (is_in_baseline(project, name, finding))
            ++removed.in_baseline;
        else
            kept.push_back(std::move(finding));
    }
    item.findings = std::move(kept);
    return removed;
}

void write_baseline(const CheckProject& project, const std::vector<CheckedItem>& items) {
    Json root = Json::object();
    std::error_code error;
    if (fs::exists(project.file, error))
        root = Json::parse(relief::detail::read_file(project.file), nullptr, false);
    Json entries = Json::array();
    for (const CheckedItem& item : items) {
        for (const CheckFinding& finding : item.findings) {
            if (finding.severity < CheckSeverity::warning) continue;
            Json entry = {{"rule", finding.rule->id}, {"file", project.name_of(item.file)}};
            if (!finding.place.empty()) entry["place"] = finding.place;
            entry["count"] = finding.count;
            entries.push_back(std::move(entry));
        }
    }
    root["baseline"] = std::move(entries);
    write_json(project.file, root);
}

}  // namespace relief::tools
