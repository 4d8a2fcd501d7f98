// SPDX-License-Identifier: Apache-2.0
// The classic table of OpenGL materials as numbers of Phong's model. Its authors chose the colors
// by eye on screens that showed radiance without a transfer function, so the colors are sRGB codes
// and are decoded; otherwise gold would be too pale. Sources: [Kilgard 1994] for the gems,
// plastics, rubbers and plain metals, [McReynolds and Blythe 1998] for pewter and the polished
// metals.
#include "relief/shade/material.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "relief/mesh/image.h"

namespace relief::shade {

namespace {

struct MaterialRow {
    const char* name;
    glm::vec3 ambient;
    glm::vec3 diffuse;
    glm::vec3 specular;
    float shininess;  ///< As a fraction of 128.
};

/// Sorted by name.
constexpr MaterialRow table[] = {
    {"black plastic", {0.0F, 0.0F, 0.0F}, {0.01F, 0.01F, 0.01F}, {0.5F, 0.5F, 0.5F}, 0.25F},
    {"black rubber", {0.02F, 0.02F, 0.02F}, {0.01F, 0.01F, 0.01F}, {0.4F, 0.4F, 0.4F}, 0.078125F},
    {"brass",
     {0.329412F, 0.223529F, 0.027451F},
     {0.780392F, 0.568627F, 0.113725F},
     {0.992157F, 0.941176F, 0.807843F},
     0.21794872F},
    {"bronze",
     {0.2125F, 0.1275F, 0.054F},
     {0.714F, 0.4284F, 0.18144F},
     {0.393548F, 0.271906F, 0.166721F},
     0.2F},
    {"chrome", {0.25F, 0.25F, 0.25F}, {0.4F, 0.4F, 0.4F}, {0.774597F, 0.774597F, 0.774597F}, 0.6F},
    {"copper",
     {0.19125F, 0.0735F, 0.0225F},
     {0.7038F, 0.27048F, 0.0828F},
     {0.256777F, 0.137622F, 0.086014F},
     0.1F},
    {"cyan plastic",
     {0.0F, 0.1F, 0.06F},
     {0.0F, 0.50980392F, 0.50980392F},
     {0.50196078F, 0.50196078F, 0.50196078F},
     0.25F},
    {"cyan rubber", {0.0F, 0.05F, 0.05F}, {0.4F, 0.5F, 0.5F}, {0.04F, 0.7F, 0.7F}, 0.078125F},
    {"emerald",
     {0.0215F, 0.1745F, 0.0215F},
     {0.07568F, 0.61424F, 0.07568F},
     {0.633F, 0.727811F, 0.633F},
     0.6F},
    {"gold",
     {0.24725F, 0.1995F, 0.0745F},
     {0.75164F, 0.60648F, 0.22648F},
     {0.628281F, 0.555802F, 0.366065F},
     0.4F},
    {"green plastic", {0.0F, 0.0F, 0.0F}, {0.1F, 0.35F, 0.1F}, {0.45F, 0.55F, 0.45F}, 0.25F},
    {"green rubber", {0.0F, 0.05F, 0.0F}, {0.4F, 0.5F, 0.4F}, {0.04F, 0.7F, 0.04F}, 0.078125F},
    {"jade",
     {0.135F, 0.2225F, 0.1575F},
     {0.54F, 0.89F, 0.63F},
     {0.316228F, 0.316228F, 0.316228F},
     0.1F},
    {"obsidian",
     {0.05375F, 0.05F, 0.06625F},
     {0.18275F, 0.17F, 0.22525F},
     {0.332741F, 0.328634F, 0.346435F},
     0.3F},
    {"pearl",
     {0.25F, 0.20725F, 0.20725F},
     {1.0F, 0.829F, 0.829F},
     {0.296648F, 0.296648F, 0.296648F},
     0.088F},
    {"pewter",
     {0.105882F, 0.058824F, 0.113725F},
     {0.427451F, 0.470588F, 0.541176F},
     {0.333333F, 0.333333F, 0.521569F},
     0.076923F},
    {"polished bronze",
     {0.25F, 0.148F, 0.06475F},
     {0.4F, 0.2368F, 0.1036F},
     {0.774597F, 0.458561F, 0.200621F},
     0.6F},
    {"polished copper",
     {0.2295F, 0.08825F, 0.0275F},
     {0.5508F, 0.2118F, 0.066F},
     {0.580594F, 0.223257F, 0.0695701F},
     0.4F},
    {"polished gold",
     {0.24725F, 0.2245F, 0.0645F},
     {0.34615F, 0.3143F, 0.0903F},
     {0.797357F, 0.723991F, 0.208006F},
     0.65F},
    {"polished silver",
     {0.23125F, 0.23125F, 0.23125F},
     {0.2775F, 0.2775F, 0.2775F},
     {0.773911F, 0.773911F, 0.773911F},
     0.7F},
    {"red plastic", {0.0F, 0.0F, 0.0F}, {0.5F, 0.0F, 0.0F}, {0.7F, 0.6F, 0.6F}, 0.25F},
    {"red rubber", {0.05F, 0.0F, 0.0F}, {0.5F, 0.4F, 0.4F}, {0.7F, 0.04F, 0.04F}, 0.078125F},
    {"ruby",
     {0.1745F, 0.01175F, 0.01175F},
     {0.61424F, 0.04136F, 0.04136F},
     {0.727811F, 0.626959F, 0.626959F},
     0.6F},
    {"silver",
     {0.19225F, 0.19225F, 0.19225F},
     {0.50754F, 0.50754F, 0.50754F},
     {0.508273F, 0.508273F, 0.508273F},
     0.4F},
    {"turquoise",
     {0.1F, 0.18725F, 0.1745F},
     {0.396F, 0.74151F, 0.69102F},
     {0.297254F, 0.30829F, 0.306678F},
     0.1F},
    {"white plastic", {0.0F, 0.0F, 0.0F}, {0.55F, 0.55F, 0.55F}, {0.7F, 0.7F, 0.7F}, 0.25F},
    {"white rubber", {0.05F, 0.05F, 0.05F}, {0.5F, 0.5F, 0.5F}, {0.7F, 0.7F, 0.7F}, 0.078125F},
    {"yellow plastic", {0.0F, 0.0F, 0.0F}, {0.5F, 0.5F, 0.0F}, {0.6F, 0.6F, 0.5F}, 0.25F},
    {"yellow rubber", {0.05F, 0.05F, 0.0F}, {0.5F, 0.5F, 0.4F}, {0.7F, 0.7F, 0.04F}, 0.078125F},
};

/// Returns the form of names in the table: lower case, with blanks between words.
std::string table_name(std::string_view name) {
    std::string result(name);
    for (char& c : result) {
        const bool separates = c == '-' || c == '_';
        c = separates ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return result;
}

glm::vec3 decoded(const glm::vec3& codes) {
    return {linear_from_srgb(codes.r), linear_from_srgb(codes.g), linear_from_srgb(codes.b)};
}

}  // namespace

std::optional<Material> material_by_name(std::string_view name) {
    const std::string key = table_name(name);
    const auto* row = std::find_if(std::begin(table), std::end(table),
                                   [&](const MaterialRow& entry) { return entry.name == key; });
    if (row == std::end(table)) return std::nullopt;
    Material material;
    material.name = row->name;
    material.ambient = decoded(row->ambient);
    material.diffuse = decoded(row->diffuse);
    material.specular = decoded(row->specular);
    material.shininess = 128.0F * row->shininess;
    material.specular_model = SpecularModel::phong;
    return material;
}

const std::vector<std::string>& material_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const MaterialRow& row : table)
            result.emplace_back(row.name);
        return result;
    }();
    return names;
}

glm::vec3 dielectric_reflectance(const MetallicRoughness& model) {
    const double n = static_cast<double>(model.refractive_index);
    const double root = (n - 1.0) / (n + 1.0);
    const glm::dvec3 f0 = glm::min(root * root * glm::dvec3(model.specular_color), 1.0);
    return glm::vec3(f0 * static_cast<double>(model.specular));
}

bool compensates_energy(const MetallicRoughness& model) {
    constexpr float smooth = 0.05F;
    constexpr float low_reflectance = 0.045F;
    const glm::vec3 f0 = dielectric_reflectance(model);
    const bool is_dark = std::max({f0.r, f0.g, f0.b}) <= low_reflectance &&
                         model.metallic == 0.0F && model.iridescence == 0.0F;
    const bool is_plain = model.clearcoat == 0.0F && model.anisotropy == 0.0F;
    return !(is_dark && is_plain && model.roughness <= smooth);
}

float specular_normalization(const Material& material) {
    const bool normalized = material.specular_model == SpecularModel::blinn_phong_normalized;
    return normalized ? (material.shininess + 2.0F) / 8.0F : 1.0F;
}

}  // namespace relief::shade
