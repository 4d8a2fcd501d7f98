// SPDX-License-Identifier: Apache-2.0
#include "check/map_remedies.h"

#include <fmt/format.h>

#include "common/text.h"

namespace relief::tools {

std::string remedy_for(MapCondition condition, MapContent content,
                       const std::filesystem::path& file) {
    using enum MapCondition;
    const auto convert = [&](const char* options) {
        return fmt::format("relief-bake convert {} out.png{}", quoted(file), options);
    };
    switch (condition) {
        case not_normals:
            if (content != MapContent::grey) return "";
            return fmt::format("relief-bake bump {} out.png", quoted(file));
        case object_space:
            return convert(" --to-tangent mesh.glb");
        case z_missing:
        case z_constant:
            return convert(" --rebuild-z rg");
        case signed_samples:
            return convert(" --input-signed");
        case tagged_as_color:
            return convert("");
        case texel_not_finite:
        case texel_without_direction:
        case not_unit:
        case not_quite_unit:
            return convert(" --normalize");
        case green_contradicted:
        case green_down:
            return convert(" --flip green");
        case flat_contradicted:
            return convert(" --input-zero-code 127.5");
        case bits_unused:
            return convert(" --bits 8");
        case alpha_opaque:
            return convert(" --alpha drop");
        default:
            return "";
    }
}

}  // namespace relief::tools
