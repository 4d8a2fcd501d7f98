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

namespace relief::detail {
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

    /// Returns the number of doubles of scratch memory for a call.
    [[nodiscard]] std::size_t scratch_size() const;
    /// Transforms in place. The inverse, without the division by n, results from exchanging the
    /// real and imaginary parts.
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
    /// The number of rows that are transformed at once, interleaved: sample j of lane i is at j *
    /// lanes + i.
    static constexpr std::size_t lanes = 8;

    /// \param length  at least 1
    RealTransform(TransformKind kind, std::size_t length);

    /// Transforms length * lanes samples in place. `inverse` undoes `forward`. The scratch memory
    /// is a vector of the thread, which grows as needed.
    void forward(double* samples, std::vector<double>& scratch) const;
    void inverse(double* samples, std::vector<double>& scratch) const;

    [[nodiscard]] std::size_t length() const { return length_; }
    /// Returns the radians per sample of coefficient k.
    [[nodiscard]] double frequency(std::size_t k) const;

  private:
    [[nodiscard]] ComplexRows unpacked(const double* samples, std::vector<double>& scratch) const;

    TransformKind kind_;
    std::size_t length_;
    ComplexFft fft_;
    std::vector<double> cosines_,
        sines_;  ///< Cosines and sines of pi k / (2n), for the cosine transform.
};

}  // namespace relief::detail
