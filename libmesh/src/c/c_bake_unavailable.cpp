// SPDX-License-Identifier: Apache-2.0
// relief_bake() of a library without relief::bake, so that programs link with any configuration.
#include "c/c_call.h"

using namespace relief::detail;

relief_status relief_bake(const relief_mesh* const*, size_t, const relief_mesh*,
                          const relief_bake_options*, const relief_execution*,
                          const relief_bake_maps*, relief_bake_result*, relief_report*) {
    return guarded([] {
        throw Unavailable(
            "this library was built without relief_bake() (build relief with RELIEF_C_BAKE=ON, "
            "which needs Embree)");
    });
}
