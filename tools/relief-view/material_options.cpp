// SPDX-License-Identifier: Apache-2.0
#include "material_options.h"

#include <array>
#include <utility>

#include "field_options.h"

namespace relief::tools {
namespace {

constexpr const char* materials_group = "Materials, for all of them";

MetallicOption parse_metallic(const std::string& subject, const std::string& text) {
    const std::vector<double> numbers = parse_numbers(subject, text);
    if (numbers.size() != 2) throw UsageError(subject + ": not metallic,roughness");
    for (const double number : numbers) {
        if (number < 0 || number > 1) throw UsageError(subject + ": both must be within 0 and 1");
    }
    return {static_cast<float>(numbers[0]), static_cast<float>(numbers[1])};
}

void add_model_options(CLI::App& app, ViewOptions& options) {
    using Model = SceneOptions::MaterialModel;
    add_choice(app, "--shading", options.shading,
               Choices<Model>{{"as_authored", Model::as_authored}, {"phong", Model::phong}},
               "glTF's materials by their own metallic-roughness model, or translated to Phong's. "
               "Default: as_authored, unless an option asks for what only Phong's model has.")
        .group(materials_group);
    add_choice(app, "--interpolation", options.interpolation, enum_choices<Interpolation>(),
               "Light at every pixel, at vertices only (Phong's model), or from the triangles' own "
               "planes. Default: as the scene says, else per_pixel.")
        .group(materials_group);
    add_value(
        app, "--material", "NAME",
        "One of the classic materials: gold, chrome, emerald, \"red plastic\", ... An unknown "
        "name lists near ones.",
        [&](const std::string&, const std::string& text) { options.material = text; })
        .group(materials_group);
    add_value(app, "--metallic-roughness", "METALLIC,ROUGHNESS",
              "glTF's model with these numbers, coloured as the material was.",
              [&](const std::string& subject, const std::string& text) {
                  options.metallic_roughness = parse_metallic(subject, text);
              })
        .group(materials_group);
}

}  // namespace

void add_material_options(CLI::App& app, ViewOptions& options) {
    add_model_options(app, options);
    add_choice(app, "--specular", options.specular, enum_choices<SpecularModel>(),
               "Model of highlights; the normalized one keeps their light whatever the shininess. "
               "Materials without a specular colour get a grey one of 0.25. "
               "Default: as the model says, else blinn_phong.")
        .group(materials_group);
    add_number(app, "--shininess", "N", options.shininess, field_limits(&Material::shininess),
               "Exponent of highlights: larger is smaller and sharper. Materials without a "
               "specular colour get a grey one of 0.25. Default: as the model says, else 32.")
        .group(materials_group);
}

void check_materials(const ViewOptions& options) {
    const std::string phong = reason_for_phong(options);
    refuse(options.shading == SceneOptions::MaterialModel::as_authored && !phong.empty(), phong,
           "asks for Phong's model, and --shading as_authored for glTF's", "leave one of them out");
    refuse(options.metallic_roughness && !phong.empty(), "--metallic-roughness",
           "is glTF's model, and " + phong + " asks for Phong's", "leave one of them out");
    refuse(options.metallic_roughness && options.material, "--metallic-roughness",
           "contradicts --material", "leave one of them out");
}

std::string reason_for_phong(const ViewOptions& options) {
    const std::array<std::pair<bool, const char*>, 9> reasons{{
        {options.shading == SceneOptions::MaterialModel::phong, "--shading phong"},
        {options.interpolation == Interpolation::gouraud, "--interpolation gouraud"},
        {options.specular.has_value(), "--specular"},
        {options.shininess.has_value(), "--shininess"},
        {options.reflectivity.has_value(), "--reflectivity"},
        {options.reflection_roughness.has_value(), "--reflection-roughness"},
        {options.fresnel.has_value() || options.no_fresnel, "--fresnel"},
        {options.transmission.has_value(), "--transmission"},
        {options.material.has_value(), "--material"},
    }};
    for (const auto& [given, name] : reasons) {
        if (given) return name;
    }
    return "";
}

}  // namespace relief::tools
