// SPDX-License-Identifier: Apache-2.0
/// \file
/// The scene of a page as JSON: what moves, by the rules of docs/page.md. Tests:
/// tests/tools/view_page/.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/summary.h"
#include "relief/shade/scene_graph.h"

namespace relief::tools {

/// Sections of bytes, each from a multiple of 4 on.
class PageSections {
  public:
    std::size_t add(std::span<const std::byte> bytes);
    template <typename T>
    std::size_t add(const std::vector<T>& values) {
        return add(std::as_bytes(std::span(values)));
    }

    /// Their first bytes and sizes.
    [[nodiscard]] Json places() const { return places_; }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    std::vector<std::array<std::size_t, 2>> places_;
    std::string bytes_;
};

/// A scene at the time of its pictures.
struct PageScene {
    const shade::SceneGraph* graph = nullptr;
    shade::Camera camera;
    bool camera_follows_scene = false;  ///< The camera belongs to the scene and may move.
};

/// Returns nodes, instances, lights, camera and animations. Animations have sections of their own.
Json page_scene_json(const PageScene& page, double seconds, PageSections& sections);

}  // namespace relief::tools
