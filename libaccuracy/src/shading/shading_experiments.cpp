// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/shading_experiments_test.cpp.
#include "shading/shading_experiments.h"

#include "planned_experiment.h"
#include "shading/shading_plan.h"

namespace relief {

std::vector<Experiment> shading_experiments(const RunOptions& options) {
    const Drawing drawing;
    const auto drawn = [&](Experiment (*experiment)(const Drawing&, const RunOptions&)) {
        return [&drawing, &options, experiment] { return experiment(drawing, options); };
    };
    const std::vector<PlannedExperiment> plan = {
        {"Flat, Gouraud and Phong shading", drawn(interpolation_experiment)},
        {"Phong's and Blinn's highlights", drawn(highlight_experiment)},
        {"Making the interpolated normal unit", [&] { return unit_normal_experiment(options); }},
        {"Schlick's factor against Fresnel's: glass", [&] { return glass_experiment(options); }},
        {"Schlick's factor against Fresnel's: a metal", [&] { return metal_experiment(options); }},
        {"The size of a reflected cube map", drawn(reflection_experiment)},
        {"Rough mirrors by levels of a cube map", drawn(glossy_experiment)},
        {"Highlights smaller than a pixel", drawn(specular_aliasing_experiment)},
        {"Edges by several samples a pixel", drawn(edge_experiment)}};
    std::vector<Experiment> experiments = run_planned(plan, options);
    for (Experiment& experiment : experiments) {
        experiment.subject = Subject::shading;
        mark_efficient(experiment);
    }
    return experiments;
}

}  // namespace relief
