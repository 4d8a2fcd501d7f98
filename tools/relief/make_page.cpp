// SPDX-License-Identifier: Apache-2.0
// Writes the report page of `relief make`. Tests: tests/make/make_page_test.cpp.
#include "make_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "common/html.h"
#include "common/text.h"
#include "common/view_direction.h"
#include "file_replacement.h"
#include "make_loss.h"
#include "make_pictures.h"
#include "make_remesh.h"
#include "page_comparison.h"
#include "page_text.h"

namespace relief::tools {
namespace {

/// Writes elements with pictures.
class PageWriter {
  public:
    PageWriter(std::filesystem::path folder, const MakeRequest& request, const Job& job,
               const MadeAsset& made, const Stages& stages, bool has_live_view)
        : folder_(std::move(folder)),
          request_(request),
          job_(job),
          made_(made),
          stages_(stages),
          has_live_view_(has_live_view) {}

    [[nodiscard]] std::string figures() const;
    [[nodiscard]] std::string comparison() const;
    [[nodiscard]] std::string remeshing() const;
    [[nodiscard]] std::string findings() const;
    [[nodiscard]] std::string stages() const;
    [[nodiscard]] std::string loss() const;
    [[nodiscard]] std::string worst_pictures() const;
    [[nodiscard]] std::string levels() const;
    [[nodiscard]] std::string maps() const;

  private:
    [[nodiscard]] std::string img(const Image& image, const std::string& alt,
                                  const std::string& id = "") const;
    [[nodiscard]] std::string live_view(AssetScenes& scenes, const glm::ivec2& size) const;

    std::filesystem::path folder_;
    const MakeRequest& request_;
    const Job& job_;
    const MadeAsset& made_;
    const Stages& stages_;
    bool has_live_view_;
};

std::string PageWriter::img(const Image& image, const std::string& alt,
                            const std::string& id) const {
    return html_image(image, alt, id, folder_);
}

std::string PageWriter::figures() const {
    const make::Asset& asset = made_.asset;
    return html_escaped(fmt::format("{}: {} became {}, with maps of {} x {} texels.",
                                    job_.input.filename().string(),
                                    counted(made_.source.triangles, "triangle"),
                                    counted(asset.mesh.triangles.size(), "triangle"),
                                    asset.normal_map.width, asset.normal_map.height));
}

/// The models as a page of their own in the page. What it lacks is no failure of the report.
std::string PageWriter::live_view(AssetScenes& scenes, const glm::ivec2& size) const {
    constexpr std::size_t max_bytes = 16'000'000;
    if (!has_live_view_) return "";
    std::string reason;
    try {
        const std::string page = scenes.page(made_.asset, size);
        if (page.size() <= max_bytes)
            return "<h2>To look around</h2>\n" + embedded_page(page, "the models, to be orbited");
        reason = fmt::format("it would have {}", byte_size(page.size()));
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        reason = error.what();
    }
    return fmt::format("<p>There is no view to look around: {}.</p>\n", html_escaped(reason));
}

std::string PageWriter::comparison() const {
    const glm::ivec2 size(960, 720);
    try {
        AssetScenes scenes(dense_model(request_, job_), job_.output);
        const AssetPictures pictures = scenes.draw(made_.asset, size);
        return fmt::format(
            "<figure class=\"comparison\">\n<div class=\"stack\">{}{}</div>\n"
            "<div class=\"controls\"><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" "
            "aria-label=\"split\">\n"
            "<label><input type=\"radio\" name=\"right\" value=\"asset\" checked> asset</label>\n"
            "<label><input type=\"radio\" name=\"right\" value=\"plain\"> asset without "
            "maps</label></div>\n"
            "<figcaption>Left of the line: the source. Right: the choice above. One camera, the "
            "same lights, drawn by {}.</figcaption>\n"
            "<details><summary>All pictures</summary>{}{}</details></figure>\n{}",
            img(pictures.source, "source"), img(pictures.asset, "asset or asset without maps"),
            html_escaped(pictures.backend), img(pictures.asset, "asset", "asset"),
            img(pictures.plain, "asset without maps", "plain"), live_view(scenes, size));
    } catch (const Cancelled&) {
        throw;
    } catch (const FileError&) {
        throw;
    } catch (const Error& error) {
        return fmt::format("<p>The models could not be drawn: {}</p>", html_escaped(error.what()));
    }
}

std::string PageWriter::remeshing() const {
    if (!made_.asset.remesh) return "";
    const std::vector<std::string> lines = remesh_lines(*made_.asset.remesh);
    std::string list;
    for (std::size_t i = 1; i < lines.size(); ++i)
        list += "<li>" + html_escaped(lines[i]) + "</li>\n";
    return fmt::format("<p>Remeshing: {}.</p>\n{}", html_escaped(lines.front()),
                       list.empty() ? "" : "<ul>\n" + list + "</ul>\n");
}

std::string PageWriter::findings() const {
    if (made_.findings.empty()) return "<p>None.</p>";
    std::string list;
    for (const PlacedFinding& finding : made_.findings.all())
        list += "<li>" + html_escaped(to_string(finding)) + "</li>\n";
    return "<ul>\n" + list + "</ul>";
}

std::string table(const std::string& head, const std::string& rows) {
    return "<div class=\"scrolled\" tabindex=\"0\"><table><thead><tr>" + head +
           "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string PageWriter::stages() const {
    const double all = std::max(stages_.milliseconds(), 1e-9);
    std::string rows;
    for (const StageUse& stage : made_.stages) {
        const double time = stages_.milliseconds(stage.stage);
        rows += fmt::format(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.0f} "
            "%</td><td>{}</td><td>{}</td></tr>\n",
            stage.stage, duration(time), 100.0 * time / all,
            duration(1e3 * stage.processor_seconds), byte_size(stage.peak_bytes));
    }
    return table(
        "<th scope=\"col\">stage</th><th scope=\"col\">time</th><th scope=\"col\">share</th>"
        "<th scope=\"col\">processor time</th>"
        "<th scope=\"col\">memory</th>",
        rows);
}

std::string figure_cell(const std::optional<double>& value) {
    return value ? fmt::format("<td>{:.4f}</td>", *value) : "<td>–</td>";
}

std::string heads(const std::vector<std::string>& names) {
    std::string html;
    for (const std::string& name : names)
        html += "<th scope=\"col\">" + html_escaped(name) + "</th>";
    return html;
}

/// The figures of all views.
std::string loss_table(const shade::Fidelity& loss, ErrorKind limited) {
    const bool has_rms = limited == ErrorKind::rms;
    std::vector<std::string> names = {"difference", "mean"};
    if (has_rms) names.emplace_back("rms");
    for (const char* name : {"95 %", "99 %", "largest", "worst view", "noise floor"})
        names.emplace_back(name);
    std::string rows;
    for (const LossRow& row : loss_rows(loss, limited)) {
        rows +=
            fmt::format("<tr><th scope=\"row\">{}</th>{}{}{}{}{}<td>{:.4f} (view {})</td>{}</tr>\n",
                        row.name, figure_cell(row.mean), has_rms ? figure_cell(row.rms) : "",
                        figure_cell(row.p95), figure_cell(row.p99), figure_cell(row.max), row.worst,
                        row.worst_view, figure_cell(row.floor));
    }
    return table(heads(names), rows);
}

/// The loss after each stage.
std::string stage_table(const AssetLoss& loss) {
    std::string rows;
    const auto add = [&](const std::string& name, const std::string& triangles,
                         const shade::SampledFidelity& of, const std::optional<double>& p99) {
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>", name, triangles);
        for (const double flip : of.flip)
            rows += figure_cell(flip);
        rows += figure_cell(of.normals.mean) + figure_cell(p99) +
                figure_cell(of.silhouette_pixels) + "</tr>\n";
    };
    for (const LossStage& stage : loss.stages)
        add(stage.name, std::to_string(stage.triangles), stage.loss, stage.loss.normals.p99);
    add("noise floor", "–", sampled_floor(loss.fidelity), {});
    return fmt::format(
        "<h3>After each stage</h3>\n<p>Against the source, in {}. The differences of stages do not "
        "add up. Decimated: without maps. Baked: normals before they are coded. Coded: the "
        "asset.</p>\n{}",
        sampled_views_text(loss.fidelity),
        table(heads({"after", "triangles", "FLIP, studio", "FLIP, grazing", "FLIP, base-color",
                     "degrees", "degrees, 99 %", "silhouettes, pixels"}),
              rows));
}

std::string distance_table(const AssetLoss& loss) {
    std::string rows;
    for (const DistanceRow& row : distance_rows(loss)) {
        rows += fmt::format("<tr><th scope=\"row\">{}</th>", row.name);
        for (const double value : {row.mean, row.p95, row.max})
            rows += "<td>" + distance_text(value, loss.diagonal) + "</td>";
        rows += "</tr>\n";
    }
    return "<h3>Distances</h3>\n<p>In units of the model, and in percent of the diagonal of its "
           "box.</p>\n" +
           table(heads({"from", "mean", "95 %", "largest"}), rows);
}

/// The views; the largest difference of pictures is first.
std::string view_table(const shade::Fidelity& loss) {
    std::string rows;
    for (const std::size_t view : shade::worst_views_first(loss)) {
        const shade::ViewLoss& one = loss.views[view];
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>", view, view_text(one.from));
        for (const double figure :
             {one.flip[0], one.flip[1], one.flip[2], one.degrees, one.silhouette_pixels})
            rows += figure_cell(figure);
        rows += "</tr>\n";
    }
    return "<details><summary>All views, the worst first</summary>\n" +
           table(heads({"view", "azimuth,elevation", "FLIP, studio", "FLIP, grazing",
                        "FLIP, base-color", "degrees", "silhouettes, pixels"}),
                 rows) +
           "</details>\n";
}

std::string PageWriter::worst_pictures() const {
    const shade::Fidelity& loss = made_.loss->fidelity;
    std::string html;
    for (std::size_t i = 0; i < shade::fidelity_light_count; ++i) {
        const shade::PictureLoss& picture = loss.pictures[i];
        if (picture.source.empty()) continue;
        const std::string light = enum_name(static_cast<shade::FidelityLight>(i));
        const auto add = [&](const Image& image, const std::string& name) {
            html += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n",
                                img(image, fmt::format("{}, {}", name, light)),
                                fmt::format("{}, {}, view {}", name, light, picture.worst.view));
        };
        add(picture.source, "source");
        add(picture.result, "asset");
        add(false_color_image(picture.difference, 1.0), "FLIP");
    }
    return "<h3>Worst view of each light</h3>\n<div class=\"pictures errors\">\n" + html +
           "</div>\n";
}

std::string PageWriter::loss() const {
    if (!made_.loss) return "";
    const shade::Fidelity& loss = made_.loss->fidelity;
    std::string attempts;
    for (const std::string& line : limit_lines(request_.limits, made_.attempts))
        attempts += "<li>" + html_escaped(line) + "</li>\n";
    if (!attempts.empty()) attempts = "<p>Attempts:</p>\n<ol>\n" + attempts + "</ol>\n";
    return fmt::format(
        "<h2>What was lost</h2>\n<p>The source against the asset in {} views, {:.0f} pixels "
        "across.</p>\n{}{}{}{}{}{}",
        loss.views.size(), loss.pixels_across,
        loss_table(loss, request_.limits.normals.statistic()), attempts, stage_table(*made_.loss),
        distance_table(*made_.loss), view_table(loss), worst_pictures());
}

std::string PageWriter::levels() const {
    if (made_.levels.empty()) return "";
    std::string rows;
    for (const make::AssetLevel& level : made_.levels) {
        rows += fmt::format(
            "<tr><th scope=\"row\">LOD{}</th><td>{}</td><td>{:.3g}</td><td>{:.4g}</td></tr>\n",
            &level - made_.levels.data() + 1, level.triangles, level.distance, level.pixels);
    }
    return "<h2>Levels of detail</h2>\n" +
           table(
               "<th scope=\"col\">level</th><th scope=\"col\">triangles</th><th scope=\"col\">"
               "largest distance</th><th scope=\"col\">used below pixels</th>",
               rows);
}

/// Returns a further layer with 8 bits. Its values fill the codes, with 0 in the middle.
Image shown(const Image& map) {
    const auto* codes = std::get_if<std::vector<std::uint16_t>>(&map.samples);
    if (codes == nullptr) return map;
    constexpr int middle = 32768;
    int largest = 1;
    for (const std::uint16_t code : *codes)
        largest = std::max(largest, std::abs(code - middle));
    Image picture = map;
    std::vector<std::uint8_t> samples(codes->size());
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<std::uint8_t>(128 + 127 * ((*codes)[i] - middle) / largest);
    picture.samples = std::move(samples);
    return picture;
}

std::string PageWriter::maps() const {
    constexpr int max_side = 512;
    const make::Asset& asset = made_.asset;
    std::string html;
    const auto add = [&](const Image& image, const std::string& caption) {
        html += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n",
                            img(reduced(image, max_side), caption), html_escaped(caption));
    };
    const glm::ivec2 size(asset.normal_map.width, asset.normal_map.height);
    const int factor = std::max(1, std::max(size.x, size.y) / max_side);
    const std::string charts =
        asset.atlas ? fmt::format("{}, {:.0f} % of the texels used",
                                  counted(asset.atlas->charts, "chart"), 100.0 * asset.atlas->used)
                    : "the texture coordinates of the source";
    add(draw_charts(asset, glm::max(size / factor, glm::ivec2(1))), charts);
    for (const make::AssetMap& map : make::maps_of(asset)) {
        add(map.slots.empty() ? shown(*map.image) : *map.image,
            fmt::format("{}, {} x {}{}", map.content, map.image->width, map.image->height,
                        map.image->bits() == 8 ? "" : fmt::format(", {} bits", map.image->bits())));
    }
    return html;
}

}  // namespace

void write_make_page(const std::filesystem::path& file, const MakeRequest& request, const Job& job,
                     const MadeAsset& made, const Stages& stages, const std::string& command,
                     bool has_live_view) {
    const PageWriter writer(file.parent_path(), request, job, made, stages, has_live_view);
    const std::string page =
        filled_page("make.html", {{"name", html_escaped(made.asset.name)},
                                  {"style", std::string(page_part("make.css"))},
                                  {"script", std::string(page_part("make.js"))},
                                  {"figures", writer.figures()},
                                  {"comparison", writer.comparison()},
                                  {"command", html_escaped(command)},
                                  {"findings", writer.remeshing() + writer.findings()},
                                  {"stages", writer.stages()},
                                  {"loss", writer.loss()},
                                  {"levels", writer.levels()},
                                  {"maps", writer.maps()},
                                  {"version", html_escaped("relief " + version() + ".")}});
    relief::detail::replace_file(file, std::as_bytes(std::span(page)));
}

}  // namespace relief::tools
