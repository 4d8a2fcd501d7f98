// SPDX-License-Identifier: Apache-2.0
#include "reference/recorder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace relief::shade::reference {

namespace {

/// Multiplies a term by a factor that stands last in its formula.
void scale(ProbeTerm& term, const ProbeFactor& factor) {
    term.factors.push_back(factor);
    term.value *= factor.value;
}

}  // namespace

// Sums of terms

void TermSum::begin(Recorder& recorder, ProbeTermKind kind, std::size_t light,
                    std::initializer_list<ProbeFactor> factors) {
    ProbeTerm term;
    term.kind = kind;
    if (light != no_light) term.light = light;
    term.factors = factors;
    term.quantities = recorder.take_quantities();
    term.value = sum_;
    terms_ = &recorder.new_terms();
    terms_->push_back(std::move(term));
}

void TermSum::append(std::vector<ProbeTerm>& others) {
    if (terms_ == nullptr) {
        terms_ = &others;
    } else {
        std::move(others.begin(), others.end(), std::back_inserter(*terms_));
    }
}

void TermSum::multiply_terms(std::initializer_list<ProbeFactor> factors) {
    glm::dvec3 product(1.0);
    for (const ProbeFactor& factor : factors)
        product *= factor.value;
    for (ProbeTerm& term : *terms_) {
        term.factors.insert(term.factors.begin(), factors);
        term.value *= product;
    }
}

void TermSum::scale_terms_to(const char* symbol, const glm::dvec3& value) {
    if (value == sum_) return;
    glm::dvec3 ratio(1.0);
    for (int i = 0; i < 3; ++i) {
        if (sum_[i] != 0.0) ratio[i] = value[i] / sum_[i];
    }
    for (ProbeTerm& term : *terms_)
        scale(term, {symbol, ratio});
}

std::vector<ProbeTerm> TermSum::take_terms() {
    std::vector<ProbeTerm>* const terms = std::exchange(terms_, nullptr);
    return terms == nullptr ? std::vector<ProbeTerm>() : std::move(*terms);
}

// Surfaces

void Recorder::end_layer(double alpha, double coverage, double share, AlphaMode mode) {
    ProbeLayer& ended = layer();
    ended.alpha = alpha;
    ended.coverage = coverage;
    ended.share = share;
    if (coverage == 0.0)
        ended.outcome = mode == AlphaMode::mask ? ProbeOutcome::cut_out : ProbeOutcome::transparent;
}

std::size_t Recorder::add(ProbeLight light) {
    light.corner = corner_;
    std::vector<ProbeLight>& lights = layer().lights;
    const auto same = std::find_if(lights.begin(), lights.end(), [&](const ProbeLight& other) {
        return other.kind == light.kind && other.index == light.index &&
               other.corner == light.corner && other.irradiance == light.irradiance;
    });
    const auto index = static_cast<std::size_t>(same - lights.begin());
    if (same == lights.end()) lights.push_back(light);
    return index;
}

void Recorder::add_vector(std::string_view symbol, const glm::dvec3& world,
                          std::optional<std::size_t> light) {
    std::vector<ProbeVector>& vectors = layer().vectors;
    const bool repeats = std::any_of(vectors.begin(), vectors.end(), [&](const ProbeVector& other) {
        return other.symbol == symbol && other.light == light && other.corner == corner_ &&
               other.world == world;
    });
    if (repeats) return;
    ProbeVector vector;
    vector.symbol = symbol;
    vector.light = light;
    vector.corner = corner_;
    vector.world = world;
    vectors.push_back(vector);
}

void Recorder::add_lookup(const ProbeLookup& lookup) {
    std::vector<ProbeLookup>& lookups = layer().lookups;
    const bool repeats = std::any_of(lookups.begin(), lookups.end(), [&](const ProbeLookup& other) {
        return other.image == lookup.image && other.use == lookup.use &&
               other.second_texcoords == lookup.second_texcoords && other.filter == lookup.filter &&
               other.texcoord == lookup.texcoord;
    });
    if (!repeats) lookups.push_back(lookup);
}

void Recorder::begin_corner(std::size_t corner, const glm::dvec3& normal_world,
                            const glm::dvec3& view_world) {
    corner_ = corner;
    add_vector("n", normal_world);
    add_vector("v", view_world);
}

// Light

void Recorder::add_radiance(TermSum&& sum, const glm::dvec3& limited, double share) {
    const bool is_limited = sum.value() != limited;
    const std::size_t index = probe_.layers.size() - 1;
    std::vector<ProbeTerm> terms = sum.take_terms();
    if (is_limited) {
        glm::dvec3 rest = limited;
        for (ProbeTerm& term : terms) {
            for (int i = 0; i < 3; ++i) {
                if (!std::isfinite(term.value[i])) term.value[i] = 0.0;
            }
            rest -= term.value;
        }
        ProbeTerm& limit = terms.emplace_back();
        limit.kind = ProbeTermKind::limit;
        limit.factors = {{"limit", rest}};
        limit.value = rest;
    }
    for (ProbeTerm& term : terms) {
        term.layer = index;
        if (share != 1.0) scale(term, {"share", share});
        probe_.terms.push_back(std::move(term));
    }
    quantities_.clear();
}

void Recorder::add_skybox(const glm::dvec3& radiance, double share) {
    ProbeTerm& term = probe_.terms.emplace_back();
    term.kind = ProbeTermKind::skybox;
    term.factors = {{"environment", radiance}};
    term.value = radiance;
    if (share != 1.0) scale(term, {"share", share});
}

void Recorder::end(double alpha) {
    if (probe_.view != DebugView::picture) {
        std::erase_if(probe_.terms, [&](const ProbeTerm& term) {
            return probe_term_info(term.kind).view != probe_.view;
        });
        alpha = 0.0;
        for (const ProbeLayer& shown : probe_.layers)
            alpha += shown.share;
    }
    // The order of the kinds, which is that of lessons.
    std::stable_sort(probe_.terms.begin(), probe_.terms.end(),
                     [](const ProbeTerm& a, const ProbeTerm& b) {
                         const std::size_t none = static_cast<std::size_t>(-1);
                         return std::pair(a.layer.value_or(none), a.kind) <
                                std::pair(b.layer.value_or(none), b.kind);
                     });
    if (!(alpha > 0.0) || alpha == 1.0) return;
    for (ProbeTerm& term : probe_.terms)
        scale(term, {"1 / coverage", 1.0 / alpha});
}

}  // namespace relief::shade::reference
