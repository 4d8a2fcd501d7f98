// SPDX-License-Identifier: Apache-2.0
// Normal maps from height maps.
#include "c/c_call.h"
#include "progress_stage.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/normal_map.h"

using namespace relief;
using namespace relief::detail;

namespace {

constexpr std::array kernels = {
    Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3,   Kernel::scharr3,
    Kernel::sobel5,  Kernel::scharr5,  Kernel::central5, Kernel::central7, Kernel::gaussian};
constexpr std::array wraps = {Wrap::repeat, Wrap::clamp, Wrap::mirror};
constexpr std::array bump_arithmetics = {Arithmetic::float64, Arithmetic::float32};

relief_bump_options default_bump_options() {
    const BumpOptions defaults;
    const FormatNumbers format = numbers_of({});
    relief_bump_options options{};
    options.strength = defaults.strength;
    options.texel_width = defaults.texel.x;
    options.texel_height = defaults.texel.y;
    options.kernel = RELIEF_KERNEL_AUTOMATIC;
    options.gaussian_radius = defaults.gaussian_radius;
    options.wrap_x = RELIEF_WRAP_AUTOMATIC;
    options.wrap_y = RELIEF_WRAP_AUTOMATIC;
    options.arithmetic = RELIEF_ARITHMETIC_AUTOMATIC;
    options.green = format.green;
    options.flat = format.flat;
    options.dither = format.dither;
    return options;
}

BumpOptions bump_options(const relief_bump_options& given) {
    BumpOptions options;
    options.kernel = optional_enumerator(given.kernel, kernels, "kernel");
    options.gaussian_radius = given.gaussian_radius;
    options.strength = given.strength;
    options.texel = {given.texel_width, given.texel_height};
    options.arithmetic = optional_enumerator(given.arithmetic, bump_arithmetics, "arithmetic");
    const std::optional<Wrap> x = optional_enumerator(given.wrap_x, wraps, "wrap_x");
    const std::optional<Wrap> y = optional_enumerator(given.wrap_y, wraps, "wrap_y");
    if (x.has_value() != y.has_value())
        throw InvalidInput("wrap_x and wrap_y must both be automatic, or neither");
    if (x) options.wrap = Wraps(*x, *y);
    return options;
}

}  // namespace

relief_status relief_bump_options_init(relief_bump_options* options, size_t size) {
    return init_struct(options, size, default_bump_options(), "relief_bump_options");
}

relief_status relief_resolve_bump_options(const relief_image* height,
                                          relief_bump_options* options) {
    return guarded([&] {
        if (options == nullptr) throw InvalidInput("relief_bump_options is NULL");
        relief_bump_options read =
            read_struct(options, default_bump_options(), "relief_bump_options");
        const BumpOptions resolved =
            resolve_options(view_of(height, "height map"), bump_options(read));
        read.kernel = number_of(*resolved.kernel, kernels);
        read.gaussian_radius = resolved.gaussian_radius;
        read.wrap_x = number_of(resolved.wrap->x, wraps);
        read.wrap_y = number_of(resolved.wrap->y, wraps);
        write_struct(options, read, "relief_bump_options");
    });
}

relief_status relief_normal_map_from_height(const relief_image* height,
                                            const relief_bump_options* options,
                                            const relief_execution* execution,
                                            const relief_output_image* map, relief_report* report) {
    return guarded([&] {
        const ImageView heights = view_of(height, "height map");
        if (map == nullptr) throw InvalidInput("the normal map is NULL");
        const relief_bump_options read =
            read_struct(options, default_bump_options(), "relief_bump_options");
        const NormalMapFormat format = normal_map_format(read.green, read.flat, read.dither, *map);
        check_apart(*map, "normal map", *height, "height map");
        const Execution run(execution);
        const ExecutionScope scope(run.options());
        const ProgressStage stage("normal map");
        CallReport findings(report);
        normal_map_from_height(heights, bump_options(read), format, view_of(*map, "normal map"),
                               findings);
    });
}
