// SPDX-License-Identifier: Apache-2.0
// A plan's programs as text, each once, whatever many draws it has. Broken override files throw
// GpuError. Tests: tests/shade/effects/shader_listing_test.cpp.
#include "relief/shade/shader_listing.h"

#include <algorithm>
#include <map>

#include "effects/surface_program.h"

namespace relief {

namespace {

ShaderListing listing_of(const Features& features) {
    const SurfaceProgram program = surface_program(features);
    ShaderListing listing;
    listing.features = features;
    listing.vertex = program.vertex.text;
    listing.fragment = program.fragment.text;
    std::vector<std::string>& files = listing.files;
    files = program.vertex.files;
    files.insert(files.end(), program.fragment.files.begin(), program.fragment.files.end());
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    return listing;
}

}  // namespace

std::vector<ShaderListing> shader_listings(const FramePlan& plan) {
    std::vector<ShaderListing> listings;
    std::map<Features, std::size_t> known;
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        const Features& features = plan.draws[i].features;
        const auto [entry, is_new] = known.emplace(features, listings.size());
        if (is_new) listings.push_back(listing_of(features));
        listings[entry->second].draws.push_back(i);
    }
    return listings;
}

}  // namespace relief
