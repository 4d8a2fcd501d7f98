// SPDX-License-Identifier: Apache-2.0
// The bake's own options, models and baker; nothing is written but an error map.
// Tests: tests/tools/relief_bake_verify_test.cpp.
#include "check/surface_check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"
#include "mesh/model_fit.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

constexpr std::array of_surface = {"--low",          "--cage",
                                   "--rays",         "--hardness",
                                   "--offset",       "--space",
                                   "--back-faces",   "--max-distance",
                                   "--samples",      "--outside",
                                   "--sample-angle", "--udim",
                                   "--max-error",    "--max-error-kind",
                                   "--error-map",    "--high-normal-map",
                                   "--max-missed",   "--allow-size-mismatch"};

/// Of the maps that the low model has, the one that a file says it is.
MapPlan plan_of(const SurfaceCheckRequest& request, const BakeModels& models,
                const std::map<std::string, std::string>& metadata) {
    const auto said = [&](const char* key) {
        const auto found = metadata.find(key);
        return found == metadata.end() ? std::string() : found->second;
    };
    MeshBakeRequest bake = request.bake;
    const std::string material = said("relief:material");
    std::string udim = said("relief:udim");
    if (request.udim) udim = fmt::format("{}", *request.udim);
    bake.output = fmt::format("{}{}.png", material.empty() ? "map" : material_word,
                              udim.empty() ? std::string_view() : tile_word);
    MapPlans plans = plan_maps(bake, models.low, models.materials);
    for (MapPlan& plan : plans.maps) {
        const bool is_it = plan.material.value_or("") == material &&
                           (udim.empty() || fmt::format("{}", plan.udim.value_or(0)) == udim);
        if (is_it) return std::move(plan);
    }
    throw failure(
        request.bake.low,
        fmt::format("has no {}{}{}", material.empty() ? "" : "material '" + material + "'",
                    material.empty() || udim.empty() ? "" : " in ",
                    udim.empty() ? "" : "tile " + udim),
        "is it the model that the map is for?");
}

/// A map that was converted to another space since it was baked says so beside.
void follow_content(const std::map<std::string, std::string>& metadata, BakeWords& words) {
    const auto content = metadata.find("relief:content");
    if (words.empty() || content == metadata.end()) return;
    for (const char* space : {"tangent", "object", "world"}) {
        if (content->second.ends_with(fmt::format("{} space", space))) words["--space"] = space;
    }
}

std::string ray_words(const SurfaceCheck& check) {
    return fmt::format("from {:.4g} outside to {:.4g} inside", check.distances.offset,
                       check.distances.max_distance);
}

}  // namespace

void add_surface_check_options(CLI::App& app, SurfaceCheckRequest& request) {
    add_repeatable(
        app, "--high", "FILE",
        "Hold the map, one alone, against this detailed model, as a renderer shows it "
        "on --low. May be given several times.",
        [&](const std::string&, const std::string& text) { request.bake.high.emplace_back(text); })
        .group("Models");
    add_path(app, "--low", request.bake.low,
             "The simple model that the map is for. How the map was baked is what its file says, "
             "if relief baked it; options of rays and texels come before that.")
        .group("Models");
    add_value(app, "--udim", "N", "The map is tile N of the model's texture, 1001 and on.",
              [&](const std::string& subject, const std::string& text) {
                  request.udim = parse_integer(subject, text, 1001, 9999);
              })
        .group("Models");
    add_ray_options(app, request.bake);
    add_fit_options(app, request.bake, "more is trouble");
    add_texel_options(app, request.bake);
    add_high_normal_map_option(app, request.bake.looks);
    add_bound_options(app, request.verify.bound,
                      "It is trouble if the map is further off its models. Default: it is if it "
                      "is 1 degree (RMS) off what this bake makes, or if another reading explains "
                      "it.");
    add_error_map_option(app, request.verify.error_map);
}

bool is_wanted(const SurfaceCheckRequest& request) {
    return !request.bake.high.empty();
}

void check(const CLI::App& app, const SurfaceCheckRequest& request,
           const std::vector<std::filesystem::path>& maps) {
    if (!is_wanted(request)) {
        for (const char* name : of_surface) {
            if (is_given(app, name))
                throw UsageError(fmt::format("{}: has no effect without --high", name),
                                 "give --high FILE and --low FILE");
        }
        return;
    }
    if (request.bake.low.empty())
        throw UsageError("--high: needs the model that the map is for", "give --low FILE");
    if (maps.size() > 1)
        throw UsageError(fmt::format("--high: is for one map, not {}", maps.size()));
    check_bake_options(request.bake);
    check(request.verify.bound);
    std::vector<std::filesystem::path> files = request.bake.high;
    files.push_back(request.bake.low);
    if (request.bake.cage) files.push_back(*request.bake.cage);
    files.push_back(maps.front());
    check_error_map(request.verify.error_map, files);
}

SurfaceCheck check_surface(const CLI::App& app, const SurfaceCheckRequest& request,
                           Stages& stages) {
    SurfaceCheck result;
    const auto metadata = read_image_info(request.verify.map).metadata;
    result.of_file = bake_words(request.verify.map, metadata);
    follow_content(metadata, result.of_file);
    result.used = joined(bake_words(app), result.of_file);
    SurfaceCheckRequest settled = request;
    settled.bake = MeshBakeRequest{};
    settled.bake.high = request.bake.high;
    settled.bake.low = request.bake.low;
    settled.bake.looks = request.bake.looks;
    settled.bake.allow_size_mismatch = request.bake.allow_size_mismatch;
    settled.bake.max_missed = request.bake.max_missed;
    if (result.used.contains("--cage") && !request.bake.cage) {
        throw failure(request.verify.map, "was baked from a cage, whose file it does not name",
                      "give --cage FILE");
    }
    apply_words(result.used, settled.bake);
    const BakeModels models =
        stages.run("read", [&] { return read_bake_models(settled.bake, result.findings); });
    BakeOptions options = bake_options_of(settled.bake);
    options.output_from_mesh = output_axes(settled.bake, models.world_from_low);
    options.details = models.looks.details();
    if (models.cage) options.cage = &*models.cage;
    const MapPlan plan = plan_of(settled, models, metadata);
    Report report;
    about(request.bake.low, [&] {
        stages.run("check", [&] {
            const Baker baker = make_baker(settled.bake, models, options, report);
            result.distances = baker.distances();
            result.map = verify_map(baker, models, settled.bake, map_options(options, plan),
                                    request.verify, report);
        });
    });
    result.findings.add("", report);
    return result;
}

void print_text(const SurfaceCheck& check) {
    print_entry("baked", {fmt::format("{} ({})", in_line(check.used),
                                      check.of_file.empty()         ? "its file does not say how"
                                      : check.of_file == check.used ? "as its file says"
                                                                    : "as told and its file says"),
                          ray_words(check)});
    print_verified(check.map);
    if (!check.findings.empty()) print_entry("findings", check.findings.lines());
}

nlohmann::ordered_json json_of(const SurfaceCheck& check) {
    nlohmann::ordered_json json = {{"baked", in_line(check.used)},
                                   {"file_says", in_line(check.of_file)},
                                   {"offset", check.distances.offset},
                                   {"max_distance", check.distances.max_distance}};
    json.update(verified_json(check.map));
    json["findings"] = check.findings.json();
    return json;
}

}  // namespace relief::tools
