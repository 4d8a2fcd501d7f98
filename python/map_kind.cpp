// SPDX-License-Identifier: Apache-2.0
#include "map_kind.h"

#include <fmt/format.h>

#include "arrays.h"
#include "relief/mesh/map_kind_check.h"

namespace relief::python {
namespace {

/// Returns what to do with a map that seems to be of another kind.
std::string remedy_for(const std::optional<MapKind>& seeming, MapKind wanted) {
    if (wanted == MapKind::normal && seeming == MapKind::height)
        return "bump() converts height maps";
    if (wanted == MapKind::height && seeming == MapKind::normal)
        return "decode_normals() and heights() convert normal maps";
    if (wanted == MapKind::normal && seeming == MapKind::object_normal)
        return "decode_normals() and convert_space() convert it";
    return fmt::format("give {}", map_kind_info(wanted).phrase);
}

}  // namespace

void check_kind(const ImageView& map, const char* name, const std::vector<MapKind>& accepted,
                const std::optional<std::string>& assume) {
    const MapKind wanted = accepted.front();
    const std::string kind(enum_name(wanted));
    if (assume && *assume != kind) refuse_name("assume", *assume, {kind});
    if (assume) return;
    const std::optional<MapContent> content = unstated_content(map, MapDescription{});
    if (!content) return;
    const std::optional<WrongMapKind> wrong = judged_wrong_kind(accepted, *content);
    if (!wrong) return;
    throw InvalidInput(fmt::format("{}: {} ({}; assume=\"{}\" reads it anyway)", name,
                                   wrong->problem, remedy_for(wrong->kind, wanted), kind));
}

Report without_assumed_normals(const Report& report) {
    Report rest;
    for (const Finding& finding : report.findings()) {
        if (finding.outcome != drawn_as(MapKind::normal) &&
            finding.outcome != drawn_as(MapKind::object_normal))
            rest.add(finding);
    }
    return rest;
}

}  // namespace relief::python
