// SPDX-License-Identifier: Apache-2.0
// Errors of gradient kernels on fields with known normals.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "error_tables/error_tables.h"
#include "experiment_parts.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/height_map.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

constexpr int field_side = 256;

/// The name in the page: `sobel3`, `gaussian` 4.
std::string code_name(const std::string& name) {
    const std::size_t end = std::min(name.find(' '), name.size());
    return "`" + name.substr(0, end) + "`" + name.substr(end);
}

/// Two significant digits.
std::string in_two_digits(double degrees) {
    if (degrees < 1e-4) return fmt::format("{:.0e}", degrees);
    if (degrees >= 10.0) return fmt::format("{:.0f}", degrees);
    const int before = static_cast<int>(std::floor(std::log10(degrees)));
    return fmt::format("{:.{}f}", degrees, std::max(0, 1 - before));
}

struct Best {
    Kernel kernel = Kernel::central3;
    int radius = 2;
    double error = std::numeric_limits<double>::infinity();
};

Best best_on(const BumpField& field) {
    Best best;
    const auto look_at = [&](Kernel kernel, int radius) {
        const double error = rms_error(field, kernel, radius);
        if (error < best.error) best = {kernel, radius, error};
        return error;
    };
    for (const BumpMethod& method : kernel_methods()) {
        if (method.kernel != Kernel::gaussian) look_at(method.kernel, 2);
    }
    double smallest = std::numeric_limits<double>::infinity();
    for (int radius = 1; radius <= max_kernel_radius; radius += radius < 12 ? 1 : 2) {
        const double error = look_at(Kernel::gaussian, radius);
        smallest = std::min(smallest, error);
        if (radius > 3 && error > 1.5 * smallest) break;
    }
    return best;
}

std::string properties_table() {
    std::string text =
        "| | order | noise gain | direction error at 8 texels | at 16 |\n|---|---|---|---|---|\n";
    for (const BumpMethod& method : kernel_methods()) {
        const GradientKernel kernel = gradient_kernel(method.kernel, method.gaussian_radius);
        const double degrees = 180.0 / std::numbers::pi;
        text += fmt::format("| {} | {} | {:.3f} | {} | {} |\n",
                            code_name(name_of(method.kernel, method.gaussian_radius)), kernel.order,
                            noise_gain(kernel), in_two_digits(anisotropy(kernel, 8.0) * degrees),
                            in_two_digits(anisotropy(kernel, 16.0) * degrees));
    }
    return text;
}

std::string error_table(const std::vector<std::string>& fields) {
    std::vector<std::vector<double>> columns;
    std::vector<Best> chosen;
    for (const std::string& name : fields) {
        const BumpField field = make_bump_field(field_recipe(name), field_side, field_side);
        std::vector<double> column;
        for (const BumpMethod& method : kernel_methods())
            column.push_back(rms_error(field, method.kernel, method.gaussian_radius));
        columns.push_back(column);
        const KernelChoice choice = choose_kernel(field.heights, field.options);
        chosen.push_back({choice.kernel, choice.gaussian_radius,
                          rms_error(field, choice.kernel, choice.gaussian_radius)});
    }
    std::string text = table_header(fields);
    for (std::size_t row = 0; row < kernel_methods().size(); ++row) {
        const BumpMethod& method = kernel_methods()[row];
        text += fmt::format("| {} |", code_name(name_of(method.kernel, method.gaussian_radius)));
        for (const std::vector<double>& column : columns) {
            const double smallest = *std::min_element(column.begin(), column.end());
            const std::string cell = in_two_digits(column[row]);
            text += column[row] == smallest ? fmt::format(" **{}** |", cell)
                                            : fmt::format(" {} |", cell);
        }
        text += "\n";
    }
    text += "| `auto` |";
    for (const Best& one : chosen)
        text += fmt::format(" {}: {} |", code_name(name_of(one.kernel, one.radius)),
                            in_two_digits(one.error));
    return text + "\n";
}

}  // namespace

PageSection kernel_tables() {
    std::string text = "\n";
    text += properties_table();
    text += "\nRMS error of the normals in degrees, on 256 x 256 texels of waves\n\n";
    text += error_table({"very smooth, float", "smooth, float", "detailed, float", "smooth, 16 bit",
                         "smooth, 8 bit", "detailed, 8 bit", "very smooth, 25 codes of 8 bit"});
    text += "\nThe same with noise, or with walls\n\n";
    text +=
        error_table({"noise 0.003, float", "noise 0.03, float", "noise 0.3, float",
                     "noise 0.1, 8 bit", "creases, float", "terraces, float", "terraces, 8 bit"});
    return written_section("tables of kernels", text);
}

PageSection choice_tables() {
    std::string text =
        "\n| field | best kernel | RMS | `auto` | RMS | above the best |\n"
        "|---|---|---|---|---|---|\n";
    for (const FieldRecipe& recipe : evaluation_fields()) {
        const BumpField field = make_bump_field(recipe, field_side, field_side);
        const Best best = best_on(field);
        const KernelChoice choice = choose_kernel(field.heights, field.options);
        const double error = rms_error(field, choice.kernel, choice.gaussian_radius);
        text += fmt::format("| {} | {} | {} | {} | {} | {:.0f}% |\n", recipe.name,
                            code_name(name_of(best.kernel, best.radius)), in_two_digits(best.error),
                            code_name(name_of(choice.kernel, choice.gaussian_radius)),
                            in_two_digits(error), 100.0 * std::max(0.0, error / best.error - 1.0));
    }
    return written_section("tables of choices", text);
}

PageSection step_tables() {
    std::string text =
        "\n| field | best kernel | RMS | after de-staircasing | RMS | gain |\n"
        "|---|---|---|---|---|---|\n";
    for (const auto& set : {tuning_fields(), evaluation_fields()}) {
        for (const FieldRecipe& recipe : set) {
            if (recipe.coding == FieldCoding::float32 || recipe.coding == FieldCoding::float16 ||
                recipe.coding == FieldCoding::bits16)
                continue;
            BumpField field = make_bump_field(recipe, field_side, field_side);
            const Best before = best_on(field);
            field.heights = destaircase(field.heights, {.wrap = *field.options.wrap}).heights;
            const Best after = best_on(field);
            text += fmt::format("| {} | {} | {} | {} | {} | {:.2f} |\n", recipe.name,
                                code_name(name_of(before.kernel, before.radius)),
                                in_two_digits(before.error),
                                code_name(name_of(after.kernel, after.radius)),
                                in_two_digits(after.error), before.error / after.error);
        }
    }
    return written_section("tables of steps", text);
}

PageSection depth_tables() {
    constexpr std::array arithmetics = {Arithmetic::float32, Arithmetic::float64};
    constexpr std::array depths = {8, 16, 32};
    const BumpField field = make_bump_field(field_recipe("smooth, float"), field_side, field_side);
    BumpExperimentOptions options;
    options.repeats = {0, 0};
    std::string text = "\n";
    text += table_header({"8 bit", "16 bit", "32 bit float"});
    for (const Arithmetic arithmetic : arithmetics) {
        text += arithmetic == Arithmetic::float32 ? "| float32 |" : "| float64 |";
        for (const int bits : depths) {
            const std::array method = {BumpMethod{Kernel::central7, 2, arithmetic, bits, false}};
            const ErrorStats error = measure_bump(field, method, options).measurements[0].error;
            text += fmt::format(" {} / {} |", in_two_digits(error.rms), in_two_digits(error.max));
        }
        text += "\n";
    }
    return written_section("tables of depths", text);
}

std::vector<PageSection> bump_tables() {
    return {kernel_tables(), choice_tables(), step_tables(), depth_tables()};
}

}  // namespace relief::test
