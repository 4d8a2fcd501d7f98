// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_mesh_check_tangents_test.cpp.
#include "tangent_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/text.h"

namespace relief::tools {
namespace {

/// Some are no reason to doubt a sign: degenerate triangles, seams that were welded.
constexpr double share_of_sign = 0.99;

/// Whether w is negated: everywhere, nowhere, or at some corners.
enum class Sign { as_it_should, negated, divided };

Sign sign_of(const BasisAgreement& agreement) {
    const auto all = static_cast<double>(agreement.agreeing());
    const auto negated = static_cast<double>(agreement.negated);
    if (negated >= share_of_sign * all) return Sign::negated;
    return negated <= (1.0 - share_of_sign) * all ? Sign::as_it_should : Sign::divided;
}

std::string variant_of(const BasisAgreement& agreement) {
    return std::string(
        variant_in_words(agreement.quarter_turns, sign_of(agreement) == Sign::negated));
}

/// Nobody needs to know digits below a thousandth of a degree.
std::string angles_in_words(AngleDistribution angles) {
    for (double* degrees : {&angles.median, &angles.p90, &angles.p99, &angles.max})
        *degrees = std::max(*degrees, 0.001);
    return fmt::format(
        "half within {:.2g}, 90 of 100 within {:.2g}, 99 within {:.2g}, largest {:.2g}",
        angles.median, angles.p90, angles.p99, angles.max);
}

std::string found_in_words(const CheckedTangents& tangents) {
    const SniffedTangents& sniffed = tangents.sniffed;
    const BasisAgreement& best = *sniffed.best();
    std::string text(word_of(*sniffed.basis));
    const std::string variant = variant_of(best);
    if (!variant.empty()) text += ", " + variant;
    if (sign_of(best) == Sign::divided) {
        text += fmt::format(", w negated at {} of {} corners", best.negated, best.agreeing());
    }
    if (tangents.texcoord_set != tangents.usual_set)
        text += fmt::format(", of texture coordinate set {}", tangents.texcoord_set);
    text += fmt::format(": {} of {} within {:.2g} degrees ({})", best.agreeing(),
                        counted(sniffed.corners, "corner"), sniffed.tolerance,
                        angles_in_words(best.angles));
    if (!sniffed.same_here.empty()) {
        std::vector<std::string_view> words;
        for (const TangentBasis basis : sniffed.same_here)
            words.push_back(word_of(basis));
        text += fmt::format("; {} {} to the same here", fmt::join(words, ", "),
                            words.size() == 1 ? "comes" : "come");
    }
    return text;
}

}  // namespace

std::optional<CheckedTangents> check_tangents(const GltfDocument& document, GltfPrimitiveId id,
                                              const Mesh& mesh) {
    if (mesh.tangents.empty()) return std::nullopt;
    CheckedTangents result;
    result.usual_set = document.tangent_texcoords(id).set;
    result.texcoord_set = result.usual_set;
    result.has_normals = !mesh.normals.empty();
    const std::vector<int> sets = document.texcoord_sets(id);
    result.has_texcoords = !sets.empty();
    if (!result.has_normals || sets.empty()) return result;
    result.sniffed = sniff_tangents(document.mesh(id, result.usual_set));
    for (const int set : sets) {
        if (result.sniffed.basis) break;
        if (set == result.usual_set) continue;
        SniffedTangents other = sniff_tangents(document.mesh(id, set));
        if (!other.basis) continue;
        result.sniffed = std::move(other);
        result.texcoord_set = set;
    }
    return result;
}

std::string in_words(const CheckedTangents& tangents) {
    if (!tangents.has_normals) return "without normals: glTF says that they are ignored";
    if (!tangents.has_texcoords)
        return "of unknown basis: without texture coordinates none can be told";
    const SniffedTangents& sniffed = tangents.sniffed;
    if (sniffed.basis) return found_in_words(tangents);
    const BasisAgreement* best = sniffed.best();
    if (best == nullptr) {
        return fmt::format(
            "of unknown basis: no triangle is large enough in the image, or no tangent a direction "
            "({} left out, {} without direction)",
            sniffed.left_out, sniffed.undefined);
    }
    const std::string variant = variant_of(*best);
    return fmt::format("of unknown basis; nearest{} is {}{}: {} of {} within {:.2g} degrees ({})",
                       sniffed.is_best_by_far() ? " by far" : "", word_of(best->basis),
                       variant.empty() ? "" : ", " + variant, best->agreeing(),
                       counted(sniffed.corners, "corner"), sniffed.tolerance,
                       angles_in_words(best->angles));
}

nlohmann::ordered_json json_of(const CheckedTangents& tangents) {
    const SniffedTangents& sniffed = tangents.sniffed;
    nlohmann::ordered_json agreements = nlohmann::ordered_json::array();
    for (const BasisAgreement& agreement : sniffed.agreements) {
        const AngleDistribution& angles = agreement.angles;
        nlohmann::ordered_json histogram = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < angles.histogram.size(); ++i)
            histogram.push_back(
                {{"up_to", AngleDistribution::bounds[i]}, {"corners", angles.histogram[i]}});
        agreements.push_back({{"basis", word_of(agreement.basis)},
                              {"agreeing", agreement.agreeing()},
                              {"variant", variant_of(agreement)},
                              {"w_negated", agreement.negated},
                              {"rms", angles.rms},
                              {"mean", angles.mean},
                              {"median", angles.median},
                              {"p90", angles.p90},
                              {"p99", angles.p99},
                              {"max", angles.max},
                              {"histogram", std::move(histogram)}});
    }
    nlohmann::ordered_json same_here = nlohmann::ordered_json::array();
    for (const TangentBasis basis : sniffed.same_here)
        same_here.push_back(word_of(basis));
    const BasisAgreement* best = sniffed.best();
    return {{"basis", sniffed.basis ? std::string(word_of(*sniffed.basis)) : "unknown"},
            {"variant", best == nullptr ? "" : variant_of(*best)},
            {"nearest", best == nullptr ? "" : std::string(word_of(best->basis))},
            {"nearest_by_far", sniffed.is_best_by_far()},
            {"same_here", std::move(same_here)},
            {"texcoord_set", tangents.texcoord_set},
            {"texcoord_set_of_material", tangents.usual_set},
            {"corners", sniffed.corners},
            {"left_out", sniffed.left_out},
            {"without_direction", sniffed.undefined},
            {"stored_bits", sniffed.stored_bits == 0 ? 32 : sniffed.stored_bits},
            {"tolerance", sniffed.tolerance},
            {"agreements", std::move(agreements)}};
}

}  // namespace relief::tools
