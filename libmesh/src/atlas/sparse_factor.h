// SPDX-License-Identifier: Apache-2.0
/// \file
/// Solves sparse linear systems whose unknowns lie on a surface. The result is the same on every
/// processor and with every compiler.
///
/// The order of elimination is a nested dissection [George 1973]: the unknowns are divided into two
/// halves along the longest axis of their box, and so on; those of one half with a neighbor in the
/// other one separate the halves and come after both. Each separator is a dense matrix, to which
/// the halves add what is left of them [Duff and Reid 1983]. Dense matrices need no indices in
/// their inner loops, which makes this a few times faster than elimination row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief::detail {

/// The factors L D L^T of a symmetric matrix, in which the diagonal of L is 1.
class SparseFactor {
  public:
    /// Two unknowns and the entry of the matrix in both of their rows. Entries of the same two
    /// unknowns add up.
    struct Entry {
        std::uint32_t a, b;
        double value;
    };

    /// \param diagonal  of the matrix. \param entries  all others, each once
    /// \param positions  of the unknowns: they only decide how long it takes
    SparseFactor(std::span<const double> diagonal, std::span<const Entry> entries,
                 std::span<const glm::dvec3> positions);

    /// False if a pivot is zero or not finite; solve() must not be called then.
    [[nodiscard]] bool is_valid() const { return is_valid_; }

    /// The number of values of L below the diagonal.
    [[nodiscard]] std::size_t value_count() const { return values_.size(); }

    /// Replaces the right side by the solution, for two of them at once: reading the factors costs
    /// most.
    void solve(std::span<glm::dvec2> values);

  private:
    /// A separator, or unknowns that are not divided further: consecutive columns of the factor
    /// with common rows.
    struct Node {
        std::uint32_t first = 0;      ///< In the order of elimination.
        std::uint32_t columns = 0;    ///< Also the number of the first rows.
        std::uint32_t children = 0;   ///< Nodes before this one that add to it.
        std::uint32_t row_count = 0;  ///< Rows after those of the columns.
        std::size_t first_row = 0;    ///< In `rows_`.
        std::size_t first_value = 0;  ///< In `values_`.
    };
    struct Neighbors;

    void order_unknowns(std::span<const Entry> entries, std::span<const glm::dvec3> positions);
    void factor(std::span<const double> diagonal, const Neighbors& neighbors);

    bool is_valid_ = true;
    std::vector<std::uint32_t> place_;  ///< Of each unknown in the order of elimination.
    std::vector<Node> nodes_;           ///< Children before their parent.
    std::vector<std::uint32_t> rows_;   ///< Places, ascending within a node.
    std::vector<double> values_;        ///< Columns below the diagonal, one after the other.
    std::vector<double> pivots_;
    std::size_t max_rows_ = 0;   ///< The largest number of rows of a node with its columns.
    std::vector<double> x_, y_;  ///< The right sides in the order of elimination.
    std::vector<double> part_x_, part_y_;
};

}  // namespace relief::detail
