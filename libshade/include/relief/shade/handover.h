// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures on their way from the thread that draws to the one that shows them.
/// Tests: tests/shade/render/handover_test.cpp.
#pragma once

#include <memory>

#include "relief/shade/renderer.h"

namespace relief {

/// Three textures: one is shown, one waits to be, one is free to be copied into.
///
/// The two threads have contexts that share their textures (a window library makes such). The one
/// that draws owns this and calls put(), the other one calls get(): it never waits for a frame, and
/// never sees half of one.
class Handover {
  public:
    explicit Handover(const Context& context);
    ~Handover();
    Handover(const Handover&) = delete;
    Handover& operator=(const Handover&) = delete;

    /// Copies what the renderer drew last, and waits until it is there. Of 8-bit pictures.
    /// \param beside  another picture that is handed over at the same moment
    void put(const Renderer& renderer, const Renderer* beside = nullptr);

    /// The same for a picture that was drawn elsewhere: 8-bit RGB or RGBA, sRGB.
    void put(const Image& picture);

    struct Shown {
        unsigned texture = 0;  ///< 0: there is none yet. Row 0 at the bottom, sRGB codes.
        int width = 0;
        int height = 0;
        unsigned beside = 0;  ///< Of the same size; 0: there is none.
    };
    /// The newest; its texture is left alone until the next call.
    Shown get();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
