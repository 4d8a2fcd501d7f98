// SPDX-License-Identifier: Apache-2.0
// The description of a part: a JSON object with all of it but the texels. All numbers of a file
// are checked. Tests: tests/tools/relief_bake_shards_test.cpp, tests/fuzz/fuzz_targets_test.cpp.
#include <limits>
#include <nlohmann/json.hpp>

#include <algorithm>

#include "common/exact_json.h"
#include "json_cursor.h"
#include "part_file.h"

namespace relief::tools {
namespace {

using relief::detail::JsonCursor;

constexpr std::size_t max_depth = 16;
constexpr int max_side = TexelRasterizer::largest_side;

template <typename Vector>
Json vector_json(const Vector& v) {
    return {number_json(v.x), number_json(v.y), number_json(v.z)};
}

glm::dvec3 vector_in(const JsonCursor& json) {
    const std::vector<JsonCursor> parts = json.elements();
    if (parts.size() != 3) json.fail("must have three numbers");
    return {number_in(parts[0]), number_in(parts[1]), number_in(parts[2])};
}

Json box_json(const Bounds& box) {
    return {{"min", vector_json(box.min)}, {"max", vector_json(box.max)}};
}

Bounds box_in(const JsonCursor& json) {
    return {glm::vec3(vector_in(json.at("min"))), glm::vec3(vector_in(json.at("max")))};
}

std::size_t count_in(const JsonCursor& json, std::string_view key) {
    return json.at(key).unsigned_number();
}

// Findings.

Json report_json(const Report& report) {
    Json json = Json::array();
    for (const Finding& finding : report.findings()) {
        json.push_back({{"kind", text_json(finding.kind)},
                        {"element", finding.element},
                        {"outcome", text_json(finding.outcome)},
                        {"count", finding.count},
                        {"first", finding.first}});
    }
    return json;
}

Finding finding_in(const JsonCursor& json) {
    constexpr std::size_t max_first = 8;  // As in Finding.
    Finding finding{text_in(json.at("kind")),
                    text_in(json.at("element")),
                    text_in(json.at("outcome")),
                    count_in(json, "count"),
                    {}};
    for (const JsonCursor& index : json.at("first").elements())
        finding.first.push_back(index.unsigned_number());
    if (finding.first.size() > max_first || finding.first.size() > finding.count ||
        !std::ranges::is_sorted(finding.first))
        json.fail("is not a finding");
    return finding;
}

Report report_in(const JsonCursor& json) {
    Report report;
    for (const JsonCursor& finding : json.elements())
        report.add(finding_in(finding));
    return report;
}

// Rows.

struct CountField {
    const char* key;
    std::size_t BakeCounts::*value;
};
constexpr CountField count_fields[] = {{"samples", &BakeCounts::samples},
                                       {"rays", &BakeCounts::rays},
                                       {"occlusion_rays", &BakeCounts::occlusion_rays},
                                       {"thickness_rays", &BakeCounts::thickness_rays},
                                       {"open_thickness_rays", &BakeCounts::open_thickness_rays},
                                       {"baked", &BakeCounts::baked},
                                       {"missed", &BakeCounts::missed},
                                       {"missed_from_behind", &BakeCounts::missed_from_behind},
                                       {"measuring_rays", &BakeCounts::measuring_rays}};

struct CoverageField {
    const char* key;
    std::size_t Coverage::*value;
};
constexpr CoverageField coverage_fields[] = {{"inside", &Coverage::inside},
                                             {"touched", &Coverage::touched},
                                             {"empty", &Coverage::empty},
                                             {"shared", &Coverage::shared},
                                             {"mirrored", &Coverage::mirrored}};

Json lengths_json(const RayLengths& lengths) {
    Json bins = Json::array();
    for (const auto& [bin, count] : lengths.bins)
        bins.push_back({bin, count});
    return {{"count", lengths.count},
            {"shortest", number_json(lengths.shortest)},
            {"longest", number_json(lengths.longest)},
            {"bins", bins}};
}

RayLengths lengths_in(const JsonCursor& json) {
    constexpr int max_bin = 20'000;  // The exponents of double, in eighths.
    RayLengths lengths{
        count_in(json, "count"), number_in(json.at("shortest")), number_in(json.at("longest")), {}};
    for (const JsonCursor& bin : json.at("bins").elements()) {
        const std::vector<JsonCursor> pair = bin.elements();
        if (pair.size() != 2) bin.fail("must have two numbers");
        lengths.bins[pair[0].whole_number(-max_bin, max_bin)] += pair[1].unsigned_number();
    }
    return lengths;
}

Json rows_json(const PartRows& rows) {
    const BakeCounts& counts = rows.found.counts;
    Json coverage, numbers, first = Json::array();
    for (const CoverageField& field : coverage_fields)
        coverage[field.key] = rows.found.coverage.*field.value;
    for (const CountField& field : count_fields)
        numbers[field.key] = counts.*field.value;
    for (const MissedTexel& texel : counts.first_missed) {
        first.push_back(
            {{"x", texel.x}, {"y", texel.y}, {"position", vector_json(texel.position)}});
    }
    return {{"map", rows.map},
            {"first", rows.found.rows.first},
            {"last", rows.found.rows.last},
            {"offset", rows.offset},
            {"coverage", coverage},
            {"counts", numbers},
            {"min_height", number_json(counts.min_height)},
            {"max_height", number_json(counts.max_height)},
            {"first_missed", first},
            {"clipped_outside", lengths_json(counts.clipped_outside)},
            {"clipped_inside", lengths_json(counts.clipped_inside)},
            {"triangles", report_json(rows.found.triangles)},
            {"texels", report_json(rows.found.texels)},
            {"findings", report_json(rows.found.rays)}};
}

PartRows rows_in(const JsonCursor& json) {
    PartRows rows;
    rows.map = count_in(json, "map");
    rows.offset = json.at("offset").unsigned_number();
    BakeShard& found = rows.found;
    found.rows.first = json.at("first").whole_number(0, max_side);
    found.rows.last = json.at("last").whole_number(found.rows.first + 1, max_side);
    for (const CoverageField& field : coverage_fields)
        found.coverage.*field.value = count_in(json.at("coverage"), field.key);
    for (const CountField& field : count_fields)
        found.counts.*field.value = count_in(json.at("counts"), field.key);
    found.counts.min_height = number_in(json.at("min_height"));
    found.counts.max_height = number_in(json.at("max_height"));
    for (const JsonCursor& texel : json.at("first_missed").elements()) {
        found.counts.first_missed.push_back({texel.at("x").whole_number(0, max_side),
                                             texel.at("y").whole_number(0, max_side),
                                             vector_in(texel.at("position"))});
    }
    found.counts.clipped_outside = lengths_in(json.at("clipped_outside"));
    found.counts.clipped_inside = lengths_in(json.at("clipped_inside"));
    found.triangles = report_in(json.at("triangles"));
    found.texels = report_in(json.at("texels"));
    found.rays = report_in(json.at("findings"));
    return rows;
}

// The models, as the summary describes them.

Json agreement_json(const BakeAgreement& agreement) {
    Json json = {{"samples", agreement.samples},
                 {"missed", agreement.missed},
                 {"from_behind", agreement.from_behind},
                 {"median_distance", number_json(agreement.median_distance)},
                 {"mean_angle", number_json(agreement.mean_angle)},
                 {"half_diagonal", number_json(agreement.half_diagonal)}};
    if (const auto& correction = agreement.correction) {
        json["correction"] = {{"scale", number_json(correction->scale)},
                              {"shift", vector_json(correction->shift)},
                              {"median_distance", number_json(correction->median_distance)},
                              {"mean_angle", number_json(correction->mean_angle)}};
    }
    return json;
}

BakeAgreement agreement_in(const JsonCursor& json) {
    BakeAgreement agreement{count_in(json, "samples"),
                            count_in(json, "missed"),
                            count_in(json, "from_behind"),
                            number_in(json.at("median_distance")),
                            number_in(json.at("mean_angle")),
                            number_in(json.at("half_diagonal")),
                            {}};
    if (const auto correction = json.find("correction")) {
        agreement.correction = {
            number_in(correction->at("scale")), vector_in(correction->at("shift")),
            number_in(correction->at("median_distance")), number_in(correction->at("mean_angle"))};
    }
    return agreement;
}

Json models_json(const MeshBake& bake) {
    Json pairs = Json::array(), findings = Json::array();
    for (const PairCount& pair : bake.pairs) {
        pairs.push_back({{"name", text_json(pair.name)},
                         {"high_triangles", pair.high_triangles},
                         {"low_triangles", pair.low_triangles}});
    }
    for (const PlacedFinding& placed : bake.findings.all()) {
        Report report;
        report.add(placed.finding);
        findings.push_back({{"where", text_json(placed.where)},
                            {"map_width", placed.map_width},
                            {"findings", report_json(report)}});
    }
    Json json = {{"high_triangles", bake.high_triangles},
                 {"low_triangles", bake.low_triangles},
                 {"has_file_tangents", bake.has_file_tangents},
                 {"materials", bake.materials},
                 {"pairs", pairs},
                 {"unpaired", texts_json(bake.unpaired)},
                 {"textures", text_json(bake.textures)},
                 {"texel_size", number_json(bake.texel_size)},
                 {"origin", vector_json(bake.origin)},
                 {"fit",
                  {{"high", box_json(bake.fit.high)},
                   {"low", box_json(bake.fit.low)},
                   {"gap", number_json(bake.fit.gap)},
                   {"size_ratio", number_json(bake.fit.size_ratio)},
                   {"fits_rotated", bake.fit.fits_rotated}}},
                 {"agreement", agreement_json(bake.agreement)},
                 {"findings", findings}};
    if (bake.alpha) {
        json["alpha"] = {{"mode", static_cast<int>(bake.alpha->mode)},
                         {"cutoff", number_json(bake.alpha->cutoff)}};
    }
    return json;
}

void read_models(const JsonCursor& json, MeshBake& bake) {
    bake.high_triangles = count_in(json, "high_triangles");
    bake.low_triangles = count_in(json, "low_triangles");
    bake.has_file_tangents = json.at("has_file_tangents").boolean();
    bake.materials = count_in(json, "materials");
    for (const JsonCursor& pair : json.at("pairs").elements()) {
        bake.pairs.push_back({text_in(pair.at("name")), count_in(pair, "high_triangles"),
                              count_in(pair, "low_triangles")});
    }
    bake.unpaired = texts_in(json.at("unpaired"));
    bake.textures = text_in(json.at("textures"));
    bake.texel_size = number_in(json.at("texel_size"));
    bake.origin = vector_in(json.at("origin"));
    const JsonCursor fit = json.at("fit");
    bake.fit = {box_in(fit.at("high")), box_in(fit.at("low")), number_in(fit.at("gap")),
                number_in(fit.at("size_ratio")), fit.at("fits_rotated").boolean()};
    bake.agreement = agreement_in(json.at("agreement"));
    for (const JsonCursor& placed : json.at("findings").elements()) {
        bake.findings.add(text_in(placed.at("where")), report_in(placed.at("findings")),
                          placed.at("map_width").whole_number(0, max_side));
    }
    if (const auto alpha = json.find("alpha")) {
        bake.alpha = {static_cast<AlphaMode>(
                          alpha->at("mode").whole_number(0, static_cast<int>(AlphaMode::blend))),
                      alpha->at("cutoff").number(0.0F, 1.0F)};
    }
}

Json facts_json(const BakeFacts& facts) {
    Json ids = Json::array();
    for (const SurfaceId& id : facts.ids)
        ids.push_back(
            {{"name", text_json(id.name)}, {"color", {id.color.r, id.color.g, id.color.b}}});
    return {{"opacity", facts.has_opacity},
            {"offset", number_json(facts.distances.offset)},
            {"max_distance", number_json(facts.distances.max_distance)},
            {"height", number_json(facts.bounds.height)},
            {"curvature", number_json(facts.bounds.curvature)},
            {"curvature_p99", number_json(facts.bounds.curvature_p99)},
            {"position", number_json(facts.bounds.position)},
            {"emission", number_json(facts.bounds.emission)},
            {"thickness", number_json(facts.bounds.thickness)},
            {"ids", ids}};
}

BakeFacts facts_in(const JsonCursor& json) {
    BakeFacts facts;
    facts.has_opacity = json.at("opacity").boolean();
    facts.distances = {number_in(json.at("offset")), number_in(json.at("max_distance"))};
    facts.bounds = {number_in(json.at("height")),        number_in(json.at("curvature")),
                    number_in(json.at("curvature_p99")), number_in(json.at("position")),
                    number_in(json.at("emission")),      number_in(json.at("thickness"))};
    for (const JsonCursor& id : json.at("ids").elements()) {
        SurfaceId one{text_in(id.at("name")), {}};
        const std::vector<JsonCursor> color = id.at("color").elements();
        if (color.size() != 3) id.fail("must have three numbers");
        for (int i = 0; i < 3; ++i) {
            one.color[i] =
                static_cast<std::uint8_t>(color[static_cast<std::size_t>(i)].whole_number(0, 255));
        }
        facts.ids.push_back(std::move(one));
    }
    return facts;
}

Json plan_json(const MapPlan& plan) {
    Json json = {{"file_name", text_json(plan.material_in_files)}};
    if (plan.material) json["material"] = text_json(*plan.material);
    if (plan.udim) json["udim"] = *plan.udim;
    return json;
}

MapPlan plan_in(const JsonCursor& json) {
    MapPlan plan;
    plan.material_in_files = text_in(json.at("file_name"));
    if (plan.material_in_files.find('/') != std::string::npos ||
        plan.material_in_files.find('\0') != std::string::npos)
        json.fail("cannot be in a file name");
    if (const auto material = json.find("material")) plan.material = text_in(*material);
    if (const auto udim = json.find("udim")) plan.udim = udim->whole_number(1001, 9999);
    return plan;
}

}  // namespace

Json part_json(const Part& part) {
    Json inputs = Json::array(), plans = Json::array(), rows = Json::array();
    for (const auto& [name, hash] : part.job.inputs)
        inputs.push_back({{"file", text_json(name)}, {"hash", hash}});
    for (const MapPlan& plan : part.plans)
        plans.push_back(plan_json(plan));
    for (const PartRows& one : part.rows)
        rows.push_back(rows_json(one));
    return {{"tool", "relief-bake mesh"},
            {"version", part.job.version},
            {"shard", part.shard},
            {"shards", part.job.count},
            {"arguments", texts_json(part.job.arguments)},
            {"files", texts_json(part.job.files)},
            {"inputs", inputs},
            {"milliseconds", part.milliseconds},
            {"facts", facts_json(part.facts)},
            {"models", models_json(part.bake)},
            {"maps", plans},
            {"rows", rows}};
}

namespace {

Part part_in(const JsonCursor& json) {
    constexpr std::size_t max_shards = 100'000;
    Part part;
    part.job.version = text_in(json.at("version"));
    part.job.count = count_in(json, "shards");
    part.shard = count_in(json, "shard");
    if (part.job.count > max_shards || part.shard < 1 || part.shard > part.job.count)
        json.fail("has an impossible shard");
    part.job.arguments = texts_in(json.at("arguments"));
    part.job.files = texts_in(json.at("files"));
    for (const JsonCursor& input : json.at("inputs").elements())
        part.job.inputs.emplace_back(text_in(input.at("file")), text_in(input.at("hash")));
    part.milliseconds = json.at("milliseconds").double_number();
    part.facts = facts_in(json.at("facts"));
    read_models(json.at("models"), part.bake);
    for (const JsonCursor& plan : json.at("maps").elements())
        part.plans.push_back(plan_in(plan));
    for (const JsonCursor& one : json.at("rows").elements()) {
        part.rows.push_back(rows_in(one));
        if (part.rows.back().map >= part.plans.size()) one.fail("has no map");
    }
    return part;
}

}  // namespace

Part parse_part(const std::string& json) {
    relief::detail::require_json_depth(json, max_depth);
    return part_in(JsonCursor::parse(json));
}

}  // namespace relief::tools
