// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_rules_test.cpp.
#include "check_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "map_remedies.h"

namespace relief::tools {
namespace {

using enum CheckSeverity;

constexpr std::string_view repair_mesh = "relief-mesh repair IN OUT";
constexpr std::string_view repair_normals = "relief-mesh process IN OUT --repair-normals";
constexpr std::string_view new_tangents = "relief-mesh process IN OUT --tangents mikktspace";
constexpr std::string_view no_remedy = "";

/// Makes the rule of a condition of meshes.
constexpr CheckRule mesh_rule(std::string_view id, CheckSeverity severity, MeshCondition condition,
                              std::string_view title, std::string_view cause, std::string_view cost,
                              std::string_view remedy) {
    return {id, severity, title, cause, cost, remedy, condition, std::nullopt};
}

/// Makes the rule of a condition of normal maps.
/// \param advice  if no command remedies the condition
constexpr CheckRule map_rule(std::string_view id, CheckSeverity severity, MapCondition condition,
                             std::string_view title, std::string_view cause, std::string_view cost,
                             std::string_view advice = "") {
    const std::string_view command = map_remedy(condition);
    const std::string_view remedy = command.empty() ? advice : command;
    return {id, severity, title, cause, cost, remedy, std::nullopt, condition};
}

constexpr std::array all_rules = {
    CheckRule{"budget/file-size", error, "The file is larger than its budget",
              "the limit `file_size` of relief.json", "downloads and repositories grow", no_remedy},
    CheckRule{"budget/map-size", error, "A map is larger than its budget",
              "the limit `map_size` of relief.json", "memory and loading time",
              "relief-bake convert with --resize, or a smaller export"},
    CheckRule{"budget/materials", error, "The model has more materials than its budget",
              "the limit `materials` of relief.json", "each material is a draw call",
              "bake them into one with relief-bake mesh"},
    CheckRule{"budget/memory", error, "The model needs more graphics memory than its budget",
              "the limit `memory` of relief.json", "textures are evicted, frames drop",
              "smaller or compressed maps (relief-bake convert to .ktx2)"},
    CheckRule{"budget/texel-density", error, "The texel density is outside its budget",
              "the limits `texel_density` of relief.json", "blurred beside sharp surfaces",
              "another map size, or relief-mesh unwrap"},
    CheckRule{"budget/triangles", error, "The model has more triangles than its budget",
              "the limit `triangles` of relief.json", "frames drop",
              "relief-mesh decimate, or relief-mesh lods"},
    CheckRule{"file/folder-link", note, "A link to a folder is not followed",
              "a symbolic link in a checked folder", "its files are not checked under this name",
              no_remedy},
    CheckRule{"file/unreadable", error, "The file cannot be read",
              "damaged, truncated, of another format, without permission, or a link to itself",
              "no program can use it", "permit reading it, or export it again"},
    CheckRule{"folder/unreadable", error, "The folder cannot be read", "without permission",
              "its files are not checked", no_remedy},
    map_rule("map/all-flat", warning, MapCondition::all_flat, "Every texel is the same",
             "an empty layer was exported, or a bake hit nothing", "memory without any detail",
             "remove the map from the material"),
    map_rule("map/alpha-constant", note, MapCondition::alpha_opaque, "Constant alpha",
             "exported with a fourth channel", "a third more memory"),
    map_rule("map/alpha-heights", note, MapCondition::alpha_heights, "Heights in alpha",
             "packed for parallax mapping", "none if the engine reads them", no_remedy),
    map_rule("map/alpha-other", note, MapCondition::alpha_other, "Something in alpha",
             "several maps packed in one", "none if the engine reads it", no_remedy),
    map_rule("map/bits-unused", note, MapCondition::bits_unused, "Bits are unused",
             "8-bit content saved with 16 bits or float", "twice or four times the memory"),
    CheckRule{"map/contradicts-name", warning, "The map is not what its name says",
              "exported under the name of another map", "importers that go by names use it wrongly",
              "rename it, or export it again"},
    map_rule("map/darkened-by-srgb", error, MapCondition::decoded_from_srgb,
             "Darkened by the sRGB curve", "loaded as a color and stored as linear light",
             "all normals lean to one corner", "export it again as data (non-color)"),
    map_rule("map/facing-back", warning, MapCondition::texel_facing_back, "Texels face back",
             "inverted blue, or rays that hit the back of the surface", "black or inverted spots",
             "bake it again; relief-bake check --high HIGH --low LOW decides for a bake"),
    map_rule("map/flat-contradicted", warning, MapCondition::flat_contradicted,
             "Zero is not as stated", "the metadata survived an edit",
             "flat areas lean by 0.3 "
             "degrees, which shows at mirrored seams"),
    map_rule("map/gray-texels", note, MapCondition::texel_gray, "Gray texels",
             "a background instead of padding", "dark seams in mip levels",
             "bake it with --padding"),
    map_rule("map/green-contradicted", error, MapCondition::green_contradicted,
             "Green is not as stated", "exported for another engine than the name or metadata say",
             "bumps are hollows"),
    map_rule("map/green-down", note, MapCondition::green_down, "Green is down",
             "made for DirectX or Unreal", "bumps are hollows in OpenGL, Unity, Godot and glTF"),
    map_rule("map/green-undecidable", note, MapCondition::green_unknown, "Green is undecidable",
             "no slopes in two directions, or painted by hand", "none", no_remedy),
    map_rule("map/no-directions", warning, MapCondition::texel_without_direction,
             "Texels without direction", "a black background, or texels that a bake missed",
             "programs show them differently, down to NaN"),
    map_rule("map/not-finite", error, MapCondition::texel_not_finite, "Texels are not finite",
             "a division by zero of the baker", "black or white blocks that grow in mip levels"),
    map_rule("map/not-normals", error, MapCondition::not_normals, "Not a normal map",
             "another map was assigned or named as one", "the surface shades at random",
             "assign the right map; relief-bake bump converts heights"),
    map_rule("map/not-quite-unit", note, MapCondition::not_quite_unit, "Not quite of unit length",
             "filtered or compressed without normalization", "slightly wrong highlights"),
    map_rule("map/not-unit", warning, MapCondition::not_unit, "Not of unit length",
             "blended, resized or painted as a color",
             "programs that do not normalize shade it wrong"),
    map_rule("map/object-space", error, MapCondition::object_space, "Object-space normals",
             "baked in the space of the object", "shades wrong as a tangent-space map",
             "relief-bake convert with --to-tangent MODEL"),
    map_rule("map/seam-x", note, MapCondition::seam_x, "Seam left and right", "not made to tile",
             "a visible seam if the map is repeated", no_remedy),
    map_rule("map/seam-y", note, MapCondition::seam_y, "Seam top and bottom", "not made to tile",
             "a visible seam if the map is repeated", no_remedy),
    map_rule("map/signed-samples", error, MapCondition::signed_samples, "Signed samples",
             "float samples hold n, not (n + 1) / 2", "all normals are wrong"),
    map_rule("map/tagged-as-color", note, MapCondition::tagged_as_color, "Tagged as a color",
             "saved with the defaults of an image editor",
             "programs that apply such tags change the normals"),
    map_rule("map/through-srgb", error, MapCondition::stored_through_srgb,
             "Stored through the sRGB curve", "saved as a color", "all normals lean to one corner",
             "export it again as data (non-color)"),
    map_rule("map/x-constant", note, MapCondition::x_constant, "Constant first component",
             "made of ripples along one axis, or a channel is lost", "no slope left and right",
             no_remedy),
    map_rule("map/y-constant", note, MapCondition::y_constant, "Constant second component",
             "made of ripples along one axis, or a channel is lost", "no slope up and down",
             no_remedy),
    map_rule("map/z-constant", note, MapCondition::z_constant, "Constant third component",
             "packed for two channels", "normals are too short on slopes"),
    map_rule("map/z-missing", warning, MapCondition::z_missing, "No third component",
             "packed for two channels",
             "programs that read three channels, as glTF requires, get wrong normals"),
    mesh_rule("mesh/boundary-edge", note, MeshCondition::edge_boundary, "Boundary edges",
              "an open surface", "none, unless it should be closed",
              "relief-mesh remesh closes a surface"),
    mesh_rule("mesh/bow-tie-vertex", note, MeshCondition::vertex_bow_tie, "Bow-tie vertices",
              "parts that touch in a point", "their normals are averaged", repair_mesh),
    mesh_rule("mesh/collapsed-triangle", note, MeshCondition::triangle_collapsed,
              "Collapsed triangles", "poles of spheres, welded vertices", "time without a pixel",
              repair_mesh),
    mesh_rule("mesh/collinear-triangle", note, MeshCondition::triangle_collinear,
              "Collinear triangles", "T-junctions that were closed", "no normal of their own",
              no_remedy),
    mesh_rule("mesh/degenerate-fan", warning, MeshCondition::vertex_degenerate_fan,
              "Vertices with only degenerate triangles", "collapsed parts",
              "normals of these vertices are arbitrary", repair_mesh),
    mesh_rule("mesh/double-sided-triangle", note, MeshCondition::triangle_two_sided,
              "Double-sided triangles", "both sides of a sheet are modeled",
              "averaged normals cancel; the sheet may flicker",
              "relief-mesh repair with --two-sided single"),
    mesh_rule("mesh/far-from-origin", warning, MeshCondition::mesh_far_away, "Far from the origin",
              "world or geographic coordinates", "vertices jump: floats are coarse there",
              "move the model to its own origin"),
    mesh_rule("mesh/flipped-neighbors", warning, MeshCondition::edge_flipped,
              "Neighbors face opposite sides", "inverted faces, a mirrored copy",
              "holes with back-face culling, wrong normals and bakes", repair_mesh),
    mesh_rule("mesh/folded-edge", note, MeshCondition::edge_folded, "Folded edges",
              "a sheet folded onto itself", "flickering, wrong smooth normals", no_remedy),
    mesh_rule("mesh/isolated-vertex", warning, MeshCondition::vertex_isolated, "Isolated vertices",
              "remains of deleted faces", "memory; they enlarge the bounding box", repair_mesh),
    mesh_rule("mesh/mirrored-texture", note, MeshCondition::texture_mirrored, "Mirrored texture",
              "half of the model reuses the map", "none with tangents; text is mirrored",
              no_remedy),
    mesh_rule("mesh/near-duplicate-vertex", note, MeshCondition::vertex_near_duplicate,
              "Near-duplicate vertices", "rounding of an exporter", "cracks, split normals",
              "relief-mesh repair with --weld"),
    mesh_rule("mesh/needle-triangle", note, MeshCondition::triangle_needle, "Needle triangles",
              "booleans, tessellated curves", "rounding decides their normals", no_remedy),
    mesh_rule("mesh/no-texture-gradient", warning, MeshCondition::texture_degenerate,
              "Triangles without texture gradient",
              "texture coordinates that are collapsed to a point or a line",
              "no tangents: a normal map shades at random there; a bake has no texel",
              "relief-mesh unwrap"),
    mesh_rule("mesh/non-manifold-edge", note, MeshCondition::edge_non_manifold,
              "Edges with three or more triangles", "parts that share edges, inner walls",
              "decimation and baking have no inside there", repair_mesh),
    mesh_rule("mesh/normal-against-some", note, MeshCondition::normal_inconsistent,
              "Normals against one of their triangles", "sharp edges with smooth normals",
              "dark edges", no_remedy),
    mesh_rule("mesh/normal-not-finite", error, MeshCondition::normal_not_finite,
              "Normals are not finite", "normals of degenerate faces",
              "black vertices; invalid glTF", repair_normals),
    mesh_rule("mesh/normal-not-unit", warning, MeshCondition::normal_not_unit,
              "Normals are not of unit length", "scaled with the model, interpolated",
              "too bright or too dark; invalid glTF", repair_normals),
    mesh_rule("mesh/normal-opposed", warning, MeshCondition::normal_opposed,
              "Normals against all of their triangles", "inverted normals or inverted winding",
              "lit from the wrong side", "relief-mesh process IN OUT --normals auto"),
    mesh_rule("mesh/normal-zero", error, MeshCondition::normal_zero, "Normals are zero",
              "normals of degenerate faces", "black vertices; invalid glTF", repair_normals),
    mesh_rule("mesh/overlapping-texture", note, MeshCondition::texture_overlapping,
              "Triangles share texels", "tiled or mirrored texture coordinates",
              "none for tiling textures; a bake is ambiguous", no_remedy),
    mesh_rule("mesh/position-not-finite", error, MeshCondition::vertex_not_finite,
              "Positions are not finite", "a division by zero of the exporter",
              "the model has no bounds, or disappears", repair_mesh),
    mesh_rule("mesh/repeated-triangle", warning, MeshCondition::triangle_repeated,
              "Repeated triangles", "a part was duplicated in place",
              "flickering, transparency counts twice, time", repair_mesh),
    mesh_rule("mesh/tangent-along-normal", warning, MeshCondition::tangent_along_normal,
              "Tangents along their normals", "placeholder tangents",
              "a normal map shades at random", new_tangents),
    mesh_rule("mesh/tangent-not-finite", error, MeshCondition::tangent_not_finite,
              "Tangents are not finite", "collapsed texture coordinates",
              "black vertices with a normal map; invalid glTF", new_tangents),
    mesh_rule("mesh/tangent-not-perpendicular", note, MeshCondition::tangent_not_perpendicular,
              "Tangents are not perpendicular to their normals", "interpolated or edited normals",
              "normals of a map lean by the same angle", new_tangents),
    mesh_rule("mesh/tangent-not-unit", warning, MeshCondition::tangent_not_unit,
              "Tangents are not of unit length", "scaled with the model, collapsed coordinates",
              "a normal map is too strong or too weak; invalid glTF", new_tangents),
    mesh_rule("mesh/tangent-sign", error, MeshCondition::tangent_invalid_sign,
              "Tangents without handedness", "w was left at 0 by the exporter",
              "no bitangent: green of a normal map has no effect; invalid glTF", new_tangents),
    mesh_rule("mesh/texcoord-not-finite", error, MeshCondition::texture_not_finite,
              "Texture coordinates are not finite", "a division by zero of the exporter",
              "streaks of single texels", "relief-mesh unwrap"),
    mesh_rule("mesh/texcoords-far", warning, MeshCondition::texture_far_away,
              "Texture coordinates far from their origin", "a wrong UDIM offset, tiling",
              "the image jumps: floats are coarse there", "move them by whole tiles"),
    mesh_rule("mesh/triangle-not-finite", error, MeshCondition::triangle_not_finite,
              "Triangles with a corner that is not finite", "a division by zero of the exporter",
              "the model has no bounds, or disappears", repair_mesh),
    CheckRule{"model/image-outside", error, "An image is outside of the model's folder",
              "absolute paths, or `..`", "it is not read, and lost when the model is moved",
              "copy it beside the model"},
    CheckRule{"model/incomplete", warning, "A part of the file was not understood",
              "missing material libraries, damaged statements", "the model differs from its source",
              "export it again"},
    CheckRule{"model/missing-image", error, "An image is missing",
              "not copied with the model, or renamed", "white or black surfaces",
              "copy it beside the model"},
    CheckRule{"model/missing-texcoords", error, "A textured part has no texture coordinates",
              "not unwrapped, or a texture names another set", "every pixel shows the same texel",
              "relief-mesh unwrap"},
    CheckRule{"model/no-tangents", note, "A normal map without stored tangents",
              "exported without tangents",
              "each program computes its own; only those of MikkTSpace fit", new_tangents},
    CheckRule{"model/no-triangles", note, "The file has no triangles",
              "only points, lines, cameras or lights", "nothing to check", no_remedy},
    CheckRule{"model/overlapping-bake", warning, "Charts of a baked map overlap",
              "the model was unwrapped for tiling, or changed after the bake",
              "one place shows the detail of another", "relief-mesh unwrap, and bake again"},
    CheckRule{"model/reader-note", note, "The reader left something out",
              "points, lines, or data that relief does not use", "none for triangles", no_remedy},
    CheckRule{"model/tangents-ignored", warning, "Tangents without normals",
              "normals were left out on export", "glTF ignores the tangents and shades flat",
              "relief-mesh process IN OUT --normals auto --tangents mikktspace"},
    CheckRule{"model/unknown-tangents", note, "The method of the tangents is unknown",
              "not MikkTSpace, or normals were edited later",
              "a map that was baked with other tangents shades wrong at seams", no_remedy},
    CheckRule{"texture/green-down", error, "Green of a glTF normal map is down",
              "made for DirectX or Unreal", "bumps are hollows: glTF has green up",
              map_remedy(MapCondition::green_down)},
    CheckRule{"texture/not-power-of-two", note, "The size is not a power of two",
              "cropped or scanned images", "older devices cannot make mip levels of it",
              "resize it"},
    CheckRule{"texture/other-material", warning, "The map was baked for another material",
              "maps were exchanged in the material", "details of another part",
              "assign the map of the material"},
    CheckRule{"texture/two-uses", warning, "One image is a color and a number",
              "a normal, occlusion or roughness slot has the image of a color slot",
              "one of the two is decoded by the wrong curve", "assign the right map"},
    CheckRule{"texture/unreadable", error, "A texture cannot be decoded",
              "damaged, truncated, or not an image", "white or black surfaces", "export it again"},
    CheckRule{"texture/wrong-kind", error, "A texture is of another kind than its slot",
              "maps were exchanged in the material", "the surface shades wrong",
              "assign the right map"},
};

static_assert(std::ranges::is_sorted(all_rules, {}, &CheckRule::id));

/// Checks that each condition from the first to the last enumerator has a rule.
template <typename Condition>
constexpr bool has_all(std::optional<Condition> CheckRule::*member, Condition last) {
    for (int i = 0; i <= static_cast<int>(last); ++i) {
        if (std::ranges::count(all_rules, static_cast<Condition>(i), member) != 1) return false;
    }
    return true;
}
static_assert(has_all(&CheckRule::of_mesh, MeshCondition::texture_far_away));
static_assert(has_all(&CheckRule::of_map, MapCondition::seam_y));

}  // namespace

std::span<const CheckRule> check_rules() {
    return all_rules;
}

const CheckRule* find_check_rule(std::string_view id) {
    const auto found = std::ranges::find(all_rules, id, &CheckRule::id);
    return found == all_rules.end() ? nullptr : &*found;
}

const CheckRule& check_rule_of(MeshCondition condition) {
    const auto found = std::ranges::find(all_rules, condition, &CheckRule::of_mesh);
    assert(found != all_rules.end());
    return *found;
}

const CheckRule& check_rule_of(MapCondition condition) {
    const auto found = std::ranges::find(all_rules, condition, &CheckRule::of_map);
    assert(found != all_rules.end());
    return *found;
}

std::string check_rules_page() {
    std::string page =
        "# The rules of relief check\n\n"
        "`relief check` ([check.md](check.md)) reports each finding under the id of a rule, which "
        "never changes. An *error* makes\nthe asset wrong, a *warning* makes it worse, and a "
        "*note* "
        "also applies to sound files. Some findings have another severity\nthan their rule: a "
        "defect "
        "that the materials of a model do not show is a note. `--fix` runs the remedies that are "
        "commands;\nIN is the file, and OUT its fixed copy. `relief-documents` writes this page "
        "from "
        "the table of the tool, and a test compares\nthem; `relief check --rules` lists the "
        "same.\n\n"
        "| rule | severity | finding | usual cause | cost | remedy |\n"
        "|---|---|---|---|---|---|\n";
    for (const CheckRule& rule : all_rules) {
        const std::string remedy =
            rule.is_fixable() ? fmt::format("`{}`", rule.remedy) : std::string(rule.remedy);
        page += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", rule.id,
                            enum_name(rule.severity), rule.title, rule.cause, rule.cost, remedy);
    }
    return page;
}

}  // namespace relief::tools
