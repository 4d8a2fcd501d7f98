// SPDX-License-Identifier: Apache-2.0
// Fields of Features as numbers, and a covering set of sets, found greedily: first those that bring
// most new pairs.
#include <algorithm>
#include <set>

#include "all_features.h"

namespace relief::test {
namespace {

template <auto Member, unsigned Count = 2>
FeatureField field(const char* name) {
    using Value = std::decay_t<decltype(std::declval<Features>().*Member)>;
    return {name, Count, [](const Features& f) { return static_cast<unsigned>(f.*Member); },
            [](Features& f, unsigned value) { f.*Member = static_cast<Value>(value); }};
}

constexpr unsigned max_values = 4;

/// One set, and how many pairs it would bring at the most: what it would have brought when that was
/// counted last, since pairs only become fewer.
struct Candidate {
    const Features* features;
    std::vector<unsigned char> values;  ///< Of each field.
    std::size_t bound = static_cast<std::size_t>(-1);
};

/// Which pairs of fields have met with which values.
class CoveredPairs {
  public:
    explicit CoveredPairs(std::size_t fields)
        : fields_(fields), met_(fields * fields * max_values * max_values, 0) {}

    [[nodiscard]] std::size_t fresh_in(const std::vector<unsigned char>& values) const {
        std::size_t fresh = 0;
        const unsigned char* const met = met_.data();
        for (std::size_t i = 0; i < fields_; ++i) {
            for (std::size_t j = i + 1; j < fields_; ++j)
                fresh += met[place(i, j, values[i], values[j])] == 0 ? 1U : 0U;
        }
        return fresh;
    }
    void add(const std::vector<unsigned char>& values) {
        for (std::size_t i = 0; i < fields_; ++i) {
            for (std::size_t j = i + 1; j < fields_; ++j)
                met_[place(i, j, values[i], values[j])] = 1;
        }
    }

  private:
    [[nodiscard]] std::size_t place(std::size_t i, std::size_t j, std::size_t a,
                                    std::size_t b) const {
        return ((i * fields_ + j) * max_values + a) * max_values + b;
    }

    std::size_t fields_;
    std::vector<unsigned char> met_;
};

}  // namespace

const std::vector<FeatureField>& feature_fields() {
    using F = Features;
    static const std::vector<FeatureField> all = {
        field<&F::unlit>("unlit"),
        field<&F::metallic_roughness>("metallic-roughness"),
        field<&F::interpolation, 3>("interpolation"),
        field<&F::diffuse_texture>("diffuse texture"),
        field<&F::specular_texture>("specular texture"),
        field<&F::metallic_roughness_texture>("metallic-roughness texture"),
        field<&F::occlusion_texture>("occlusion texture"),
        field<&F::vertex_colors>("vertex colours"),
        field<&F::alpha, 3>("alpha"),
        field<&F::opacity_texture>("opacity texture"),
        field<&F::detail, 4>("detail"),
        field<&F::frame, 2>("frame"),
        field<&F::specular_antialiasing>("specular antialiasing"),
        field<&F::double_sided>("double-sided"),
        field<&F::ambient>("ambient"),
        field<&F::directional_lights, 3>("directional lights"),
        field<&F::point_lights, 3>("point lights"),
        field<&F::spot_lights, 3>("spot lights"),
        field<&F::falloff, 3>("falloff"),
        field<&F::light_ranges>("light ranges"),
        field<&F::highlight_colors>("highlight colours"),
        field<&F::lights_in_buffer>("light buffer"),
        field<&F::environment_diffuse>("environment light"),
        field<&F::diffuse>("diffuse"),
        field<&F::specular, 3>("specular"),
        field<&F::emission>("emission"),
        field<&F::emission_texture>("emission texture"),
        field<&F::reflection, 3>("reflection"),
        field<&F::fresnel, 4>("fresnel"),
        field<&F::refraction>("refraction"),
        field<&F::output, 4>("output"),
        field<&F::tone_mapping, 3>("tone mapping"),
        field<&F::exposure>("exposure"),
    };
    return all;
}

Features random_features(std::mt19937& random) {
    Features f;
    for (const FeatureField& field : feature_fields())
        field.set(f, static_cast<unsigned>(random() % field.count));
    if (random() % 8 != 0) f.unlit = false;
    return f;
}

void for_random_features(std::size_t count, const std::function<void(const Features&)>& visit) {
    std::mt19937 random(1);
    for (std::size_t i = 0; i < count; ++i)
        visit(random_features(random));
}

namespace {

std::vector<Features> make_covering_features() {
    std::set<Features> canonical_sets;
    for_random_features(40000, [&](const Features& f) { canonical_sets.insert(canonical(f)); });
    std::vector<Candidate> candidates;
    for (const Features& f : canonical_sets) {
        Candidate candidate{&f, {}};
        for (const FeatureField& field : feature_fields())
            candidate.values.push_back(static_cast<unsigned char>(field.get(f)));
        candidates.push_back(std::move(candidate));
    }
    CoveredPairs covered(feature_fields().size());
    std::vector<Features> chosen;
    // Passes with a falling bar: cheaper than the true greedy choice, and nearly as small.
    for (std::size_t bar = 400; bar > 0; bar = bar > 8 ? bar * 3 / 4 : bar - 1) {
        for (Candidate& candidate : candidates) {
            if (candidate.bound < bar) continue;
            candidate.bound = covered.fresh_in(candidate.values);
            if (candidate.bound < bar) continue;
            covered.add(candidate.values);
            chosen.push_back(*candidate.features);
            candidate.bound = 0;
        }
    }
    return chosen;
}

}  // namespace

const std::vector<Features>& covering_features() {
    static const std::vector<Features> all = make_covering_features();
    return all;
}

}  // namespace relief::test
