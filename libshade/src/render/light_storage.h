// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene's lights on the GPU: a uniform block, or a buffer texture where they are too many.
/// Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <map>
#include <tuple>

#include "gl/buffer.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief {

/// One buffer for each way of counting the lights: one, unless a plan is forced.
class LightStorage {
  public:
    /// Uploads what these features want, at first sight. \throws GpuError
    void add(const gl::Api& api, const Scene& scene, const Features& features);

    /// Uploads the lights again, from the same scene at another time. \throws GpuError
    void update(const gl::Api& api, const Scene& scene);

    /// Binds what the program for these features reads.
    void bind(const gl::Api& api, const Features& features) const;

  private:
    struct Lights {
        Features features;
        gl::Buffer rows;
        gl::Texture texture;  ///< Only for lights in a buffer.
    };
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, bool, bool>;
    static Key key(const Features& features);

    std::map<Key, Lights> lights_;
};

}  // namespace relief
