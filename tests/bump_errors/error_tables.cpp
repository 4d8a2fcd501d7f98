// SPDX-License-Identifier: Apache-2.0
#include "bump_errors/error_tables.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "relief/mesh/bump_experiment.h"
#include "relief/mesh/destaircase.h"
#include "support/error_page.h"

namespace relief::test {
namespace {

constexpr int side = 256;

struct NamedKernel {
    const char* name;
    Kernel kernel;
    int radius;
};
constexpr std::array kernels = {NamedKernel{"`forward`", Kernel::forward, 2},
                                NamedKernel{"`central3`", Kernel::central3, 2},
                                NamedKernel{"`prewitt3`", Kernel::prewitt3, 2},
                                NamedKernel{"`sobel3`", Kernel::sobel3, 2},
                                NamedKernel{"`scharr3`", Kernel::scharr3, 2},
                                NamedKernel{"`sobel5`", Kernel::sobel5, 2},
                                NamedKernel{"`scharr5`", Kernel::scharr5, 2},
                                NamedKernel{"`central5`", Kernel::central5, 2},
                                NamedKernel{"`central7`", Kernel::central7, 2},
                                NamedKernel{"`gaussian` 2", Kernel::gaussian, 2},
                                NamedKernel{"`gaussian` 4", Kernel::gaussian, 4},
                                NamedKernel{"`gaussian` 8", Kernel::gaussian, 8},
                                NamedKernel{"`gaussian` 16", Kernel::gaussian, 16}};

std::string name_of(Kernel kernel, int radius) {
    for (const NamedKernel& named : kernels) {
        if (named.kernel == kernel && kernel != Kernel::gaussian) return named.name;
    }
    return fmt::format("`gaussian` {}", radius);
}

/// Two digits, whatever the size.
std::string in_two_digits(double degrees) {
    if (degrees < 1e-4) return fmt::format("{:.0e}", degrees);
    if (degrees >= 10.0) return fmt::format("{:.0f}", degrees);
    const int before = static_cast<int>(std::floor(std::log10(degrees)));
    return fmt::format("{:.{}f}", degrees, std::max(0, 1 - before));
}

double error_by(const BumpField& field, Kernel kernel, int radius) {
    BumpOptions options = field.options;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    options.arithmetic = Arithmetic::float64;
    Report report;
    return field_error(normals_from_height(field.heights, options, report), field).rms;
}

struct Best {
    Kernel kernel = Kernel::central3;
    int radius = 2;
    double error = std::numeric_limits<double>::infinity();
};

Best best_on(const BumpField& field) {
    Best best;
    const auto look_at = [&](Kernel kernel, int radius) {
        const double error = error_by(field, kernel, radius);
        if (error < best.error) best = {kernel, radius, error};
        return error;
    };
    for (const NamedKernel& named : kernels) {
        if (named.kernel != Kernel::gaussian) look_at(named.kernel, 2);
    }
    double least = std::numeric_limits<double>::infinity();
    for (int radius = 1; radius <= largest_kernel_radius; radius += radius < 12 ? 1 : 2) {
        const double error = look_at(Kernel::gaussian, radius);
        least = std::min(least, error);
        if (radius > 3 && error > 1.5 * least) break;
    }
    return best;
}

const FieldRecipe& recipe_named(const std::string& name) {
    for (const FieldRecipe& recipe : tuning_fields()) {
        if (name == recipe.name) return recipe;
    }
    throw std::runtime_error("no field " + name);
}

std::string properties_table() {
    std::string text =
        "| | order | noise gain | direction off at 8 texels | at 16 |\n|---|---|---|---|---|\n";
    for (const NamedKernel& named : kernels) {
        const GradientKernel kernel = gradient_kernel(named.kernel, named.radius);
        const double degrees = 180.0 / std::numbers::pi;
        text += fmt::format("| {} | {} | {:.3f} | {} | {} |\n", named.name, kernel.order,
                            noise_gain(kernel), in_two_digits(anisotropy(kernel, 8.0) * degrees),
                            in_two_digits(anisotropy(kernel, 16.0) * degrees));
    }
    return text;
}

std::string error_table(const std::vector<std::string>& fields) {
    std::vector<std::vector<double>> columns;
    std::vector<Best> chosen;
    for (const std::string& name : fields) {
        const BumpField field = make_bump_field(recipe_named(name), side, side);
        std::vector<double> column;
        for (const NamedKernel& named : kernels)
            column.push_back(error_by(field, named.kernel, named.radius));
        columns.push_back(column);
        const KernelChoice choice = choose_kernel(field.heights, field.options);
        chosen.push_back({choice.kernel, choice.gaussian_radius,
                          error_by(field, choice.kernel, choice.gaussian_radius)});
    }
    std::string text = table_header(fields);
    for (std::size_t row = 0; row < kernels.size(); ++row) {
        text += fmt::format("| {} |", kernels[row].name);
        for (const std::vector<double>& column : columns) {
            const double least = *std::min_element(column.begin(), column.end());
            const std::string cell = in_two_digits(column[row]);
            text +=
                column[row] == least ? fmt::format(" **{}** |", cell) : fmt::format(" {} |", cell);
        }
        text += "\n";
    }
    text += "| `auto` |";
    for (const Best& one : chosen)
        text += fmt::format(" {}: {} |", name_of(one.kernel, one.radius), in_two_digits(one.error));
    return text + "\n";
}

}  // namespace

std::string kernel_tables() {
    std::string text = "\n";
    text += properties_table();
    text += "\nRMS error of the normals in degrees, on 256 x 256 texels of waves\n\n";
    text += error_table({"very smooth, float", "smooth, float", "detailed, float", "smooth, 16 bit",
                         "smooth, 8 bit", "detailed, 8 bit", "very smooth, 25 codes of 8 bit"});
    text += "\nand with noise, or walls\n\n";
    text +=
        error_table({"noise 0.003, float", "noise 0.03, float", "noise 0.3, float",
                     "noise 0.1, 8 bit", "creases, float", "terraces, float", "terraces, 8 bit"});
    return text;
}

std::string choice_tables() {
    std::string text =
        "\n| field | best kernel | RMS | `auto` | RMS | over the best |\n"
        "|---|---|---|---|---|---|\n";
    for (const FieldRecipe& recipe : judging_fields()) {
        const BumpField field = make_bump_field(recipe, side, side);
        const Best best = best_on(field);
        const KernelChoice choice = choose_kernel(field.heights, field.options);
        const double error = error_by(field, choice.kernel, choice.gaussian_radius);
        text += fmt::format("| {} | {} | {} | {} | {} | {:.0f}% |\n", recipe.name,
                            name_of(best.kernel, best.radius), in_two_digits(best.error),
                            name_of(choice.kernel, choice.gaussian_radius), in_two_digits(error),
                            100.0 * std::max(0.0, error / best.error - 1.0));
    }
    return text;
}

std::string step_tables() {
    std::string text =
        "\n| field | best kernel | RMS | after de-staircasing | RMS | gain |\n"
        "|---|---|---|---|---|---|\n";
    for (const auto& set : {tuning_fields(), judging_fields()}) {
        for (const FieldRecipe& recipe : set) {
            if (recipe.coding == FieldCoding::float32 || recipe.coding == FieldCoding::float16 ||
                recipe.coding == FieldCoding::bits16)
                continue;
            BumpField field = make_bump_field(recipe, side, side);
            const Best before = best_on(field);
            field.heights = destaircase(field.heights, {.wrap = field.options.wrap}).heights;
            const Best after = best_on(field);
            text += fmt::format("| {} | {} | {} | {} | {} | {:.2f} |\n", recipe.name,
                                name_of(before.kernel, before.radius), in_two_digits(before.error),
                                name_of(after.kernel, after.radius), in_two_digits(after.error),
                                before.error / after.error);
        }
    }
    return text;
}

std::string depth_tables() {
    constexpr std::array arithmetics = {Arithmetic::float32, Arithmetic::float64};
    constexpr std::array depths = {8, 16, 32};
    const BumpField field = make_bump_field(recipe_named("smooth, float"), side, side);
    BumpExperimentOptions options;
    options.repeats = {0, 0};
    std::string text = "\n";
    text += table_header({"8 bit", "16 bit", "32 bit float"});
    for (const Arithmetic arithmetic : arithmetics) {
        text += arithmetic == Arithmetic::float32 ? "| float32 |" : "| float64 |";
        for (const int bits : depths) {
            const std::array method = {BumpMethod{Kernel::central7, 2, arithmetic, bits, false}};
            const AngleDistribution error =
                measure_bump(field, method, options).measurements[0].error;
            text += fmt::format(" {} / {} |", in_two_digits(error.rms), in_two_digits(error.max));
        }
        text += "\n";
    }
    return text;
}

}  // namespace relief::test
