// SPDX-License-Identifier: Apache-2.0
/// \file
/// glTF and GLB files as documents: what is read is kept, and only what is processed changes.
///
/// Materials, animations, skins, morph targets, extensions, extras, names and images (their bytes,
/// never re-encoded) come out of write() as they went into read().
/// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// One primitive of one mesh of a document.
struct GltfPrimitiveId {
    std::size_t mesh = 0;
    std::size_t primitive = 0;

    friend bool operator==(const GltfPrimitiveId&, const GltfPrimitiveId&) = default;
};

enum class TextureWrap { repeat, clamp, mirror };
enum class TextureFilter { linear, nearest };

/// KHR_texture_transform: texture coordinates are scaled, then turned, then shifted.
struct GltfTextureTransform {
    glm::vec2 offset{0.0F};
    float rotation = 0.0F;  ///< Radians; the image turns clockwise.
    glm::vec2 scale{1.0F};

    friend bool operator==(const GltfTextureTransform&, const GltfTextureTransform&) = default;
};

/// The coordinates at which the image is looked up. Both have v downwards.
glm::vec2 transformed(const GltfTextureTransform& transform, const glm::vec2& texcoord);

/// The tangent of the coordinates after a transform, from that of those before: both of the frames
/// in which a renderer reads a normal map whose coordinates it transforms.
///
/// \param tangent  unit, w = +1 or -1, with its normal, unit, as in mesh.h
/// \return turned in the plane of the normal, w negated where the transform mirrors; exact where
/// the
///         image lies on the surface undistorted, or where axes are only scaled and mirrored. A
///         transform that shows a line or a point of the image changes nothing
glm::vec4 transformed(const GltfTextureTransform& transform, const glm::vec4& tangent,
                      const glm::vec3& normal);

/// A use of an image as a texture.
struct GltfTexture {
    std::size_t image = 0;  ///< Index into GltfView::images.
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    int texcoord_set = 0;
    GltfTextureTransform transform;
};

/// An image in its encoded form: bytes from the document, or a file beside it.
struct GltfImage {
    std::string name;
    /// Without bytes where `fault` says why.
    std::variant<std::vector<std::byte>, std::filesystem::path> source;
    /// Why the image cannot be read: "images[0].uri '../x.png' leads out of the document's folder,
    /// so it is not read". Empty: nothing is known to be wrong before the image is decoded.
    std::string fault{};
};

/// A material as glTF defines it; colours linear.
struct GltfMaterial {
    std::string name;
    glm::vec4 base_color{1.0F};
    float metallic = 1.0F;
    float roughness = 1.0F;
    glm::vec3 emission{0.0F};  ///< emissiveFactor times KHR_materials_emissive_strength.
    std::optional<GltfTexture> base_color_texture;
    std::optional<GltfTexture> metallic_roughness_texture;  ///< Green roughness, blue metallic.
    std::optional<GltfTexture> normal_texture;
    std::optional<GltfTexture> emission_texture;
    std::optional<GltfTexture> occlusion_texture;  ///< Red: how much of the surroundings gets here.
    float normal_scale = 1.0F;
    float occlusion_strength = 1.0F;
    enum class AlphaMode { opaque, mask, blend } alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5F;  ///< Of AlphaMode::mask: what is below is not there.
    bool double_sided = false;
    bool unlit = false;  ///< KHR_materials_unlit
};

/// KHR_lights_punctual: looks along its node's -z.
struct GltfLight {
    enum class Type { directional, point, spot } type = Type::directional;
    std::string name;
    glm::vec3 color{1.0F};
    float intensity = 1.0F;      ///< lux for directional, candela for the others
    std::optional<float> range;  ///< Unit of length; absent: unlimited.
    float inner_cone = 0.0F;     ///< Radians from the axis.
    float outer_cone = 0.785398163F;
};

/// A perspective camera; looks along its node's -z.
struct GltfCamera {
    std::string name;
    float vertical_fov = 0.8F;  ///< Radians.
    float near = 0.1F;
    std::optional<float> far;  ///< Absent: infinite.
};

/// A node at rest: where its space stands in its parent's.
struct GltfNode {
    std::string name;
    std::optional<std::size_t> parent;  ///< Absent: the world.
    glm::vec3 translation{0.0F};
    glm::vec4 rotation{0.0F, 0.0F, 0.0F, 1.0F};  ///< Quaternion x, y, z, w.
    glm::vec3 scale{1.0F};
    std::optional<glm::mat4> matrix;  ///< Takes the place of the three above.
    bool has_skin = false;
    bool has_morph_targets = false;  ///< Some primitive of its mesh has.
};

/// The keys of one property of one node.
struct GltfChannel {
    enum class Path { translation, rotation, scale };
    enum class Interpolation { step, linear, cubic_spline };

    std::size_t node = 0;
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;  ///< Seconds.
    /// One for each time, or three for cubic_spline: in-tangent, value, out-tangent. Rotations are
    /// quaternions x, y, z, w; of the others w is 0.
    std::vector<glm::vec4> values;
};

struct GltfAnimation {
    std::string name;
    std::vector<GltfChannel> channels;
};

/// A thing of the document at its place in the world (the default scene, or the first).
template <typename T>
struct GltfPlaced {
    T what;
    glm::mat4 world_from_object{1.0F};
    std::string name;  ///< The node's.
    std::size_t node = 0;
    glm::mat4 node_from_object{1.0F};  ///< Of instances of EXT_mesh_gpu_instancing.
};

/// What a renderer needs of a document, in plain data. Animations and skins are at rest; instances
/// of EXT_mesh_gpu_instancing are placed one by one; orthographic cameras are left out.
struct GltfView {
    std::vector<GltfNode> nodes;                          ///< All of the document's, in its order.
    std::vector<GltfPlaced<GltfPrimitiveId>> primitives;  ///< Triangles only.
    std::vector<GltfPlaced<GltfLight>> lights;
    std::vector<GltfPlaced<GltfCamera>> cameras;
    std::vector<GltfMaterial> materials;
    std::vector<GltfImage> images;
};

/// Which texture coordinates the tangents of a primitive belong to.
struct GltfTangentTexcoords {
    int set = 0;  ///< TEXCOORD_n.
    /// The texture of its material that asks for them: "normalTexture", "clearcoatNormalTexture" or
    /// "anisotropyTexture"; empty where none does, and the set is the first that there is.
    std::string texture;
    /// The set that the texture names, where the primitive does not have it: `set` is then the
    /// first that it has.
    std::optional<int> missing;
    /// KHR_texture_transform turns or mirrors the texture. Tangents belong to the coordinates as
    /// stored all the same: a renderer turns them together with the texture.
    bool is_turned = false;

    friend bool operator==(const GltfTangentTexcoords&, const GltfTangentTexcoords&) = default;
};

/// One way in which parts of a file were compressed when it was read.
struct GltfCompression {
    std::string extension;    ///< "KHR_draco_mesh_compression", ...
    std::string element;      ///< What it compresses: "primitive" or "buffer view".
    std::size_t decoded = 0;  ///< How many were decoded, and are written plain.
    std::size_t copies = 0;   ///< How many have their plain data beside it; written as they are.
};

class GltfDocument {
  public:
    /// Reads a .gltf or .glb file, told apart by content.
    ///
    /// What is compressed (KHR_draco_mesh_compression; EXT_ and KHR_meshopt_compression in all
    /// modes, filters and versions) is decoded here and written plain; accessors, nodes and all
    /// else stay as they are, except that min and max of what Draco quantised are those of the
    /// decoded values. Where the plain data is in the file as well, that is used, and both stay.
    ///
    /// \param report  counts what is unusual but harmless: images that are missing or outside the
    ///                folder (such are never opened), bytes behind a GLB, accessors whose count is
    ///                not that of their compressed data
    /// \throws FileError if the file is unreadable; if a property that relief knows has the wrong
    ///         type, or an index, count, offset or length is out of range; if nodes form a cycle or
    ///         share a child; if it requires an extension that relief does not know how to keep or
    ///         decode; if compressed data is damaged; or if it names a buffer that is missing or
    ///         outside its folder
    static GltfDocument read(const std::filesystem::path& file, Report& report);

    /// A new document with one mesh, a primitive for each material range over its own vertices, and
    /// materials translated from MTL: Kd and d to base colour (within [0,1]), roughness =
    /// (2 / (Ns + 2))^(1/4), metallic 0, Ke to emission (KHR_materials_emissive_strength above 1),
    /// norm to the normal map. Images are embedded as they are; bump maps (heights), specular and
    /// opacity maps have no place in glTF and are left out. Normals of other than unit length,
    /// which OBJ allows, are scaled. The origin of the file becomes the node's translation. \throws
    /// FileError if an image is missing or neither PNG nor JPEG; InvalidInput if the mesh is
    ///         not valid, has no triangle or names a material that is not there
    static GltfDocument from_mesh(const MeshFile& contents);

    /// The same, but a material whose image is missing is written without that texture.
    ///
    /// \param report  names each such texture: its material, its file and what is wrong
    static GltfDocument from_mesh(const MeshFile& contents, Report& report);

    GltfDocument(GltfDocument&&) noexcept;
    GltfDocument& operator=(GltfDocument&&) noexcept;
    ~GltfDocument();

    /// Writes .glb (one file, images in files and data URIs put inside) or .gltf (JSON, with its
    /// buffer beside it as NAME.bin), by extension. Written beside and renamed.
    ///
    /// Buffers become one, with the name and extras of the first; what set_frames replaced is left
    /// out, and all else keeps its bytes. A .gltf in another folder gets copies of the images that
    /// lie in files, at the same place below it. Images that are missing stay missing.
    /// \throws FileError if it cannot be written, if a file of other content is where an image
    ///         should go, or if an image lies outside the document's folder and the target is not
    ///         in that same folder
    void write(const std::filesystem::path& file) const;

    /// All primitives made of triangles (lists, strips, fans) that have positions, each once, in
    /// document order.
    [[nodiscard]] std::vector<GltfPrimitiveId> triangle_primitives() const;

    /// "mesh 'Body' primitive 0", for messages.
    [[nodiscard]] std::string describe(GltfPrimitiveId id) const;

    /// A primitive in plain arrays: indices made explicit, strips and fans unrolled, sparse and
    /// normalised-integer accessors made float; one texture coordinate set, colour set 0. Its one
    /// material range names the document's material. Where primitives share an array of vertices
    /// and this one uses only a part of it, the mesh has that part, in the same order.
    /// \param texcoord_set  TEXCOORD_n; the mesh has no texture coordinates where there is none
    /// \throws InvalidInput if indices are out of range or make no whole triangles, if attributes
    ///         differ in number or have the wrong type, or if there is no such primitive
    [[nodiscard]] Mesh mesh(GltfPrimitiveId id, int texcoord_set = 0) const;

    /// The texture coordinate sets that a primitive has, ascending.
    [[nodiscard]] std::vector<int> texcoord_sets(GltfPrimitiveId id) const;

    /// Those that its tangents belong to: the set of its material's normal texture, where
    /// KHR_texture_transform has the last word.
    ///
    /// Where there is no normal texture, the set of the clearcoat's normal texture or of the
    /// anisotropy texture, which are looked up in the same frame; else the first set. Scales,
    /// turns and shifts of KHR_texture_transform have no say in tangents: they can be animated, and
    /// other textures of the material share the tangents without sharing the transform.
    /// \throws InvalidInput if there is no such primitive
    [[nodiscard]] GltfTangentTexcoords tangent_texcoords(GltfPrimitiveId id) const;

    /// Replaces a primitive's NORMAL and TANGENT by those of `framed`, which with_frames() or
    /// decimated() made from mesh(id). Where vertices were split or left out, indices are rewritten
    /// and every other attribute and morph target is carried along, in its own type. Attributes
    /// that did not change keep their bytes; primitives that shared what is replaced keep theirs,
    /// and share the new where they come to the same. Without normals or tangents in `framed` the
    /// primitive loses them, and so do its morph targets. \throws InvalidInput if `framed` does not
    /// belong to this primitive
    void set_frames(GltfPrimitiveId id, const FramedMesh& framed);

    /// The same for a primitive that may have morph targets: their NORMAL and TANGENT go with the
    /// new frames.
    ///
    /// They become the frames of the displaced shape by the same method, minus the primitive's;
    /// where corners that share a vertex at rest differ when displaced, the vertex is split. A
    /// target gets those that it had; and, where the primitive had no NORMAL (TANGENT) at all and
    /// now has, also those that its displaced shape needs, since without them a renderer made
    /// normals of that shape. What is kept in the primitive is kept in its targets.
    /// \param framed   what with_frames() made of mesh(id) with these options
    /// \param report   counts targets whose shape shows what the primitive does not (degenerate
    ///                 triangles, say), and those that would turn the handedness of tangents
    /// \return how many vertices the primitive has now
    /// \throws InvalidInput as above, or if a target's displacements have the wrong type
    std::size_t set_frames(GltfPrimitiveId id, const FramedMesh& framed,
                           const FrameOptions& options, Report& report);

    /// Puts another mesh in the place of a primitive's, as floats: its positions, normals,
    /// tangents, texture coordinates (set 0) and colours. The material stays. \throws InvalidInput
    /// if the primitive has what such a mesh cannot take over: morph targets,
    ///         joints and weights, further texture coordinates; or if the mesh is not valid or has
    ///         no triangle
    void set_geometry(GltfPrimitiveId id, const Mesh& mesh);

    /// The document as a scene. \throws InvalidInput if it cannot be read
    [[nodiscard]] GltfView view() const;

    /// The animations of nodes, in the document's order.
    ///
    /// \param report  counts what is left out: channels of morph weights or of what an extension
    ///                points at, and of nodes with a matrix, which glTF does not animate; channels
    ///                whose times or values are not finite, not as many as they must be, or of the
    ///                wrong type
    [[nodiscard]] std::vector<GltfAnimation> animations(Report& report) const;

    /// How parts of the file are compressed, one entry for each extension; empty where none is.
    [[nodiscard]] std::vector<GltfCompression> compression() const;

    /// What other formats cannot hold: "2 animations", "1 skin", "3 morph targets", ...
    [[nodiscard]] std::vector<std::string> beyond_a_mesh() const;

  private:
    struct Contents;
    explicit GltfDocument(std::unique_ptr<Contents> contents);
    std::unique_ptr<Contents> contents_;
};

/// All primitives of the default scene in world space as one mesh, with materials translated to
/// MTL (names, base colour, image paths where images are files), for OBJ and PLY. Negative scale
/// turns the winding, so that faces stay counter-clockwise. Where only some primitives have
/// normals, texture coordinates or colours, the others get flat normals, (0,0) and white. Tangents
/// are left out. \throws InvalidInput if it cannot be read
MeshFile flattened(const GltfDocument& document);

}  // namespace relief
