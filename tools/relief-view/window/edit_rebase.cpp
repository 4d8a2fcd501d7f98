// SPDX-License-Identifier: Apache-2.0
// Applies the edits of a scene to the same scene as it is read again. Fields are compared and
// copied by their descriptions. Tests: tests/tools/window/edit_rebase_test.cpp.
#include "window/edit_rebase.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "relief/shade/frame_settings.h"
#include "relief/shade/scene_fields.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Compares by name and path, because the file's contents may have changed.
bool is_same_image(const ImageSource& a, const ImageSource& b) {
    if (a.name != b.name || a.source.index() != b.source.index()) return false;
    const auto* file = std::get_if<std::filesystem::path>(&a.source);
    return file == nullptr || *file == std::get<std::filesystem::path>(b.source);
}

/// Compares two values of different scenes. Textures are equal if their images are.
template <typename T>
bool is_same(const T& a, const Scene& of_a, const T& b, const Scene& of_b) {
    if constexpr (is_optional_value<T>) {
        return a.has_value() == b.has_value() && (!a || is_same(*a, of_a, *b, of_b));
    } else if constexpr (has_fields<T>) {
        bool are_same = true;
        for_each_field<T>([&](const auto& field) {
            are_same = are_same && is_same(a.*field.member, of_a, b.*field.member, of_b);
        });
        if constexpr (std::is_same_v<T, Texture>)
            return are_same && is_same_image(of_a.images[a.image], of_b.images[b.image]);
        return are_same;
    } else {
        return a == b;
    }
}

template <typename T>
bool are_same(const std::vector<T>& a, const Scene& of_a, const std::vector<T>& b,
              const Scene& of_b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const T& one, const T& other) {
        return is_same(one, of_a, other, of_b);
    });
}

class EditRebase {
  public:
    EditRebase(const Scene& read, const Scene& edited, Scene& fresh)
        : read_(read), edited_(edited), fresh_(fresh) {}

    void rebase_materials();
    template <typename Light>
    void rebase_lights(const char* kind, std::vector<Light> Scene::*lights);
    void rebase_scene() {
        rebase(read_, edited_, fresh_);
        report_lost("the scene");
    }
    RebasedEdits take() { return std::move(result_); }

  private:
    /// Applies the edits of a value to the fresh value.
    template <typename T>
    void rebase(const T& read, const T& edited, T& fresh);

    /// Replaces image indices of the edited scene by those of the fresh scene.
    template <typename T>
    void import_images(T& value);
    std::size_t imported_image(std::size_t image);

    [[nodiscard]] std::optional<std::size_t> fresh_material(std::size_t material) const;

    /// Reports edits that were lost since the last call.
    void report_lost(const std::string& subject) {
        if (std::exchange(has_lost_, false))
            result_.lost.push_back("some edits of " + subject + " no longer apply");
    }

    const Scene& read_;
    const Scene& edited_;
    Scene& fresh_;
    bool has_lost_ = false;
    RebasedEdits result_;
};

std::size_t EditRebase::imported_image(std::size_t image) {
    const ImageSource& source = edited_.images[image];
    const auto known =
        std::find_if(fresh_.images.begin(), fresh_.images.end(),
                     [&](const ImageSource& one) { return is_same_image(one, source); });
    const auto place = static_cast<std::size_t>(known - fresh_.images.begin());
    if (known == fresh_.images.end()) fresh_.images.push_back(source);
    return place;
}

template <typename T>
void EditRebase::import_images(T& value) {
    if constexpr (is_optional_value<T>) {
        if (value) import_images(*value);
    } else if constexpr (std::is_same_v<T, Texture>) {
        value.image = imported_image(value.image);
    } else if constexpr (has_fields<T>) {
        for_each_field<T>([&](const auto& field) { import_images(value.*field.member); });
    }
}

template <typename T>
void EditRebase::rebase(const T& read, const T& edited, T& fresh) {
    if (is_same(read, read_, edited, edited_)) return;
    if constexpr (is_optional_value<T>) {
        if (read && edited && fresh) return rebase(*read, *edited, *fresh);
        // The edit added or removed the value, or changed a value that the file no longer has.
        const bool is_put = read.has_value() != edited.has_value();
        if (is_put && is_same(read, read_, fresh, fresh_)) {
            fresh = edited;
            import_images(fresh);
            ++result_.kept;
        } else if (!is_put) {
            has_lost_ = true;
        }
    } else if constexpr (has_fields<T>) {
        for_each_field<T>([&](const auto& field) {
            rebase(read.*field.member, edited.*field.member, fresh.*field.member);
        });
        if constexpr (std::is_same_v<T, Texture>) {
            if (is_same_image(read_.images[read.image], edited_.images[edited.image])) return;
            fresh.image = imported_image(edited.image);
            ++result_.kept;
        }
    } else {
        fresh = edited;
        ++result_.kept;
    }
}

std::optional<std::size_t> EditRebase::fresh_material(std::size_t material) const {
    const std::vector<Material>& all = fresh_.materials;
    const std::string& name = read_.materials[material].name;
    if (all.size() == read_.materials.size() && all[material].name == name) return material;
    if (name.empty()) return std::nullopt;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Material& one) { return one.name == name; });
    if (found == all.end()) return std::nullopt;
    return static_cast<std::size_t>(found - all.begin());
}

void EditRebase::rebase_materials() {
    const std::size_t count = std::min(read_.materials.size(), edited_.materials.size());
    for (std::size_t i = 0; i < count; ++i) {
        const Material& read = read_.materials[i];
        const Material& edited = edited_.materials[i];
        if (is_same(read, read_, edited, edited_)) continue;
        if (const std::optional<std::size_t> place = fresh_material(i)) {
            rebase(read, edited, fresh_.materials[*place]);
        } else {
            has_lost_ = true;
        }
        report_lost(material_label(read_, i));
    }
}

template <typename Light>
void EditRebase::rebase_lights(const char* kind, std::vector<Light> Scene::*lights) {
    const std::vector<Light>& read = read_.*lights;
    const std::vector<Light>& edited = edited_.*lights;
    std::vector<Light>& fresh = fresh_.*lights;
    if (are_same(read, read_, edited, edited_)) return;
    if (are_same(read, read_, fresh, fresh_)) {
        fresh = edited;
        ++result_.kept;
        return;
    }
    const bool has_places = fresh.size() == read.size();
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (i < edited.size() && is_same(read[i], read_, edited[i], edited_)) continue;
        if (has_places && edited.size() >= read.size()) {
            rebase(read[i], edited[i], fresh[i]);
        } else {
            has_lost_ = true;
        }
    }
    for (std::size_t i = read.size(); i < edited.size(); ++i) {
        fresh.push_back(edited[i]);
        ++result_.kept;
    }
    report_lost(fmt::format("{} lights", kind));
}

}  // namespace

RebasedEdits rebase_edits(const Scene& read, const Scene& edited, Scene& fresh) {
    EditRebase keeper(read, edited, fresh);
    keeper.rebase_materials();
    keeper.rebase_lights("directional", &Scene::directional_lights);
    keeper.rebase_lights("point", &Scene::point_lights);
    keeper.rebase_lights("spot", &Scene::spot_lights);
    keeper.rebase_scene();
    return keeper.take();
}

}  // namespace relief::tools
