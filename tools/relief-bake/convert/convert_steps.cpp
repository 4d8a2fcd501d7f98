// SPDX-License-Identifier: Apache-2.0
// The steps of a conversion between decoding and encoding. Tests: tests/tools/convert_test.cpp.
#include "convert/convert_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/choices.h"
#include "convert/convert_words.h"

namespace relief::tools {
namespace {

ResizeOptions resize_options_of(const ResizeChoice& choice) {
    ResizeOptions options;
    options.filter = choice.filter.value_or(options.filter);
    options.domain = choice.domain.value_or(options.domain);
    options.wrap = choice.wrap.value_or(options.wrap);
    return options;
}

glm::ivec2 size_of(const SizeChoice& choice, const Image& image) {
    if (choice.share == 0.0) return choice.texels;
    const auto side = [&](int size) {
        return std::max(1, static_cast<int>(std::lround(size * choice.share)));
    };
    return {side(image.width), side(image.height)};
}

ConvertStep resize_step(const ResizeChoice& choice) {
    const ResizeOptions options = resize_options_of(choice);
    const SizeChoice& size = *choice.size;
    const std::string to = size.share > 0.0 ? fmt::format("{:g} %", size.share * 100.0)
                                            : fmt::format("{} x {}", size.texels.x, size.texels.y);
    return {fmt::format("resized to {} by {} ({})", to, name_of(options.domain, domain_choices()),
                        name_of(options.filter, filter_choices())),
            [=](NormalField& field, Report& report) {
                const glm::ivec2 texels = size_of(size, field.normals);
                field.normals = resize_normals(field.normals, texels.x, texels.y, options, report);
                if (field.alpha)
                    field.alpha = resize_samples(*field.alpha, texels.x, texels.y, options);
            }};
}

ConvertStep strength_step(double strength) {
    return {fmt::format("slopes times {:g}", strength), [=](NormalField& field, Report& report) {
                scale_slopes(field.normals, strength, report);
            }};
}

/// The normals of the detail map, y pointing where that of the base does.
Image detail_normals(const DetailChoice& choice, const NormalField& base, Report& report) {
    const InputMap detail = read_normal_map(*choice.file, choice.input);
    Image normals = about(*choice.file, [&] {
        return decode_normal_map(detail.image, Green::up, detail.flat, report, FlatTexels::exact);
    });
    const std::optional<Green> base_green = base.green ? base.green : detail.green;
    const Green green = detail.green.value_or(base_green.value_or(Green::up));
    if (base_green && green != *base_green) {
        constexpr AxisMapping flip = {{{0, false}, {1, true}, {2, false}}};
        turn_normals(normals, flip);
    }
    if (choice.strength) scale_slopes(normals, *choice.strength, report);
    return normals;
}

/// Findings about another file, so that nobody takes them for the base's.
void merge_as_details(const Report& found, Report& report) {
    for (Finding finding : found.findings()) {
        finding.kind += " in the detail";
        report.add(finding);
    }
}

std::string detail_words(const DetailChoice& choice) {
    std::string words =
        fmt::format("{} laid over it ({}", choice.file->string(),
                    name_of(choice.blend.value_or(NormalBlend::reoriented), blend_choices()));
    if (choice.repeat)
        words += fmt::format(", {:g} x {:g} times", choice.repeat->x, choice.repeat->y);
    if (choice.strength) words += fmt::format(", slopes times {:g}", *choice.strength);
    return words + ")";
}

ConvertStep detail_step(const DetailChoice& choice, const ResizeChoice& resize) {
    ResizeOptions options;
    options.filter = resize.filter.value_or(options.filter);
    options.repeat = choice.repeat.value_or(options.repeat);
    const NormalBlend method = choice.blend.value_or(NormalBlend::reoriented);
    return {detail_words(choice), [=](NormalField& field, Report& report) {
                Report of_detail;
                const Image detail =
                    fitted_detail(detail_normals(choice, field, of_detail), field.normals.width,
                                  field.normals.height, options, of_detail);
                merge_as_details(of_detail, report);
                blend_normals(field.normals, detail, method, report);
            }};
}

}  // namespace

std::vector<ConvertStep> steps_of(const ConvertRequest& request) {
    std::vector<ConvertStep> steps;
    if (request.space.to_tangent) steps.push_back(to_tangent_step(request.space));
    if (request.resize.size) steps.push_back(resize_step(request.resize));
    if (request.strength) steps.push_back(strength_step(*request.strength));
    if (request.detail.file) steps.push_back(detail_step(request.detail, request.resize));
    if (request.space.to_object) steps.push_back(to_object_step(request.space));
    return steps;
}

}  // namespace relief::tools
