// SPDX-License-Identifier: Apache-2.0
#include "storage/storage_experiments.h"

#include "planned_experiment.h"

namespace relief {

std::vector<Experiment> storage_experiments(const RunOptions& options) {
    const std::vector<PlannedExperiment> plan = {
        {"Normals in few bits", [&] { return normal_reading_experiment(options); }},
        {"A smooth surface in few bits, written",
         [&] { return normal_writing_experiment(options); }},
        {"Tangent frames in few bits", [&] { return frame_reading_experiment(options); }},
        {"Tangent frames in few bits, written", [&] { return frame_writing_experiment(options); }}};
    return run_planned(plan, options);
}

}  // namespace relief
