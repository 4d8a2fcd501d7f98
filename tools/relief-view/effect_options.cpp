// SPDX-License-Identifier: Apache-2.0
#include "effect_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/command.h"
#include "common/text.h"
#include "relief/shade/effects.h"

namespace relief::tools {
namespace {

std::string instance_name(const Scene& scene, const DrawPlan& draw) {
    const Instance& instance = scene.instances[draw.instance];
    if (!instance.name.empty()) return instance.name;
    const std::string& mesh = scene.meshes[instance.mesh]->name;
    return mesh.empty() ? fmt::format("instance {}", draw.instance) : mesh;
}

std::string material_name(const Scene& scene, const DrawPlan& draw) {
    if (!draw.range.material) return "default";
    const std::string& name = scene.materials[*draw.range.material].name;
    return name.empty() ? fmt::format("material {}", *draw.range.material) : name;
}

using Table = std::vector<EffectReason>;

void print_table(const Table& reasons) {
    std::size_t width = 0;
    for (const EffectReason& reason : reasons)
        width = std::max(width, reason.effect.size());
    for (const EffectReason& reason : reasons) {
        fmt::print(out(), "  {:<3}  {:<{}}  {}\n", reason.on ? "on" : "off", reason.effect, width,
                   reason.reason);
    }
}

/// The vertex attributes and textures of a draw, as table rows.
std::vector<EffectReason> input_rows(const Scene& scene, const DrawPlan& draw) {
    std::vector<EffectReason> rows;
    const DrawInputs inputs = planned_inputs(scene, draw);
    for (const PlannedAttribute& attribute : inputs.attributes) {
        rows.push_back({"attribute " + attribute.name, true,
                        attribute.reason + (attribute.stored ? "" : "; the mesh has none")});
    }
    for (const PlannedTexture& texture : inputs.textures) {
        rows.push_back(
            {"texture " + texture.sampler, true,
             fmt::format("{}{}{}", texture.reason,
                         texture.image.empty() ? "" : ": " + texture.image,
                         texture.mip_chain ? "; with a mip chain for minification" : "")});
    }
    return rows;
}

std::vector<EffectReason> pass_rows(const FramePlan& plan) {
    std::vector<EffectReason> rows;
    for (const PlannedPass& pass : planned_passes(plan))
        rows.push_back({"pass: " + pass.name, true, pass.reason});
    return rows;
}

nlohmann::ordered_json attributes_json(const DrawInputs& inputs) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const PlannedAttribute& attribute : inputs.attributes) {
        list.push_back(
            {{"name", attribute.name}, {"stored", attribute.stored}, {"reason", attribute.reason}});
    }
    return list;
}

nlohmann::ordered_json textures_json(const DrawInputs& inputs) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const PlannedTexture& texture : inputs.textures) {
        list.push_back({{"sampler", texture.sampler},
                        {"image", texture.image},
                        {"mip_chain", texture.mip_chain},
                        {"reason", texture.reason}});
    }
    return list;
}

nlohmann::ordered_json reasons_json(const std::vector<EffectReason>& reasons) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EffectReason& reason : reasons)
        list.push_back({{"effect", reason.effect}, {"on", reason.on}, {"reason", reason.reason}});
    return list;
}

Table joined(Table rows, const Table& more) {
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

bool same_table(const Table& a, const Table& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const EffectReason& x, const EffectReason& y) {
                          return x.effect == y.effect && x.on == y.on && x.reason == y.reason;
                      });
}

}  // namespace

std::string draw_heading(const Scene& scene, const DrawPlan& draw) {
    return fmt::format("'{}', material '{}', {}", instance_name(scene, draw),
                       material_name(scene, draw), counted(draw.range.triangle_count, "triangle"));
}

void print_effects(const Scene& scene, const FramePlan& plan) {
    fmt::print(out(), "Whole frame\n");
    print_table(joined(plan.reasons, pass_rows(plan)));
    std::vector<Table> tables;
    for (const DrawPlan& draw : plan.draws)
        tables.push_back(joined(draw.reasons, input_rows(scene, draw)));
    std::vector<bool> printed(plan.draws.size(), false);
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        if (printed[i]) continue;
        std::size_t same = 0;
        for (std::size_t j = i; j < plan.draws.size(); ++j) {
            if (!same_table(tables[i], tables[j])) continue;
            printed[j] = true;
            ++same;
        }
        fmt::print(out(), "\n{}{}\n", draw_heading(scene, plan.draws[i]),
                   same > 1 ? fmt::format(" (and {} alike)", counted(same - 1, "draw")) : "");
        print_table(tables[i]);
    }
}

nlohmann::ordered_json effects_json(const Scene& scene, const FramePlan& plan) {
    nlohmann::ordered_json draws = nlohmann::ordered_json::array();
    for (const DrawPlan& draw : plan.draws) {
        const DrawInputs inputs = planned_inputs(scene, draw);
        draws.push_back({{"instance", instance_name(scene, draw)},
                         {"material", material_name(scene, draw)},
                         {"triangles", draw.range.triangle_count},
                         {"tangents_computed", draw.needs_tangents},
                         {"effects", reasons_json(draw.reasons)},
                         {"attributes", attributes_json(inputs)},
                         {"textures", textures_json(inputs)}});
    }
    nlohmann::ordered_json passes = nlohmann::ordered_json::array();
    for (const PlannedPass& pass : planned_passes(plan))
        passes.push_back({{"pass", pass.name}, {"reason", pass.reason}});
    return {{"frame", reasons_json(plan.reasons)},
            {"passes", std::move(passes)},
            {"draws", std::move(draws)}};
}

namespace {

using Json = nlohmann::ordered_json;

/// Frames per effect, unless --benchmark gives a number.
constexpr std::size_t frames_per_effect = 3;
/// The first frame is not counted, because the driver compiles shaders then.
constexpr std::size_t warm_up_frames = 1;

std::string milliseconds(const TimeStatistics& spread) {
    return fmt::format("{:.2f} ms ({:.2f} to {:.2f})", spread.median, spread.p10, spread.p90);
}

Json spread_json(const TimeStatistics& spread) {
    return {{"median", spread.median}, {"p10", spread.p10}, {"p90", spread.p90}};
}

std::string change_text(const PictureChange& change, double peak) {
    if (change.max == 0.0) return "no difference";
    const std::string of_peak = peak == 1.0 ? "" : fmt::format(" of {}", peak);
    return fmt::format("largest {:.4g}{}, mean {:.3g}, FLIP {:.3g} (largest {:.3g})", change.max,
                       of_peak, change.mean, change.flip_mean, change.flip_max);
}

Json change_json(const PictureChange& change) {
    return {{"max", change.max},
            {"mean", change.mean},
            {"flip_mean", change.flip_mean},
            {"flip_max", change.flip_max}};
}

/// The largest sample value of the picture.
double peak_of(const ViewOptions& options) {
    return is_linear_output(options) ? 1.0 : 255.0;
}

void print_costs(const EffectCosts& costs, const ViewOptions& options) {
    print_entry("costs", fmt::format("a frame takes {}; without", milliseconds(costs.frame)));
    std::size_t width = 0;
    for (const EffectCost& cost : costs.effects)
        width = std::max(width, cost.effect.size());
    for (const EffectCost& cost : costs.effects) {
        fmt::print(out(), "  {:<{}}  {:+8.2f} ms  {}\n", cost.effect, width, -cost.milliseconds,
                   change_text(cost.change, peak_of(options)));
    }
}

std::string budget_text(const BudgetedPlan& budgeted, const ViewOptions& options) {
    if (budgeted.choice.dropped.empty()) {
        return fmt::format("a frame takes {:.2f} ms of {:.4g}: no effect is dropped",
                           budgeted.milliseconds_before, *options.effects.budget);
    }
    return fmt::format("{:.2f} ms became {:.2f} of {:.4g} without {}; the picture differs by {}",
                       budgeted.milliseconds_before, budgeted.choice.milliseconds,
                       *options.effects.budget, fmt::join(budgeted.choice.dropped, ", "),
                       change_text(budgeted.change, peak_of(options)));
}

BudgetedPlan keep_budget(const ViewOptions& options, const MeasuredFrame& frame,
                         const FramePlan& plan) {
    const double budget = *options.effects.budget;
    BudgetedPlan budgeted = plan_within_budget(frame, plan, budget);
    if (budgeted.choice.fits) return budgeted;
    const std::string without = budgeted.choice.dropped.empty()
                                    ? "no effect saves time"
                                    : fmt::format("even without {}, and no other effect saves time",
                                                  fmt::join(budgeted.choice.dropped, ", "));
    throw failure(options.model,
                  fmt::format("a frame takes {:.2f} ms, and --budget allows {:.4g}: {}",
                              budgeted.choice.milliseconds, budget, without),
                  "allow more, or draw fewer pixels or samples");
}

FrameSeries benchmark(const MeasuredFrame& frame, const FramePlan& plan) {
    Report unused;
    Renderer renderer(frame.context, frame.scene, plan, frame.settings, unused);
    Renderer* const alone = &renderer;
    return time_frames({&alone, 1}, frame.camera, frame.repeats)[0];
}

}  // namespace

void add_effect_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Effects";
    EffectChoices& choices = options.effects;
    add_value(
        app, "--effects", "auto|all|none|+NAME,-NAME",
        "Force effects on (+) or off (-). The names are those of --explain-effects. Start with the "
        "effects that the scene needs (auto), with additional effects that change no pixel (all), "
        "or with none. Separate entries by commas, as in none,+diffuse. Default: auto.",
        [&choices](const std::string& subject, const std::string& text) {
            choices.requests = parse_effects(subject, text);
        })
        .group(group);
    add_value(app, "--benchmark", "N",
              "Draw N more frames after a warm-up, and print the time per frame. This option needs "
              "no --output.",
              [&choices](const std::string& subject, const std::string& text) {
                  choices.benchmark = parse_integer(subject, text, 1, 100000);
              })
        .group(group);
    add_value(app, "--budget", "MS",
              "Limit the time per frame in milliseconds. If a frame takes longer, the effects with "
              "the least visible change for their time are dropped.",
              [&choices](const std::string& subject, const std::string& text) {
                  choices.budget = parse_number(subject, text, {1e-3, 1e6, "ms"});
              })
        .group(group);
    add_switch(app, "--print-shaders", choices.print_shaders,
               "Print the shaders that are assembled for this scene. Without --output, this option "
               "needs no OpenGL.")
        .group(group);
}

EffectRequest parse_effects(const std::string& subject, const std::string& text) {
    EffectRequest requests;
    std::vector<std::string> words = split(text, ',');
    const Choices<EffectBase> bases = {{"auto", EffectBase::planned},
                                       {"all", EffectBase::all_neutral},
                                       {"none", EffectBase::nothing}};
    const auto base = std::find_if(bases.begin(), bases.end(), [&](const auto& choice) {
        return choice.first == words.front();
    });
    if (base != bases.end()) {
        requests.base = base->second;
        words.erase(words.begin());
    }
    for (const std::string& word : words) {
        if (word.size() < 2 || (word[0] != '+' && word[0] != '-')) {
            throw UsageError(subject + ": '" + word + "' does not force an effect",
                             "start with auto, all or none, and write effects as +NAME or -NAME");
        }
        requests.forced.push_back({word.substr(1), word[0] == '+'});
    }
    return requests;
}

FramePlan chosen_plan(const ViewOptions& options, const Scene& scene,
                      const FrameSettings& settings) {
    FramePlan plan = plan_effects(scene, settings);
    const EffectRequest& requests = options.effects.requests;
    if (requests.base == EffectBase::planned && requests.forced.empty()) return plan;
    try {
        return force_effects(scene, settings, std::move(plan), requests);
    } catch (const InvalidInput& error) {
        throw UsageError(std::string("--effects: ") + error.what(),
                         "--explain-effects lists the effects and their reasons");
    }
}

FrameMeasures measure_frame(const ViewOptions& options, const MeasuredFrame& frame, FramePlan& plan,
                            Stages& stages) {
    const EffectChoices& choices = options.effects;
    MeasuredFrame repeated = frame;
    repeated.repeats = {.counted = choices.benchmark ? static_cast<std::size_t>(*choices.benchmark)
                                                     : frames_per_effect,
                        .warm_up = warm_up_frames};
    FrameMeasures measures;
    if (choices.budget) {
        measures.budget =
            stages.run("budget", [&] { return keep_budget(options, repeated, plan); });
        plan = measures.budget->plan;
    }
    if (choices.benchmark) {
        measures.benchmark = stages.run("benchmark", [&] { return benchmark(repeated, plan); });
    }
    if (options.explain_effects && (options.output || choices.benchmark)) {
        measures.costs = stages.run("costs", [&] { return measure_effects(repeated, plan); });
    }
    return measures;
}

void print_measures(const FrameMeasures& measures, const ViewOptions& options, const Frame& drawn) {
    if (measures.budget) print_entry("budget", budget_text(*measures.budget, options));
    if (measures.benchmark) {
        const FrameSeries& series = *measures.benchmark;
        print_entry("benchmark",
                    fmt::format("{}: {}, of which drawing {} and reading back {}; {} linked in {}",
                                counted(series.frame.size(), "frame"),
                                milliseconds(time_statistics(series.frame)),
                                milliseconds(time_statistics(series.draw)),
                                milliseconds(time_statistics(series.read_back)),
                                counted(drawn.programs, "program"), duration(drawn.times.link)));
    }
    if (measures.costs) print_costs(*measures.costs, options);
}

Json measures_json(const FrameMeasures& measures, const ViewOptions& options, const Frame& drawn) {
    Json json = Json::object();
    if (measures.benchmark) {
        const FrameSeries& series = *measures.benchmark;
        json["benchmark"] = {
            {"frames", series.frame.size()},
            {"frame_milliseconds", spread_json(time_statistics(series.frame))},
            {"draw_milliseconds", spread_json(time_statistics(series.draw))},
            {"read_back_milliseconds", spread_json(time_statistics(series.read_back))},
            {"programs", drawn.programs},
            {"link_milliseconds", drawn.times.link}};
    }
    if (measures.costs) {
        Json list = Json::array();
        for (const EffectCost& cost : measures.costs->effects) {
            list.push_back({{"effect", cost.effect},
                            {"milliseconds", cost.milliseconds},
                            {"change", change_json(cost.change)}});
        }
        json["effect_costs"] = {{"frame_milliseconds", spread_json(measures.costs->frame)},
                                {"effects", std::move(list)}};
    }
    if (measures.budget) {
        const BudgetedPlan& budgeted = *measures.budget;
        json["budget"] = {{"milliseconds", *options.effects.budget},
                          {"before", budgeted.milliseconds_before},
                          {"after", budgeted.choice.milliseconds},
                          {"dropped", budgeted.choice.dropped},
                          {"change", change_json(budgeted.change)}};
    }
    return json;
}

void print_shaders(const Scene& scene, const FramePlan& plan) {
    const std::vector<ShaderListing> listings = shader_listings(plan);
    for (std::size_t i = 0; i < listings.size(); ++i) {
        const ShaderListing& listing = listings[i];
        fmt::print(out(), "{}// Program {} of {}: {}\n", i == 0 ? "" : "\n", i + 1, listings.size(),
                   describe(listing.features));
        for (const std::size_t draw : listing.draws)
            fmt::print(out(), "// draws {}\n", draw_heading(scene, plan.draws[draw]));
        fmt::print(out(), "// from {}\n\n// Vertex shader\n{}\n// Fragment shader\n{}",
                   fmt::join(listing.files, ", "), listing.vertex, listing.fragment);
    }
}

Json shaders_json(const FramePlan& plan) {
    Json list = Json::array();
    for (const ShaderListing& listing : shader_listings(plan)) {
        list.push_back({{"effects", describe(listing.features)},
                        {"draws", listing.draws},
                        {"files", listing.files},
                        {"vertex", listing.vertex},
                        {"fragment", listing.fragment}});
    }
    return list;
}

}  // namespace relief::tools
