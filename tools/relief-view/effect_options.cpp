// SPDX-License-Identifier: Apache-2.0
#include "effect_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/command.h"
#include "common/text.h"
#include "effects_text.h"

namespace relief::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Frames that measuring an effect takes, unless --benchmark says how many.
constexpr std::size_t frames_per_effect = 3;
/// Frames that are drawn and forgotten first: the driver compiles shaders there.
constexpr std::size_t warm_up_frames = 1;

std::string milliseconds(const Spread& spread) {
    return fmt::format("{:.2f} ms ({:.2f} to {:.2f})", spread.median, spread.p10, spread.p90);
}

Json spread_json(const Spread& spread) {
    return {{"median", spread.median}, {"p10", spread.p10}, {"p90", spread.p90}};
}

std::string change_in_words(const PictureChange& change, double peak) {
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

/// What the largest sample of the picture stands for.
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
                   change_in_words(cost.change, peak_of(options)));
    }
}

std::string budget_in_words(const BudgetedPlan& budgeted, const ViewOptions& options) {
    if (budgeted.choice.dropped.empty()) {
        return fmt::format("a frame takes {:.2f} ms of {:.4g}: nothing is dropped",
                           budgeted.milliseconds_before, *options.effects.budget);
    }
    return fmt::format("{:.2f} ms became {:.2f} of {:.4g} without {}; the picture differs by {}",
                       budgeted.milliseconds_before, budgeted.choice.milliseconds,
                       *options.effects.budget, fmt::join(budgeted.choice.dropped, ", "),
                       change_in_words(budgeted.change, peak_of(options)));
}

BudgetedPlan keep_budget(const ViewOptions& options, const MeasuredFrame& frame,
                         const FramePlan& plan) {
    const double budget = *options.effects.budget;
    BudgetedPlan budgeted = plan_within_budget(frame, plan, budget);
    if (budgeted.choice.fits) return budgeted;
    const std::string without = budgeted.choice.dropped.empty()
                                    ? "no effect saves any of it"
                                    : fmt::format("without {} too, and no other effect saves time",
                                                  fmt::join(budgeted.choice.dropped, ", "));
    throw failure(options.model,
                  fmt::format("a frame takes {:.2f} ms, and --budget allows {:.4g}: {}",
                              budgeted.choice.milliseconds, budget, without),
                  "allow more, or draw fewer pixels or samples");
}

FrameSeries benchmark(const MeasuredFrame& frame, const FramePlan& plan) {
    Report told_already;
    Renderer renderer(frame.context, frame.scene, plan, frame.settings, told_already);
    Renderer* const alone = &renderer;
    return time_frames({&alone, 1}, frame.camera, frame.repeats)[0];
}

}  // namespace

void add_effect_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Effects";
    EffectChoices& choices = options.effects;
    add_value(app, "--effects", "auto|all|none|+NAME,-NAME",
              "Effects forced on (+) or off (-) by the names that --explain-effects prints: those "
              "that the scene calls for (auto), with all that change no pixel (all), or from none. "
              "Separated by commas, as in none,+diffuse. Default: auto.",
              [&choices](const std::string& subject, const std::string& text) {
                  choices.wishes = parse_effects(subject, text);
              })
        .group(group);
    add_value(app, "--benchmark", "N",
              "Draw N frames more, after a few that are not counted, and print what one takes. "
              "Needs no --output.",
              [&choices](const std::string& subject, const std::string& text) {
                  choices.benchmark = parse_integer(subject, text, 1, 100000);
              })
        .group(group);
    add_value(app, "--budget", "MS",
              "Milliseconds that a frame may take: where it takes longer, the effects that show "
              "least for their time are dropped.",
              [&choices](const std::string& subject, const std::string& text) {
                  choices.budget = parse_number(subject, text, {1e-3, 1e6, "ms"});
              })
        .group(group);
    add_switch(app, "--print-shaders", choices.print_shaders,
               "Print the shaders as they are put together for this scene. Needs no --output, and "
               "then no OpenGL.")
        .group(group);
}

EffectWishes parse_effects(const std::string& subject, const std::string& text) {
    EffectWishes wishes;
    std::vector<std::string> words = split(text, ',');
    const Choices<EffectBase> bases = {{"auto", EffectBase::planned},
                                       {"all", EffectBase::all_neutral},
                                       {"none", EffectBase::nothing}};
    const auto base = std::find_if(bases.begin(), bases.end(), [&](const auto& choice) {
        return choice.first == words.front();
    });
    if (base != bases.end()) {
        wishes.base = base->second;
        words.erase(words.begin());
    }
    for (const std::string& word : words) {
        if (word.size() < 2 || (word[0] != '+' && word[0] != '-')) {
            throw UsageError(subject + ": '" + word + "' forces nothing",
                             "write auto, all or none first, and effects as +NAME or -NAME");
        }
        wishes.forced.push_back({word.substr(1), word[0] == '+'});
    }
    return wishes;
}

FramePlan chosen_plan(const ViewOptions& options, const Scene& scene,
                      const FrameSettings& settings) {
    FramePlan plan = plan_effects(scene, settings);
    const EffectWishes& wishes = options.effects.wishes;
    if (wishes.base == EffectBase::planned && wishes.forced.empty()) return plan;
    try {
        return force_effects(scene, settings, std::move(plan), wishes);
    } catch (const InvalidInput& error) {
        throw UsageError(std::string("--effects: ") + error.what(),
                         "--explain-effects lists them with their reasons");
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
    if (measures.budget) print_entry("budget", budget_in_words(*measures.budget, options));
    if (measures.benchmark) {
        const FrameSeries& series = *measures.benchmark;
        print_entry(
            "benchmark",
            fmt::format("{}: {}, of which drawing {} and reading back {}; {} linked in {}",
                        counted(series.frame.size(), "frame"),
                        milliseconds(spread_of(series.frame)), milliseconds(spread_of(series.draw)),
                        milliseconds(spread_of(series.read_back)),
                        counted(drawn.programs, "program"), duration(drawn.times.link)));
    }
    if (measures.costs) print_costs(*measures.costs, options);
}

Json measures_json(const FrameMeasures& measures, const ViewOptions& options, const Frame& drawn) {
    Json json = Json::object();
    if (measures.benchmark) {
        const FrameSeries& series = *measures.benchmark;
        json["benchmark"] = {{"frames", series.frame.size()},
                             {"frame_milliseconds", spread_json(spread_of(series.frame))},
                             {"draw_milliseconds", spread_json(spread_of(series.draw))},
                             {"read_back_milliseconds", spread_json(spread_of(series.read_back))},
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
