// SPDX-License-Identifier: Apache-2.0
// Checks of models: the conditions of their meshes, weighed by their materials, what they need for
// their textures, and their embedded images. Tests: tests/check/relief_check_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <map>
#include <new>
#include <set>
#include <utility>
#include <variant>

#include "check_files.h"
#include "common/command.h"
#include "common/model_file.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/model.h"
#include "relief/mesh/texcoord_quality.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// Up to this share of the vertices, normals against their triangles are a note: rounding of sharp
/// corners, as in most hand-made models.
constexpr double max_opposed_share = 0.01;

/// The findings of one rule and severity in all parts of a model.
struct FindingSum {
    CheckFinding finding;
    Finding first;
    std::size_t parts = 0;
};

/// Adds up findings of parts, so that a model with a hundred equal parts has one finding.
class FindingSums {
  public:
    void add(const CheckRule& rule, CheckSeverity severity, const std::string& place,
             const Finding& finding) {
        const auto found = std::ranges::find_if(sums_, [&](const FindingSum& sum) {
            return sum.finding.rule == &rule && sum.finding.severity == severity;
        });
        if (found == sums_.end()) {
            sums_.push_back(
                {{&rule, severity, place, "", finding.count, rule.is_fixable()}, finding, 1});
        } else {
            found->finding.count += finding.count;
            ++found->parts;
        }
    }

    void move_to(CheckedItem& item) {
        for (FindingSum& sum : sums_) {
            sum.finding.text = to_string(sum.first);
            if (sum.parts > 1) {
                sum.finding.text +=
                    fmt::format(" ({} in {})", sum.finding.count, counted(sum.parts, "primitive"));
            }
            sum.finding.is_fixable = sum.finding.is_fixable && can_be_fixed(item.file);
            item.findings.push_back(std::move(sum.finding));
        }
    }

  private:
    std::vector<FindingSum> sums_;
};

/// The severity of a condition of a part. A defect that its material does not show is a note.
/// \param shows_tangent_maps  the material has a map in the tangent frame
CheckSeverity severity_of(const MeshConditionCount& found, const CheckedPart& part,
                          bool shows_tangent_maps) {
    const CheckSeverity severity = check_rule_of(found.condition).severity;
    switch (found.condition) {
        case MeshCondition::texture_degenerate:
            // With stored tangents, the texture is a line there, but shades right.
            return shows_tangent_maps && !part.tangents ? severity : CheckSeverity::note;
        case MeshCondition::tangent_along_normal:
            return shows_tangent_maps ? severity : CheckSeverity::note;
        case MeshCondition::normal_opposed:
            return static_cast<double>(found.count) >
                           max_opposed_share * static_cast<double>(part.vertices)
                       ? severity
                       : CheckSeverity::note;
        default:
            return severity;
    }
}

void add_conditions(const CheckedPart& part, bool shows_tangent_maps, FindingSums& sums) {
    for (const MeshConditionCount& found : part.diagnosis.conditions)
        sums.add(check_rule_of(found.condition), severity_of(found, part, shows_tangent_maps),
                 part.name, to_finding(found));
}

void add_tangent_findings(const CheckedPart& part, bool shows_tangent_maps, FindingSums& sums) {
    const auto add = [&](const char* id, const char* kind, const char* outcome) {
        const CheckRule& rule = rule_named(id);
        sums.add(rule, rule.severity, part.name, {kind, "primitive", outcome, 1, {}});
    };
    if (!part.tangents) {
        if (shows_tangent_maps)
            add("model/no-tangents", "normal map without tangents",
                "each program computes its own");
        return;
    }
    const CheckedTangents& tangents = *part.tangents;
    if (!tangents.has_normals)
        return add("model/tangents-ignored", "tangents without normals", "glTF ignores them");
    if (tangents.has_texcoords && tangents.identified.corners > 0 && !tangents.identified.method &&
        shows_tangent_maps)
        add("model/unknown-tangents", "tangents of an unknown method",
            "a map may be baked for others");
}

void add_reading(const CheckedModel& model, CheckedItem& item) {
    for (const Finding& finding : model.reading_problems.findings()) {
        // The conditions of the mesh have it, with its vertex.
        if (finding.kind.starts_with("non-finite ")) continue;
        const bool is_missing = finding.kind.starts_with("missing image");
        const bool is_outside = finding.kind.starts_with("image outside");
        const char* const id = is_missing   ? "model/missing-image"
                               : is_outside ? "model/image-outside"
                                            : "model/incomplete";
        item.add(rule_named(id), "", is_missing ? finding.kind : to_string(finding), finding.count);
    }
    for (const Finding& finding : model.reading_notes.findings())
        item.add(rule_named("model/reader-note"), "", to_string(finding), finding.count);
}

// Areas, for the texel density.

/// Adds the areas of triangles in space and in the image.
void add_areas(const Mesh& mesh, std::span<const glm::uvec3> triangles,
               const glm::mat4& world_from_object, MaterialFigures& surface) {
    if (mesh.texcoords.empty()) return;
    const auto position = [&](std::uint32_t vertex) {
        return glm::dvec3(glm::dmat4(world_from_object) *
                          glm::dvec4(glm::dvec3(mesh.positions[vertex]), 1.0));
    };
    for (const glm::uvec3& triangle : triangles) {
        const glm::dvec3 a = position(triangle.x);
        const glm::dvec3 normal = glm::cross(position(triangle.y) - a, position(triangle.z) - a);
        const glm::dvec2 p = mesh.texcoords[triangle.x];
        const glm::dvec2 u = glm::dvec2(mesh.texcoords[triangle.y]) - p;
        const glm::dvec2 v = glm::dvec2(mesh.texcoords[triangle.z]) - p;
        const double surface_area = 0.5 * std::sqrt(glm::dot(normal, normal));
        const double texture_area = 0.5 * std::abs(u.x * v.y - u.y * v.x);
        if (!std::isfinite(surface_area) || !std::isfinite(texture_area)) continue;
        surface.surface_area += surface_area;
        surface.texture_area += texture_area;
    }
}

// Documents of glTF.

std::string name_of_material(const GltfMaterial& material, std::size_t index) {
    return material.name.empty() ? fmt::format("material {}", index) : material.name;
}

bool shows_tangent_maps(const GltfMaterial& material) {
    return std::ranges::any_of(texture_slots, [&](const TextureSlotInfo& slot) {
        return slot.in_tangent_frame && find_texture(material, slot.slot) != nullptr;
    });
}

/// The checks of one document.
class DocumentCheck {
  public:
    DocumentCheck(const GltfDocument& document, const CheckedModel& model, CheckedItem& item)
        : document_(document), view_(document.view()), model_(model), item_(item) {}

    void run() {
        const std::vector<GltfPrimitiveId> primitives = document_.triangle_primitives();
        for (std::size_t i = 0; i < primitives.size(); ++i)
            check_primitive(primitives[i], model_.parts[i]);
        sums_.move_to(item_);
        item_.model.materials = view_.materials.size();
        check_images();
        add_surfaces();
        check_baked_charts();
    }

  private:
    /// Returns the material of a primitive; null if it has none.
    const GltfMaterial* material_of(const Mesh& mesh) const {
        if (mesh.material_ranges.empty() || !mesh.material_ranges.front().material) return nullptr;
        const std::uint32_t index = *mesh.material_ranges.front().material;
        return index < view_.materials.size() ? &view_.materials[index] : nullptr;
    }

    void check_primitive(GltfPrimitiveId id, const CheckedPart& part) {
        const GltfMaterial* const material = material_of(document_.mesh(id));
        const bool is_mapped = material != nullptr && shows_tangent_maps(*material);
        add_conditions(part, is_mapped, sums_);
        add_tangent_findings(part, is_mapped, sums_);
        if (material == nullptr) return;
        const std::vector<int> sets = document_.texcoord_sets(id);
        std::set<int> missing;
        for (const TextureSlotInfo& slot : texture_slots) {
            if (find_texture(*material, slot.slot) == nullptr) continue;
            const int set = material->texcoords_of(slot.slot).set;
            if (std::ranges::find(sets, set) == sets.end()) missing.insert(set);
        }
        const CheckRule& rule = rule_named("model/missing-texcoords");
        for (const int set : missing) {
            sums_.add(rule, rule.severity, part.name,
                      {fmt::format("primitive without texture coordinate set {}", set),
                       "primitive",
                       "a texture of its material is looked up there",
                       1,
                       {}});
        }
    }

    /// Returns the materials that use each image.
    [[nodiscard]] std::map<std::size_t, std::vector<ImageRole>> roles() const {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < view_.materials.size(); ++i)
            names.push_back(name_of_material(view_.materials[i], i));
        std::map<std::size_t, std::vector<ImageRole>> roles;
        for (std::size_t i = 0; i < view_.materials.size(); ++i) {
            for (const TextureSlotInfo& slot : texture_slots) {
                const Texture* const texture = find_texture(view_.materials[i], slot.slot);
                if (texture == nullptr || texture->image >= view_.images.size()) continue;
                roles[texture->image].push_back({slot.slot, true, names[i], names});
            }
        }
        return roles;
    }

    /// Returns the absolute path of an image as that of the model is written.
    [[nodiscard]] fs::path shown(const fs::path& file) const {
        const fs::path folder = fs::absolute(item_.file).parent_path();
        const fs::path relative = file.lexically_relative(folder);
        return relative.empty() ? file : item_.file.parent_path() / relative;
    }

    void check_images() {
        const auto roles_of = roles();
        item_.model.embedded.resize(view_.images.size());
        for (std::size_t i = 0; i < view_.images.size(); ++i) {
            const GltfImage& image = view_.images[i];
            const auto found = roles_of.find(i);
            std::vector<ImageRole> roles =
                found == roles_of.end() ? std::vector<ImageRole>{} : found->second;
            std::ranges::sort(roles);
            if (const auto* const file = std::get_if<fs::path>(&image.source)) {
                std::error_code ignored;
                if (!image.fault.empty() || !fs::is_regular_file(*file, ignored)) {
                    // The reader reported it. If it appears, the model is checked again.
                    if (!file->empty()) item_.inputs.emplace(*file, stamp_of(*file));
                    continue;
                }
                for (const ImageRole& role : roles)
                    item_.images.push_back({shown(*file), role});
                continue;
            }
            if (image.fault.find("leads out") != std::string::npos) continue;  // As before.
            item_.model.embedded[i] = check_embedded_image(image, i, roles, item_);
        }
    }

    void add_surfaces() {
        std::map<std::size_t, MaterialFigures> surfaces;
        std::set<std::pair<std::size_t, std::size_t>> seen;
        for (const auto& instance : view_.primitives) {
            if (!seen.emplace(instance.what.mesh, instance.what.primitive).second) continue;
            const GltfMaterial* const material = material_of(document_.mesh(instance.what));
            if (material == nullptr) continue;
            const bool has_color = find_texture(*material, TextureSlot::base_color) != nullptr;
            const TextureSlot slot = has_color ? TextureSlot::base_color : TextureSlot::normal;
            const Texture* const texture = find_texture(*material, slot);
            if (texture == nullptr || texture->image >= view_.images.size()) continue;
            const auto index = static_cast<std::size_t>(material - view_.materials.data());
            MaterialFigures& surface = surfaces[index];
            surface.name = name_of_material(*material, index);
            if (const auto* const file =
                    std::get_if<fs::path>(&view_.images[texture->image].source))
                surface.file = shown(*file);
            else
                surface.embedded = texture->image;
            const GltfTexcoords& texcoords = material->texcoords_of(slot);
            Mesh mesh = document_.mesh(instance.what, texcoords.set);
            for (glm::vec2& texcoord : mesh.texcoords)
                texcoord *= texcoords.transform.scale;
            add_areas(mesh, mesh.triangles, instance.world_from_object, surface);
        }
        for (auto& [index, surface] : surfaces)
            item_.model.surfaces.push_back(std::move(surface));
    }

    /// Charts of a map that relief baked must not overlap. Only its file says so.
    void check_baked_charts() {
        for (std::size_t i = 0; i < view_.materials.size(); ++i) {
            const GltfMaterial& material = view_.materials[i];
            const auto size = size_of_baked_map(material);
            if (!size) continue;
            Mesh all;
            std::vector<std::uint32_t> first_vertices;
            std::optional<std::size_t> last_mesh;
            for (const GltfPrimitiveId id : document_.triangle_primitives()) {
                const Mesh mesh = document_.mesh(id, document_.tangent_texcoords(id).set);
                if (material_of(mesh) != &material || mesh.texcoords.empty()) continue;
                const auto first = static_cast<std::uint32_t>(all.positions.size());
                if (last_mesh != id.mesh) first_vertices.push_back(first);
                last_mesh = id.mesh;
                all.positions.insert(all.positions.end(), mesh.positions.begin(),
                                     mesh.positions.end());
                all.texcoords.insert(all.texcoords.end(), mesh.texcoords.begin(),
                                     mesh.texcoords.end());
                for (const glm::uvec3& triangle : mesh.triangles)
                    all.triangles.push_back(triangle + first);
            }
            if (all.triangles.empty()) continue;
            Report ignored;
            const TexcoordQuality quality = measure_texcoords(all, *size, ignored, first_vertices);
            if (quality.overlapping == 0) continue;
            const std::string name = name_of_material(material, i);
            item_.add(rule_named("model/overlapping-bake"), fmt::format("material '{}'", name),
                      fmt::format("{} of its baked map share an area with others",
                                  counted(quality.overlapping, "triangle")),
                      quality.overlapping);
        }
    }

    /// Returns the size of the first map of a material that has the record of a bake.
    [[nodiscard]] std::optional<glm::ivec2> size_of_baked_map(const GltfMaterial& material) const {
        for (const TextureSlot slot : {TextureSlot::normal, TextureSlot::occlusion}) {
            const Texture* const texture = find_texture(material, slot);
            if (texture == nullptr || texture->image >= view_.images.size()) continue;
            const GltfImage& image = view_.images[texture->image];
            if (!image.fault.empty()) continue;
            try {
                const auto* const file = std::get_if<fs::path>(&image.source);
                const ImageInfo info =
                    file != nullptr
                        ? read_image_info(*file)
                        : read_image_info(std::get<std::vector<std::byte>>(image.source), "image");
                if (info.metadata.contains("relief:bake"))
                    return glm::ivec2(info.width, info.height);
            } catch (const FileError&) {
                continue;  // The check of the image reports it.
            }
        }
        return std::nullopt;
    }

    const GltfDocument& document_;
    const GltfView view_;
    const CheckedModel& model_;
    CheckedItem& item_;
    FindingSums sums_;
};

// Mesh files.

/// Returns the images of the materials of a file, and of their names.
std::vector<UsedImage> images_of(const MeshFile& contents, CheckedItem& item) {
    struct Slot {
        TextureSlot slot;
        std::optional<fs::path> MtlMaterial::*map;
    };
    static constexpr std::array slots = {Slot{TextureSlot::base_color, &MtlMaterial::diffuse_map},
                                         Slot{TextureSlot::specular, &MtlMaterial::specular_map},
                                         Slot{TextureSlot::emission, &MtlMaterial::emission_map},
                                         Slot{TextureSlot::opacity, &MtlMaterial::opacity_map},
                                         Slot{TextureSlot::normal, &MtlMaterial::normal_map},
                                         Slot{TextureSlot::bump, &MtlMaterial::bump_map}};
    std::vector<UsedImage> images;
    for (const MtlMaterial& material : contents.materials) {
        for (const Slot& slot : slots) {
            const std::optional<fs::path>& map = material.*slot.map;
            if (!map) continue;
            const std::string place = fmt::format("material '{}'", material.name);
            std::error_code ignored;
            if (!material.may_read(*map)) {
                item.add(rule_named("model/image-outside"), place,
                         fmt::format("'{}' is outside of the folder", map->string()));
            } else if (!fs::is_regular_file(*map, ignored)) {
                item.inputs.emplace(*map, stamp_of(*map));
                item.add(rule_named("model/missing-image"), place,
                         fmt::format("missing image '{}'", map->filename().string()));
            } else {
                images.push_back({*map, {slot.slot, false, material.name, {}}});
            }
        }
    }
    return images;
}

void check_mesh_file(const MeshFile& contents, const CheckedModel& model, const CheckInput& input,
                     CheckedItem& item) {
    item.images = images_of(contents, item);
    item.images.insert(item.images.end(), input.paired.begin(), input.paired.end());
    item.model.materials = contents.materials.size();
    const auto in_tangent_frame = [](const UsedImage& image) {
        return slot_info(image.role.slot).in_tangent_frame;
    };
    const bool is_mapped = std::ranges::any_of(item.images, in_tangent_frame);
    FindingSums sums;
    add_conditions(model.parts.front(), is_mapped, sums);
    sums.move_to(item);
    const Mesh& mesh = contents.mesh;
    if (mesh.texcoords.empty() && !item.images.empty()) {
        item.add(rule_named("model/missing-texcoords"), "",
                 fmt::format("has no texture coordinates, but {}",
                             counted(item.images.size(), "texture")));
    }
    const auto shown = std::ranges::find_if(item.images, [](const UsedImage& image) {
        return image.role.slot == TextureSlot::base_color || image.role.slot == TextureSlot::normal;
    });
    if (shown == item.images.end()) return;
    MaterialFigures surface;
    surface.name = shown->role.material;
    surface.file = shown->file;
    add_areas(mesh, mesh.triangles, glm::mat4(1.0F), surface);
    item.model.surfaces.push_back(std::move(surface));
}

void check_contents(const CheckInput& input, CheckedItem& item) {
    Report reading;
    const Model contents = read_model(input.file, reading);
    about(input.file, [&] {
        const CheckedModel model = check_model(contents, reading, false);
        add_reading(model, item);
        for (const CheckedPart& part : model.parts) {
            item.model.triangles += part.triangles;
            item.model.vertices += part.vertices;
        }
        if (const auto* const document = std::get_if<GltfDocument>(&contents))
            DocumentCheck(*document, model, item).run();
        else
            check_mesh_file(std::get<MeshFile>(contents), model, input, item);
    });
    if (item.model.triangles == 0)
        item.add(rule_named("model/no-triangles"), "", "has no triangles");
}

}  // namespace

std::string reason_of(const std::string& message, const fs::path& file) {
    const std::string prefix = file.string() + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

CheckedItem check_model_file(const CheckInput& input) {
    CheckedItem item;
    item.file = input.file;
    Progress progress;
    const ProgressScope scope(progress);
    try {
        check_contents(input, item);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::bad_alloc&) {
        item.is_unreadable = true;
        item.add(rule_named("file/unreadable"), "", "out of memory");
    } catch (const std::exception& error) {
        item.is_unreadable = true;
        item.add(rule_named("file/unreadable"), "", reason_of(error.what(), input.file));
    }
    item.inputs.merge(progress.files());
    return item;
}

}  // namespace relief::tools
