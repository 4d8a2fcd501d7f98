// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/hard_case.h"
#include "hard_cases/map_cases.h"
#include "hard_cases/mesh_cases.h"

namespace relief::test {

const std::vector<HardCase>& hard_cases() {
    static const std::vector<HardCase> table = [] {
        std::vector<HardCase> rows;
        for (const auto& part :
             {triangle_cases(), surface_cases(), number_cases(), stored_cases(), tangent_cases(),
              tangent_surface_cases(), encoding_cases(), image_cases(), image_file_cases(),
              normal_map_cases(), map_check_cases(), bake_cases(), bake_shape_cases()})
            rows.insert(rows.end(), part.begin(), part.end());
        return rows;
    }();
    return table;
}

}  // namespace relief::test
