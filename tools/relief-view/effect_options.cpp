// SPDX-License-Identifier: Apache-2.0
// Forces, measures, drops and prints effects, and adds debug views and overlays to a plan.
// Tests: tests/tools/effect_options_test.cpp, debug_options_test.cpp.
#include "effect_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/command.h"
#include "common/summary.h"
#include "common/text.h"
#include "relief/shade/effects.h"

namespace relief::tools {
using namespace relief::shade;

// Effects.

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

/// A line for each effect that is on. Effects that are off for the same reason share a line.
std::vector<std::string> table_lines(const Table& reasons) {
    std::size_t width = 0;
    for (const EffectReason& reason : reasons) {
        if (reason.on) width = std::max(width, reason.effect.size());
    }
    std::vector<std::string> lines;
    std::vector<std::pair<std::string, std::string>> off;  // Reasons and the names of effects.
    for (const EffectReason& reason : reasons) {
        if (reason.on) {
            lines.push_back(fmt::format("on   {:<{}}  {}", reason.effect, width, reason.reason));
            continue;
        }
        const auto same = std::ranges::find(off, reason.reason, &decltype(off)::value_type::first);
        if (same == off.end()) {
            off.emplace_back(reason.reason, reason.effect);
        } else {
            same->second += ", " + reason.effect;
        }
    }
    for (const auto& [why, effects] : off)
        lines.push_back(fmt::format("off  {}: {}", effects, why));
    return lines;
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

Json json_of(const PlannedAttribute& attribute) {
    return {{"name", attribute.name}, {"stored", attribute.stored}, {"reason", attribute.reason}};
}

Json json_of(const PlannedTexture& texture) {
    return {{"sampler", texture.sampler},
            {"image", texture.image},
            {"mip_chain", texture.mip_chain},
            {"reason", texture.reason}};
}

Json json_of(const EffectReason& reason) {
    return {{"effect", reason.effect}, {"on", reason.on}, {"reason", reason.reason}};
}

Json json_of(const PlannedPass& pass) {
    return {{"pass", pass.name}, {"reason", pass.reason}};
}

template <typename Thing>
Json list_of(const std::vector<Thing>& things) {
    return json_list(things, [](const Thing& thing) { return json_of(thing); });
}

Table joined(Table rows, const Table& more) {
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

bool same_row(const EffectReason& a, const EffectReason& b) {
    return a.effect == b.effect && a.on == b.on && a.reason == b.reason;
}

bool same_table(const Table& a, const Table& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_row);
}

bool has_row(const Table& table, const EffectReason& row) {
    return std::any_of(table.begin(), table.end(),
                       [&](const EffectReason& other) { return same_row(other, row); });
}

void replace_all(std::string& text, const std::string& old, const std::string& with) {
    for (std::size_t at = text.find(old); at != std::string::npos;
         at = text.find(old, at + with.size()))
        text.replace(at, old.size(), with);
}

/// Returns the rows of a draw with the names of its material and mesh replaced, so that the reasons
/// of different draws can be the same.
Table without_names(Table table, const Scene& scene, const DrawPlan& draw) {
    const std::size_t mesh = scene.instances[draw.instance].mesh;
    const std::string unnamed_mesh = fmt::format("mesh '{}'", scene.meshes[mesh]->name);
    for (EffectReason& row : table) {
        replace_all(row.reason, material_label(scene, draw.range.material), "the material");
        replace_all(row.reason, unnamed_mesh, "the mesh");
        replace_all(row.reason, mesh_label(scene, mesh), "the mesh");
    }
    return table;
}

/// Draws whose rows differ by names only.
struct DrawGroup {
    std::vector<std::size_t> draws;
    Table table;  ///< Without the names of materials and meshes.
    Table shown;  ///< With the names, unless they differ between the draws.
};

std::vector<DrawGroup> draw_groups(const Scene& scene, const FramePlan& plan) {
    std::vector<DrawGroup> groups;
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        const DrawPlan& draw = plan.draws[i];
        Table named = joined(draw.reasons, input_rows(scene, draw));
        Table table = without_names(named, scene, draw);
        const auto group = std::find_if(groups.begin(), groups.end(), [&](const DrawGroup& other) {
            return same_table(other.table, table);
        });
        if (group == groups.end()) {
            groups.push_back({{i}, std::move(table), std::move(named)});
            continue;
        }
        group->draws.push_back(i);
        if (!same_table(group->shown, named)) group->shown = group->table;
    }
    return groups;
}

/// Returns the rows that all groups have; none for a single group.
Table shared_rows(const std::vector<DrawGroup>& groups) {
    Table shared;
    if (groups.size() < 2) return shared;
    for (const EffectReason& row : groups.front().table) {
        const bool is_shared =
            std::all_of(groups.begin(), groups.end(),
                        [&](const DrawGroup& group) { return has_row(group.table, row); });
        if (is_shared) shared.push_back(row);
    }
    return shared;
}

/// Adds a heading with the lines of a table.
void add_table(Summary& summary, const char* name, std::string heading, const Table& table) {
    std::vector<std::string> lines = {std::move(heading)};
    const std::vector<std::string> rows = table_lines(table);
    lines.insert(lines.end(), rows.begin(), rows.end());
    summary.add(name, lines);
}

}  // namespace

std::string draw_heading(const Scene& scene, const DrawPlan& draw) {
    return fmt::format("'{}', material '{}', {}", instance_name(scene, draw),
                       material_name(scene, draw), counted(draw.range.triangle_count, "triangle"));
}

namespace {

/// Adds the rows that all draws share once, and for each group of draws the others.
void add_draws(Summary& summary, const Scene& scene, const FramePlan& plan) {
    const std::vector<DrawGroup> groups = draw_groups(scene, plan);
    const Table shared = shared_rows(groups);
    if (!shared.empty())
        add_table(summary, "draws", fmt::format("all {}", plan.draws.size()), shared);
    for (const DrawGroup& group : groups) {
        Table own;
        for (std::size_t i = 0; i < group.table.size(); ++i) {
            if (!has_row(shared, group.table[i])) own.push_back(group.shown[i]);
        }
        const std::size_t more = group.draws.size() - 1;
        add_table(summary, "draw",
                  draw_heading(scene, plan.draws[group.draws.front()]) +
                      (more > 0 ? fmt::format(" (and {} alike)", counted(more, "draw")) : ""),
                  own);
    }
}

}  // namespace

Summary effect_summary(const Scene& scene, const FramePlan& plan) {
    Summary summary;
    summary.add("frame", table_lines(joined(plan.reasons, pass_rows(plan))),
                {{"frame", list_of(plan.reasons)}, {"passes", list_of(planned_passes(plan))}});
    add_draws(summary, scene, plan);
    const auto draw_json = [&](const DrawPlan& draw) -> Json {
        const DrawInputs inputs = planned_inputs(scene, draw);
        return {
            {"instance", instance_name(scene, draw)}, {"material", material_name(scene, draw)},
            {"triangles", draw.range.triangle_count}, {"tangents_computed", draw.needs_tangents},
            {"effects", list_of(*draw.reasons)},      {"attributes", list_of(inputs.attributes)},
            {"textures", list_of(inputs.textures)}};
    };
    summary.add_json({{"draws", json_list(plan.draws, draw_json)}});
    return summary;
}

namespace {

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

void add_costs(Summary& summary, const EffectCosts& costs, const ViewOptions& options) {
    std::size_t width = 0;
    for (const EffectCost& cost : costs.effects)
        width = std::max(width, cost.effect.size());
    Summary::Lines lines = {fmt::format("a frame takes {}; without", milliseconds(costs.frame))};
    for (const EffectCost& cost : costs.effects) {
        const std::string time = exceeds_noise(cost, costs)
                                     ? fmt::format("{:+8.2f} ms", -cost.milliseconds)
                                     : fmt::format("{:>11}", "(noise)");
        lines.push_back(fmt::format("{:<{}}  {}  {}", cost.effect, width, time,
                                    change_text(cost.change, peak_of(options))));
    }
    const auto cost_json = [&](const EffectCost& cost) -> Json {
        return {{"effect", cost.effect},
                {"milliseconds", cost.milliseconds},
                {"exceeds_noise", exceeds_noise(cost, costs)},
                {"change", change_json(cost.change)}};
    };
    summary.add("costs", lines,
                {{"effect_costs",
                  {{"frame_milliseconds", spread_json(costs.frame)},
                   {"effects", json_list(costs.effects, cost_json)}}}});
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

void add_measures(Summary& summary, const FrameMeasures& measures, const ViewOptions& options,
                  const Frame& drawn) {
    if (measures.budget) {
        const BudgetedPlan& budgeted = *measures.budget;
        summary.add("budget", budget_text(budgeted, options),
                    {{"budget",
                      {{"milliseconds", *options.effects.budget},
                       {"before", budgeted.milliseconds_before},
                       {"after", budgeted.choice.milliseconds},
                       {"dropped", budgeted.choice.dropped},
                       {"change", change_json(budgeted.change)}}}});
    }
    if (measures.benchmark) {
        const FrameSeries& series = *measures.benchmark;
        const TimeStatistics frame = time_statistics(series.frame);
        const TimeStatistics draw = time_statistics(series.draw);
        const TimeStatistics read_back = time_statistics(series.read_back);
        summary.add("benchmark",
                    fmt::format("{}: {}, of which drawing {} and reading back {}; {} linked in {}",
                                counted(series.frame.size(), "frame"), milliseconds(frame),
                                milliseconds(draw), milliseconds(read_back),
                                counted(drawn.programs, "program"), duration(drawn.times.link)),
                    {{"benchmark",
                      {{"frames", series.frame.size()},
                       {"frame_milliseconds", spread_json(frame)},
                       {"draw_milliseconds", spread_json(draw)},
                       {"read_back_milliseconds", spread_json(read_back)},
                       {"programs", drawn.programs},
                       {"link_milliseconds", drawn.times.link}}}});
    }
    if (measures.costs) add_costs(summary, *measures.costs, options);
}

void print_shaders(const Scene& scene, const FramePlan& plan) {
    const std::vector<ShaderListing> listings = shader_listings(plan);
    for (std::size_t i = 0; i < listings.size(); ++i) {
        const ShaderListing& listing = listings[i];
        print_text(fmt::format("{}// Program {} of {}: {}\n", i == 0 ? "" : "\n", i + 1,
                               listings.size(), describe(listing.features)));
        for (const std::size_t draw : listing.draws)
            print_text(
                fmt::format("// draws {}\n", printable(draw_heading(scene, plan.draws[draw]))));
        print_text(fmt::format("// from {}\n\n// Vertex shader\n{}\n// Fragment shader\n{}",
                               fmt::join(listing.files, ", "), listing.vertex, listing.fragment));
    }
}

Json shaders_json(const FramePlan& plan) {
    return json_list(shader_listings(plan), [](const ShaderListing& listing) -> Json {
        return {{"effects", describe(listing.features)},
                {"draws", listing.draws},
                {"files", listing.files},
                {"vertex", listing.vertex},
                {"fragment", listing.fragment}};
    });
}

// Debug views and overlays.

namespace {

Choices<DebugView> view_choices() {
    Choices<DebugView> words;
    for (const DebugViewInfo& info : debug_views())
        words.emplace_back(info.name, info.view);
    return words;
}

const Choices<HealthChoice>& health_choices() {
    static const Choices<HealthChoice> words = {{"problems", HealthChoice::problem},
                                                {"all", HealthChoice::all}};
    return words;
}

std::string hex_color(const glm::vec3& srgb) {
    const auto code = [](float value) { return std::lround(255.0F * value); };
    return fmt::format("#{:02x}{:02x}{:02x}", code(srgb.r), code(srgb.g), code(srgb.b));
}

std::string remedy_for(DebugView view) {
    switch (view) {
        case DebugView::height:
            return "give --height-map with --height-as bump_map";
        case DebugView::normal_map:
            return "give --normal-map or --height-map";
        case DebugView::tangent:
        case DebugView::bitangent:
        case DebugView::handedness:
        case DebugView::texcoords:
            return "unwrap the model first";
        default:
            return "--explain-effects lists what the scene needs";
    }
}

}  // namespace

void add_debug_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Debug views";
    DebugChoices& choices = options.debug;
    add_choice(app, "--show", choices.view, view_choices(),
               "Show a property of the surfaces instead of the picture: directions in world space "
               "as 0.5 v + 0.5, or one term of the lighting. docs/debug-views.md describes the "
               "coding. Default: picture.")
        .group(group);
    add_switch(app, "--wireframe", choices.wireframe,
               "Draw the edges of all triangles over the picture.")
        .group(group);
    add_switch(app, "--vertex-frames", choices.vertex_frames,
               "Draw the tangent (red), bitangent (green) and normal (blue) of each vertex over "
               "the picture.")
        .group(group);
    add_number(
        app, "--frame-length", "R", choices.frame_length, {1e-6, 10, ""},
        "Set the length of the lines of --vertex-frames, times the scene's size. Default: 0.01.")
        .group(group);
    add_switch(app, "--grid", choices.grid,
               "Draw a grid below the scene and the axes over the picture.")
        .group(group);
    add_choice(app, "--health-markers", choices.health_markers, health_choices(),
               "Mark the problems that relief-mesh check finds with colored discs, or all its "
               "findings. The summary lists the colors.")
        .group(group);
}

void check_debug_options(ViewOptions& options) {
    const DebugChoices& choices = options.debug;
    const bool overlaid =
        choices.wireframe || choices.vertex_frames || choices.grid || choices.health_markers;
    const bool draws =
        options.output || options.reference || options.effects.measures() || options.wants_window();
    refuse(overlaid && !draws,
           choices.wireframe       ? "--wireframe"
           : choices.vertex_frames ? "--vertex-frames"
           : choices.grid          ? "--grid"
                                   : "--health-markers",
           "there is no --output", "add one");
    if (!is_data(choices.view)) return;
    const bool exposes = options.scene_fields.has(&Scene::exposure);
    refuse(exposes || options.scene_fields.has(&Scene::tone_mapping),
           exposes ? "--exposure" : "--tone-mapping",
           fmt::format("does not apply to data, which --show {} shows",
                       debug_view_info(choices.view).name),
           "leave it out");
    if (!options.wants_window()) options.samples = 1;
}

HealthMarkers chosen_markers(const DebugChoices& choices, const Scene& scene) {
    if (!choices.health_markers) return {};
    return choices.health_markers == HealthChoice::all ? health_markers(scene, std::nullopt)
                                                       : health_markers(scene);
}

Overlays overlays_of(const DebugChoices& choices, const HealthMarkers& markers, const Grid& grid) {
    Overlays overlays;
    overlays.wireframe = choices.wireframe;
    if (choices.vertex_frames)
        overlays.vertex_frames = choices.frame_length.value_or(default_frame_length);
    if (choices.grid) overlays.grid = grid;
    overlays.markers = markers.markers;
    return overlays;
}

FramePlan viewed_plan(const ViewOptions& options, const Scene& scene, const FrameSettings& settings,
                      FramePlan plan, Report& report) {
    try {
        return plan_view(scene, settings, std::move(plan), report);
    } catch (const InvalidInput& error) {
        throw failure(options.model, error.what(), remedy_for(options.debug.view));
    }
}

void add_legend(Summary& summary, const HealthMarkers& markers) {
    Summary::Lines lines;
    for (const MarkedCondition& marked : markers.conditions) {
        const std::string_view word = condition_info(marked.condition).word;
        std::string line =
            fmt::format("{} {}: {}", hex_color(marked.color_srgb), word, marked.count);
        if (marked.marked < marked.count) line += fmt::format(", {} marked", marked.marked);
        lines.push_back(std::move(line));
    }
    if (lines.empty()) lines.emplace_back("none");
    summary.add("markers", lines, {{"markers", legend_json(markers)}});
}

Json legend_json(const HealthMarkers& markers) {
    return json_list(markers.conditions, [](const MarkedCondition& marked) -> Json {
        return {{"kind", condition_info(marked.condition).word},
                {"count", marked.count},
                {"marked", marked.marked},
                {"color", hex_color(marked.color_srgb)}};
    });
}

Json overlays_json(const DebugChoices& choices, const HealthMarkers& markers) {
    return {{"wireframe", choices.wireframe},
            {"vertex_frames", choices.vertex_frames},
            {"grid", choices.grid},
            {"health_markers", choices.health_markers ? legend_json(markers) : Json()}};
}

std::string command_line_of(const DebugChoices& choices) {
    std::string text;
    if (choices.view != DebugView::picture)
        text += fmt::format(" --show {}", debug_view_info(choices.view).name);
    if (choices.wireframe) text += " --wireframe";
    if (choices.vertex_frames) text += " --vertex-frames";
    if (choices.vertex_frames && choices.frame_length)
        text += fmt::format(" --frame-length {}", *choices.frame_length);
    if (choices.grid) text += " --grid";
    if (choices.health_markers)
        text += " --health-markers " + name_of(*choices.health_markers, health_choices());
    return text;
}

}  // namespace relief::tools
