// SPDX-License-Identifier: Apache-2.0
#include "page_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/options.h"
#include "common/text.h"
#include "effect_options.h"
#include "file_replacement.h"
#include "page_motion.h"
#include "page_probes.h"
#include "page_writer.h"
#include "picture_comparison.h"
#include "relief/shade/page.h"
#include "relief/shade/picture_steps.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Each explained pixel is 1 to 2 kB of the page.
constexpr int max_probes = 4096;

DebugView view_of(const std::string& subject, const std::string& name) {
    for (const DebugViewInfo& info : debug_views()) {
        if (info.name == name) return info.view;
    }
    throw UsageError(fmt::format("{}: there is no view '{}'", subject, name),
                     "relief-view --help lists those of --show");
}

/// The scene with the material variants of its file, the one of the command line first.
std::vector<ComposedScene> variants_of(const ViewOptions& options, const ComposedScene& composed,
                                       Stages& stages) {
    std::vector<ComposedScene> variants;
    if (options.material_variant) return variants;
    for (std::size_t i = 0; i < composed.graph.material_variants.size(); ++i) {
        ViewOptions chosen = options;
        chosen.material_variant = std::to_string(i + 1);
        Report same;
        variants.push_back(compose_scene(chosen, stages, same));
    }
    return variants;
}

/// The other side of a comparison, as a scene that moves.
ComposedScene compose_other_side(const ViewOptions& options, const ComposedScene& composed,
                                 Stages& stages) {
    Report same;  // Most of these findings belong to both sides.
    if (options.compare.variant) {
        ComposedScene other = composed;
        other.scene() = other_side(options, composed, stages, same).scene;
        return other;
    }
    ViewOptions chosen = options;
    chosen.model = *options.compare.file;
    ComposedScene other = compose_scene(chosen, stages, same);
    OtherSide side =
        side_of_file(composed.scene(), composed.camera, chosen, std::move(other.scene()));
    other.scene() = std::move(side.scene);
    other.camera = side.camera;
    other.camera_follows_scene = false;
    if (is_scene_file(chosen)) return other;
    // Its lights are those of the first scene, at rest.
    for (auto* lights :
         {&other.graph.directional_lights, &other.graph.point_lights, &other.graph.spot_lights})
        lights->clear();
    for (Animation& animation : other.graph.animations) {
        if (auto* keys = std::get_if<KeyAnimation>(&animation))
            std::erase_if(keys->channels, [](const KeyChannel& channel) {
                return channel.property == KeyChannel::Property::pointer;
            });
    }
    return other;
}

/// Records pictures: views, material variants, steps, and the other side of a comparison.
class PictureRecorder {
  public:
    PictureRecorder(const ViewOptions& options, const FrameSettings& settings,
                    PageRecorder& recorder, Report& report)
        : options_(options), settings_(settings), recorder_(recorder), report_(report) {}

    /// Records all views of a scene.
    /// \param name  of its first picture
    void add_views(const ComposedScene& composed, PagePictureName name) {
        for (const DebugView view : views()) {
            name.view = debug_view_info(view).name;
            add(composed, view, name);
            name.step.reset();
        }
    }

    /// Records the right sides of the first pictures.
    void add_right_sides(const ComposedScene& other, const std::string& variant,
                         std::size_t scene) {
        std::size_t left = 0;
        for (const DebugView view : views())
            add(other, view, {std::string(debug_view_info(view).name), variant, {}, left++, scene});
    }

    /// Records the steps before the last one, which is the whole picture.
    void add_steps(const ComposedScene& composed, const std::vector<PictureStep>& steps) {
        FrameSettings single = settings_;
        single.samples = 1;
        for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
            ComposedScene& scene = *kept_.emplace_back(std::make_unique<ComposedScene>(composed));
            scene.scene() = scene_of_step(composed.scene(), steps[i]);
            Report same;
            recorder_.add(scene.graph, plan_of_step(scene.scene(), single, steps[i]), settings_,
                          same);
            names_.push_back({names_.front().view, names_.front().variant, i});
        }
    }

    /// Records the first picture at times, for its values. These pictures have no names.
    void add_motion(const ComposedScene& composed, const std::vector<double>& times) {
        for (const double time : times) {
            Report same;
            record(
                *kept_.emplace_back(std::make_unique<ComposedScene>(composed_at(composed, time))),
                settings_.view, same);
        }
    }

    [[nodiscard]] const std::vector<PagePictureName>& names() const { return names_; }

  private:
    [[nodiscard]] std::vector<DebugView> views() const {
        std::vector<DebugView> views = {settings_.view};
        for (const DebugView view : options_.page_views) {
            if (std::find(views.begin(), views.end(), view) == views.end()) views.push_back(view);
        }
        return views;
    }

    void add(const ComposedScene& composed, DebugView view, const PagePictureName& name) {
        Report others;
        record(composed, view, names_.empty() ? report_ : others);
        names_.push_back(name);
    }

    void record(const ComposedScene& composed, DebugView view, Report& report) {
        ViewOptions options = options_;
        options.debug.view = view;
        FrameSettings settings = settings_;
        settings.view = view;
        FrameSettings single = settings;
        single.samples = 1;
        const Scene& scene = composed.scene();
        const FramePlan plan =
            viewed_plan(options, scene, single, chosen_plan(options, scene, single), report);
        recorder_.add(composed.graph, plan, settings, report);
    }

    const ViewOptions& options_;
    const FrameSettings& settings_;
    PageRecorder& recorder_;
    Report& report_;
    std::vector<PagePictureName> names_;
    std::vector<std::unique_ptr<ComposedScene>> kept_;  ///< The recorder refers to them.
};

PageScene scene_of(const ComposedScene& composed) {
    return {&composed.graph, composed.camera, composed.camera_follows_scene};
}

PageSettings page_settings_of(const ViewOptions& options, const ComposedScene& composed,
                              const std::optional<ComposedScene>& other) {
    PageSettings page;
    page.title = options.model.filename().string();
    page.scenes = {scene_of(composed)};
    page.seconds = options.time.value_or(0.0);
    page.size = options.size;
    if (!other) return page;
    page.split = {options.compare.split.value_or(default_split), page.title,
                  side_name(options.compare)};
    if (options.compare.file) page.scenes.push_back(scene_of(*other));
    return page;
}

/// The height map, if it is a normal map, with its conversions: those of both sides.
std::optional<PageHeights> heights_of(const ViewOptions& options) {
    if (!options.height_map || options.height_as == HeightUse::bump_map) return std::nullopt;
    PageHeights heights{read_image(*options.height_map, ImageUse::data), {}};
    BumpOptions bump;
    bump.strength = options.strength.value_or(bump.strength);
    bump.kernel = options.kernel;
    heights.conversions.push_back(bump);
    if (!options.compare.variant) return heights;
    if (const auto* kernel = std::get_if<Kernel>(&*options.compare.variant)) {
        bump.kernel = *kernel;
        heights.conversions.push_back(bump);
    }
    return heights;
}

std::vector<Json> probes_of(const ViewOptions& options, const FrameSettings& settings,
                            const ComposedScene& composed, Stages& stages) {
    const std::vector<glm::ivec2> places = page_probe_places(options, options.size);
    if (places.empty()) return {};
    std::vector<Json> probes;
    Report same;
    for (const ProbedPixel& pixel :
         probed_pixels(options, composed, settings, places, stages, same)) {
        Json json = page_probe_json(pixel, composed.scene());
        if (!json.is_null()) probes.push_back(std::move(json));
    }
    return probes;
}

/// The times at which values of materials are recorded, with the effects for them in the options.
std::vector<double> times_of_materials(ViewOptions& options, const FrameSettings& settings,
                                       const ComposedScene& composed, Report& report) {
    if (!moves_materials(composed.graph)) return {};
    const std::vector<double> times = material_times(composed.graph);
    const bool is_picture = settings.view == DebugView::picture;
    if (is_picture && !times.empty()) force_moving_effects(options, settings, composed, times);
    const bool shows_others = !options.page_views.empty() || options.steps ||
                              options.compare.compares() ||
                              !composed.graph.material_variants.empty();
    if (!is_picture || times.empty() || shows_others) {
        report.add("materials that animations move", "scene", 0,
                   is_picture && !times.empty()
                       ? "other views, variants, steps and sides show them at the time of --time"
                       : "the page shows them at the time of --time");
    }
    return is_picture ? times : std::vector<double>();
}

}  // namespace

void add_page_options(CLI::App& app, ViewOptions& options) {
    add_value(app, "--page-views", "VIEW,...",
              "Offer these views of --show in the page (--output page.html), beside the picture. "
              "docs/page.md describes pages.",
              [&](const std::string& subject, const std::string& text) {
                  for (const std::string& name : split(text, ','))
                      options.page_views.push_back(view_of(subject, name));
              })
        .group("Debug views");
    add_value(
        app, "--page-probes", "WxH",
        "Explain W x H pixels of the first view in the page: a click on the picture shows the "
        "nearest one with its vectors, and the terms of its light, as --probe does. "
        "--probe X,Y adds that pixel.",
        [&](const std::string& subject, const std::string& text) {
            options.page_probes = parse_size(subject, text);
            if (options.page_probes.x * options.page_probes.y > max_probes) {
                throw UsageError(
                    fmt::format("{}: a page explains at most {} pixels", subject, max_probes),
                    "choose fewer columns or rows");
            }
        })
        .group("Debug views");
    add_switch(app, "--page-quantize", options.page_quantize,
               "Store the vertices of the page in 16 bits. The summary states the largest error of "
               "each attribute.")
        .group("Output");
}

bool is_page(const ViewOptions& options) {
    return options.output && extension_of(*options.output) == ".html";
}

void report_size(std::size_t bytes, Report& report) {
    constexpr std::size_t megabyte = 1'000'000;
    if (bytes > 100 * megabyte) {
        report.add("page larger than 100 MB", "megabyte", bytes / megabyte,
                   "browsers take long to open it");
    }
}

WrittenPage write_page(const ViewOptions& given, const FrameSettings& settings,
                       const ComposedScene& composed, Stages& stages, Report& report) {
    ViewOptions options = given;
    const std::vector<double> times = times_of_materials(options, settings, composed, report);
    std::optional<ComposedScene> other;
    if (options.compare.compares()) other = compose_other_side(options, composed, stages);
    PageSettings page_settings = page_settings_of(options, composed, other);
    if (options.steps) page_settings.steps = picture_steps(composed.scene(), settings);
    page_settings.heights = heights_of(options);
    page_settings.probes = probes_of(options, settings, composed, stages);
    const std::unique_ptr<Context> context =
        stages.run("context", [&] { return std::make_unique<Context>(options.backend); });
    const std::vector<ComposedScene> variants = variants_of(options, composed, stages);
    PageRecorder recorder(*context);
    PictureRecorder pictures(options, settings, recorder, report);
    stages.run("record", [&] {
        PagePictureName first;
        if (!variants.empty()) first.variant = "default";
        if (options.steps) first.step = page_settings.steps.size() - 1;
        pictures.add_views(composed, first);
        if (other) pictures.add_right_sides(*other, first.variant, page_settings.scenes.size() - 1);
        pictures.add_steps(composed, page_settings.steps);
        for (std::size_t i = 0; i < variants.size(); ++i)
            pictures.add_views(variants[i], {"", composed.graph.material_variants[i]});
        pictures.add_motion(composed, times);
    });
    page_settings.names = pictures.names();
    page_settings.motion_times = times;
    const PageDescription& page = recorder.description();
    return stages.run("write", [&] {
        const PageQuantization codes = options.page_quantize ? quantized(page) : PageQuantization();
        const std::string text = page_html(page, page_settings, codes);
        report_size(text.size(), report);
        relief::detail::FileReplacement file(*options.output);
        relief::detail::write_all(file, std::as_bytes(std::span(text)));
        file.commit();
        return WrittenPage{text.size(),
                           page.programs.size(),
                           page.textures.size(),
                           page_settings.names.size(),
                           page_settings.steps.size(),
                           page_settings.probes.size(),
                           codes.errors};
    });
}

}  // namespace relief::tools
