// SPDX-License-Identifier: Apache-2.0
/// \file
/// A Workspace reuses the memory of intermediate results in repeated computations of normals and
/// tangents, and corner_tangents() writes into the caller's memory. Tests:
/// tests/mesh/geometry/workspace_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <mutex>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/buffers.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Memory for intermediate results, which normals and tangents leave to the next call. The system
/// clears new memory at its first use, which costs up to a tenth of the time.
///
///     Workspace workspace;
///     for (each frame) {
///         const WorkspaceScope scope(workspace);
///         vertex_normals(positions, triangles, {}, normals);
///     }
///
/// Operations of several threads may share it; each has memory of its own then.
class Workspace {
  public:
    Workspace() = default;
    ~Workspace();
    Workspace(const Workspace&) = delete;
    Workspace& operator=(const Workspace&) = delete;

    /// The number of bytes that wait for the next call: at most what the calls so far used at once.
    [[nodiscard]] std::size_t size() const;
    /// Frees them.
    void clear();

  private:
    friend class WorkMemory;

    struct Block {
        void* memory = nullptr;
        std::size_t size = 0;
    };
    Block take(std::size_t size);
    void give_back(const Block& block) noexcept;

    mutable std::mutex mutex_;
    std::vector<Block> free_;  ///< Ascending by size.
    std::size_t taken_ = 0;
};

/// Lets everything that this thread calls use `workspace`, which must outlive the scope. In nested
/// scopes, the innermost one is used. Results do not depend on it.
class WorkspaceScope {
  public:
    explicit WorkspaceScope(Workspace& workspace);
    ~WorkspaceScope();
    WorkspaceScope(const WorkspaceScope&) = delete;
    WorkspaceScope& operator=(const WorkspaceScope&) = delete;

  private:
    Workspace* before_;
};

/// Writes the tangents of mikktspace_tangents() (tangents.h) into the caller's memory.
///
/// \param tangents  three per triangle, in corner order; must not overlap the inputs
/// \param execution  threads, progress and cancellation; the tangents do not depend on it
/// \throws InvalidInput as mikktspace_tangents(), and if there are not three tangents per triangle;
///         Cancelled, and then the tangents are undefined
void corner_tangents(StridedSpan<const glm::vec3> positions, StridedSpan<const glm::vec3> normals,
                     StridedSpan<const glm::vec2> texcoords, TriangleSpan triangles,
                     std::span<glm::vec4> tangents, Report& report = IgnoredReport(),
                     const ExecutionOptions& execution = {});

}  // namespace relief
