// SPDX-License-Identifier: Apache-2.0
#include "page_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/text.h"
#include "effect_options.h"
#include "file_replacement.h"
#include "page_writer.h"
#include "relief/shade/page.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

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

/// Records the views of one variant.
class ViewRecorder {
  public:
    ViewRecorder(const ViewOptions& options, const FrameSettings& settings, PageRecorder& recorder,
                 Report& report)
        : options_(options), settings_(settings), recorder_(recorder), report_(report) {}

    void add(const ComposedScene& composed, const std::string& variant) {
        add(composed, settings_.view, variant);
        for (const DebugView view : options_.page_views) {
            if (view != settings_.view) add(composed, view, variant);
        }
    }

    [[nodiscard]] const std::vector<PagePictureName>& names() const { return names_; }

  private:
    void add(const ComposedScene& composed, DebugView view, const std::string& variant) {
        ViewOptions options = options_;
        options.debug.view = view;
        FrameSettings settings = settings_;
        settings.view = view;
        FrameSettings single = settings;
        single.samples = 1;
        const Scene& scene = composed.scene();
        Report others;
        Report& report = names_.empty() ? report_ : others;
        const FramePlan plan =
            viewed_plan(options, scene, single, chosen_plan(options, scene, single), report);
        recorder_.add(composed.graph, plan, settings, report);
        names_.push_back({std::string(debug_view_info(view).name), variant});
    }

    const ViewOptions& options_;
    const FrameSettings& settings_;
    PageRecorder& recorder_;
    Report& report_;
    std::vector<PagePictureName> names_;
};

}  // namespace

void add_page_options(CLI::App& app, ViewOptions& options) {
    add_value(
        app, "--page-views", "VIEW,...",
        "Offer these views of --show in the page (--output page.html), beside the picture. "
        "docs/page.md describes pages.",
        [&](const std::string& subject, const std::string& text) {
            std::size_t begin = 0;
            while (begin <= text.size()) {
                const std::size_t end = std::min(text.find(',', begin), text.size());
                options.page_views.push_back(view_of(subject, text.substr(begin, end - begin)));
                begin = end + 1;
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

WrittenPage write_page(const ViewOptions& options, const FrameSettings& settings,
                       const ComposedScene& composed, Stages& stages, Report& report) {
    const std::unique_ptr<Context> context =
        stages.run("context", [&] { return std::make_unique<Context>(options.backend); });
    const std::vector<ComposedScene> variants = variants_of(options, composed, stages);
    PageRecorder recorder(*context);
    ViewRecorder views(options, settings, recorder, report);
    stages.run("record", [&] {
        views.add(composed, variants.empty() ? "" : "default");
        for (std::size_t i = 0; i < variants.size(); ++i)
            views.add(variants[i], composed.graph.material_variants[i]);
    });
    if (moves_materials(composed.graph)) {
        report.add("materials that animations move", "scene", 0,
                   "the page shows them at the time of --time");
    }
    const PageDescription& page = recorder.description();
    return stages.run("write", [&] {
        const PageQuantization codes = options.page_quantize ? quantized(page) : PageQuantization();
        const std::string text =
            page_html(page, composed, views.names(), options.model.filename().string(),
                      options.time.value_or(0.0),
                      static_cast<double>(options.size.x) / options.size.y, codes);
        report_size(text.size(), report);
        relief::detail::FileReplacement file(*options.output);
        relief::detail::write_all(file, std::as_bytes(std::span(text)));
        file.commit();
        return WrittenPage{text.size(), page.programs.size(), page.textures.size(),
                           page.pictures.size(), codes.errors};
    });
}

}  // namespace relief::tools
