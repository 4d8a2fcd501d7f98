// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads and writes glTF and GLB files as documents: all contents are kept, and only processed
/// parts change.
///
/// write() preserves materials, animations, skins, morph targets, extensions, extras, names and
/// images (their bytes, without re-encoding).
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image.h"
#include "relief/mesh/material.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

struct Deformation;  // mesh.h

/// One primitive of one mesh of a document.
struct GltfPrimitiveId {
    std::size_t mesh = 0;
    std::size_t primitive = 0;

    friend bool operator==(const GltfPrimitiveId&, const GltfPrimitiveId&) = default;
};

/// The texture coordinates at which a texture is looked up.
struct GltfTexcoords {
    int set = 0;  ///< TEXCOORD_n.
    GltfTextureTransform transform;

    friend bool operator==(const GltfTexcoords&, const GltfTexcoords&) = default;
};

/// An image in its encoded form: bytes from the document, or a file beside it.
struct GltfImage {
    std::string name;
    /// It has no bytes if `fault` states a reason.
    std::variant<std::vector<std::byte>, std::filesystem::path> source;
    /// The reason why the image cannot be read: "images[0].uri '../x.png' leads out of the
    /// document's folder, so it is not read". Empty if no problem is known before the image is
    /// decoded.
    std::string fault{};
};

/// A material as glTF defines it: factors have the values of the document, also those outside of
/// their ranges, and Phong's factors have their defaults.
struct GltfMaterial : Material {
    GltfMaterial() { metallic_roughness.emplace(); }

    // Material::emission is the product.
    glm::vec3 emission_factor{0.0F};
    float emission_strength = 1.0F;                             ///< KHR_materials_emissive_strength
    std::array<GltfTexcoords, texture_slot_count> texcoords{};  ///< By TextureSlot.
    /// The extensions that change the appearance and are not among the members, sorted. Extensions
    /// whose values change nothing are left out.
    std::vector<std::string> more_extensions;

    [[nodiscard]] const GltfTexcoords& texcoords_of(TextureSlot slot) const {
        return texcoords[static_cast<std::size_t>(slot)];
    }
};

enum class LightType { directional, point, spot };

template <>
inline constexpr auto enum_names<LightType> =
    std::to_array<EnumName<LightType>>({{"directional", LightType::directional},
                                        {"point", LightType::point},
                                        {"spot", LightType::spot}});

/// KHR_lights_punctual: the light points along its node's -z.
struct GltfLight {
    LightType type = LightType::directional;
    std::string name;
    glm::vec3 color{1.0F};
    float intensity = 1.0F;      ///< lux for directional, candela for the others
    std::optional<float> range;  ///< In units of length; unlimited if absent.
    float inner_cone = 0.0F;     ///< Radians from the axis.
    float outer_cone = 0.785398163F;
    std::size_t number = 0;  ///< In the document.
};

/// A camera; it looks along its node's -z.
struct GltfCamera {
    std::string name;
    float vertical_fov = 0.8F;  ///< Radians.
    float near = 0.1F;
    std::optional<float> far;  ///< Infinite if absent.
    /// The height of the picture in units of length, if the camera is orthographic.
    std::optional<float> orthographic_height{};
    std::size_t number = 0;  ///< In the document.
};

/// A node at rest: its transform relative to its parent.
struct GltfNode {
    std::string name;
    std::optional<std::size_t> parent;  ///< The world if absent.
    glm::vec3 translation{0.0F};
    glm::vec4 rotation{0.0F, 0.0F, 0.0F, 1.0F};  ///< Quaternion x, y, z, w.
    glm::vec3 scale{1.0F};
    std::optional<glm::mat4> matrix;  ///< Replaces the three members above.
    bool has_skin = false;
    bool has_morph_targets = false;      ///< True if a primitive of its mesh has morph targets.
    std::optional<std::size_t> skin{};   ///< Index into GltfView::skins.
    std::vector<float> morph_weights{};  ///< At rest, one for each morph target of its mesh.
};

/// The joints of a skin.
struct GltfSkin {
    std::vector<std::size_t> joints;         ///< Nodes.
    std::vector<glm::mat4> joint_from_mesh;  ///< Inverse bind matrices, one for each joint.
};

/// The displacements of a morph target, one for each vertex; empty where it has none.
struct GltfMorphTarget {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec3> tangents;
};

/// Four joints of each vertex with their weights.
struct GltfJoints {
    std::vector<glm::uvec4> joints;  ///< Indices into GltfSkin::joints, which may be too large.
    std::vector<glm::vec4> weights;
};

/// The skin and the morph targets of a primitive, for the vertices of GltfDocument::mesh().
struct GltfDeformation {
    std::vector<GltfMorphTarget> targets;
    std::vector<GltfJoints> joints;  ///< Those of JOINTS_0, JOINTS_1, ...
};

/// The interpolation between two keys, as in glTF.
enum class KeyInterpolation {
    step,          ///< The value of the previous key.
    linear,        ///< Linear; rotations along the shortest arc.
    cubic_spline,  ///< Cubic Hermite, with a tangent before and after each key.
};

template <>
inline constexpr auto enum_names<KeyInterpolation> =
    std::to_array<EnumName<KeyInterpolation>>({{"step", KeyInterpolation::step},
                                               {"linear", KeyInterpolation::linear},
                                               {"cubic_spline", KeyInterpolation::cubic_spline}});

/// The keys of one property of a node. The first value holds before the first key, the last value
/// after the last key.
struct KeyChannel {
    enum class Property { translation, rotation, scale, weights, pointer };

    std::size_t node = 0;
    Property property = Property::translation;
    KeyInterpolation interpolation = KeyInterpolation::linear;
    std::vector<float> times;  ///< Ascending, at least one.
    /// One for each time, or three for cubic_spline: in-tangent, value, out-tangent. Quaternions
    /// are x, y, z, w of any length but 0; w of other properties is ignored.
    std::vector<glm::vec4> values;
    /// The weights of all morph targets of the node's mesh, for each time, or three times for each;
    /// only for Property::weights, which has no `values`.
    std::vector<float> weights{};
    /// The JSON pointer of the property; only for Property::pointer (KHR_animation_pointer), where
    /// `node` is 0, and missing components of the values are 0.
    std::string pointer{};
};

template <>
inline constexpr auto enum_names<KeyChannel::Property> =
    std::to_array<EnumName<KeyChannel::Property>>({{"translation",
                                                    KeyChannel::Property::translation},
                                                   {"rotation", KeyChannel::Property::rotation},
                                                   {"scale", KeyChannel::Property::scale},
                                                   {"weights", KeyChannel::Property::weights},
                                                   {"pointer", KeyChannel::Property::pointer}});

/// Key frames that repeat from the start.
struct KeyAnimation {
    std::string name;
    std::vector<KeyChannel> channels;
};

/// An item of the document with its transform to the world (of the default scene, or the first
/// one).
template <typename T>
struct GltfInstance {
    T what;
    glm::mat4 world_from_object{1.0F};
    std::string name;  ///< Name of the node.
    std::size_t node = 0;
    glm::mat4 node_from_object{1.0F};  ///< For instances of EXT_mesh_gpu_instancing.
};

/// The data of a document that a renderer needs. Animations and skins are at rest; instances of
/// EXT_mesh_gpu_instancing are separate items.
struct GltfView {
    std::vector<GltfNode> nodes;  ///< All nodes of the document, in its order.
    std::vector<GltfInstance<GltfPrimitiveId>> primitives;  ///< Triangles only.
    std::vector<GltfInstance<GltfLight>> lights;
    std::vector<GltfInstance<GltfCamera>> cameras;
    std::vector<GltfMaterial> materials;
    std::vector<GltfImage> images;
    std::vector<GltfSkin> skins{};
    std::vector<std::string> required_extensions{};  ///< In the order of the document.
    std::vector<std::string> material_variants{};    ///< Names (KHR_materials_variants).
};

/// The texture coordinates to which the tangents of a primitive belong.
struct GltfTangentTexcoords {
    int set = 0;  ///< TEXCOORD_n.
    /// The texture of its material that needs them: "normalTexture", "clearcoatNormalTexture" or
    /// "anisotropyTexture"; empty if there is none. The set is then the first one.
    std::string texture;
    /// The set that the texture names, if the primitive does not have it; `set` is then the first
    /// one.
    std::optional<int> missing;
    /// True if KHR_texture_transform rotates or mirrors the texture. Tangents still belong to the
    /// stored coordinates: a renderer rotates them together with the texture.
    bool is_rotated = false;

    friend bool operator==(const GltfTangentTexcoords&, const GltfTangentTexcoords&) = default;
};

/// The compression of parts of a file when it was read.
struct GltfCompression {
    std::string extension;    ///< "KHR_draco_mesh_compression", ...
    std::string element;      ///< The compressed elements: "primitive" or "buffer view".
    std::size_t decoded = 0;  ///< Number of decoded elements, written uncompressed.
    std::size_t copies = 0;   ///< Number of elements with plain data beside the compressed data;
                              ///< both are written unchanged.
};

/// A lower level of detail of a mesh.
struct GltfLevel {
    std::size_t mesh = 0;
    /// The part of the screen, 0 to 1, below which the level replaces the one before.
    double max_coverage = 0.0;
};

/// The location of an image: in the document, or in a file next to it.
enum class GltfImageStorage { embedded, external };

class GltfDocument {
  public:
    /// Reads a .gltf or .glb file; the content decides which it is.
    ///
    /// Compressed parts (KHR_draco_mesh_compression; EXT_ and KHR_meshopt_compression in all modes,
    /// filters and versions) are decoded here and written uncompressed. Accessors, nodes and
    /// everything else do not change, except that min and max of values that Draco quantized are
    /// those of the decoded values. If a file also has the plain data, that is used, and both are
    /// kept.
    ///
    /// \param report  counts unusual but harmless parts: images that are missing or outside the
    ///         folder (the latter are never opened), bytes behind a GLB, accessors whose count
    ///         differs from that of their compressed data
    /// \throws FileError if the file is unreadable; if a known property has the wrong type, or an
    ///         index, count, offset or length is out of range; if nodes form a cycle or share a
    ///         child; if the file requires an extension that relief can neither keep nor decode; if
    ///         compressed data is damaged; or if a buffer is missing or outside the folder
    static GltfDocument read(const std::filesystem::path& file, Report& report = IgnoredReport());

    /// Creates a document with one mesh: a primitive for each material range with its own vertices,
    /// and materials converted from MTL. Kd and d become the base color (within [0,1]), roughness
    /// is (2 / (Ns + 2))^(1/4), metallic 0, Ke becomes emission (KHR_materials_emissive_strength
    /// above 1), norm the normal map. Images are embedded without re-encoding, with the names of
    /// their files, which are converted from Latin-1 if they are not UTF-8. Bump maps (heights),
    /// specular and opacity maps are left out, because glTF cannot hold them. So are the textures
    /// of a primitive without texture coordinates, and tangents without normals. Normals are
    /// normalized (OBJ allows any length). Values that are not finite stay, and write() refuses
    /// them. The origin of the file becomes the node's translation.
    ///
    /// \throws FileError if an image is missing or neither PNG nor JPEG; InvalidInput if the mesh
    ///         is not valid, has no triangle or names a missing material
    static GltfDocument from_mesh(const MeshFile& contents);

    /// The same, but a material whose image is missing loses that texture, and values that glTF
    /// forbids are repaired as set_frames() with a report does.
    ///
    /// \param report  names each such texture, and each map_d that is not map_Kd: material, file
    /// and
    ///                problem; counts converted names, and each kind of repaired value
    static GltfDocument from_mesh(const MeshFile& contents, Report& report);

    /// Writes from_mesh(contents, report), as write() does, but copies no array of a mesh whose
    /// triangles have one material.
    ///
    /// \throws FileError if the file cannot be written; else as from_mesh()
    static void write_mesh(const std::filesystem::path& file, const MeshFile& contents,
                           Report& report);

    GltfDocument(GltfDocument&&) noexcept;
    GltfDocument& operator=(GltfDocument&&) noexcept;
    ~GltfDocument();

    /// Writes .glb (one file, in which images of files and data URIs are embedded) or .gltf (JSON,
    /// with its buffer beside it as NAME.bin), by extension. Files are written to temporary ones
    /// and renamed: after a failure, the old document is unchanged, and so is its buffer unless the
    /// file system cannot exchange two files (NFS, vfat).
    ///
    /// Buffers are joined into one with the name and extras of the first. Replaced parts are left
    /// out; everything else keeps its bytes. For a .gltf in another folder, image files are copied
    /// to the same relative paths. Missing images stay missing.
    ///
    /// The written file is valid glTF 2.0, except for missing images and for extensions that relief
    /// does not know. Faults of the document that was read are repaired in the file, not in this
    /// object: accessors that glTF does not permit at their place (buffer views shared without
    /// byteStride, offsets and strides of vertices that are not multiples of 4) are stored anew;
    /// bounds are recomputed; normals, tangents and rotations get unit length, the w of tangents
    /// becomes 1 or -1; weights of joints get the sum 1; colors and factors are clamped; texture
    /// coordinates become (0,0) and tangents MikkTSpace's if a material needs them; extensions are
    /// declared; empty arrays and properties without a meaning are left out.
    ///
    /// \param report  counts each kind of repair
    /// \throws FileError if the file cannot be written, if another file is in the place of an
    ///         image, if NAME.bin is a buffer of another document that was read as this one, or if
    ///         an image lies outside the document's folder and the target is in another folder;
    ///         also, with the place and the remedy, if a fault has no repair: indices of vertices
    ///         or joints out of range, values that are not finite, attributes of different lengths
    ///         or of types that glTF forbids, matrices that are no translation, rotation and scale,
    ///         skins whose joints have no common root, and required arrays that are empty
    void write(const std::filesystem::path& file, Report& report = IgnoredReport()) const;

    /// Returns all primitives of triangles (lists, strips, fans) with positions, each once, in
    /// document order.
    [[nodiscard]] std::vector<GltfPrimitiveId> triangle_primitives() const;

    /// Returns "mesh 'Body' primitive 0", for messages.
    [[nodiscard]] std::string describe(GltfPrimitiveId id) const;

    /// Returns a primitive as plain arrays: with explicit indices, strips and fans as triangles,
    /// sparse and normalized-integer accessors as floats, one texture coordinate set, and color set
    /// 0. Its only material range names the document's material. If primitives share vertices and
    /// this one does not use all of them, the mesh has only the used ones, in the same order.
    /// \param texcoord_set  TEXCOORD_n; the mesh has no texture coordinates if it is absent
    /// \throws InvalidInput if indices are out of range or their count is not a multiple of 3, if
    ///         attributes differ in length or have the wrong type, or if there is no such primitive
    [[nodiscard]] Mesh mesh(GltfPrimitiveId id, int texcoord_set = 0) const;

    /// Returns the morph targets and the joints of a primitive.
    /// \throws InvalidInput if an attribute has the wrong type, or as mesh()
    [[nodiscard]] GltfDeformation deformation(GltfPrimitiveId id) const;

    /// Returns the material that a variant of KHR_materials_variants gives to a primitive.
    /// \param variant  index into GltfView::material_variants
    /// \return none if the variant does not change the material of this primitive
    /// \throws InvalidInput if there is no such primitive
    [[nodiscard]] std::optional<std::size_t> variant_material(GltfPrimitiveId id,
                                                              std::size_t variant) const;

    /// Returns how the vertices of mesh(id) move with joints and morph targets. Attributes of other
    /// types than glTF allows count as absent.
    /// \throws InvalidInput as mesh() does
    [[nodiscard]] Deformation deformation_sums(GltfPrimitiveId id) const;

    /// Returns the texture coordinate sets of a primitive, ascending.
    [[nodiscard]] std::vector<int> texcoord_sets(GltfPrimitiveId id) const;

    /// Returns the texture coordinate set to which the tangents of a primitive belong: that of its
    /// material's normal texture; KHR_texture_transform takes precedence.
    ///
    /// Without a normal texture it is the set of the clearcoat's normal texture or of the
    /// anisotropy texture, which use the same frame; otherwise the first set. The scale, rotation
    /// and offset of KHR_texture_transform do not affect tangents: they can be animated, and other
    /// textures of the material share the tangents but not the transform.
    /// \throws InvalidInput if there is no such primitive
    [[nodiscard]] GltfTangentTexcoords tangent_texcoords(GltfPrimitiveId id) const;

    /// Replaces NORMAL, TANGENT and POSITION of a primitive by those of `framed`, the result of
    /// with_frames() or decimated() for mesh(id). If vertices were split or removed, indices are
    /// rewritten, and all other attributes and morph targets follow, in their own types. Unchanged
    /// attributes keep their bytes. Primitives that shared the replaced data keep it, and share the
    /// new data if it is equal. Without normals or tangents in `framed`, the primitive and its
    /// morph targets lose them. Values that are not finite stay, and write() refuses them.
    /// \throws InvalidInput if `framed` does not belong to this primitive, or as mesh()
    void set_frames(GltfPrimitiveId id, const FramedMesh& framed);

    /// Like the above, and also updates NORMAL and TANGENT of morph targets.
    ///
    /// They become the frames of the displaced shape by the same method, minus those of the
    /// primitive. If corners that share a vertex at rest differ when displaced, the vertex is
    /// split. A target gets the attributes that it had. If the primitive had no NORMAL (TANGENT)
    /// and has it now, a target that changes the shape gets it too, because renderers derived it
    /// from the displaced shape. Attributes that are kept in the primitive are kept in its targets.
    ///
    /// Values that glTF forbids are repaired: the corners of triangles with a position that is not
    /// finite become one vertex, and such a position becomes that of another vertex; normals that
    /// are zero or not finite become (0,0,1), tangents that are not finite (1,0,0,1), colors 1, and
    /// other components and displacements that are not finite 0.
    /// \param framed   the result of with_frames() for mesh(id) with these options
    /// \param report   counts targets whose shape has findings that the primitive does not have
    ///         (degenerate triangles, for example), those that would change the handedness of
    ///         tangents, and each kind of repaired value
    /// \return the new number of vertices of the primitive
    /// \throws InvalidInput as above, or if a target's displacements have the wrong type
    std::size_t set_frames(GltfPrimitiveId id, const FramedMesh& framed,
                           const FrameOptions& options, Report& report = IgnoredReport());

    /// Replaces a texture coordinate set of a primitive, or adds it. If vertices were split,
    /// indices are rewritten, and all other attributes and morph targets follow, in their own
    /// types.
    ///
    /// The tangents stay, also if they belong to this set. Missing sets below it are (0,0), because
    /// glTF numbers sets without gaps.
    /// \param framed  the triangles of mesh(id) with their texture coordinates; its vertices are
    ///         copies of the primitive's by `source_vertex`
    /// \param report  counts missing lower sets, and morph targets that displaced this set: they
    ///         no longer do
    /// \throws InvalidInput if `framed` does not belong to this primitive, or as mesh()
    void set_texcoords(GltfPrimitiveId id, int set, const FramedMesh& framed,
                       Report& report = IgnoredReport());

    /// Returns the materials that a primitive has, also by variants, and that look up textures at a
    /// texture coordinate set, ascending.
    /// \throws InvalidInput if there is no such primitive
    [[nodiscard]] std::vector<std::size_t> materials_with_textures_at(GltfPrimitiveId id,
                                                                      int set) const;

    /// Removes all textures of a material that are looked up at a texture coordinate set. Its
    /// factors stay. Textures and images that nothing else uses are not written.
    /// \throws InvalidInput if there is no such material, or if an animation changes such a texture
    void remove_textures_at(std::size_t material, int set);

    /// Replaces the mesh of a primitive, as floats: positions, normals, tangents, texture
    /// coordinates (set 0) and colors. The material stays.
    /// \throws InvalidInput if the primitive has attributes that a mesh cannot hold (morph targets,
    ///         joints and weights, further texture coordinates), or if the mesh is not valid or has
    ///         no triangle
    void set_geometry(GltfPrimitiveId id, const Mesh& mesh);

    /// Appends a copy of a mesh, which no node uses. It shares all data until one of them changes.
    /// \return its index
    /// \throws InvalidInput if there is no such mesh
    std::size_t copy_mesh(std::size_t mesh);

    /// Removes the last mesh, for example a copy that turned out to be useless. Its data is not
    /// written unless something else uses it.
    /// \throws InvalidInput if there is no mesh, or if a node uses it
    void remove_last_mesh();

    /// Returns whether a node has lower levels of detail (MSFT_lod).
    [[nodiscard]] bool has_levels_of_detail() const;

    /// Gives each node of a mesh lower levels of detail (MSFT_lod, with MSFT_screencoverage in the
    /// node's extras). The nodes of the levels are copies of the node. If it has children, a camera
    /// or animations, its mesh moves to a new child first.
    ///
    /// \param levels      other meshes, from fine to coarse
    /// \param with_names  appends _LOD0, _LOD1, ... to the names of the nodes
    /// \throws InvalidInput if a node has levels already, or extras that are not an object
    void set_levels_of_detail(std::size_t mesh, std::span<const GltfLevel> levels, bool with_names);

    /// Appends a material with glTF's defaults, and assigns it to all primitives without one.
    /// \return its index
    std::size_t add_material(const std::string& name);

    /// Sets a texture of a material to an image file; the bytes of the file are kept.
    ///
    /// The sampler, the texture coordinate set, the transform and the factors stay. If nothing else
    /// uses the old texture, its entry changes, and its image is left out when the document is
    /// written. A file that is used for several textures is stored once. The image gets the name of
    /// the file, converted from Latin-1 if it is not UTF-8. If the material emits no light, an
    /// emissive map sets the emissive factor to 1.
    ///
    /// \param image    PNG or JPEG
    /// \param storage  external: write() copies the file beside a .gltf; a .glb embeds all images
    /// \param report   counts converted names, properties of the material that hide or transform
    ///                 the map, and primitives of the material without texture coordinates for it
    /// \throws FileError if the image cannot be read, is neither PNG nor JPEG, or has the name of
    ///         another external image; InvalidInput if there is no such material, if the texture
    ///         belongs to an extension or not to glTF, or if no primitive of the material has the
    ///         texture coordinates of the map
    void set_texture(std::size_t material, TextureSlot slot, const std::filesystem::path& image,
                     GltfImageStorage storage, Report& report = IgnoredReport());

    /// Sets the factor of the x and y of a material's normal map.
    /// \throws InvalidInput if there is no such material, or if it has no normal map
    void set_normal_scale(std::size_t material, double scale);

    /// Sets the alpha mode of a material. \param cutoff  for AlphaMode::mask
    /// \throws InvalidInput if there is no such material
    void set_alpha_mode(std::size_t material, AlphaMode mode, float cutoff);

    /// Sets the factors of a material: those of glTF's model with the opacity, the emission with
    /// its strength, and whether it is double-sided. Values are clamped to the ranges of glTF.
    /// Factors with their defaults are left out, and so are extensions without another value.
    /// Names, textures, `emission` and the alpha mode of `values` are ignored. \throws InvalidInput
    /// if there is no such material, or if a factor is not finite
    void set_factors(std::size_t material, const GltfMaterial& values);

    /// Returns the document as a scene.
    /// \throws InvalidInput if instance attributes have a wrong type or differ in length
    [[nodiscard]] GltfView view() const;

    /// Checks that one mesh of all instances in world space fits into the memory that the contents
    /// of the file may take (limits.h), besides what was read. Documents that were not read have no
    /// limit. \throws InvalidInput naming the first node that exceeds it; as view() does
    void require_memory_of_instances() const;

    /// Returns the animations of nodes, and of properties by KHR_animation_pointer, in the
    /// document's order. A pointer to a property of a node becomes an animation of the node.
    ///
    /// \param report  counts channels that are left out: those of other extensions, and those of
    ///         nodes with a matrix, which glTF does not animate; also those with times or values
    ///         that are not finite, of the wrong number, or of the wrong type
    [[nodiscard]] std::vector<KeyAnimation> animations(Report& report = IgnoredReport()) const;

    /// Returns the compression of the file, one entry for each extension; empty if there is none.
    [[nodiscard]] std::vector<GltfCompression> compression() const;

    /// Returns the contents that other formats cannot hold: "2 animations", "1 skin", "3 morph
    /// targets", ...
    [[nodiscard]] std::vector<std::string> unsupported_contents() const;

  private:
    struct Contents;
    explicit GltfDocument(std::unique_ptr<Contents> contents);
    std::unique_ptr<Contents> contents_;
};

/// Joins all primitives of the default scene in world space into one mesh, with materials converted
/// to MTL (names, base color, image paths for image files), for OBJ and PLY.
///
/// With a negative scale the winding is reversed, so that faces stay counter-clockwise. If only
/// some primitives have normals, texture coordinates or colors, the others get flat normals, (0,0)
/// and white. Tangents are left out. \throws InvalidInput as GltfDocument::view(), mesh() and
/// require_memory_of_instances()
MeshFile flattened(const GltfDocument& document);

}  // namespace relief
