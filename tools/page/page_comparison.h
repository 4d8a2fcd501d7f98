// SPDX-License-Identifier: Apache-2.0
/// \file
/// A page with a split line between scenes, for reports. Tests: tests/tools/view_page/.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"

namespace relief::tools {

struct PageSide {
    std::string name;
    const shade::Scene* scene = nullptr;
};

/// Returns a page with one scene to the left of the line, and a choice of others to its right.
/// Their vertices are stored in 16 bits. \param size  of the picture whose extent the page shows at
/// least \throws as PageRecorder::add() does
std::string comparison_page(const shade::Context& context, const shade::Camera& camera,
                            const PageSide& left, const std::vector<PageSide>& right,
                            const glm::ivec2& size, const std::string& title);

/// Returns an element that shows a page inside of another one. Scripts of both need permission by
/// the policy of the outer page.
/// \param label  for screen readers
std::string embedded_page(const std::string& page, const std::string& label);

}  // namespace relief::tools
