// SPDX-License-Identifier: Apache-2.0
// Tests: tests/make/make_loss_test.cpp.
#include "make_loss.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace relief::tools {
using namespace relief::shade;

namespace {

std::string figure_text(const std::optional<double>& value) {
    return value ? fmt::format("{:.4f}", *value) : "";
}

std::vector<std::string> table_lines(const Fidelity& loss, ErrorKind limited) {
    const bool has_rms = limited == ErrorKind::rms;
    const auto rms = [&](const std::string& text) {
        return has_rms ? fmt::format("{:>9}", text) : std::string();
    };
    std::vector<std::string> lines = {
        fmt::format("{:<21}{:>9}{}{:>9}{:>9}{:>10}{:>9}{:>11}{:>9}",
                    fmt::format("of {:.0f} pixels", loss.pixels_across), "mean", rms("rms"), "95 %",
                    "99 %", "largest", "worst", "", "floor")};
    for (const LossRow& row : loss_rows(loss, limited)) {
        lines.push_back(fmt::format(
            "{:<21}{:>9.4f}{}{:>9}{:>9}{:>10}{:>9.4f}{:>11}{:>9.4f}", row.name, row.mean,
            rms(figure_text(row.rms)), figure_text(row.p95), figure_text(row.p99),
            figure_text(row.max), row.worst, fmt::format("(view {})", row.worst_view), row.floor));
    }
    return lines;
}

std::vector<std::string> chain_lines(const AssetLoss& loss) {
    if (loss.stages.empty()) return {};
    constexpr const char* format = "{:<11}{:>10}{:>9}{:>9}{:>12}{:>9}{:>9}{:>12}";
    const auto row = [&](const std::string& name, const std::string& triangles,
                         const SampledFidelity& of, const std::string& p99) {
        return fmt::format(format, name, triangles, figure_text(of.flip[0]),
                           figure_text(of.flip[1]), figure_text(of.flip[2]),
                           figure_text(of.normals.mean), p99, figure_text(of.silhouette_pixels));
    };
    std::vector<std::string> lines = {
        "",
        fmt::format("after each stage, in {}", sampled_views_text(loss.fidelity)),
        fmt::format(format, "", "triangles", "studio", "grazing", "base color", "degrees", "99 %",
                    "silhouette"),
    };
    for (const LossStage& stage : loss.stages) {
        lines.push_back(row(stage.name, fmt::format("{}", stage.triangles), stage.loss,
                            figure_text(stage.loss.normals.p99)));
    }
    lines.push_back(row("floor", "", sampled_floor(loss.fidelity), ""));
    return lines;
}

std::vector<std::string> distance_lines(const AssetLoss& loss) {
    if (loss.stages.empty()) return {};
    std::vector<std::string> lines = {
        "", fmt::format("{:<21}{:>21}{:>21}{:>21}", "distance", "mean", "95 %", "largest")};
    for (const DistanceRow& row : distance_rows(loss)) {
        lines.push_back(fmt::format(
            "{:<21}{:>21}{:>21}{:>21}", row.name, distance_text(row.mean, loss.diagonal),
            distance_text(row.p95, loss.diagonal), distance_text(row.max, loss.diagonal)));
    }
    return lines;
}

Json flip_json(const std::array<double, fidelity_light_count>& flip) {
    Json json = Json::object();
    for (std::size_t i = 0; i < fidelity_light_count; ++i)
        json[enum_name(static_cast<FidelityLight>(i))] = flip[i];
    return json;
}

Json distance_json(const DistanceStats& distance) {
    return {{"mean", distance.mean}, {"p95", distance.p95}, {"max", distance.max}};
}

Json stage_json(const LossStage& stage) {
    const NormalLoss& normals = stage.loss.normals;
    return {{"stage", stage.name},
            {"triangles", stage.triangles},
            {"flip", flip_json(stage.loss.flip)},
            {"degrees",
             {{"mean", normals.mean},
              {"rms", normals.rms},
              {"p95", normals.p95},
              {"p99", normals.p99},
              {"max", normals.max}}},
            {"silhouette_pixels", stage.loss.silhouette_pixels},
            {"distance_from_source", distance_json(stage.distance.from_a)},
            {"distance_to_source", distance_json(stage.distance.from_b)}};
}

Json view_json(const Fidelity& loss, std::size_t view) {
    const ViewLoss& one = loss.views[view];
    return {{"view", view},
            {"from", {one.from.x, one.from.y, one.from.z}},
            {"flip", flip_json(one.flip)},
            {"degrees", one.degrees},
            {"silhouette_pixels", one.silhouette_pixels}};
}

}  // namespace

std::vector<LossRow> loss_rows(const Fidelity& loss, ErrorKind limited) {
    std::vector<LossRow> rows;
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        const PictureLoss& picture = loss.pictures[i];
        LossRow& row = rows.emplace_back();
        row.name = fmt::format("FLIP, {}", enum_name(static_cast<FidelityLight>(i)));
        row.mean = picture.mean;
        row.p95 = picture.p95;
        row.worst_view = picture.worst.view;
        row.worst = picture.worst.value;
        row.floor = picture.floor;
    }
    const NormalLoss& normals = loss.normals;
    LossRow& degrees = rows.emplace_back();
    degrees.name = "normals, degrees";
    degrees.mean = normals.mean;
    if (limited == ErrorKind::rms) degrees.rms = normals.rms;
    degrees.p95 = normals.p95;
    degrees.p99 = normals.p99;
    degrees.max = normals.max;
    degrees.worst_view = normals.worst.view;
    degrees.worst = normals.worst.value;
    degrees.floor = normals.floor;
    const SilhouetteLoss& silhouettes = loss.silhouettes;
    LossRow& widths = rows.emplace_back();
    widths.name = "silhouettes, pixels";
    widths.mean = silhouettes.width;
    widths.worst_view = silhouettes.worst.view;
    widths.worst = silhouettes.worst.value;
    widths.floor = silhouettes.floor;
    return rows;
}

std::vector<DistanceRow> distance_rows(const AssetLoss& loss) {
    std::vector<DistanceRow> rows;
    for (const LossStage& stage : loss.stages) {
        // Maps do not move the surface.
        if (stage.name == "decimated" || stage.name == "baked") continue;
        const std::string name = stage.name == "coded" ? "asset" : stage.name;
        const auto add = [&](const std::string& direction, const DistanceStats& distance) {
            rows.push_back({direction, distance.mean, distance.p95, distance.max});
        };
        add(fmt::format("source to {}", name), stage.distance.from_a);
        add(fmt::format("{} to source", name), stage.distance.from_b);
    }
    return rows;
}

std::string distance_text(double distance, double diagonal) {
    return fmt::format("{:.4g} ({:.3f} %)", distance,
                       diagonal > 0.0 ? 100.0 * distance / diagonal : 0.0);
}

SampledFidelity sampled_floor(const Fidelity& loss) {
    SampledFidelity floor;
    for (std::size_t i = 0; i < fidelity_light_count; ++i)
        floor.flip[i] = loss.pictures[i].floor;
    floor.normals.mean = loss.normals.floor;
    floor.silhouette_pixels = loss.silhouettes.floor;
    return floor;
}

std::string sampled_views_text(const Fidelity& loss) {
    std::vector<std::size_t> views;
    for (std::size_t view = 0; view < std::min(loss.views.size(), fidelity_view_count);
         view += fidelity_sample_stride)
        views.push_back(view);
    return fmt::format("views {}", fmt::join(views, ", "));
}

std::vector<std::string> loss_lines(const AssetLoss& loss, ErrorKind limited) {
    std::vector<std::string> lines = table_lines(loss.fidelity, limited);
    for (const auto& more : {chain_lines(loss), distance_lines(loss)})
        lines.insert(lines.end(), more.begin(), more.end());
    return lines;
}

Json loss_json(const AssetLoss& loss) {
    const Fidelity& fidelity = loss.fidelity;
    Json json = {{"pixels_across", fidelity.pixels_across},
                 {"views", fidelity.views.size()},
                 {"diagonal", loss.diagonal},
                 {"figures", json_list(loss_rows(fidelity, ErrorKind::rms), [](const LossRow& row) {
                      return Json{{"name", row.name},        {"mean", row.mean},
                                  {"rms", or_null(row.rms)}, {"p95", or_null(row.p95)},
                                  {"p99", or_null(row.p99)}, {"max", or_null(row.max)},
                                  {"worst", row.worst},      {"worst_view", row.worst_view},
                                  {"floor", row.floor}};
                  })}};
    json["stages"] = json_list(loss.stages, stage_json);
    json["by_view"] = json_list(worst_views_first(fidelity),
                                [&](std::size_t view) { return view_json(fidelity, view); });
    return json;
}

}  // namespace relief::tools
