// SPDX-License-Identifier: Apache-2.0
// The file read back, checked, judged. Tests: tests/tools/relief_bake_verify_test.cpp.
#include "mesh/mesh_verify.h"

#include <fmt/format.h>

#include <cmath>

#include "common/options.h"
#include "common/text.h"
#include "mesh/convention_words.h"
#include "mesh/error_map.h"
#include "mesh/model_fit.h"
#include "relief/mesh/timing.h"

namespace relief::tools {
namespace {

/// Codes that a bake does not make, but by so much: other rays, another program, an edit.
constexpr double other_degrees = 1.0;

MapConvention told_of(const MeshBakeRequest& bake, const InputMap& map) {
    MapConvention told;
    told.flat = map.flat;
    told.space = bake.space == SpaceChoice::tangent  ? MapAxes::tangent
                 : bake.space == SpaceChoice::object ? MapAxes::object
                                                     : MapAxes::world;
    return told;
}

void judge(VerifiedMap& map, const MeshBakeRequest& bake, const BakeModels& models) {
    const BakeCheck& check = map.check;
    const double other = check.stages.at(static_cast<std::size_t>(BakeStage::other)).rms;
    if (check.convention.is_explained) {
        map.trouble.push_back(convention_words(check.convention));
        map.remedies = convention_remedies(map.request.map, bake.low, check.convention);
    } else if (other > other_degrees) {
        map.trouble.push_back(
            fmt::format("not what this bake makes: {:.3g} degrees (RMS) off that, and none of {} "
                        "readings explains it (other models, other rays, or edited since?)",
                        other, check.convention.tried));
    }
    const double error = bounded(check.error, map.request.bound);
    if (map.request.bound.degrees && !(error <= *map.request.bound.degrees)) {
        map.trouble.push_back(fmt::format("{:.3g} degrees off, more than the {} allowed", error,
                                          bound_words(map.request.bound)));
    }
    const double missed = missed_percent(check.missed, check.error.count + check.frameless);
    if (check.error.count == 0) {
        map.trouble.push_back("no texel has a surface to be compared with; " +
                              fit_words(bake, models));
    } else if (missed > missed_limit(bake)) {
        map.trouble.push_back(
            fmt::format("{:.3g} % of the texels are missed by their rays, more than {:g}; {}",
                        missed, missed_limit(bake), fit_words(bake, models)));
    }
}

}  // namespace

VerifiedMap verify_map(const Baker& baker, const BakeModels& models, const MeshBakeRequest& bake,
                       BakeMapOptions map, const VerifyRequest& request, Report& report) {
    const Stopwatch stopwatch;
    VerifiedMap verified;
    verified.request = request;
    InputMap input = read_normal_map(request.map, request.input);
    map.width = input.image.width;
    map.height = input.image.height;
    map.padding = 0;
    map.border_folder.reset();
    BakeCheckOptions options;
    options.map = map;
    options.format.green = input.green.value_or(Green::up);
    options.format.flat = input.flat;
    options.format.dither = bake.map.dither.value_or(Dither::none);
    options.given = &models.low;
    options.is_object = bake.space == SpaceChoice::object;
    if (models.world_from_low) options.object_from_mesh = glm::transpose(*models.world_from_low);
    verified.told = told_of(bake, input);
    ErrorMap errors(map.width, map.height, request.error_map.has_value());
    verified.check = about(request.map, [&] {
        return check_bake(
            baker, input.image, options,
            [&](int, std::span<const float> degrees) { errors.add(degrees); }, report);
    });
    if (request.error_map) verified.brightest = errors.write(*request.error_map, verified.check);
    judge(verified, bake, models);
    verified.milliseconds = 1e3 * stopwatch.seconds();
    return verified;
}

}  // namespace relief::tools
