// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_verify_test.cpp.
#include "mesh/convention_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/text.h"

namespace relief::tools {
namespace {

const SignedAxis plain_x{0, false}, plain_y{1, false}, plain_z{2, false};
const SignedAxis minus_x{0, true}, minus_y{1, true};

/// As --axes of `relief-bake convert` takes it.
std::string axes_option(const AxisMapping& axes) {
    std::string words;
    for (const SignedAxis& axis : axes) {
        words += words.empty() ? "" : ",";
        words += axis.is_negative ? "-" : "";
        words += "xyz"[axis.axis];
    }
    return words;
}

std::string axes_words(const AxisMapping& axes) {
    if (axes == AxisMapping{plain_x, minus_y, plain_z})
        return "green is turned round (down for up, or the reverse)";
    if (axes == AxisMapping{minus_x, plain_y, plain_z}) return "red is turned round";
    if (axes == AxisMapping{minus_x, minus_y, plain_z}) return "red and green are turned round";
    if (axes == AxisMapping{plain_y, plain_x, plain_z}) return "red and green are swapped";
    return fmt::format("its axes are others: x, y, z are its {}", axes_option(axes));
}

const char* space_words(MapAxes space) {
    return space == MapAxes::tangent  ? "it is in tangent space"
           : space == MapAxes::object ? "it is in object space"
                                      : "it is in world space";
}

const char* basis_words(MapBasis basis) {
    return basis == MapBasis::mikktspace      ? "it was baked with MikkTSpace's tangents"
           : basis == MapBasis::area_weighted ? "it was baked with tangents weighted by area"
           : basis == MapBasis::lengyel       ? "it was baked with tangents averaged as Lengyel's"
                                              : "it was baked with the model's tangents";
}

const char* frame_words(MapFrame frame) {
    return frame == MapFrame::unit ? "it was baked with normal and tangent made unit by pixel"
           : frame == MapFrame::orthonormal
               ? "it was baked with normal and tangent made orthonormal by pixel"
           : frame == MapFrame::vertex_bitangent
               ? "it was baked with bitangents interpolated from the vertices"
               : "it was baked with normal and tangent as interpolated";
}

const char* turn_words(MapTurn turn) {
    return turn == MapTurn::upside_down ? "the image is upside down"
           : turn == MapTurn::mirrored  ? "the image is mirrored, left to right"
                                        : "the image is turned by half a turn";
}

std::string part_words(const MapConvention& found, ConventionPart part) {
    using enum ConventionPart;
    switch (part) {
        case curve:
            return found.curve == StoredCurve::srgb_encoded
                       ? "its numbers went through the sRGB curve"
                       : "its numbers were taken for sRGB and decoded";
        case flat:
            return found.flat == FlatCode::half ? "its zero is between two codes (127.5 of 255)"
                                                : "its zero is a code (128 of 255)";
        case turn:
            return turn_words(found.turn);
        case axes:
            return axes_words(found.axes);
        case space:
            return space_words(found.space);
        case basis:
            return basis_words(found.basis);
        case frame:
            return frame_words(found.frame);
        case mirroring:
            return "mirrored parts of the texture were baked as if they were not (w is +1)";
    }
    return "";
}

const char* part_name(ConventionPart part) {
    using enum ConventionPart;
    switch (part) {
        case curve:
            return "curve";
        case flat:
            return "flat";
        case turn:
            return "turn";
        case axes:
            return "axes";
        case space:
            return "space";
        case basis:
            return "basis";
        case frame:
            return "frame";
        case mirroring:
            return "mirroring";
    }
    return "";
}

}  // namespace

std::string convention_words(const ConventionFit& fit) {
    std::vector<std::string> parts;
    for (const ConventionPart part : fit.changes)
        parts.push_back(part_words(fit.convention, part));
    return fmt::format("{}: read so, it is {:.3g} degrees off instead of {:.3g} (RMS)",
                       fmt::join(parts, "; "), fit.found_degrees, fit.told_degrees);
}

std::vector<std::string> convention_parts(const ConventionFit& fit) {
    std::vector<std::string> parts;
    for (const ConventionPart part : fit.changes)
        parts.emplace_back(part_name(part));
    return parts;
}

std::vector<std::string> convention_remedies(const std::filesystem::path& map,
                                             const std::filesystem::path& low,
                                             const ConventionFit& fit) {
    using enum ConventionPart;
    if (fit.changes.size() != 1) return {};  // Several: no one command says it.
    const MapConvention& found = fit.convention;
    const std::string convert = fmt::format("relief-bake convert {} out.png", quoted(map));
    switch (fit.changes.front()) {
        case axes:
            return {convert + " --axes=" + axes_option(found.axes)};
        case flat:
            return {convert + (found.flat == FlatCode::half
                                   ? " --input-zero-code 127.5"
                                   : " --input-zero-code 128 --zero-code 127.5")};
        case space:
            if (found.space == MapAxes::tangent)
                return {fmt::format("{} --to-object {}", convert, quoted(low))};
            if (found.space == MapAxes::object)
                return {fmt::format("{} --to-tangent {}", convert, quoted(low))};
            return {};
        case basis:
            if (found.basis == MapBasis::used) return {};
            return {fmt::format("relief-mesh process {} out.glb --tangents {}", quoted(low),
                                found.basis == MapBasis::mikktspace      ? "mikktspace"
                                : found.basis == MapBasis::area_weighted ? "area-weighted"
                                                                         : "lengyel")};
        default:
            return {};
    }
}

}  // namespace relief::tools
