// SPDX-License-Identifier: Apache-2.0
// The steps of a conversion: open, look at the map where it is to decide, convert and write.
// Tests: tests/tools/relief_bake_test.cpp.
#include "bump_job.h"

namespace relief::tools {
namespace {

/// Fills in what the command line leaves to the map.
void settle(const HeightMapFile& map, const BumpRequest& request, Stages& stages, Baked& baked) {
    if (!request.wrap_x || !request.wrap_y) {
        const HeightMapFile::Survey survey = stages.run("look", [&] { return map.survey({}); });
        baked.tiling = survey.tiling;
    }
    const Wraps found = baked.tiling.value_or(Tiling{}).wraps();
    baked.bump.wrap = {request.wrap_x.value_or(found.x), request.wrap_y.value_or(found.y)};
}

void convert(const HeightMapFile& map, const Job& job, Stages& stages, Baked& baked) {
    Report report;
    const BumpFileTimes times =
        write_bump_file(map, baked.bump, job.output, baked.format, report,
                        [&](double part) { stages.show_progress("convert", part); });
    stages.clear_progress();
    if (map.is_streamed()) stages.book("read", times.read);
    stages.book("convert", times.convert);
    stages.book("write", times.write);
    baked.findings.add("", report);
}

}  // namespace

Baked bake_bump(const Job& job, const BumpRequest& request, Stages& stages) {
    Baked baked;
    baked.bump = bump_of(request);
    baked.format = file_format_of(request, job.output);
    about(job.input, [&] {
        const HeightMapFile map = stages.run("read", [&] {
            return HeightMapFile(job.input, {request.channel, request.ignore_alpha});
        });
        baked.input = map.info();
        baked.is_streamed = map.is_streamed();
        baked.transparent = map.map().transparent_count();
        settle(map, request, stages, baked);
        convert(map, job, stages, baked);
    });
    return baked;
}

}  // namespace relief::tools
