// SPDX-License-Identifier: Apache-2.0
// Scenes and their pictures.
// Tests: tests/python/test_command_line.py.
#include <filesystem>
#include <memory>
#include <numbers>
#include <tuple>

#include "arrays.h"
#include "map_kind.h"
#include "mesh_type.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/shade/effects.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_graph.h"

namespace relief::python {
using namespace relief::shade;

namespace {

using Text = std::optional<std::string>;
using Color = std::tuple<float, float, float>;
using ColorAndAlpha = std::tuple<float, float, float, float>;

glm::vec3 vector_of(const Color& color) {
    return {std::get<0>(color), std::get<1>(color), std::get<2>(color)};
}

float radians(double degrees) {
    return static_cast<float>(degrees * std::numbers::pi / 180.0);
}

/// A scene, and the size of pictures that its file states.
struct SceneObject {
    Scene scene;
    std::optional<glm::ivec2> size;
    std::vector<MapKind> assumed;  ///< The kinds of `assume`: such findings are left out.
};

/// Loads a scene with the background and the environment that relief-view draws.
SceneObject load(const FileName& file, bool studio, const std::vector<std::string>& assume,
                 const FindingList& report) {
    Report findings;
    const std::vector<MapKind> assumed = assumed_kinds(assume);
    SceneObject loaded = without_gil([&] {
        SceneGraph graph = load_scene_graph(file, SceneOptions{}, findings);
        const bool is_model = file.extension() != ".json";
        if (!is_model) check_scene_maps(graph.scene, file, assumed);
        if (is_model) graph.scene.background = default_background;
        if (is_model && studio) (void)add_default_environment(graph.scene);
        return SceneObject{std::move(graph.scene), graph.picture_size, assumed};
    });
    append(without_assumed(findings, assumed), report);
    return loaded;
}

SceneObject new_scene(const MeshObject& mesh, const Color& diffuse, const Color& specular,
                      float shininess, const Text& material, const py::object& normal_map,
                      const std::string& green, const std::string& normal_space, const Text& assume,
                      const FindingList& report) {
    Report findings;
    constexpr auto spaces = std::to_array<EnumName<NormalSpace>>(
        {{"tangent", NormalSpace::tangent}, {"object", NormalSpace::object}});
    Material surface;
    if (material) {
        const std::optional<Material> named = material_by_name(*material);
        if (!named) refuse_name("material", *material, material_names());
        surface = *named;
    } else {
        surface.diffuse = vector_of(diffuse);
        surface.ambient = surface.diffuse;
        surface.specular = vector_of(specular);
        surface.shininess = shininess;
    }
    SceneObject result;
    if (assume) result.assumed = {MapKind::normal};
    Scene& scene = result.scene;
    if (!normal_map.is_none()) {
        Image image = image_of(normal_map, "normal_map", findings);
        without_gil(
            [&] { check_kind(image, "normal_map", accepted_kinds(TextureSlot::normal), assume); });
        scene.images.push_back({.name = "normal map", .source = Shared(std::move(image))});
        NormalMap map;
        map.texture.image = 0;
        map.green = value_of<Green>(green, "green");
        map.space = value_of<NormalSpace>(normal_space, "normal_space", spaces);
        surface.normal_map = map;
    }
    surface.double_sided = true;
    Mesh copy = mesh;
    if (copy.normals.empty()) {
        FrameOptions options;
        options.normals = NormalWeight::angle;
        copy = without_gil([&] { return with_frames(std::move(copy), options, findings).mesh; });
    }
    copy.material_ranges = {
        {.triangle_count = static_cast<std::uint32_t>(copy.triangles.size()), .material = 0}};
    scene.meshes.emplace_back(std::move(copy));
    scene.materials.push_back(std::move(surface));
    scene.instances.push_back({.mesh = 0, .name = mesh.name});
    scene.background = default_background;
    append(findings, report);
    return result;
}

/// The view of a picture, as the options of relief-view.
struct ViewRequest {
    std::optional<std::pair<int, int>> size;
    int samples = 4;
    std::string output = "srgb";
    std::optional<std::tuple<double, double, double>> camera;  ///< Degrees, degrees, factor.
    std::optional<double> fov_degrees;
    std::string backend = "auto";
};

Camera camera_of(const Scene& scene, const ViewRequest& view, float aspect) {
    if (scene.camera && !view.camera) {
        Camera camera = *scene.camera;
        if (view.fov_degrees) camera.vertical_fov = radians(*view.fov_degrees);
        return camera;
    }
    const float fov = view.fov_degrees ? radians(*view.fov_degrees) : default_vertical_fov;
    if (!view.camera) return framed(scene, default_azimuth, default_elevation, fov, aspect);
    const auto& [azimuth, elevation, factor] = *view.camera;
    return framed(scene, radians(azimuth), radians(elevation), fov, aspect,
                  static_cast<float>(factor));
}

FrameSettings settings_of(const SceneObject& object, const ViewRequest& view) {
    constexpr auto codings =
        std::to_array<EnumName<OutputCoding>>({{"srgb", OutputCoding::srgb},
                                               {"linear", OutputCoding::linear},
                                               {"clamped", OutputCoding::clamped}});
    FrameSettings settings;
    if (view.size) {
        settings.width = view.size->first;
        settings.height = view.size->second;
    } else if (object.size) {
        settings.width = object.size->x;
        settings.height = object.size->y;
    }
    if (settings.width < 1 || settings.height < 1) {
        throw InvalidInput("size: " + std::to_string(settings.width) + " x " +
                           std::to_string(settings.height) +
                           " pixels, expected at least 1 along each side");
    }
    settings.samples = view.samples;
    settings.output = value_of<OutputCoding>(view.output, "output", codings);
    return settings;
}

/// A scene with all of its lights, and its camera.
struct LitScene {
    Scene scene;  ///< Its meshes and images are shared.
    Camera camera;
};

/// Adds the default lights to a scene without a light.
LitScene lit_scene(const SceneObject& object, const ViewRequest& view,
                   const FrameSettings& settings) {
    LitScene lit{object.scene, camera_of(object.scene, view,
                                         static_cast<float>(settings.width) /
                                             static_cast<float>(settings.height))};
    const Scene& scene = lit.scene;
    const bool has_light = !scene.directional_lights.empty() || !scene.point_lights.empty() ||
                           !scene.spot_lights.empty() ||
                           (scene.environment && scene.environment->lights);
    if (!has_light) add_default_lights(lit.scene, lit.camera);
    return lit;
}

Image draw(const SceneObject& object, const ViewRequest& view, Report& report) {
    constexpr auto backends = std::to_array<EnumName<Backend>>(
        {{"auto", Backend::automatic}, {"osmesa", Backend::osmesa}, {"egl", Backend::egl}});
    const FrameSettings settings = settings_of(object, view);
    const Backend backend = value_of<Backend>(view.backend, "backend", backends);
    const LitScene lit = lit_scene(object, view, settings);
    const Context context(backend);
    Renderer renderer(context, lit.scene, settings, report);
    Image picture = renderer.draw(lit.camera).image;
    if (lit.scene.background.a == 1.0F) drop_alpha(picture);
    return picture;
}

py::array py_render(const SceneObject& scene, std::optional<std::pair<int, int>> size, int samples,
                    const std::string& output,
                    std::optional<std::tuple<double, double, double>> camera,
                    std::optional<double> fov_degrees, const std::string& backend,
                    const FindingList& report) {
    const ViewRequest view{size, samples, output, camera, fov_degrees, backend};
    Report findings;
    Image picture = without_gil([&] { return draw(scene, view, findings); });
    append(without_assumed(findings, scene.assumed), report);
    return array_of(std::move(picture));
}

py::list to_list(const std::vector<EffectReason>& reasons) {
    py::list effects;
    for (const EffectReason& effect : reasons) {
        py::dict entry;
        entry["effect"] = effect.effect;
        entry["on"] = effect.on;
        entry["reason"] = effect.reason;
        effects.append(std::move(entry));
    }
    return effects;
}

FramePlan plan_of(const SceneObject& object, const ViewRequest& view) {
    return without_gil([&] {
        const FrameSettings settings = settings_of(object, view);
        return plan_effects(lit_scene(object, view, settings).scene, settings);
    });
}

py::list py_effects(const SceneObject& object, std::optional<std::pair<int, int>> size, int samples,
                    const std::string& output,
                    std::optional<std::tuple<double, double, double>> camera,
                    std::optional<double> fov_degrees) {
    py::list draws;
    const FramePlan plan = plan_of(object, {size, samples, output, camera, fov_degrees, "auto"});
    for (const DrawPlan& draw : plan.draws)
        draws.append(to_list(*draw.reasons));
    return draws;
}

py::list py_frame_effects(const SceneObject& object, std::optional<std::pair<int, int>> size,
                          int samples, const std::string& output,
                          std::optional<std::tuple<double, double, double>> camera,
                          std::optional<double> fov_degrees) {
    return to_list(plan_of(object, {size, samples, output, camera, fov_degrees, "auto"}).reasons);
}

}  // namespace

void add_scenes(py::module_& module) {
    using py::arg;
    const py::object none = py::none();
    py::class_<SceneObject>(module, "Scene",
                            "Meshes, materials, lights, and a camera to draw.\n\n"
                            "Copies share their meshes and images. Scenes cannot be pickled: send\n"
                            "the name of the file.")
        .def(py::init(&new_scene), arg("mesh"), py::kw_only(),
             arg("diffuse") = Color(0.8F, 0.8F, 0.8F), arg("specular") = Color(0.0F, 0.0F, 0.0F),
             arg("shininess") = 32.0F, arg("material") = none, arg("normal_map") = none,
             arg("green") = "up", arg("normal_space") = "tangent", arg("assume") = none,
             arg("report") = none,
             "Create a scene of one mesh with a Phong material, or one of the classic table.\n\n"
             "Colors are linear RGB. The normal map is a stored map, as from bump(): uint8,\n"
             "uint16 or float32, (height, width, 3). A mesh without normals gets them.\n\n"
             "Raises InvalidInput for wrong values, and for a map whose texels are clearly no\n"
             "normals unless `assume` is \"normal\", and TypeError for wrong types.")
        .def_static(
            "load", &load, arg("file"), py::kw_only(), arg("studio") = true,
            arg("assume") = py::tuple(), arg("report") = none,
            "Load a model (.glb .gltf .obj .ply .stl .off) or a scene file (.json).\n\n"
            "Models with a metallic, coated or transmissive material get the built-in\n"
            "studio as their environment, unless `studio` is False. `assume` names kinds of\n"
            "maps, \"normal\", \"height\" or \"color\", that are not examined.\n\n"
            "Raises FileError if a file cannot be read, or is damaged, or if a scene file\n"
            "names a map of the wrong kind; in models, such maps are findings.")
        .def_property(
            "ambient",
            [](const SceneObject& object) {
                const glm::vec3& color = object.scene.ambient;
                return Color(color.x, color.y, color.z);
            },
            [](SceneObject& object, const Color& color) {
                object.scene.ambient = vector_of(color);
            },
            "The constant radiance from all directions, linear.")
        .def_property(
            "background",
            [](const SceneObject& object) {
                const glm::vec4& color = object.scene.background;
                return ColorAndAlpha(color.x, color.y, color.z, color.w);
            },
            [](SceneObject& object, const ColorAndAlpha& color) {
                const auto& [red, green, blue, alpha] = color;
                object.scene.background = {red, green, blue, alpha};
            },
            "The color behind the model: linear RGB, and alpha. Pictures of an opaque background\n"
            "have three channels.")
        .def_property(
            "exposure", [](const SceneObject& object) { return object.scene.exposure; },
            [](SceneObject& object, float exposure) { object.scene.exposure = exposure; },
            "The factor of the radiance before tone mapping.")
        .def(
            "add_light",
            [](SceneObject& object, const Color& direction, const Color& irradiance) {
                object.scene.directional_lights.push_back(
                    {.direction_world = vector_of(direction), .irradiance = vector_of(irradiance)});
            },
            arg("direction"), py::kw_only(), arg("irradiance") = Color(1.0F, 1.0F, 1.0F),
            "Add light that travels in a direction. A white surface that faces it has the\n"
            "radiance `irradiance`. Scenes without a light get a key and a fill light.\n\n"
            "Raises TypeError unless both are three numbers.")
        .def("render", &py_render, py::kw_only(), arg("size") = none, arg("samples") = 4,
             arg("output") = "srgb", arg("camera") = none, arg("fov_degrees") = none,
             arg("backend") = "auto", arg("report") = none,
             "Draw the scene to an array of shape (height, width, 3 or 4), as relief-view does.\n\n"
             "`size` is (width, height). `output` is srgb (uint8), linear or clamped (float32).\n"
             "`camera` is (azimuth, elevation, distance factor), in degrees.\n\n"
             "Raises GpuError if OpenGL is missing or lacks memory, and InvalidInput for wrong\n"
             "options.")
        .def("effects", &py_effects, py::kw_only(), arg("size") = none, arg("samples") = 4,
             arg("output") = "srgb", arg("camera") = none, arg("fov_degrees") = none,
             "Return for each draw which effects render() uses, and why the others are off.\n\n"
             "The options are those of render(). The result is a list of draws, each a list of\n"
             "dictionaries with effect, on and reason. A scene without a light has the default\n"
             "lights, as in render(). Nothing is drawn.\n\n"
             "Raises InvalidInput for wrong options.")
        .def("frame_effects", &py_frame_effects, py::kw_only(), arg("size") = none,
             arg("samples") = 4, arg("output") = "srgb", arg("camera") = none,
             arg("fov_degrees") = none,
             "Return which effects of the whole picture render() uses, and why: the background,\n"
             "shadow maps, transmission, sorting, and averaging of samples.\n\n"
             "The options are those of render(). The result is a list of dictionaries with\n"
             "effect, on and reason. Nothing is drawn.\n\n"
             "Raises InvalidInput for wrong options.")
        .def("__copy__", [](const SceneObject& object) { return SceneObject(object); })
        .def("__deepcopy__",
             [](const SceneObject& object, const py::dict&) { return SceneObject(object); })
        .def("__repr__", [](const SceneObject& object) {
            return "<relief.Scene, instances: " + std::to_string(object.scene.instances.size()) +
                   ", meshes: " + std::to_string(object.scene.meshes.size()) +
                   ", materials: " + std::to_string(object.scene.materials.size()) + ">";
        });
}

}  // namespace relief::python
