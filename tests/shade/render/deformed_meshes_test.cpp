// SPDX-License-Identifier: Apache-2.0
// OpenGL's picture of skinned and morphed meshes against the CPU reference.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_graph.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "shade/render/random_scene.h"
#include "shade/render/reference_agreement.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::AgainstReference;
using test::lit_sphere;

/// A change of a scene that shows the deformed position, normal or tangent.
struct ShownDeformation {
    const char* name;
    std::function<void(Scene&)> add;
};

std::vector<ShownDeformation> shown_deformations() {
    return {
        {"nothing else", [](Scene&) {}},
        {"Gouraud highlights",
         [](Scene& s) {
             s.materials[0].specular = glm::vec3(0.5F);
             s.materials[0].interpolation = Interpolation::gouraud;
         }},
        {"normal map",
         [](Scene& s) {
             s.images.push_back({"normals", test::constant_image({0.7F, 0.4F, 0.9F, 1.0F}, 3, 16,
                                                                 ColorSpace::data)});
             s.materials[0].normal_map = NormalMap{Texture{s.images.size() - 1}};
         }},
        {"flat", [](Scene& s) { s.materials[0].interpolation = Interpolation::flat; }},
        {"unlit", [](Scene& s) { s.materials[0].unlit = true; }},
        {"blending",
         [](Scene& s) {
             s.materials[0].alpha_mode = AlphaMode::blend;
             s.materials[0].opacity = 0.6F;
             s.materials[0].double_sided = true;
         }},
        {"a second pose of the mesh",
         [](Scene& s) {
             s.instances.push_back(s.instances[0]);
             s.instances[1].world_from_object[3].x += 0.7F;
             s.instances[1].pose->weights = {-0.4F, 0.0F};
             s.instances[1].pose->joint_matrices.clear();
         }},
        {"mirrored instance", [](Scene& s) { s.instances[0].world_from_object[0].x = -1.2F; }},
    };
}

TEST_F(AgainstReference, AgreesForDeformedMeshes) {
    for (const ShownDeformation& material : shown_deformations()) {
        for (unsigned set = 1; set < 8; ++set) {
            Features f;
            f.morphing = (set & 1) != 0;
            f.skinning = (set & 2) != 0;
            f.deformed_facets = (set & 4) != 0;
            if (!f.morphing && !f.skinning) continue;
            SCOPED_TRACE(testing::Message() << material.name << ", set " << set);
            Scene scene = lit_sphere();
            if (f.deformed_facets) scene.meshes[0] = test::faceted(scene.meshes[0]);
            scene.instances[0].pose = test::pose_calling_for(scene.meshes[0], f);
            material.add(scene);
            const Features planned = plan_effects(scene, {}).draws[0].features;
            EXPECT_EQ(planned.morphing, f.morphing);
            EXPECT_EQ(planned.skinning, f.skinning);
            expect_agreement(scene);
        }
    }
}

TEST_F(AgainstReference, AgreesForSkinsWithHundredsOfJointsAndEightPerVertex) {
    Scene scene = lit_sphere();
    MeshPose& pose = scene.instances[0].pose.emplace();
    test::Dice dice(3);
    constexpr unsigned count = 400;
    for (unsigned i = 0; i < count; ++i) {
        const float angle = 6.0F * static_cast<float>(i) / count;
        glm::mat4 matrix(1.0F);
        matrix[3] = {0.1F * std::sin(angle), 0.1F * std::cos(2.0F * angle), 0.0F, 1.0F};
        matrix[1][0] = 0.2F * std::sin(3.0F * angle);
        pose.joint_matrices.push_back(matrix);
    }
    GltfDeformation& deformation = pose.deformation.edit();
    deformation.joints.resize(2);
    for (const glm::vec3& p : scene.meshes[0]->positions) {
        const auto first = static_cast<unsigned>((p.y + 1.0F) * 0.49F * (count - 8));
        deformation.joints[0].joints.emplace_back(first, first + 1, first + 2, first + 3);
        deformation.joints[1].joints.emplace_back(first + 4, first + 5, first + 6, first + 7);
        deformation.joints[0].weights.emplace_back(0.3F, 0.7F, 1.0F, 0.9F);
        deformation.joints[1].weights.emplace_back(0.6F, 0.4F, 0.2F, 0.1F);
    }
    expect_agreement(scene);
}

TEST_F(AgainstReference, AgreesForDegenerateSkins) {
    const std::vector<std::pair<const char*, glm::mat4>> matrices = {
        {"mirroring", glm::mat4(glm::vec4(-1, 0, 0, 0), glm::vec4(0, 1, 0, 0),
                                glm::vec4(0, 0, 1, 0), glm::vec4(0, 0, 0, 1))},
        {"flattening", glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0.0F),
                                 glm::vec4(0, 0, 0, 1))},
        {"a line",
         glm::mat4(glm::vec4(0.0F), glm::vec4(0, 1, 0, 0), glm::vec4(0.0F), glm::vec4(0, 0, 0, 1))},
        {"not finite", glm::mat4(std::numeric_limits<float>::quiet_NaN())},
        {"tiny", glm::mat4(glm::vec4(1e-6F, 0, 0, 0), glm::vec4(0, 1e-6F, 0, 0),
                           glm::vec4(0, 0, 1e-6F, 0), glm::vec4(0, 0, 0, 1))},
    };
    for (const auto& [name, matrix] : matrices) {
        SCOPED_TRACE(name);
        Scene scene = lit_sphere();
        scene.materials[0].double_sided = true;
        Features f;
        f.skinning = true;
        scene.instances[0].pose = test::pose_calling_for(scene.meshes[0], f);
        MeshPose& pose = *scene.instances[0].pose;
        pose.joint_matrices = {matrix, glm::mat4(1.0F)};
        // Vertices without weights follow the first joint.
        GltfJoints& joints = pose.deformation.edit().joints[0];
        joints.weights.assign(joints.weights.size(), {0.0F, 1.0F, 0.0F, 0.0F});
        for (std::size_t i = 0; i < joints.weights.size() / 4; ++i)
            joints.weights[i] = glm::vec4(0.0F);
        if (std::string(name) == "tiny") {  // A large mesh.
            for (glm::vec3& position : scene.meshes[0].edit().positions)
                position *= 1e6F;
            pose.joint_matrices[1] = matrix;
        }
        expect_agreement(scene);
    }
}

TEST_F(AgainstReference, AgreesForModelsThatAreSkinnedAndMorphed) {
    for (const char* name :
         {"Fox/glTF-Binary/Fox.glb", "CesiumMan/glTF-Binary/CesiumMan.glb",
          "RiggedFigure/glTF-Binary/RiggedFigure.glb", "SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
          "AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb"}) {
        SCOPED_TRACE(name);
        RELIEF_NEEDS_SHARED(file, std::string("data/models/gltf/") + name);
        SceneGraph graph = load_scene_graph(file, {});
        pose(graph, 0.3 * duration(graph));
        Scene& scene = graph.scene;
        for (Material& material : scene.materials)
            material.diffuse_texture.reset();  // Its minification is not the subject.
        scene.directional_lights = {{{-1, -2, -3}, {0.6F, 0.5F, 0.4F}}};
        scene.ambient = {0.1F, 0.15F, 0.2F};
        scene.camera = framed(scene, 0.6F, 0.3F, 0.6F, 1.0F);
        const Features planned = plan_effects(scene, {}).draws[0].features;
        EXPECT_TRUE(planned.morphing || planned.skinning);
        expect_agreement(scene);
    }
}

}  // namespace
}  // namespace relief
