// SPDX-License-Identifier: Apache-2.0
/// \file
/// The discrete Fourier transform of complex rows of any length, four rows at once, in double.
/// Tests: tests/mesh/image/integration/real_transform_test.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace relief {

/// Rows side by side: sample j of lane i is real[j * lanes + i] + sqrt(-1) imag[j * lanes + i].
struct ComplexRows {
    double* real;
    double* imag;
};

/// Z[k] = sum z[j] exp(-2 pi sqrt(-1) j k / n)
class ComplexFft {
  public:
    static constexpr std::size_t lanes = 4;

    explicit ComplexFft(std::size_t length);
    ~ComplexFft();
    ComplexFft(const ComplexFft&) = delete;
    ComplexFft& operator=(const ComplexFft&) = delete;

    /// How many doubles of scratch a call needs.
    [[nodiscard]] std::size_t scratch_size() const;
    /// In place; the inverse, without the division by n, by exchanging real and imaginary parts.
    void transform(ComplexRows rows, double* scratch) const;

  private:
    struct Pass;
    struct Chirp;

    std::size_t length_;
    std::vector<Pass> passes_;
    std::unique_ptr<Chirp> chirp_;  ///< For lengths with a large prime factor.
};

}  // namespace relief
