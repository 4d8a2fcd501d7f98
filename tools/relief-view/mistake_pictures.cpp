// SPDX-License-Identifier: Apache-2.0
#include "mistake_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "common/options.h"
#include "picture_sheet.h"
#include "picture_sink.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr std::string_view all_mistakes = "all";

std::vector<std::string> mistake_names() {
    std::vector<std::string> names;
    for (const Mistake& mistake : mistakes())
        names.emplace_back(mistake.name);
    return names;
}

std::vector<const Mistake*> parse_mistakes(const std::string& subject, const std::string& text) {
    std::vector<const Mistake*> chosen;
    if (text == all_mistakes) {
        for (const Mistake& mistake : mistakes())
            chosen.push_back(&mistake);
        return chosen;
    }
    for (const std::string& name : split(text, ',')) {
        const Mistake* const mistake = find_mistake(name);
        if (mistake == nullptr) {
            throw UsageError(fmt::format("{}: '{}' is not one of {}, {}", subject, name,
                                         all_mistakes, fmt::join(mistake_names(), ", ")));
        }
        if (std::find(chosen.begin(), chosen.end(), mistake) != chosen.end())
            throw UsageError(fmt::format("{}: '{}' is named twice", subject, name));
        chosen.push_back(mistake);
    }
    return chosen;
}

/// The pictures of a row of the sheet.
std::vector<Image> row_of(const MistakeCost& cost) {
    Image flip = false_color_image(cost.flip.map, 1.0);
    if (cost.right.channels == 4) flip = with_alpha(flip);
    return {cost.right, cost.wrong, std::move(flip)};
}

/// Writes the wrong pictures, or the sheet.
class MistakeWriter {
  public:
    explicit MistakeWriter(const ViewOptions& options) : options_(options) {}

    void take(const MistakeCost& cost, const PictureComparison& change) {
        if (options_.mistakes.size() == 1) write_difference_map(options_, change);
        if (!options_.output) return;
        if (has_numbers(*options_.output)) {
            write_image(numbered_file(*options_.output, ++written_), cost.wrong);
        } else if (options_.mistakes.size() == 1) {
            write_image(*options_.output, cost.wrong);
        } else {
            rows_.push_back(row_of(cost));
        }
    }

    void finish() {
        if (!rows_.empty()) write_image(*options_.output, sheet_of(rows_));
    }

  private:
    const ViewOptions& options_;
    std::vector<std::vector<Image>> rows_;
    int written_ = 0;
};

Json angles_json(const DrawnMistake& drawn) {
    if (!drawn.angles) return nullptr;
    const ErrorStats& angles = *drawn.angles;
    return {{"vector", drawn.vector}, {"count", angles.count}, {"undefined", angles.undefined},
            {"mean", angles.mean},    {"p99", angles.p99},     {"max", angles.max}};
}

Json mistake_json(const DrawnMistake& drawn) {
    const bool shows = drawn.change.has_value();
    return {{"name", drawn.mistake->name},
            {"what", drawn.mistake->what},
            {"shows", shows},
            {"reason", shows ? Json() : Json(drawn.reach.hidden)},
            {"surfaces", drawn.reach.draws},
            {"of", drawn.reach.total},
            {"change", shows ? numbers_json(*drawn.change) : Json()},
            {"changed_share", drawn.changed_share},
            {"angles", angles_json(drawn)}};
}

}  // namespace

void add_mistake_options(CLI::App& app, ViewOptions& options) {
    add_value(app, "--mistake", "NAME[,NAME...]",
              fmt::format("Draw the picture with a mistake that shaders often have, and measure "
                          "what it costs: FLIP, the pixels that change, and the angle between "
                          "right and wrong directions. Mistakes: {}, or all for those that show. "
                          "The output of several is a sheet, in which a row has the right picture, "
                          "the wrong one and their FLIP, or numbered files of wrong pictures if "
                          "its name has a #. This option needs no --output. docs/mistakes.md "
                          "shows them.",
                          fmt::join(mistake_names(), ", ")),
              [&](const std::string& subject, const std::string& text) {
                  options.mistakes = parse_mistakes(subject, text);
                  options.all_mistakes = text == all_mistakes;
              })
        .group("Shaders");
}

DrawnMistake measured_mistake(const Mistake& mistake, const Scene& scene, const Camera& camera,
                              const FrameSettings& settings, const Context& context,
                              RenderCache& cache, Report& report, MistakeCost* cost) {
    DrawnMistake drawn{&mistake, reach_of(mistake, scene, settings), {}, {}, {}};
    if (!drawn.reach.hidden.empty()) return drawn;
    const Image* const right = cost != nullptr && !cost->right.empty() ? &cost->right : nullptr;
    MistakeCost found =
        mistake_cost(mistake, scene, camera, settings, context, cache, report, right);
    drawn.vector = measured_name(mistake, scene);
    drawn.angles = found.angles;
    drawn.change = PictureComparison{found.difference, found.flip, peak_of(found.right)};
    const double pixels =
        static_cast<double>(found.right.width) * static_cast<double>(found.right.height);
    drawn.changed_share = static_cast<double>(found.difference.differing_pixels) / pixels;
    if (cost != nullptr) *cost = std::move(found);
    return drawn;
}

std::vector<DrawnMistake> draw_mistakes(const ViewOptions& options, const FrameSettings& settings,
                                        const ComposedScene& composed, Stages& stages,
                                        Report& report) {
    const Scene& scene = composed.scene();
    const auto context =
        stages.run("context", [&] { return std::make_unique<Context>(options.backend); });
    RenderCache cache(*context);
    MistakeWriter writer(options);
    std::vector<DrawnMistake> drawn;
    MistakeCost cost;  // The first one draws the right picture, with all findings.
    for (const Mistake* const mistake : options.mistakes) {
        stages.run("draw", fmt::format("draw {}", mistake->name), [&] {
            drawn.push_back(measured_mistake(*mistake, scene, composed.camera, settings, *context,
                                             cache, report, &cost));
            if (drawn.back().change) {
                writer.take(cost, *drawn.back().change);
            } else if (!options.all_mistakes) {
                throw UsageError(fmt::format("--mistake {}: would change nothing, because {}",
                                             mistake->name, drawn.back().reach.hidden),
                                 "--mistake all lists those that show");
            }
        });
    }
    stages.run("write", [&] { writer.finish(); });
    return drawn;
}

std::string cost_text(const DrawnMistake& drawn) {
    if (!drawn.change) return "does not show: " + drawn.reach.hidden;
    const std::string reach =
        fmt::format(", on {} of {}", drawn.reach.draws, counted(drawn.reach.total, "surface"));
    if (drawn.change->difference.differing_pixels == 0)
        return "changes no pixel that this camera sees" + reach;
    std::string text =
        fmt::format("FLIP {:.3g} (largest {:.3g}), {:.3g} % of the pixels change",
                    drawn.change->flip.mean, drawn.change->flip.max, 100.0 * drawn.changed_share);
    if (drawn.angles && drawn.angles->count > 0) {
        text += fmt::format(", {} off by {:.3g} degrees (99 %: {:.3g}, largest {:.3g})",
                            drawn.vector, drawn.angles->mean, drawn.angles->p99, drawn.angles->max);
    }
    return text + reach;
}

void add_mistakes(Summary& summary, const ViewOptions& options,
                  const std::vector<DrawnMistake>& drawn) {
    Summary::Lines lines;
    std::size_t shown = 0;
    for (const DrawnMistake& each : drawn) {
        if (!options.all_mistakes)
            lines.push_back(fmt::format("{}: {}", each.mistake->name, each.mistake->what));
        lines.push_back(fmt::format("{}: {}", each.mistake->name, cost_text(each)));
        if (each.change) ++shown;
    }
    summary.add("mistakes", lines, {{"mistakes", json_list(drawn, mistake_json)}});
    if (!options.output || shown == 0) return;
    const std::filesystem::path& output = *options.output;
    summary.add("wrote", has_numbers(output)
                             ? fmt::format("{} to {}", numbered_file(output, 1).string(),
                                           numbered_file(output, static_cast<int>(shown)).string())
                             : file_and_size(output));
}

}  // namespace relief::tools
