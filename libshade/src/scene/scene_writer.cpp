// SPDX-License-Identifier: Apache-2.0
// Writes the differences from the scene as its file gives it. Materials and lights are compared as
// JSON, the form in which they are written.
#include "relief/shade/scene_file.h"

#include <fmt/format.h>

#include <map>
#include <numbers>
#include <span>

#include "file_replacement.h"
#include "files.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "scene/json_fields.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

bool is_scene_file(const std::filesystem::path& file) {
    return file.extension() == ".json";
}

/// Returns the text of a path. \throws InvalidInput if JSON, which is UTF-8, cannot hold it
std::string json_text(const std::filesystem::path& path) {
    std::string text = path.string();
    if (!is_utf8(text))
        throw InvalidInput("a scene file cannot name " + text + ", which is not UTF-8");
    return text;
}

/// Returns the path of a file relative to a folder.
std::string relative_path(const std::filesystem::path& folder, const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    const fs::path absolute = fs::absolute(file).lexically_normal();
    const fs::path begin = fs::absolute(folder.empty() ? "." : folder).lexically_normal();
    // The path of "." ends in a slash, which has no file name.
    const fs::path relative =
        absolute.lexically_relative(begin.has_filename() ? begin : begin.parent_path());
    return json_text(relative.empty() ? absolute : relative);
}

/// Returns all lights, in the world.
Json lights_json(const Scene& scene) {
    Json lights = Json::array();
    const auto add = [&](const char* type, const auto& all) {
        for (const auto& light : all) {
            Json& object = lights.emplace_back(Json{{"type", type}});
            add_fields(object, light, {});
        }
    };
    add("directional", scene.directional_lights);
    add("point", scene.point_lights);
    add("spot", scene.spot_lights);
    return lights;
}

class SceneWriter {
  public:
    SceneWriter(const std::filesystem::path& file, const SceneToSave& saved)
        : file_(file), saved_(saved), scene_(saved.scene) {
        // Scene files read materials as they are, so the differences are from those.
        SceneOptions options = saved.options;
        options.model = SceneOptions::MaterialModel::as_authored;
        Report ignored;
        loaded_ = load_scene(saved.source, options, ignored);
        name_default_material(loaded_);
        name_default_material(scene_);
    }

    void write() {
        check_meshes();
        begin();
        write_materials();
        write_lights();
        write_settings();
        // The matrix keeps the camera without loss.
        json_["camera"] = {{"matrix", matrix_json(saved_.camera.world_from_view)}};
        add_fields(json_["camera"], saved_.camera, {});
        json_["picture"] = {{"width", saved_.size.x}, {"height", saved_.size.y}};
        FileSet files;
        for (const auto& [image, path] : new_images_)
            write_image(path, *std::get<Shared<Image>>(scene_.images[image].source));
        const std::string text = json_.dump(2) + "\n";
        replace_file(file_, std::as_bytes(std::span(text)));
        files.commit();
    }

  private:
    void check_meshes() const {
        bool are_same = loaded_.instances.size() == scene_.instances.size() &&
                        loaded_.meshes.size() == scene_.meshes.size() &&
                        loaded_.materials.size() == scene_.materials.size();
        for (std::size_t i = 0; are_same && i < scene_.instances.size(); ++i) {
            are_same =
                loaded_.instances[i].world_from_object == scene_.instances[i].world_from_object &&
                loaded_.instances[i].mesh == scene_.instances[i].mesh;
        }
        if (!are_same) {
            throw InvalidInput(
                fmt::format("the positions of meshes differ from {} (by --time or light markers), "
                            "which a scene file cannot store",
                            saved_.source.string()));
        }
    }

    /// Starts from the source: a scene with the model, or the scene file itself.
    void begin() {
        if (!is_scene_file(saved_.source)) {
            json_["relief_scene"] = 1;
            Json node = {{"model", relative_path(file_.parent_path(), saved_.source)}};
            if (is_z_up(saved_.source, saved_.options))
                node["matrix"] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
            if (saved_.options.material_variant)
                node["material_variant"] = *saved_.options.material_variant;
            if (saved_.options.normals != NormalMode::keep)
                node["normals"] = enum_name(saved_.options.normals);
            if (saved_.options.crease_angle)
                node["crease"] = *saved_.options.crease_angle * 180.0 / std::numbers::pi;
            json_["nodes"] = Json::array({std::move(node)});
            return;
        }
        if (std::filesystem::absolute(file_).parent_path().lexically_normal() !=
            std::filesystem::absolute(saved_.source).parent_path().lexically_normal()) {
            throw InvalidInput("a scene file names other files relative to its folder, so " +
                               saved_.source.string() + " can be saved in its own folder only");
        }
        json_ = Json::parse(read_file(saved_.source));
        if (json_.contains("nodes")) drop_cameras(json_["nodes"]);
    }

    /// Removes the cameras of nodes: a scene has one camera, which is written below.
    static void drop_cameras(Json& nodes) {
        for (Json& node : nodes) {
            node.erase("camera");
            if (node.contains("children")) drop_cameras(node["children"]);
        }
    }

    void write_materials() {
        Json edits = json_.contains("material_edits") ? json_["material_edits"] : Json::array();
        bool is_edited = !edits.empty();
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            const Json before = fields_json(loaded_.materials[i], loaded_name());
            const Json now = fields_json(scene_.materials[i], name());
            if (edits.size() <= i) edits.push_back(nullptr);
            for (const auto& [key, value] : now.items()) {
                if (value == before[key]) continue;
                edits[i][key] = value;
                is_edited = true;
            }
        }
        if (is_edited) json_["material_edits"] = std::move(edits);
    }

    void write_lights() {
        if (lights_json(loaded_) == lights_json(scene_) && loaded_.ambient == scene_.ambient)
            return;
        json_["only_lights"] = lights_json(scene_);
        json_[ambient_field.name] = value_json(ambient_field, scene_.ambient, {});
    }

    void write_settings() {
        for_each_field<Scene>([&](const auto& field) {
            const auto& value = scene_.*field.member;
            // The environment follows below, and the ambient light belongs to the lights.
            using Value = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<Value, std::optional<Environment>>) {
                json_.erase(field.name);
            } else if constexpr (is_optional_value<Value>) {
                json_.erase(field.name);
                if (value) json_[field.name] = value_json(field, value, {});
            } else if (std::string_view(field.name) != ambient_field.name) {
                json_[field.name] = value_json(field, value, {});
            }
        });
        if (!scene_.environment) return;
        json_["environment"] =
            environment_json(*scene_.environment, [&](const ImageSource& source) -> Json {
                const auto* path = std::get_if<std::filesystem::path>(&source.source);
                if (path == nullptr)
                    throw InvalidInput("the environment is not a file, but " + source.name);
                return relative_path(file_.parent_path(), *path);
            });
    }

    /// Images of the model keep their numbers, so that unchanged textures compare equal.
    [[nodiscard]] static ImageName loaded_name() {
        return [](std::size_t image) { return Json(image); };
    }

    [[nodiscard]] ImageName name() {
        return [this](std::size_t image) -> Json {
            if (image < loaded_.images.size()) return image;
            const ImageSource& source = scene_.images.at(image);
            if (const auto* path = std::get_if<std::filesystem::path>(&source.source))
                return relative_path(file_.parent_path(), *path);
            if (!std::holds_alternative<Shared<Image>>(source.source))
                throw InvalidInput(source.name + " is an image in memory, which cannot be named");
            return json_text(new_image(image).filename());
        };
    }

    /// The file for an image that exists in memory only.
    const std::filesystem::path& new_image(std::size_t image) {
        const auto [entry, is_new] = new_images_.try_emplace(image);
        if (is_new) {
            entry->second =
                file_.parent_path() /
                fmt::format("{}-image-{}.png", file_.stem().string(), new_images_.size());
            if (std::filesystem::exists(entry->second))
                throw FileError(entry->second, "already exists");
        }
        return entry->second;
    }

    const std::filesystem::path& file_;
    const SceneToSave& saved_;
    Scene scene_;
    Scene loaded_;
    Json json_;
    std::map<std::size_t, std::filesystem::path> new_images_;
};

}  // namespace

void save_scene(const std::filesystem::path& file, const SceneToSave& saved) {
    SceneWriter(file, saved).write();
}

}  // namespace relief::shade
