// SPDX-License-Identifier: Apache-2.0
// Tests: tests/make/make_page_test.cpp.
#include "make_loss.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

namespace relief::tools {
using namespace relief::shade;

std::vector<LossRow> loss_rows(const Fidelity& loss) {
    std::vector<LossRow> rows;
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        const PictureLoss& picture = loss.pictures[i];
        rows.push_back({fmt::format("FLIP, {}", enum_name(static_cast<FidelityLight>(i))),
                        picture.mean, picture.p95, picture.worst.view, picture.worst.value,
                        picture.floor});
    }
    const NormalLoss& normals = loss.normals;
    rows.push_back({"normals, degrees", normals.mean, normals.p95, normals.worst.view,
                    normals.worst.value, normals.floor});
    const SilhouetteLoss& silhouettes = loss.silhouettes;
    rows.push_back({"silhouettes, pixels", silhouettes.width, std::nullopt, silhouettes.worst.view,
                    silhouettes.worst.value, silhouettes.floor});
    return rows;
}

std::vector<std::string> loss_lines(const Fidelity& loss) {
    std::vector<std::string> lines = {fmt::format(
        "{:<21}{:>9}{:>9}{:>9}{:>13}{:>9}", fmt::format("of {:.0f} pixels", loss.pixels_across),
        "mean", "95 %", "worst", "", "floor")};
    for (const LossRow& row : loss_rows(loss)) {
        lines.push_back(fmt::format("{:<21}{:>9.4f}{:>9}{:>9.4f}{:>13}{:>9.4f}", row.name, row.mean,
                                    row.p95 ? fmt::format("{:.4f}", *row.p95) : "", row.worst,
                                    fmt::format("(view {})", row.worst_view), row.floor));
    }
    return lines;
}

Json loss_json(const Fidelity& loss) {
    return {{"pixels_across", loss.pixels_across},
            {"views", loss.views.size()},
            {"figures", json_list(loss_rows(loss), [](const LossRow& row) -> Json {
                 return {{"name", row.name},
                         {"mean", row.mean},
                         {"p95", or_null(row.p95)},
                         {"worst", row.worst},
                         {"worst_view", row.worst_view},
                         {"floor", row.floor}};
             })}};
}

}  // namespace relief::tools
