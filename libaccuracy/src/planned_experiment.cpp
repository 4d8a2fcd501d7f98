// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/planned_experiment_test.cpp.
#include "planned_experiment.h"

namespace relief {

std::vector<Experiment> run_planned(std::span<const PlannedExperiment> plan,
                                    const RunOptions& options) {
    std::vector<Experiment> experiments;
    for (const PlannedExperiment& planned : plan) {
        if (options.tell) options.tell(planned.title, experiments.size(), plan.size());
        experiments.push_back(planned.run());
        experiments.back().title = planned.title;
    }
    return experiments;
}

}  // namespace relief
