// SPDX-License-Identifier: Apache-2.0
#include "support/triangle_orders.h"

#include <numeric>
#include <random>

namespace relief::test {

Mesh with_triangle_order(const Mesh& mesh, const std::vector<std::size_t>& order) {
    Mesh result = mesh;
    for (std::size_t i = 0; i < order.size(); ++i)
        result.triangles[i] = mesh.triangles[order[i]];
    return result;
}

std::vector<std::size_t> shuffled(std::size_t count, std::uint32_t seed) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 generator(seed);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[generator() % i]);
    return order;
}

std::vector<std::size_t> reversed(std::size_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.rbegin(), order.rend(), std::size_t{0});
    return order;
}

std::vector<glm::vec4> corners_in_order(const std::vector<glm::vec4>& values,
                                        const std::vector<std::size_t>& order) {
    std::vector<glm::vec4> result;
    for (const std::size_t triangle : order) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
        result.insert(result.end(), first, first + 3);
    }
    return result;
}

}  // namespace relief::test
