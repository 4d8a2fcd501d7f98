// SPDX-License-Identifier: Apache-2.0
// The steps of a conversion: what turns axes alone stays codes, all else goes through unit floats.
// Tests: tests/tools/convert_test.cpp.
#include "convert/convert_job.h"

#include <fmt/format.h>

#include "common/choices.h"
#include "convert/convert_levels.h"
#include "convert/convert_steps.h"
#include "relief/mesh/image_channels.h"

namespace relief::tools {
namespace {

/// First one mapping, then flipped green.
AxisMapping with_green_flipped(AxisMapping mapping) {
    mapping[1].is_negative = !mapping[1].is_negative;
    return mapping;
}

/// What the mapping makes of the knowledge about green.
std::optional<Green> mapped_green(std::optional<Green> green, const AxisMapping& mapping) {
    const bool keeps_axes = mapping[1].axis == 1 && mapping[2] == same_axes[2];
    if (!green || !keeps_axes) return std::nullopt;
    if (!mapping[1].is_negative) return green;
    return *green == Green::up ? Green::down : Green::up;
}

/// How the axes of the stored vectors turn in all, and where green is bright afterwards.
struct Turn {
    AxisMapping mapping = same_axes;
    std::optional<Green> green;
};

Turn turn_of(const Job& job, const ConvertRequest& request, const InputMap& input) {
    const AxisMapping mapping = mapping_of(request);
    const std::optional<Green> green = mapped_green(input.green, mapping);
    const std::optional<Green> wanted = request.output.green;
    if (!wanted || green == wanted) return {mapping, green};
    if (!green) {
        throw failure(job.input, "where its green is bright is not known",
                      "give --input-green, or --flip green to turn it, whichever it is");
    }
    return {with_green_flipped(mapping), wanted};
}

std::string axis_words(const AxisMapping& mapping) {
    if (mapping == flip_green) return "green flipped";
    const auto word = [](const SignedAxis& axis) {
        return std::string(axis.is_negative ? "-" : "") + "xyz"[axis.axis];
    };
    return fmt::format("axes turned to {},{},{}", word(mapping[0]), word(mapping[1]),
                       word(mapping[2]));
}

void check_channels(const Job& job, const ConvertRequest& request, const InputMap& input) {
    if (input.image.channels > 2 || request.rebuild_z) return;
    throw failure(job.input, "has 2 channels, which hold no z",
                  "--rebuild-z rg computes it from them");
}

/// Whether nothing but the axes changes, so that codes need not be decoded.
bool keeps_codes(const ConvertRequest& request, const InputMap& input,
                 const NormalMapFormat& format) {
    const bool same_codes =
        input.image.bits() == format.bits && (format.bits == 32 || input.flat == format.flat);
    return same_codes && !request.rebuild_z && !request.normalize && !request.mips.wanted &&
           steps_of(request).empty();
}

/// The fourth channel by itself, if it is to be kept.
std::optional<Image> alpha_of(const ConvertRequest& request, const Image& image) {
    const bool is_x = request.rebuild_z && request.rebuild_z->x == 3;
    if (image.channels < 4 || is_x || request.alpha == AlphaChoice::drop) return std::nullopt;
    return channel_of(image, 3);
}

/// Unit normals of the input, y as it is stored.
Image decoded(const ConvertRequest& request, const InputMap& input, Converted& done,
              Report& report) {
    if (request.rebuild_z) {
        done.steps.emplace_back("z computed from x and y");
        return decode_xy_map(input.image, *request.rebuild_z, Green::up, input.flat, report,
                             FlatTexels::exact);
    }
    done.lengths = count_lengths(input.image, input.flat, report);
    done.steps.push_back(fmt::format("made of length 1 (was {:.3f}, from {:.3f} to {:.3f})",
                                     done.lengths->mean, done.lengths->least,
                                     done.lengths->greatest));
    return decode_normal_map(input.image, Green::up, input.flat, report, FlatTexels::exact);
}

/// All that goes through floats. Frees the texels of the input on the way.
void convert_floats(const ConvertRequest& request, InputMap& input, const Turn& turn,
                    Converted& done, NormalField& field, Report& report) {
    field.normals = decoded(request, input, done, report);
    field.alpha = alpha_of(request, input.image);
    field.green = turn.green;
    input.image = Image{};
    if (turn.mapping != same_axes) {
        turn_normals(field.normals, turn.mapping);
        done.steps.push_back(axis_words(turn.mapping));
    }
    for (const ConvertStep& step : steps_of(request)) {
        step.apply(field, report);
        done.steps.push_back(step.words + field.note);
        field.note.clear();
    }
    done.green = field.green;
    if (request.space.to_tangent) done.content = "normal map, tangent space";
    if (field.is_object_space) done.content = "normal map, object space";
}

/// Turns axes code by code; drops alpha where that is asked for.
void convert_codes(const ConvertRequest& request, InputMap& input, const Turn& turn,
                   Converted& done, Report& report) {
    if (request.output.dither && *request.output.dither != Dither::none)
        throw UsageError("--dither: has no effect where every code is kept");
    if (turn.mapping != same_axes) {
        map_axes(input.image, turn.mapping, input.flat, report);
        done.steps.push_back(axis_words(turn.mapping));
    }
    if (input.image.channels == 4 && request.alpha == AlphaChoice::drop) {
        drop_alpha(input.image);
        done.steps.push_back("alpha dropped");
    }
    if (done.steps.empty()) done.steps.emplace_back("nothing");
    done.steps.back() += ", every code kept";
    done.green = turn.green;
}

}  // namespace

Converted convert_map(const Job& job, const ConvertRequest& request, Stages& stages) {
    Converted done;
    Report report;
    InputMap input = stages.run("read", [&] { return read_normal_map(job.input, request.input); });
    done.width = input.image.width;
    done.height = input.image.height;
    done.channels = input.image.channels;
    done.bits_read = input.image.bits();
    done.input_words = input.words;
    check_channels(job, request, input);
    // The green of what is made of it: object space has none.
    if (request.space.to_tangent) input.green = request.output.green;
    const Turn turn = turn_of(job, request, input);
    done.format = format_of(request.output, job.output,
                            {.bits = done.bits_read, .green = Green::up, .flat = input.flat});
    LevelWriter writer(job, request, input.metadata, done);
    if (keeps_codes(request, input, done.format)) {
        about(job.input, [&] {
            stages.run("convert", [&] { convert_codes(request, input, turn, done, report); });
        });
        stages.run("write", [&] { writer.write_codes(input.image, report); });
    } else {
        NormalField field;
        about(job.input, [&] {
            stages.run("convert",
                       [&] { convert_floats(request, input, turn, done, field, report); });
        });
        writer.write_levels(field, stages, report);
    }
    done.findings.add("", report);
    return done;
}

}  // namespace relief::tools
