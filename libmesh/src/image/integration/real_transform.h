// SPDX-License-Identifier: Apache-2.0
/// \file
/// Transforms of real rows in which differences of neighbours become multiplications: the Hartley
/// transform where a row goes on at its other end, the cosine transform where it goes on mirrored.
/// For any length, several rows at once. Tests:
/// tests/mesh/image/integration/real_transform_test.cpp.
#pragma once

#include <cstddef>
#include <vector>

#include "image/integration/complex_fft.h"

namespace relief {

enum class TransformKind {
    hartley,  ///< X[k] = sum x[j] (cos + sin)(2 pi j k / n)
    cosine,   ///< X[k] = sum x[j] cos(pi (2j + 1) k / (2n))
};

class RealTransform {
  public:
    /// Rows that are transformed at once, their samples side by side: sample j of lane i is at
    /// j * lanes + i.
    static constexpr std::size_t lanes = 8;

    /// \param length  at least 1
    RealTransform(TransformKind kind, std::size_t length);

    /// In place, length * lanes samples. `inverse` undoes `forward`. The scratch is any vector of
    /// the thread's own, made as large as needed.
    void forward(double* samples, std::vector<double>& scratch) const;
    void inverse(double* samples, std::vector<double>& scratch) const;

    [[nodiscard]] std::size_t length() const { return length_; }
    /// Radians a sample that coefficient k stands for.
    [[nodiscard]] double frequency(std::size_t k) const;

  private:
    [[nodiscard]] ComplexRows unpacked(const double* samples, std::vector<double>& scratch) const;

    TransformKind kind_;
    std::size_t length_;
    ComplexFft fft_;
    std::vector<double> cosines_, sines_;  ///< Of pi k / (2n), for the cosine transform.
};

}  // namespace relief
