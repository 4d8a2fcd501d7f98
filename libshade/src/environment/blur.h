// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surroundings as rough surfaces mirror them: radiance in each direction d, averaged over the
/// hemisphere around it with the weight D(h) n.l, where normal and eye are d itself and D is GGX's
/// distribution of the half vector h. World space, linear light.
///
/// Far from d the weight changes slowly, so that many texels count as one there
/// [Barnes and Hut 1986]: one texel of the result takes some hundred terms instead of a hundred
/// thousand. Source: the first half of the split sum [Karis, SIGGRAPH 2013]. Tests:
/// tests/shade/environment/blur_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/image.h"

namespace relief {

/// Six faces, and their means over 2 x 2, 4 x 4, ... texels, weighted by what each texel covers of
/// the sphere.
class RadianceTree {
  public:
    /// A texel, or the mean of some.
    struct Node {
        glm::vec3 direction{0.0F};  ///< Of its middle, unit.
        float solid_angle = 0.0F;
        glm::vec3 radiance{0.0F};         ///< Mean over the solid angle.
        glm::vec3 light_direction{0.0F};  ///< Where its light comes from on average, unit.
    };

    /// \param faces  +x -x +y -y +z -z, three float channels of finite radiance, their size a power
    ///               of two
    /// \throws InvalidInput if they do not fit together or have another size or kind
    explicit RadianceTree(std::span<const Image> faces);

    /// Down from the whole faces, which are level 0, to the texels.
    [[nodiscard]] std::size_t level_count() const { return levels_.size(); }

    /// 2^level by 2^level nodes of a face.
    [[nodiscard]] const Node& node(std::size_t level, std::size_t face, std::size_t x,
                                   std::size_t y) const {
        return levels_[level][(((face << level) + y) << level) + x];
    }

  private:
    std::vector<std::vector<Node>> levels_;
};

/// Six faces of blurred radiance.
///
/// \param roughness  0.1 to 1, alpha = roughness^2; sharper lobes end between the texels
/// \return three float channels, within 2% (root mean square, by that of the sum over all texels)
/// of
///         blurred_radiance(), and 1% in pictures of real places; the same bits for any number of
///         threads
std::vector<Image> blurred_faces(const RadianceTree& tree, int size, double roughness);

/// The same for one direction of any length but zero, by a sum over all texels in double.
///
/// \param faces  as above, of any size
glm::dvec3 blurred_radiance(std::span<const Image> faces, const glm::dvec3& direction,
                            double roughness);

}  // namespace relief
