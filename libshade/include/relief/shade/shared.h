// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines values that copies share until one is edited: meshes and images of scenes.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace shade {

/// A value that copies share until one of them is edited.
///
/// Several threads may read without a lock, also while another thread edits its own copy.
template <typename T>
class Shared {
    struct Held {
        T value;
        std::uint64_t edits = 0;
    };

  public:
    Shared() : held_(std::make_shared<Held>()) {}
    // The conversions are implicit, so that a Shared<T> can be used like a T.
    Shared(T value) : held_(std::make_shared<Held>(Held{std::move(value)})) {}  // NOLINT

    const T& operator*() const { return held_->value; }
    const T* operator->() const { return &held_->value; }
    operator const T&() const { return held_->value; }  // NOLINT

    /// The value for editing. It is copied first if other copies share it.
    T& edit() {
        if (held_.use_count() > 1) held_ = std::make_shared<Held>(*held_);
        ++held_->edits;
        return held_->value;
    }

    /// Identifies an unedited value without keeping it in memory.
    class Identity {
      public:
        explicit Identity(const Shared& shared)
            : held_(shared.held_), edits_(shared.held_->edits) {}

        /// Returns true if this is the same object, not only an equal one, and has not been edited
        /// since.
        [[nodiscard]] bool is(const Shared& shared) const {
            const bool is_other =
                held_.owner_before(shared.held_) || shared.held_.owner_before(held_);
            return !is_other && edits_ == shared.held_->edits;
        }

      private:
        std::weak_ptr<const Held> held_;
        std::uint64_t edits_;
    };
    [[nodiscard]] Identity identity() const { return Identity(*this); }

  private:
    std::shared_ptr<Held> held_;
};

}  // namespace shade
}  // namespace relief
