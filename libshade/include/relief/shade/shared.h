// SPDX-License-Identifier: Apache-2.0
/// \file
/// Large values that copies have in common: a scene with millions of triangles is copied like a few
/// numbers. Tests: tests/shade/scene/shared_test.cpp.
#pragma once

#include <memory>
#include <utility>

namespace relief {

/// A value that copies share until one of them is edited.
///
/// Reading from several threads needs no lock, also while another thread edits its own copy.
template <typename T>
class Shared {
  public:
    Shared() : value_(std::make_shared<T>()) {}
    // Wherever a T is taken, so that sharing is no business of those who make one.
    Shared(T value) : value_(std::make_shared<T>(std::move(value))) {}  // NOLINT

    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }
    operator const T&() const { return *value_; }  // NOLINT: likewise where one is read.

    /// To change it; copies keep what they have, for which it is copied if there are any.
    T& edit() {
        if (value_.use_count() > 1) value_ = std::make_shared<T>(*value_);
        return *value_;
    }

    /// Whether both are one value, not only equal ones.
    [[nodiscard]] bool is_same(const Shared& other) const { return value_ == other.value_; }

  private:
    std::shared_ptr<T> value_;
};

}  // namespace relief
