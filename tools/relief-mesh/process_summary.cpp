// SPDX-License-Identifier: Apache-2.0
#include "process_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "common/frame_choices.h"
#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
namespace {

struct Totals {
    std::size_t triangles = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;
};

Totals totals_of(const Processed& done) {
    Totals totals;
    for (const ProcessedPart& part : done.parts) {
        totals.triangles += part.triangles;
        totals.vertices_read += part.vertices_read;
        totals.vertices_written += part.vertices_written;
    }
    return totals;
}

std::string part_normals_in_words(const ProcessedPart& part) {
    switch (part.normals) {
        case Fate::kept:
            return "kept";
        case Fate::removed:
            return "removed";
        case Fate::absent:
            return "none";
        case Fate::computed:
            break;
    }
    if (part.normal_mode == NormalMode::flat) return "computed, one per triangle";
    std::string text = fmt::format("computed, averaged by {}", word_of(part.normal_mode));
    if (part.normal_mode == NormalMode::automatic) {
        text = "computed, averaged by max";
        if (part.normals_by_area != 0) {
            text += fmt::format(", and by area at {} around which triangles fold over",
                                counted(part.normals_by_area, "vertex", "vertices"));
        }
    }
    return text + (part.smoothing_groups ? ", within the file's smoothing groups" : "");
}

/// "MikkTSpace", "area-weighted", ...
std::string method_in_words(TangentMode mode) {
    return mode == TangentMode::mikktspace ? "MikkTSpace" : word_of(mode);
}

std::string part_tangents_in_words(const ProcessedPart& part) {
    switch (part.tangents) {
        case Fate::kept:
            return "kept";
        case Fate::computed: {
            const std::string method = "computed, " + method_in_words(part.tangent_mode);
            if (part.texcoords.is_only && part.texcoords.set == 0) return method;
            return fmt::format("{}, from texture coordinate set {} ({})", method,
                               part.texcoords.set, part.texcoords.reason);
        }
        case Fate::removed:
            return "removed";
        case Fate::absent:
            break;
    }
    return "none";
}

/// "kept", or where primitives differ: "kept in 3 primitives; computed in 1 primitive".
std::string summed_up(const std::vector<ProcessedPart>& parts,
                      const std::function<std::string(const ProcessedPart&)>& words) {
    std::map<std::string, std::size_t> counts;
    for (const ProcessedPart& part : parts)
        ++counts[words(part)];
    if (counts.size() == 1) return counts.begin()->first;
    std::string text;
    for (const auto& [what, count] : counts) {
        text +=
            fmt::format("{}{} in {}", text.empty() ? "" : "; ", what, counted(count, "primitive"));
    }
    return text;
}

std::string splits_in_words(const Totals& totals) {
    if (totals.vertices_written == totals.vertices_read) return "none needed";
    return fmt::format("{} -> {} vertices", totals.vertices_read, totals.vertices_written);
}

std::string fate_word(Fate fate) {
    switch (fate) {
        case Fate::kept:
            return "kept";
        case Fate::computed:
            return "computed";
        case Fate::removed:
            return "removed";
        case Fate::absent:
            break;
    }
    return "none";
}

/// Notes of all primitives; those that several share, once.
std::vector<std::string> notes_in_words(const Processed& done) {
    std::vector<std::pair<std::string, std::vector<std::string>>> places;
    for (const ProcessedPart& part : done.parts) {
        for (const std::string& note : part.notes) {
            auto place = std::find_if(places.begin(), places.end(),
                                      [&](const auto& other) { return other.first == note; });
            if (place == places.end()) place = places.insert(places.end(), {note, {}});
            place->second.push_back(part.name);
        }
    }
    std::vector<std::string> lines;
    for (const auto& [note, names] : places) {
        lines.push_back(fmt::format(
            "{}{}: {}", names.front(),
            names.size() == 1 ? "" : fmt::format(" and {} more", names.size() - 1), note));
    }
    return lines;
}

nlohmann::ordered_json parts_json(const Processed& done) {
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (const ProcessedPart& part : done.parts) {
        nlohmann::ordered_json json = {{"name", part.name},
                                       {"triangles", part.triangles},
                                       {"vertices_read", part.vertices_read},
                                       {"vertices_written", part.vertices_written},
                                       {"normals", fate_word(part.normals)}};
        if (part.normals == Fate::computed) {
            json["normal_method"] = word_of(part.normal_mode);
            if (part.normal_mode == NormalMode::automatic)
                json["vertices_by_area"] = part.normals_by_area;
            json["smoothing_groups"] = part.smoothing_groups;
        }
        json["tangents"] = fate_word(part.tangents);
        if (part.tangents == Fate::computed) {
            json["tangent_method"] = word_of(part.tangent_mode);
            json["texcoord_set"] = part.texcoords.set;
            json["texcoord_set_reason"] = part.texcoords.reason;
        }
        json["notes"] = part.notes;
        parts.push_back(std::move(json));
    }
    return parts;
}

}  // namespace

std::string word_of(NormalMode mode) {
    return name_of(mode, normal_choices());
}

std::string word_of(TangentMode mode) {
    return name_of(mode, tangent_choices());
}

void print_summary(const ProcessRequest& request, const Processed& done, const Stages& stages) {
    const Totals totals = totals_of(done);
    print_entry("read", fmt::format("{}: {}, {}, {}, {}", request.input.string(),
                                    format_name(readable_format(request.input)),
                                    counted(done.parts.size(), "primitive"),
                                    counted(totals.triangles, "triangle"),
                                    counted(totals.vertices_read, "vertex", "vertices")));
    print_entry("normals", summed_up(done.parts, part_normals_in_words));
    print_entry("tangents", summed_up(done.parts, part_tangents_in_words));
    print_entry("splits", splits_in_words(totals));
    print_entry("findings",
                done.findings.empty() ? std::vector<std::string>{"none"} : done.findings.lines());
    print_entry("notes", notes_in_words(done));
    if (!done.decompressed.empty()) {
        print_entry("unpacked",
                    fmt::format("{} (written uncompressed)", fmt::join(done.decompressed, ", ")));
    }
    if (!done.left_behind.empty()) {
        print_entry("left out",
                    fmt::format("{} (cannot be stored in {})", fmt::join(done.left_behind, ", "),
                                extension_of(request.output)));
    }
    print_entry("time", durations(stages.finished()));
    const bool has_companions = writable_format(request.output) == ModelFormat::gltf;
    print_entry("wrote", file_and_size(request.output) +
                             (has_companions ? ", its buffer and images beside it" : ""));
}

std::string line_of(const ProcessRequest& request, const Processed& done, const Stages& stages) {
    const Totals totals = totals_of(done);
    double sum = 0;
    for (const Stage& stage : stages.finished())
        sum += stage.milliseconds;
    return fmt::format(
        "{}: {}, {}, normals {}, tangents {}, {}{}, {}", request.output.string(),
        counted(totals.triangles, "triangle"),
        counted(totals.vertices_written, "vertex", "vertices"),
        summed_up(done.parts, part_normals_in_words), summed_up(done.parts, part_tangents_in_words),
        done.findings.empty() ? "no findings" : counted(done.findings.all().size(), "finding"),
        done.left_behind.empty() ? ""
                                 : fmt::format(", left out: {}", fmt::join(done.left_behind, ", ")),
        duration(sum));
}

nlohmann::ordered_json options_json(const ProcessRequest& request) {
    nlohmann::ordered_json json = {{"normals", word_of(request.normals)},
                                   {"tangents", word_of(request.tangents)}};
    if (request.uv_set) json["uv_set"] = *request.uv_set;
    if (request.crease_degrees) json["crease_degrees"] = *request.crease_degrees;
    json["weld_tolerance"] = request.weld_tolerance;
    return json;
}

nlohmann::ordered_json results_json(const Processed& done, const Stages& stages) {
    return {{"primitives", parts_json(done)},
            {"findings", done.findings.json()},
            {"decompressed", done.decompressed},
            {"left_behind", done.left_behind},
            {"milliseconds", durations_json(stages.finished())}};
}

nlohmann::ordered_json process_json(const ProcessRequest& request, const Processed& done,
                                    const Stages& stages) {
    nlohmann::ordered_json json = {{"tool", "relief-mesh process"},
                                   {"version", version()},
                                   {"input", request.input.string()},
                                   {"output", request.output.string()},
                                   {"options", options_json(request)}};
    json.update(results_json(done, stages));
    return json;
}

}  // namespace relief::tools
