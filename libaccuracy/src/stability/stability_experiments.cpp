// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/stability_experiments_test.cpp.
#include "stability/stability_experiments.h"

#include "planned_experiment.h"
#include "stability/stability_plan.h"

namespace relief {

std::vector<Experiment> stability_experiments(const RunOptions& options) {
    const std::vector<PlannedExperiment> plan = {
        {"Normals: scale", [&] { return normals_by_scale(options); }},
        {"Normals: distance from the origin", [&] { return normals_by_offset(options); }},
        {"Normals: needles", [&] { return normals_of_needles(options); }},
        {"Normals: hard triangles", [&] { return normals_beside_hard_triangles(options); }},
        {"Tangents: scale", [&] { return tangents_by_scale(options); }},
        {"Tangents: distance from the origin", [&] { return tangents_by_offset(options); }},
        {"Bump: steepness", [&] { return bump_by_steepness(options); }},
        {"Bump: height above zero", [&] { return bump_by_offset(options); }}};
    std::vector<Experiment> experiments = run_planned(plan, options);
    for (Experiment& experiment : experiments) {
        experiment.subject = Subject::stability;
        experiment.finding += " Single hard inputs, each with its outcome: docs/hard-cases.md.";
    }
    return experiments;
}

}  // namespace relief
