// SPDX-License-Identifier: Apache-2.0
// The steps of a conversion. Tests: tests/tools/relief_bake_test.cpp.
#include "bump_job.h"

#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

/// The options for a map, whose seams are looked at where that is asked for.
void settle_wraps(const BumpRequest& request, const Image& height, Baked& baked) {
    if (!request.wrap_x || !request.wrap_y) baked.tiling = detect_tiling(height);
    const Wraps found = baked.tiling.value_or(Tiling{}).wraps();
    baked.bump.wrap = {request.wrap_x.value_or(found.x), request.wrap_y.value_or(found.y)};
}

}  // namespace

Baked bake_bump(const Job& job, const BumpRequest& request, Stages& stages) {
    Baked baked;
    baked.bump = bump_of(request);
    baked.format = format_of(request.output, job.output);
    const Image source = stages.run("read", [&] { return read_image(job.input, ImageUse::data); });
    baked.width = source.width;
    baked.height = source.height;
    baked.channels = source.channels;
    baked.bits_read = source.bits();

    Report report;
    const Image coded = about(job.input, [&] {
        return stages.run("convert", [&] {
            const auto converted = [&](const Image& height) {
                settle_wraps(request, height, baked);
                return normal_map_from_height(height, baked.bump, baked.format, report);
            };
            return source.channels == 1 ? converted(source) : converted(height_field(source));
        });
    });
    stages.run("write", [&] {
        write_image(job.output, coded, normal_map_metadata(baked.format),
                    write_options_of(request.output, job.output), report);
    });
    baked.findings.add("", report);
    return baked;
}

}  // namespace relief::tools
