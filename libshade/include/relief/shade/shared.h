// SPDX-License-Identifier: Apache-2.0
/// \file
/// Large values that copies have in common: a scene with millions of triangles is copied like a few
/// numbers. Tests: tests/shade/scene/shared_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

namespace relief {

/// A value that copies share until one of them is edited.
///
/// Reading from several threads needs no lock, also while another thread edits its own copy.
template <typename T>
class Shared {
    struct Held {
        T value;
        std::uint64_t edits = 0;
    };

  public:
    Shared() : held_(std::make_shared<Held>()) {}
    // Wherever a T is taken, so that sharing is no business of those who make one.
    Shared(T value) : held_(std::make_shared<Held>(Held{std::move(value)})) {}  // NOLINT

    const T& operator*() const { return held_->value; }
    const T* operator->() const { return &held_->value; }
    operator const T&() const { return held_->value; }  // NOLINT: likewise where one is read.

    /// To change it; copies keep what they have, for which it is copied if there are any.
    T& edit() {
        if (held_.use_count() > 1) held_ = std::make_shared<Held>(*held_);
        ++held_->edits;
        return held_->value;
    }

    /// Tells an unedited value from all others, without keeping it in memory.
    class Identity {
      public:
        explicit Identity(const Shared& shared)
            : held_(shared.held_), edits_(shared.held_->edits) {}

        /// Whether this is the very value, not only an equal one, and not edited since.
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

}  // namespace relief
