// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_shards_test.cpp, tests/fuzz/fuzz_targets_test.cpp.
#include "check_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "common/content_hash.h"
#include "common/exact_json.h"
#include "common/file_jobs.h"
#include "common/summary.h"
#include "file_replacement.h"
#include "files.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view part_magic = "relief check part 1 ";
constexpr std::size_t hash_letters = 16;
constexpr std::size_t max_depth = 16;
constexpr std::size_t max_shards = 100'000;

[[noreturn]] void refuse(const fs::path& file, const std::string& problem) {
    throw failure(file, problem, "repeat its shard");
}

std::string hash_of(std::string_view text) {
    ContentHash hash;
    hash.add(text);
    return hash.text();
}

// JSON.

Json facts_json(const ImageFacts& facts) {
    Json metadata = Json::array();
    for (const auto& [key, value] : facts.metadata)
        metadata.push_back({text_json(key), text_json(value)});
    const Json conditions = json_list(facts.conditions, [](const MapConditionCount& found) -> Json {
        return {{"condition", static_cast<int>(found.condition)},
                {"count", found.count},
                {"first", found.first}};
    });
    return {{"file", text_json(facts.file.string())},
            {"are_normals", facts.are_normals},
            {"is_unused", facts.is_unused},
            {"fault", text_json(facts.fault)},
            {"figures", json_of(facts.figures)},
            {"texels", {facts.texels.x, facts.texels.y}},
            {"metadata", metadata},
            {"content", facts.content ? Json(static_cast<int>(*facts.content)) : Json()},
            {"conditions", conditions}};
}

/// Returns an enumerator by its number.
template <typename Enum>
Enum enum_in(const Json& json, Enum last) {
    const int number = json.get<int>();
    if (number < 0 || number > static_cast<int>(last)) throw std::out_of_range("enumerator");
    return static_cast<Enum>(number);
}

ImageFacts facts_in(const Json& json) {
    const auto last_condition = static_cast<MapCondition>(map_conditions().size() - 1);
    ImageFacts facts;
    facts.file = text_in(json.at("file"));
    facts.are_normals = json.at("are_normals");
    facts.is_unused = json.at("is_unused");
    facts.fault = text_in(json.at("fault"));
    facts.figures = image_figures_of(json.at("figures"));
    facts.texels = {json.at("texels").at(0).get<int>(), json.at("texels").at(1).get<int>()};
    for (const Json& entry : json.at("metadata"))
        facts.metadata.emplace(text_in(entry.at(0)), text_in(entry.at(1)));
    if (!json.at("content").is_null())
        facts.content = enum_in(json.at("content"), MapContent::other);
    for (const Json& found : json.at("conditions")) {
        facts.conditions.push_back(
            {enum_in(found.at("condition"), last_condition), found.at("count"), found.at("first")});
    }
    // Positions of texels divide by the width.
    if (facts.fault.empty() && (facts.texels.x < 1 || facts.texels.y < 1))
        throw std::out_of_range("texels");
    return facts;
}

Json part_json(const CheckPart& part) {
    const PartJob& job = part.job;
    return {
        {"tool", "relief check"},
        {"version", job.version},
        {"shard", part.shard},
        {"shards", job.count},
        {"arguments", texts_json(job.arguments)},
        {"paths", texts_json(job.files)},
        {"inputs", json_list(job.inputs,
                             [](const auto& input) -> Json {
                                 return {text_json(input.first), input.second};
                             })},
        {"files",
         json_list(part.walked.files,
                   [](const CheckInput& input) -> Json {
                       return {text_json(input.file.string()), static_cast<int>(input.kind)};
                   })},
        {"findings",
         json_list(part.walked.findings, [](const CheckedItem& item) { return json_of(item); })},
        {"models", json_list(part.models, [](const CheckedItem& item) { return json_of(item); })},
        {"images", json_list(part.images, facts_json)}};
}

std::vector<std::string> texts_of(const Json& json) {
    std::vector<std::string> texts;
    for (const Json& text : json)
        texts.push_back(text_in(text));
    return texts;
}

CheckPart part_in(const Json& json) {
    CheckPart part;
    PartJob& job = part.job;
    job.version = json.at("version");
    job.count = json.at("shards");
    part.shard = json.at("shard");
    if (job.count > max_shards || part.shard < 1 || part.shard > job.count)
        throw std::out_of_range("shard");
    job.arguments = texts_of(json.at("arguments"));
    job.files = texts_of(json.at("paths"));
    for (const Json& input : json.at("inputs"))
        job.inputs.emplace_back(text_in(input.at(0)), input.at(1));
    for (const Json& file : json.at("files"))
        part.walked.files.push_back({text_in(file.at(0)), checked_kind_of(file.at(1)), {}});
    for (const Json& item : json.at("findings"))
        part.walked.findings.push_back(item_of(item));
    for (const Json& item : json.at("models"))
        part.models.push_back(item_of(item));
    for (const Json& facts : json.at("images"))
        part.images.push_back(facts_in(facts));
    return part;
}

/// Returns the results of the models, by name, if each shard has its share.
std::map<std::string, const CheckedItem*> models_of(const std::vector<CheckPart>& parts,
                                                    const std::vector<fs::path>& names) {
    std::map<std::string, const CheckedItem*> models;
    std::vector<std::size_t> counts(parts.size(), 0);
    std::size_t index = 0;
    for (const CheckInput& input : parts.front().walked.files) {
        if (input.kind != CheckedKind::model) continue;
        const std::size_t part = index++ % parts.size();
        const std::size_t place = counts[part]++;
        if (place >= parts[part].models.size() || parts[part].models[place].file != input.file)
            refuse(names[part], "is damaged: it does not have its share of the models");
        models.emplace(input.file.string(), &parts[part].models[place]);
    }
    return models;
}

}  // namespace

std::string hash_of(const WalkedFiles& walked) {
    ContentHash hash;
    for (const CheckInput& input : walked.files) {
        std::error_code error;
        const std::uintmax_t size = fs::file_size(input.file, error);
        hash.add_text(input.file.string());
        hash.add_text(fmt::format("{} {}", static_cast<int>(input.kind), error ? 0 : size));
    }
    for (const CheckedItem& item : walked.findings)
        hash.add_text(item.file.string());
    return hash.text();
}

void check_shard(const WalkedFiles& walked, CheckPart& part, Stages& stages) {
    std::vector<const CheckInput*> models;
    std::vector<fs::path> images;
    std::set<fs::path> known;  // Images in the folders.
    std::size_t model = 0, image = 0;
    const auto is_mine = [&](std::size_t index) {
        return index % part.job.count == part.shard - 1;
    };
    for (const CheckInput& input : walked.files) {
        if (input.kind == CheckedKind::model) {
            if (is_mine(model++)) models.push_back(&input);
        } else if (known.insert(identity_of(input.file)).second) {
            if (is_mine(image++)) images.push_back(input.file);
        }
    }
    part.models.resize(models.size());
    run_stage(stages, "models", models.size(),
              [&](std::size_t i) { part.models[i] = check_model_file(*models[i]); });
    for (const CheckedItem& item : part.models) {
        for (const UsedImage& used : item.images) {
            if (known.insert(identity_of(used.file)).second) images.push_back(used.file);
        }
    }
    std::vector<std::vector<ImageFacts>> found(images.size());
    run_stage(stages, "images", images.size(), [&](std::size_t i) {
        found[i].push_back(measure_image_file(images[i], std::nullopt, true));
        // A material will use it as what its texels show.
        const ImageFacts& facts = found[i].front();
        if (!facts.are_normals && facts.content == MapContent::tangent_normals)
            found[i].push_back(measure_image_file(images[i], true, true));
    });
    for (std::vector<ImageFacts>& facts : found)
        std::ranges::move(facts, std::back_inserter(part.images));
}

void write_part(const fs::path& file, const CheckPart& part) {
    const std::string json = part_json(part).dump();
    const std::string text = fmt::format("{}{}\n{}", part_magic, hash_of(json), json);
    relief::detail::replace_file(file, std::as_bytes(std::span(text)));
}

CheckPart read_check_part(const fs::path& file) {
    const std::string text = relief::detail::read_file(file);
    const std::size_t begin = part_magic.size() + hash_letters + 1;
    if (!text.starts_with(part_magic) || text.size() < begin)
        throw failure(file, "is not a part of a check", "relief check --shard writes parts");
    const std::string_view json = std::string_view(text).substr(begin);
    if (std::string_view(text).substr(part_magic.size(), hash_letters) != hash_of(json))
        refuse(file, "is damaged: its hash differs");
    try {
        relief::detail::require_json_depth(json, max_depth);
        return part_in(Json::parse(json));
    } catch (const std::exception& error) {
        refuse(file, std::string("is damaged: ") + error.what());
    }
}

CheckSource merged_source(const std::vector<CheckPart>& parts, const std::vector<fs::path>& names) {
    using Facts = std::multimap<fs::path, const ImageFacts*>;
    const auto images = std::make_shared<Facts>();
    for (const CheckPart& part : parts) {
        for (const ImageFacts& facts : part.images)
            images->emplace(identity_of(facts.file), &facts);
    }
    CheckSource source;
    source.model = [models = models_of(parts, names)](const CheckInput& input) {
        return *models.at(input.file.string());
    };
    source.image = [images](const fs::path& file, const std::vector<ImageRole>& roles) {
        const auto as_normals = are_used_as_normals(roles);
        const auto [begin, end] = images->equal_range(identity_of(file));
        for (auto it = begin; it != end; ++it) {
            ImageFacts facts = *it->second;
            const bool fits = as_normals ? facts.are_normals == *as_normals : facts.is_unused;
            // A link may have another name, which says something else.
            if (!fits || facts.file.filename() != file.filename()) continue;
            facts.file = file;
            return judge_image(facts, roles);
        }
        return check_image_file(file, roles);
    };
    return source;
}

}  // namespace relief::tools
