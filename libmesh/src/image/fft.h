// SPDX-License-Identifier: Apache-2.0
/// \file
/// Discrete Fourier transforms of any length, in double precision, several rows at once.
///
/// Real rows have two transforms in which differences of neighbors become multiplications: the
/// Hartley transform for periodic rows and the cosine transform for mirrored rows.
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
