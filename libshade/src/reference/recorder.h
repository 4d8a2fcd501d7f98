// SPDX-License-Identifier: Apache-2.0
/// \file
/// Records the terms of a pixel where the reference computes them. World space, linear light.
///
/// A TermSum is light on its way to the eye. Its operations act on the sum and, if a recorder
/// listens, on each of its terms; without a recorder it is the sum and a null pointer. A Recorder
/// collects what else the formula uses: lights, vectors, lookups, and quantities, which belong to
/// the next term that begins.
#pragma once

#include <cstddef>
#include <deque>
#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "relief/export.h"
#include "relief/shade/probe.h"

namespace relief::shade {
namespace RELIEF_API reference {

class TermSum;

/// Fills a Probe while the reference computes its pixel. Vectors are in world space only; lookups
/// have neither slots nor footprints: the probe adds them later.
class Recorder {
  public:
    explicit Recorder(Probe& probe) : probe_(probe) {}

    // Surfaces
    void begin_layer() { probe_.layers.emplace_back(); }
    /// Returns the surface that is being shaded.
    [[nodiscard]] ProbeLayer& layer() { return probe_.layers.back(); }
    /// \param share  of the pixel
    void end_layer(double alpha, double coverage, double share, AlphaMode mode);

    // The quantities of the formula
    /// Adds a quantity to the next term that begins.
    void note(const ProbeFactor& quantity) { quantities_.push_back(quantity); }
    std::vector<ProbeFactor> take_quantities() { return std::exchange(quantities_, {}); }
    /// Returns a new list of terms, which lives as long as the recorder.
    std::vector<ProbeTerm>& new_terms() { return lists_.emplace_back(); }
    /// Adds a light, unless it repeats one, and returns its index in the layer.
    std::size_t add(ProbeLight light);
    /// Adds a unit or zero vector in world space, unless it repeats one.
    void add_vector(std::string_view symbol, const glm::dvec3& world,
                    std::optional<std::size_t> light = std::nullopt);
    /// Adds a lookup, unless it repeats one.
    void add_lookup(const ProbeLookup& lookup);
    /// Lights and vectors that follow are those of a corner of the triangle.
    void begin_corner(std::size_t corner, const glm::dvec3& normal_world,
                      const glm::dvec3& view_world);
    void end_corners() { corner_.reset(); }

    // Light
    /// Adds the light of the layer.
    /// \param limited  the light as it is added
    void add_radiance(TermSum&& sum, const glm::dvec3& limited, double share);
    void add_skybox(const glm::dvec3& radiance, double share);
    /// Ends the pixel: its light is divided by its alpha, and the terms of a view are selected.
    void end(double alpha);

  private:
    Probe& probe_;
    std::vector<ProbeFactor> quantities_;
    std::optional<std::size_t> corner_;
    std::deque<std::vector<ProbeTerm>> lists_;
};

/// A named factor of a term: a number or a color.
template <typename Value>
struct Named {
    const char* symbol;
    Value value;
};
template <typename Value>
Named<Value> named(const char* symbol, const Value& value) {
    return {symbol, value};
}

/// The light that a term has no light source.
inline constexpr std::size_t no_light = static_cast<std::size_t>(-1);

class TermSum {
  public:
    TermSum() = default;

    /// Begins a sum with one term: the product of the factors, from left to right.
    /// \param light  the index of the recorded light, or no_light
    template <typename... Values>
    TermSum(Recorder* recorder, ProbeTermKind kind, std::size_t light,
            const Named<Values>&... factors)
        : sum_((... * factors.value)) {
        if (recorder != nullptr) [[unlikely]]
            begin(*recorder, kind, light, {ProbeFactor(factors.symbol, factors.value)...});
    }

    TermSum& operator+=(TermSum&& other) {
        sum_ += other.sum_;
        if (other.terms_ != nullptr) [[unlikely]]
            append(*other.terms_);
        return *this;
    }

    /// Multiplies the sum by the product of the factors, from left to right.
    template <typename... Values>
    TermSum&& multiply(const Named<Values>&... factors) {
        sum_ = (... * factors.value) * sum_;
        if (terms_ != nullptr) [[unlikely]]
            multiply_terms({ProbeFactor(factors.symbol, factors.value)...});
        return std::move(*this);
    }

    /// \param inverse  the symbol of 1 / divisor
    void divide(const char* inverse, double divisor) {
        sum_ /= divisor;
        if (terms_ != nullptr) [[unlikely]]
            multiply_terms({ProbeFactor(inverse, 1.0 / divisor)});
    }

    /// Sets the sum to a value near it; terms get the factor that this amounts to.
    void become(const char* symbol, const glm::dvec3& value) {
        if (terms_ != nullptr) [[unlikely]]
            scale_terms_to(symbol, value);
        sum_ = value;
    }

    [[nodiscard]] const glm::dvec3& value() const { return sum_; }
    /// Returns the recorded terms and leaves none.
    [[nodiscard]] std::vector<ProbeTerm> take_terms();

  private:
    void begin(Recorder& recorder, ProbeTermKind kind, std::size_t light,
               std::initializer_list<ProbeFactor> factors);
    void append(std::vector<ProbeTerm>& others);
    void multiply_terms(std::initializer_list<ProbeFactor> factors);
    void scale_terms_to(const char* symbol, const glm::dvec3& value);

    glm::dvec3 sum_{0.0};
    std::vector<ProbeTerm>* terms_ = nullptr;  ///< The recorder's; null without one.
};

}  // namespace reference
}  // namespace relief::shade
