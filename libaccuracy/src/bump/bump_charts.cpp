// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/bump_experiments_test.cpp.
#include "bump/bump_charts.h"

#include "bump/bump_methods.h"
#include "relief/mesh/gradient_kernel.h"

namespace relief {
namespace {

/// Of the points that a kernel's order rules: waves longer than it reaches over, and errors above
/// what heights rounded to float leave.
Curve with_order(Curve curve, const GradientKernel& kernel) {
    std::vector<CurvePoint> ruled;
    for (const CurvePoint& point : curve.points) {
        if (point.x >= 4.0 * kernel.radius && point.error > 1e-4) ruled.push_back(point);
    }
    curve.order = fitted_order(ruled);
    curve.expected_order = -kernel.order;
    return curve;
}

}  // namespace

Chart wavelength_chart(int bits, int side, bool is_quick) {
    Chart chart;
    chart.id = "wavelength";
    chart.title = "Longer waves";
    chart.x_label = "wavelength, texels";
    chart.y_label = "RMS error, degrees";
    std::vector<double> wavelengths = {4, 6, 8, 12, 16, 24, 32, 64, 128, 256};
    if (!is_quick) wavelengths = {4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256};
    for (const NamedKernel& kernel : named_kernels())
        chart.curves.emplace_back().method = kernel.name;
    for (const double wavelength : wavelengths) {
        const WaveMap wave = oblique_wave(side, wavelength, bits);
        for (std::size_t k = 0; k < chart.curves.size(); ++k) {
            const AngleDistribution errors =
                wave_errors(wave, named_kernels()[k], Arithmetic::float64);
            chart.curves[k].points.push_back({wavelength, curve_error(errors)});
        }
    }
    if (bits < 32) return chart;  // Longer waves are gentler steps: errors grow again.
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
        const NamedKernel& kernel = named_kernels()[k];
        chart.curves[k] =
            with_order(chart.curves[k], gradient_kernel(kernel.kernel, kernel.radius));
    }
    return chart;
}

Chart resolution_chart(bool is_quick) {
    Chart chart;
    chart.id = "resolution";
    chart.title = "The same surface in finer texels";
    chart.x_label = "texels along a side";
    chart.y_label = "RMS error, degrees";
    for (const NamedKernel& kernel : named_kernels())
        chart.curves.emplace_back().method = kernel.name;
    for (const int side :
         is_quick ? std::vector{64, 128, 256} : std::vector{64, 128, 256, 512, 1024}) {
        const WaveMap surface = surface_at(side);
        for (std::size_t k = 0; k < chart.curves.size(); ++k) {
            const AngleDistribution errors =
                wave_errors(surface, named_kernels()[k], Arithmetic::float64);
            chart.curves[k].points.push_back({static_cast<double>(side), curve_error(errors)});
        }
    }
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
        const NamedKernel& kernel = named_kernels()[k];
        // Its shortest waves have an eighth of the texels of the coarsest map.
        GradientKernel reach = gradient_kernel(kernel.kernel, kernel.radius);
        reach.radius *= 8;
        chart.curves[k] = with_order(chart.curves[k], reach);
    }
    return chart;
}

}  // namespace relief
