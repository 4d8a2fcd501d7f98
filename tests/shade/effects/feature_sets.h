// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sets of effects for tests: each field of Features with its values, random sets, a small list of
/// sets that covers every pair of values, and a scene that needs exactly a given set.
#pragma once

#include <functional>
#include <random>
#include <vector>

#include "relief/shade/effects.h"

namespace relief::test {

/// One field of Features as a number below `count`. Light counts have the values 0, 1 and 2.
struct FeatureField {
    const char* name;
    unsigned count;
    unsigned (*get)(const shade::Features& f);
    void (*set)(shade::Features& f, unsigned value);
};

const std::vector<FeatureField>& feature_fields();

/// Returns random values with a probability for each field. Unlit, which removes most other
/// effects, is rare.
shade::Features random_features(std::mt19937& random);

/// Calls visit with `count` random sets, the same in every run.
void for_random_features(std::size_t count,
                         const std::function<void(const shade::Features&)>& visit);

/// A small set of canonical features in which every value of every field meets every value of every
/// other field, as far as 40,000 random sets show that they can meet. The greedy algorithm has a
/// fixed order.
const std::vector<shade::Features>& covering_features();

struct CallingScene {
    shade::Scene scene;
    shade::FrameSettings settings;
    /// The planned features of its only draw: the requested ones, unless no scene needs exactly
    /// those (a light buffer for few lights; glTF's model without reflection of the environment;
    /// codes before blending).
    shade::Features expected;
};

/// Returns a pose with two morph targets, of which the second has no weight, and two joints, which
/// bend a mesh of about unit size. Features without morphing or skinning leave it at rest.
shade::MeshPose pose_calling_for(const Mesh& mesh, const shade::Features& features);

/// Returns the mesh with vertices of its own for every triangle, and the normals of their planes.
Mesh faceted(const Mesh& mesh);

/// Returns shares of light from all around that differ between the vertices.
std::vector<float> shares_of(const Mesh& mesh);

/// \param features  canonical
CallingScene scene_calling_for(const shade::Features& features);

/// The default material with a name.
Material gray(const char* name = "body");

/// A grid under one directional light.
shade::Scene lit_scene(const Material& material);

/// Returns the reason of an effect. \throws std::runtime_error if there is none
const shade::EffectReason& reason(const std::vector<shade::EffectReason>& reasons,
                                  const char* effect);

}  // namespace relief::test
