// SPDX-License-Identifier: Apache-2.0
/// \file
/// Passes pictures from the drawing thread to the thread that shows them.
#pragma once

#include <memory>

#include "relief/shade/renderer.h"

namespace relief {

/// A triple buffer of textures: one is shown, one is the next, one is free for the next copy.
///
/// The contexts of both threads share textures (a window library creates them). The drawing thread
/// owns this object and calls put(); the other thread calls get(), which never waits for a frame
/// and never returns an incomplete one.
class PictureExchange {
  public:
    explicit PictureExchange(const Context& context);
    ~PictureExchange();
    PictureExchange(const PictureExchange&) = delete;
    PictureExchange& operator=(const PictureExchange&) = delete;

    /// Copies the last picture of the renderer, which must have 8 bits, and waits for the copy.
    /// \param beside  a second picture that is passed on together with the first
    void put(const Renderer& renderer, const Renderer* beside = nullptr);

    /// Passes on another picture: 8-bit RGB or RGBA, sRGB.
    void put(const Image& picture);

    struct Shown {
        unsigned texture = 0;  ///< 0 before the first. Row 0 at the bottom, sRGB codes.
        int width = 0;
        int height = 0;
        unsigned beside = 0;  ///< The second picture, of the same size; 0 if there is none.
    };
    /// Returns the newest picture; its texture does not change until the next call.
    Shown get();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
