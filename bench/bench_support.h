// SPDX-License-Identifier: Apache-2.0
/// \file
/// Interleaved timing, so that slow changes of the machine affect all contenders alike; a loop that
/// measures memory bandwidth; and the mesh of most geometry benchmarks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace relief::bench {

struct Contender {
    std::string name;
    std::function<void()> run;
    std::vector<double> nanoseconds{};
    double bytes = 0.0;  ///< Minimum memory traffic per element; 0: unknown.
};

/// Runs all contenders interleaved, and stores their times after `warm_up` rounds.
inline void measure(std::vector<Contender>& all, std::size_t rounds, std::size_t warm_up = 2) {
    interleave(all.size(), {rounds, warm_up}, [&](std::size_t i, bool counted) {
        const double taken = seconds_of(all[i].run);
        if (counted) all[i].nanoseconds.push_back(1e9 * taken);
    });
}

/// The least time of a contender: that of the round which other processes disturbed least.
inline double least(const Contender& contender) {
    return *std::min_element(contender.nanoseconds.begin(), contender.nanoseconds.end());
}

/// McCalpin's triad: a = b + s * c over three arrays larger than any cache. Loops with known memory
/// traffic are compared with it.
class Triad {
  public:
    void run() {
        for (std::size_t i = 0; i < size; ++i)
            a_[i] = b_[i] + 3.0F * c_[i];
        keep_ = a_[size / 2];
    }
    static constexpr std::size_t size = 16'000'000;
    static constexpr double bytes = 3.0 * sizeof(float) * size;

  private:
    std::vector<float> a_ = std::vector<float>(size, 0.0F);
    std::vector<float> b_ = std::vector<float>(size, 1.0F);
    std::vector<float> c_ = std::vector<float>(size, 2.0F);
    volatile float keep_ = 0.0F;
};

/// The mesh of most geometry benchmarks, of about `triangles` triangles: a sphere with waves, a
/// texture seam and poles. The vertices are in scan-line order. The normals are those of the sphere
/// without waves, which is sufficient for timing.
inline Mesh bumpy_sphere(std::size_t triangles) {
    const auto stacks = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 4.0));
    const std::uint32_t slices = 2 * stacks;
    Mesh mesh;
    for (std::uint32_t stack = 0; stack <= stacks; ++stack) {
        for (std::uint32_t slice = 0; slice <= slices; ++slice) {
            const double u = static_cast<double>(slice) / slices;
            const double v = static_cast<double>(stack) / stacks;
            const double longitude = 2.0 * std::numbers::pi * (slice == slices ? 0.0 : u);
            const double colatitude = std::numbers::pi * v;
            const glm::dvec3 direction(std::sin(colatitude) * std::sin(longitude),
                                       std::cos(colatitude),
                                       std::sin(colatitude) * std::cos(longitude));
            const double radius =
                1.0 + 0.02 * std::sin(24.0 * longitude) * std::sin(24.0 * colatitude);
            mesh.positions.emplace_back(radius * direction);
            mesh.normals.emplace_back(direction);
            mesh.texcoords.emplace_back(u, v);
        }
    }
    for (std::uint32_t stack = 0; stack < stacks; ++stack) {
        for (std::uint32_t slice = 0; slice < slices; ++slice) {
            const std::uint32_t upper_left = stack * (slices + 1) + slice;
            const std::uint32_t lower_left = upper_left + slices + 1;
            mesh.triangles.emplace_back(upper_left, lower_left, lower_left + 1);
            mesh.triangles.emplace_back(upper_left, lower_left + 1, upper_left + 1);
        }
    }
    return mesh;
}

}  // namespace relief::bench
