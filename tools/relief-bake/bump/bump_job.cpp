// SPDX-License-Identifier: Apache-2.0
// The steps of a conversion: open, look at the map where it is to decide, convert and write.
// Tests: tests/tools/relief_bake_test.cpp.
#include "bump/bump_job.h"

#include <fmt/format.h>

namespace relief::tools {
namespace {

/// The depths that are open to choice.
std::vector<int> open_depths(const BumpRequest& request, const Job& job) {
    if (request.output.bits) return {*request.output.bits};
    std::vector<int> depths = depths_of(job.output);
    // What is said of codes has no effect on floats.
    if (request.output.flat || request.output.dither) std::erase(depths, 32);
    return depths;
}

/// Says what of the file is not looked at: colors that differ are no heights.
void report_channels(const BumpRequest& request, const HeightMapFile& map,
                     const HeightMapFile::Survey& survey, Baked& baked) {
    constexpr double least_share = 0.01;
    if (request.channel) return;
    const bool is_streamed = map.is_streamed();
    const double colored = is_streamed ? survey.colored_share : map.map().colored_share;
    const double alpha = is_streamed ? survey.partial_alpha_share : map.map().partial_alpha_share;
    Report report;
    if (colored > least_share) {
        report.add(
            "color image read as heights", "map", 0,
            fmt::format("the mean of red, green and blue is the height, though they differ in "
                        "{:.0f}% of the texels (a picture is no height map; choose one "
                        "channel by --channel, or --channel mean if this is meant)",
                        100.0 * colored));
    }
    if (alpha > least_share && request.alpha != MapAlpha::keep) {
        report.add("alpha with values between 0 and 1", "map", 0,
                   "is not read (--channel alpha takes it for the heights)");
    }
    baked.findings.add("", report);
}

/// Fills in what the command line leaves to the map.
void settle(HeightMapFile& map, const Job& job, const BumpRequest& request, Stages& stages,
            Baked& baked) {
    const std::vector<ImagePart> parts = parts_wanted(request.accuracy, map.info());
    HeightMapFile::Survey survey;
    if (!request.wrap.is_settled() || !parts.empty()) {
        survey = stages.run("look", [&] { return map.survey(parts); });
        if (!request.wrap.is_settled()) baked.tiling = survey.tiling;
    }
    report_channels(request, map, survey, baked);
    baked.bump.wrap = request.wrap.value_or(baked.tiling.value_or(Tiling{}).wraps());
    if (parts.empty() && !request.accuracy.destaircase && !request.accuracy.kernel) return;
    // Where the kernel is given, there is nothing to time.
    const bool chooses = !parts.empty() || request.accuracy.destaircase;
    const auto choose = [&] {
        Report report;
        baked.accuracy =
            settle_accuracy(request.accuracy, map.info(), survey.parts, open_depths(request, job),
                            baked.bump, baked.format.normals, report);
        baked.findings.add("", report);
        destaircase_map(request.accuracy, *baked.bump.wrap, map, baked.accuracy);
    };
    if (chooses)
        stages.run("choose", choose);
    else
        choose();
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
        HeightMapFile map = stages.run("read", [&] {
            return HeightMapFile(
                job.input, {request.channel.value_or(HeightChannel::mean), request.ignore_alpha});
        });
        baked.input = map.info();
        baked.is_streamed = map.is_streamed();
        baked.transparent = map.map().transparent_count();
        settle(map, job, request, stages, baked);
        convert(map, job, stages, baked);
    });
    return baked;
}

}  // namespace relief::tools
