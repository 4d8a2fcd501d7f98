// SPDX-License-Identifier: Apache-2.0
#include "storage/storage_experiments.h"

namespace relief {

std::vector<Experiment> storage_experiments(const RunOptions& options) {
    if (options.tell) options.tell("tangent frames in few bits", 0, 1);
    return {frame_codes_experiment(options)};
}

}  // namespace relief
