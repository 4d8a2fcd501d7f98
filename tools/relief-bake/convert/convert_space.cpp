// SPDX-License-Identifier: Apache-2.0
// Steps of a conversion that need a mesh. Tangent-space fields have y where NormalField says;
// object-space ones have no green at all. Tests: tests/tools/relief_bake_space_test.cpp.
#include "convert/convert_space.h"

#include <fmt/format.h>

#include "common/choices.h"
#include "common/map_models.h"
#include "common/options.h"
#include "convert/convert_steps.h"
#include "relief/mesh/error.h"
#include "relief/mesh/normal_map_operations.h"
#include "relief/mesh/normal_space.h"

namespace relief::tools {
namespace {

constexpr int first_tile = 1001;
constexpr int tiles_across = 10;

Choices<UvOutside> outside_choices() {
    return {{"ignore", UvOutside::ignore}, {"repeat", UvOutside::repeat}};
}

/// Tangents that can be made; "none" makes no sense here.
Choices<TangentMode> made_tangents() {
    Choices<TangentMode> choices;
    for (const auto& [name, mode] : tangent_choices()) {
        if (computes_tangents(mode)) choices.emplace_back(name, mode);
    }
    return choices;
}

/// UDIM counts upwards, texture coordinates downwards.
MapPlacement placement_of(const SpaceConversion& choice) {
    const int index = choice.udim.value_or(first_tile) - first_tile;
    return {{index % tiles_across, -(index / tiles_across)},
            choice.outside.value_or(UvOutside::ignore) == UvOutside::repeat};
}

struct TargetMesh {
    Mesh mesh;
    bool has_own_tangents = true;  ///< All that it has are the file's.
};

/// The mesh that the map belongs to, in object space, with normals and tangents.
TargetMesh read_target(const std::filesystem::path& file, std::optional<TangentMode> tangents,
                       Report& report) {
    TargetMesh target;
    MapModel model = read_map_model(file, ModelSpace::object, report);
    require_texcoords(file, model, "no texture coordinates", "unwrap it first");
    about(file, [&] {
        for (MapModelPart& part : model.parts) {
            const bool keeps =
                !tangents && !part.mesh.tangents.empty() && !part.mesh.normals.empty();
            target.has_own_tangents = target.has_own_tangents && keeps;
            FrameOptions options;
            options.tangents =
                keeps ? TangentMode::keep : tangents.value_or(TangentMode::mikktspace);
            part.mesh = with_frames(std::move(part.mesh), options, report).mesh;
        }
        target.mesh = joined(std::move(model.parts));
    });
    if (target.mesh.triangles.empty()) throw FileError(file, "holds no triangles");
    return target;
}

TargetMesh mesh_of(const std::filesystem::path& file, const SpaceConversion& choice,
                   Report& report) {
    Report found;
    TargetMesh target = read_target(file, choice.tangents, found);
    for (Finding finding : found.findings()) {
        finding.kind += " in the mesh";
        report.add(finding);
    }
    return target;
}

/// The result in the place of what it was made of, with a word on how the mesh covers it.
void put(ConvertedNormals converted, const TargetMesh& target, NormalField& field) {
    field.normals = std::move(converted.normals);
    const Coverage& coverage = converted.coverage;
    const double all = static_cast<double>(coverage.inside + coverage.touched + coverage.empty);
    field.note =
        fmt::format(", with {} tangents; it covers {:.1f} % of the map, the rest is (0, 0, 1)",
                    target.has_own_tangents ? "its own" : "new",
                    100.0 * static_cast<double>(coverage.inside + coverage.touched) / all);
}

std::string words_of(const std::string& space, const std::filesystem::path& file) {
    return fmt::format("to the {} space of {}", space, file.string());
}

}  // namespace

void add_space_options(CLI::App& app, SpaceConversion& choice) {
    const std::string group = "Space";
    add_path(
        app, "--to-object", choice.to_object,
        "Turn tangent-space normals into those of the mesh in FILE, in its own axes; done last.")
        .group(group);
    add_path(app, "--to-tangent", choice.to_tangent,
             "Take the input for object-space normals of the mesh in FILE, and turn them into its "
             "tangent space; done first.")
        .group(group);
    add_choice(app, "--tangents", choice.tangents, made_tangents(),
               "Make the mesh's tangents by this method. Default: its own, else mikktspace.")
        .group(group);
    add_choice(app, "--outside", choice.outside, outside_choices(),
               "Triangles outside the unit square of texture coordinates: leave them out (ignore), "
               "or move them there, for maps that repeat. Default: ignore.")
        .group(group);
    add_value(
        app, "--udim", "N",
        "The map is tile N of the mesh's texture, 1001 and on; 1011 lies above 1001. Default: "
        "1001.",
        [&](const std::string& subject, const std::string& text) {
            choice.udim = parse_integer(subject, text, first_tile, 9999);
        })
        .group(group);
}

void check_space_options(const SpaceConversion& choice) {
    if (choice.to_object && choice.to_tangent)
        throw UsageError("--to-object, --to-tangent: contradict each other");
    if (choice.udim && choice.outside)
        throw UsageError("--udim, --outside: both say what lies outside the unit square");
    if (choice.to_object || choice.to_tangent) return;
    const auto need = [](bool is_given, const std::string& option) {
        if (is_given)
            throw UsageError(option + ": has no effect without --to-object or --to-tangent");
    };
    need(choice.tangents.has_value(), "--tangents");
    need(choice.outside.has_value(), "--outside");
    need(choice.udim.has_value(), "--udim");
}

ConvertStep to_object_step(const SpaceConversion& choice) {
    return {
        words_of("object", *choice.to_object), [choice](NormalField& field, Report& report) {
            if (!field.green) {
                throw InvalidInput("where its green is bright is not known (give --input-green)");
            }
            if (*field.green == Green::down) turn_normals(field.normals, flip_green);
            const TargetMesh target = mesh_of(*choice.to_object, choice, report);
            put(object_from_tangent(field.normals, target.mesh, placement_of(choice), report),
                target, field);
            field.green.reset();
            field.is_object_space = true;
        }};
}

ConvertStep to_tangent_step(const SpaceConversion& choice) {
    return {words_of("tangent", *choice.to_tangent), [choice](NormalField& field, Report& report) {
                const TargetMesh target = mesh_of(*choice.to_tangent, choice, report);
                put(tangent_from_object(field.normals, target.mesh, placement_of(choice), report),
                    target, field);
                // What was asked for, if anything was, else as OpenGL has it.
                if (field.green == Green::down) turn_normals(field.normals, flip_green);
                field.green = field.green.value_or(Green::up);
            }};
}

}  // namespace relief::tools
