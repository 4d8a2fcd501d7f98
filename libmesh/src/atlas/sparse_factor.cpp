// SPDX-License-Identifier: Apache-2.0
#include "atlas/sparse_factor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "progress_stage.h"

namespace relief::detail {
namespace {

/// Unknowns are divided until at most so many are left.
constexpr std::size_t max_leaf = 16;

/// Divides points into 2^depth sets of nearly equal size; sets whose numbers differ in low bits
/// only are near each other. Each set is divided along the axis where the fewest edges are expected
/// to be cut, which is not always the longest one: triangles may be long and thin.
class Bisection {
  public:
    Bisection(std::span<const glm::dvec3> positions, std::span<const SparseFactor::Entry> edges,
              int depth)
        : depth_(depth), set_(positions.size()), reach_(positions.size(), glm::uvec3(0)) {
        glm::dvec3 low(std::numeric_limits<double>::infinity());
        glm::dvec3 high(-std::numeric_limits<double>::infinity());
        for (const glm::dvec3& each : positions) {
            low = glm::min(low, each);
            high = glm::max(high, each);
        }
        const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
        const double scale = size > 0.0 ? 1.0 / size : 0.0;
        points_.reserve(positions.size());
        for (std::uint32_t i = 0; i < positions.size(); ++i)
            points_.push_back({glm::vec3((positions[i] - low) * scale), i});
        for (const SparseFactor::Entry& edge : edges) {
            const glm::uvec3 reach(glm::abs(positions[edge.a] - positions[edge.b]) *
                                   (scale * reach_unit));
            reach_[edge.a] += reach;
            reach_[edge.b] += reach;
        }
        divide(0, points_.size(), 0, 0);
    }
    [[nodiscard]] const std::vector<std::uint32_t>& sets() const { return set_; }

  private:
    static constexpr double reach_unit = 1 << 16;
    struct Point {
        glm::vec3 position;  ///< In a box whose longest side is 1.
        std::uint32_t index;
    };
    void divide(std::size_t begin, std::size_t end, int level, std::uint32_t number) {
        if (level == depth_) {
            for (std::size_t i = begin; i < end; ++i)
                set_[points_[i].index] = number;
            return;
        }
        const glm::length_t axis = best_axis(begin, end);
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) {
            return points_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end), [axis](const Point& a, const Point& b) {
            const float x = a.position[axis];
            const float y = b.position[axis];
            return x != y ? x < y : a.index < b.index;
        });
        divide(begin, middle, level + 1, 2 * number);
        divide(middle, end, level + 1, 2 * number + 1);
    }
    /// The order of the points is not the same everywhere, so that sums are those of integers.
    [[nodiscard]] glm::length_t best_axis(std::size_t begin, std::size_t end) const {
        glm::vec3 low(std::numeric_limits<float>::infinity());
        glm::vec3 high(-std::numeric_limits<float>::infinity());
        glm::u64vec3 reach(0);
        for (std::size_t i = begin; i < end; ++i) {
            low = glm::min(low, points_[i].position);
            high = glm::max(high, points_[i].position);
            reach += reach_[points_[i].index];
        }
        glm::length_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const auto size = static_cast<double>(high[axis] - low[axis]);
            // The number of edges that a plane cuts on average.
            const double cut = static_cast<double>(reach[axis]) / size;
            if (!(cut < least)) continue;
            least = cut;
            best = axis;
        }
        return best;
    }

    int depth_;
    std::vector<Point> points_;
    std::vector<std::uint32_t> set_;
    std::vector<glm::uvec3> reach_;  ///< For each point, the lengths of its edges along the axes.
};

/// target -= factor * source.
void subtract(double* target, const double* source, double factor, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        target[i] -= factor * source[i];
}

/// Subtracts the multiples of four columns, one after the other.
void subtract_four(double* __restrict target, const double* a, const double* b, const double* c,
                   const double* d, const double* factors, std::size_t count) {
    const double fa = factors[0];
    const double fb = factors[1];
    const double fc = factors[2];
    const double fd = factors[3];
    for (std::size_t i = 0; i < count; ++i)
        target[i] = (((target[i] - fa * a[i]) - fb * b[i]) - fc * c[i]) - fd * d[i];
}

/// Eliminates the first columns of a symmetric matrix, whose lower half is stored by columns of
/// `size` rows. These columns become columns of L, and the rest what is left to eliminate.
/// \return false if a pivot is zero or not finite
bool eliminate(double* matrix, std::size_t size, std::size_t columns, double* pivots) {
    constexpr std::size_t block = 4;
    const auto column = [&](std::size_t j) { return matrix + j * size; };
    for (std::size_t first = 0; first < columns; first += block) {
        const std::size_t width = std::min(block, columns - first);
        for (std::size_t j = first; j < first + width; ++j) {
            for (std::size_t k = first; k < j; ++k)
                subtract(column(j) + j, column(k) + j, column(k)[j] * pivots[k], size - j);
            const double pivot = column(j)[j];
            if (pivot == 0.0 || !std::isfinite(pivot)) return false;
            pivots[j] = pivot;
            const double inverse = 1.0 / pivot;
            for (std::size_t i = j + 1; i < size; ++i)
                column(j)[i] *= inverse;
        }
        for (std::size_t j = first + width; j < size; ++j) {
            double factors[block];
            for (std::size_t k = 0; k < width; ++k)
                factors[k] = column(first + k)[j] * pivots[first + k];
            if (width == block) {
                subtract_four(column(j) + j, column(first) + j, column(first + 1) + j,
                              column(first + 2) + j, column(first + 3) + j, factors, size - j);
                continue;
            }
            for (std::size_t k = 0; k < width; ++k)
                subtract(column(j) + j, column(first + k) + j, factors[k], size - j);
        }
    }
    return true;
}

}  // namespace

/// For each unknown in the order of elimination, its entries with later ones.
struct SparseFactor::Neighbors {
    std::vector<std::uint32_t> begin;
    std::vector<std::uint32_t> place;
    std::vector<double> value;

    Neighbors(std::span<const Entry> entries, std::span<const std::uint32_t> places)
        : begin(places.size() + 1, 0), place(entries.size()), value(entries.size()) {
        for (const Entry& entry : entries)
            ++begin[std::min(places[entry.a], places[entry.b]) + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
        for (const Entry& entry : entries) {
            const auto [low, high] = std::minmax(places[entry.a], places[entry.b]);
            place[next[low]] = high;
            value[next[low]++] = entry.value;
        }
    }
};

SparseFactor::SparseFactor(std::span<const double> diagonal, std::span<const Entry> entries,
                           std::span<const glm::dvec3> positions)
    : place_(diagonal.size()), pivots_(diagonal.size()), x_(diagonal.size()), y_(diagonal.size()) {
    order_unknowns(entries, positions);
    check_cancelled();
    factor(diagonal, Neighbors(entries, place_));
    part_x_.resize(max_rows_);
    part_y_.resize(max_rows_);
}

void SparseFactor::order_unknowns(std::span<const Entry> entries,
                                  std::span<const glm::dvec3> positions) {
    const auto count = static_cast<std::uint32_t>(positions.size());
    int depth = 0;
    while (count >> depth > max_leaf)
        ++depth;
    // The sets are the leaves of a binary tree whose root has the number 1, and whose node k has
    // the children 2 k and 2 k + 1.
    std::vector<std::uint32_t> node_of = Bisection(positions, entries, depth).sets();
    // Entries between the two halves of a node, the root first.
    const auto split = [&](const Entry& entry) {
        // 0 if both are in one set.
        return static_cast<int>(std::bit_width(node_of[entry.a] ^ node_of[entry.b]));
    };
    std::vector<std::uint32_t> begin(static_cast<std::size_t>(depth) + 2, 0);
    const auto bucket = [&](const Entry& entry) {
        return static_cast<std::size_t>(depth - split(entry));
    };
    for (const Entry& entry : entries)
        ++begin[bucket(entry) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> sorted(begin[static_cast<std::size_t>(depth)]);
    for (std::uint32_t i = 0; i < entries.size(); ++i)
        if (split(entries[i]) > 0) sorted[begin[bucket(entries[i])]++] = i;
    const std::uint32_t leaf = std::uint32_t{1} << depth;
    for (std::uint32_t& each : node_of)
        each += leaf;
    for (const std::uint32_t i : sorted) {
        const Entry& entry = entries[i];
        const std::uint32_t a = node_of[entry.a];
        const std::uint32_t b = node_of[entry.b];
        // One of them is in a separator already.
        if (a < leaf || b < leaf) continue;
        (a < b ? node_of[entry.a] : node_of[entry.b]) = a >> std::bit_width(a ^ b);
    }
    // Nodes in the order of elimination; those without unknowns do not exist.
    std::vector<std::uint32_t> sizes(2 * std::size_t{leaf}, 0);
    for (const std::uint32_t each : node_of)
        ++sizes[each];
    std::vector<std::uint32_t> first(sizes.size());
    std::uint32_t next = 0;
    const auto visit = [&](const auto& self, std::uint32_t node) -> std::uint32_t {
        const std::uint32_t children =
            node < leaf ? self(self, 2 * node) + self(self, 2 * node + 1) : 0;
        if (sizes[node] == 0) return children;
        first[node] = next;
        nodes_.push_back({next, sizes[node], children, 0, 0, 0});
        next += sizes[node];
        return 1;
    };
    visit(visit, 1);
    for (std::uint32_t i = 0; i < count; ++i)
        place_[i] = first[node_of[i]]++;
}

void SparseFactor::factor(std::span<const double> diagonal, const Neighbors& neighbors) {
    std::vector<double> ordered_diagonal(diagonal.size());
    for (std::size_t i = 0; i < diagonal.size(); ++i)
        ordered_diagonal[place_[i]] = diagonal[i];
    std::vector<std::uint32_t> seen(diagonal.size(), std::numeric_limits<std::uint32_t>::max());
    std::vector<std::uint32_t> index(diagonal.size());  // In the matrix of the present node.
    std::vector<double> matrix;
    // The remainders of nodes, square matrices, which their parents add; the latest is at the end.
    std::vector<double> left;
    std::vector<std::uint32_t> roots;  // Nodes without a parent so far.
    for (std::uint32_t number = 0; number < nodes_.size(); ++number) {
        check_cancelled(number);
        Node& node = nodes_[number];
        const std::uint32_t end = node.first + node.columns;
        const std::span<const std::uint32_t> children =
            std::span(roots).subspan(roots.size() - node.children);
        node.first_row = rows_.size();
        const auto add_row = [&](std::uint32_t place) {
            if (place < end || seen[place] == number) return;
            seen[place] = number;
            rows_.push_back(place);
        };
        for (const std::uint32_t child : children)
            for (std::uint32_t i = 0; i < nodes_[child].row_count; ++i)
                add_row(rows_[nodes_[child].first_row + i]);
        for (std::uint32_t i = neighbors.begin[node.first]; i < neighbors.begin[end]; ++i)
            add_row(neighbors.place[i]);
        std::sort(rows_.begin() + static_cast<std::ptrdiff_t>(node.first_row), rows_.end());
        node.row_count = static_cast<std::uint32_t>(rows_.size() - node.first_row);
        for (std::uint32_t i = 0; i < node.columns; ++i)
            index[node.first + i] = i;
        for (std::uint32_t i = 0; i < node.row_count; ++i)
            index[rows_[node.first_row + i]] = node.columns + i;

        const std::size_t size = std::size_t{node.columns} + node.row_count;
        max_rows_ = std::max(max_rows_, size);
        matrix.assign(size * size, 0.0);
        for (std::uint32_t i = 0; i < node.columns; ++i) {
            const std::uint32_t place = node.first + i;
            matrix[i * size + i] = ordered_diagonal[place];
            for (std::uint32_t k = neighbors.begin[place]; k < neighbors.begin[place + 1]; ++k)
                matrix[i * size + index[neighbors.place[k]]] += neighbors.value[k];
        }
        for (std::size_t c = children.size(); c-- > 0;) {
            const Node& child = nodes_[children[c]];
            const std::size_t width = child.row_count;
            const double* const from = left.data() + left.size() - width * width;
            const std::uint32_t* const rows = rows_.data() + child.first_row;
            for (std::size_t j = 0; j < width; ++j) {
                double* const to = matrix.data() + index[rows[j]] * size;
                for (std::size_t i = j; i < width; ++i)
                    to[index[rows[i]]] += from[j * width + i];
            }
            left.resize(left.size() - width * width);
        }
        roots.resize(roots.size() - node.children);
        roots.push_back(number);

        if (!eliminate(matrix.data(), size, node.columns, pivots_.data() + node.first)) {
            is_valid_ = false;
            return;
        }
        node.first_value = values_.size();
        for (std::size_t j = 0; j < node.columns; ++j) {
            const double* const column = matrix.data() + j * size;
            values_.insert(values_.end(), column + j + 1, column + size);
        }
        for (std::size_t j = node.columns; j < size; ++j) {
            const double* const column = matrix.data() + j * size;
            left.insert(left.end(), column + node.columns, column + size);
        }
    }
}

void SparseFactor::solve(std::span<glm::dvec2> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        x_[place_[i]] = values[i].x;
        y_[place_[i]] = values[i].y;
    }
    double* const x = part_x_.data();
    double* const y = part_y_.data();
    for (const Node& node : nodes_) {
        const std::size_t size = std::size_t{node.columns} + node.row_count;
        const std::uint32_t* const rows = rows_.data() + node.first_row;
        std::copy_n(x_.begin() + node.first, node.columns, x);
        std::copy_n(y_.begin() + node.first, node.columns, y);
        std::fill_n(x + node.columns, node.row_count, 0.0);
        std::fill_n(y + node.columns, node.row_count, 0.0);
        const double* column = values_.data() + node.first_value;
        for (std::size_t j = 0; j < node.columns; ++j) {
            subtract(x + j + 1, column, x[j], size - j - 1);
            subtract(y + j + 1, column, y[j], size - j - 1);
            column += size - j - 1;
        }
        std::copy_n(x, node.columns, x_.begin() + node.first);
        std::copy_n(y, node.columns, y_.begin() + node.first);
        for (std::size_t i = 0; i < node.row_count; ++i) {
            x_[rows[i]] += x[node.columns + i];
            y_[rows[i]] += y[node.columns + i];
        }
    }
    for (auto each = nodes_.rbegin(); each != nodes_.rend(); ++each) {
        const Node& node = *each;
        const std::size_t size = std::size_t{node.columns} + node.row_count;
        const std::uint32_t* const rows = rows_.data() + node.first_row;
        for (std::size_t i = 0; i < node.row_count; ++i) {
            x[node.columns + i] = x_[rows[i]];
            y[node.columns + i] = y_[rows[i]];
        }
        for (std::size_t i = 0; i < node.columns; ++i) {
            x[i] = x_[node.first + i] / pivots_[node.first + i];
            y[i] = y_[node.first + i] / pivots_[node.first + i];
        }
        // Two columns at once: their sums do not depend on each other, but for one term.
        const double* column = values_.data() + node.first_value + node.columns * (size - 1) -
                               std::size_t{node.columns} * (node.columns - std::size_t{1}) / 2;
        std::size_t j = node.columns;
        if (j % 2 == 1) {
            --j;
            column -= size - j - 1;
            for (std::size_t i = j + 1; i < size; ++i) {
                x[j] -= column[i - j - 1] * x[i];
                y[j] -= column[i - j - 1] * y[i];
            }
        }
        while (j > 0) {
            const double* const high = column - (size - j);
            const double* const low = high - (size - j + 1);
            column = low;
            double high_x = x[j - 1];
            double high_y = y[j - 1];
            double low_x = x[j - 2];
            double low_y = y[j - 2];
            for (std::size_t i = j; i < size; ++i) {
                high_x -= high[i - j] * x[i];
                high_y -= high[i - j] * y[i];
                low_x -= low[i - j + 1] * x[i];
                low_y -= low[i - j + 1] * y[i];
            }
            x[j - 1] = high_x;
            y[j - 1] = high_y;
            x[j - 2] = low_x - low[0] * high_x;
            y[j - 2] = low_y - low[0] * high_y;
            j -= 2;
        }
        std::copy_n(x, node.columns, x_.begin() + node.first);
        std::copy_n(y, node.columns, y_.begin() + node.first);
    }
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = {x_[place_[i]], y_[place_[i]]};
}

}  // namespace relief::detail
