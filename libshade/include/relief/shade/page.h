// SPDX-License-Identifier: Apache-2.0
/// \file
/// Records pictures of scenes as plain data that WebGL 2 can draw without relief: programs in GLSL
/// ES 3.00, meshes, textures with their samplers, and the draws of each pass.
///
/// Uniforms that depend on the camera, on matrices of instances or on the time are not recorded:
/// docs/page.md names them with their rules. All others are those that OpenGL holds when the
/// renderer draws. Numbers of OpenGL, such as GL_REPEAT, are also WebGL's. World space is
/// right-handed, y up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"

namespace RELIEF_API relief {
namespace shade {

/// The texels of a page's texture.
enum class PageTexels : std::uint8_t {
    encoded,  ///< A PNG or JPEG file as the scene has it, at most 8 bits per sample.
    bits_8,   ///< Rows of samples.
    bits_16,  ///< Rows of little-endian samples.
    floats,   ///< Rows of little-endian floats.
    rgb9e5,   ///< 32 bits per texel with a shared exponent.
};

struct PageTexture {
    enum class Kind : std::uint8_t {
        map,   ///< Two dimensions; one level, from which the others are computed (mip_levels()).
        cube,  ///< All levels, the largest first, each with the faces +x -x +y -y +z -z.
        rows,  ///< Texels by number, for buffer_texel() of shaders/version.glsl.
    };
    Kind kind = Kind::map;
    PageTexels texels = PageTexels::bits_8;
    bool is_srgb = false;     ///< The samples are sRGB codes, which lookups decode.
    bool has_levels = false;  ///< Minification uses smaller levels.
    bool has_maxima = false;  ///< The levels are maxima of heights (shaders/height_march.glsl).
    bool is_gray = false;     ///< One or two channels are gray, and gray with alpha.
    int channels = 4;
    std::string image = {};  ///< The name of the scene's image that it shows, if there is one.
    int width = 0;           ///< Of `rows`, the number of texels.
    int height = 1;
    std::size_t section = 0;
};

/// A sampler object, in OpenGL's numbers.
struct PageSampler {
    unsigned wrap_u = 0;
    unsigned wrap_v = 0;
    unsigned minify = 0;
    unsigned magnify = 0;
    float anisotropy = 1.0F;

    friend auto operator<=>(const PageSampler&, const PageSampler&) = default;
};

/// A texture and its sampler.
struct PageLookup {
    std::size_t texture = 0;
    std::size_t sampler = 0;

    friend auto operator<=>(const PageLookup&, const PageLookup&) = default;
};

/// A shader in GLSL ES 3.00, to be assembled from PageDescription::parts: the head, then the main
/// part, whose lines `//@include "ADDRESS"` and `//@include <STEP>` stand for other parts. Each
/// part enters once. A global variable `TYPE NAME = VALUE;` gets its value where main() begins.
/// Then the lookups are changed.
struct PageStage {
    std::string head;                          ///< The version, the precision and constants.
    std::string main;                          ///< The address of the main part.
    std::map<std::string, std::string> steps;  ///< The part of each step.
    /// Texts and what stands instead: lookups at second or displaced texture coordinates.
    std::map<std::string, std::string> lookups;

    friend auto operator<=>(const PageStage&, const PageStage&) = default;
};

struct PageProgram {
    PageStage vertex;
    PageStage fragment;

    friend auto operator<=>(const PageProgram&, const PageProgram&) = default;
};

/// A vertex attribute: floats in a section.
struct PageStream {
    std::string attribute;
    int components = 3;
    std::size_t section = 0;

    friend auto operator<=>(const PageStream&, const PageStream&) = default;
};

struct PageMesh {
    std::vector<PageStream> streams;  ///< Attributes without a stream keep their constant.
    std::size_t triangles = 0;        ///< The section of the 32-bit indices.

    friend auto operator<=>(const PageMesh&, const PageMesh&) = default;
};

/// The values and textures that the draws of one material share.
struct PageSurface {
    std::map<std::string, std::vector<float>> values;  ///< Of uniforms, by name.
    std::map<std::string, PageLookup> textures;        ///< Of samplers, by name.

    friend auto operator<=>(const PageSurface&, const PageSurface&) = default;
};

/// The lights that a program reads, as light_rows.h of libshade/src/effects arranges them.
struct PageLights {
    std::uint32_t directional = 0;
    std::uint32_t point = 0;
    std::uint32_t spot = 0;
    bool highlight_colors = false;

    friend auto operator<=>(const PageLights&, const PageLights&) = default;
};

enum class PagePass : std::uint8_t { covering, transmissive, blended };

struct PageDraw {
    PagePass pass = PagePass::covering;
    std::size_t program = 0;
    std::optional<std::size_t> shadow_program;  ///< If it casts a shadow.
    std::size_t mesh = 0;
    std::size_t surface = 0;
    std::size_t instance = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
    bool both_sides = false;
    PageLights lights;
    std::map<std::string, std::size_t> rows;     ///< Textures by vertex, by name of the sampler.
    int joint_pairs = 0;                         ///< Texels of joint_weights for a vertex.
    glm::ivec2 morph_texels{0};                  ///< Of morph_displacements: of a target, a vertex.
    std::optional<std::size_t> overlay_program;  ///< In one color, if the picture has overlays.
    bool hides_overlays = false;
};

/// Lines or discs over the finished picture (Overlays). Their colors are sRGB codes from 0 to 1.
struct PageOverlay {
    enum class Kind : std::uint8_t {
        grid,       ///< Lines.
        wireframe,  ///< The edges of the drawn triangles, by the programs of the draws.
        frames,     ///< Lines of the vertices in the recorded pose.
        markers,    ///< Discs on an instance, with a color per vertex, which nothing hides.
    };
    Kind kind = Kind::grid;
    std::size_t program = 0;
    std::size_t mesh = 0;  ///< Pairs of vertices, or vertices; without triangles.
    std::size_t count = 0;
    glm::vec3 color_srgb{0.0F};
    glm::dvec3 origin{0.0};  ///< Of lines, in world space.
    std::optional<std::size_t> instance;
};

/// A pass over the whole picture.
struct PageScreenPass {
    std::size_t program = 0;
    PageSurface surface;
};

/// One picture of a page: a scene in a view, with its draws in the renderer's order.
struct PagePicture {
    std::vector<PageDraw> draws;
    std::optional<PageScreenPass> skybox;
    std::optional<PageScreenPass> finishing;  ///< Surfaces are drawn into half floats.
    int samples = 1;
    bool has_shadow_maps = false;
    bool copies_behind = false;         ///< For transmissive surfaces.
    bool counts_fragments = false;      ///< The overdraw view.
    std::vector<PageOverlay> overlays;  ///< In the order in which they are drawn.
    glm::vec4 clear_color{0.0F};        ///< Of the target of surfaces.
};

/// All pictures, and what they share.
struct PageDescription {
    std::vector<std::vector<std::byte>> sections;
    std::vector<PageTexture> textures;
    std::vector<PageSampler> samplers;
    std::vector<PageProgram> programs;
    std::map<std::string, std::string> parts;  ///< The parts of all programs, by address.
    std::vector<PageMesh> meshes;
    std::vector<PageSurface> surfaces;
    std::vector<PagePicture> pictures;
};

/// Records pictures for a page.
class PageRecorder {
  public:
    explicit PageRecorder(const Context& context);
    ~PageRecorder();
    PageRecorder(const PageRecorder&) = delete;
    PageRecorder& operator=(const PageRecorder&) = delete;

    /// Records one picture. Meshes that move in time are recorded with all of their deformations.
    ///
    /// \param plan      for one sample per pixel
    /// \param settings  of the picture; coding srgb. With 4 samples, surfaces
    ///                  without blending and transmission write what the picture shows of them, so
    ///                  that the mean of samples is exact; others write radiance
    /// \param report    also counts what WebGL 2 does not guarantee, and what the page leaves out
    /// \throws GpuError if a program samples more than 16 textures, which is what WebGL 2
    ///         guarantees; InvalidInput if the rows of a mesh do not fit a texture; as Renderer
    ///         does
    void add(const SceneGraph& graph, const FramePlan& plan, const FrameSettings& settings,
             Report& report = IgnoredReport());

    [[nodiscard]] const PageDescription& description() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace shade

template <>
inline constexpr auto enum_names<shade::PageTexels> =
    std::to_array<EnumName<shade::PageTexels>>({{"encoded", shade::PageTexels::encoded},
                                                {"bits_8", shade::PageTexels::bits_8},
                                                {"bits_16", shade::PageTexels::bits_16},
                                                {"floats", shade::PageTexels::floats},
                                                {"rgb9e5", shade::PageTexels::rgb9e5}});

template <>
inline constexpr auto enum_names<shade::PageTexture::Kind> =
    std::to_array<EnumName<shade::PageTexture::Kind>>({{"map", shade::PageTexture::Kind::map},
                                                       {"cube", shade::PageTexture::Kind::cube},
                                                       {"rows", shade::PageTexture::Kind::rows}});

template <>
inline constexpr auto enum_names<shade::PageOverlay::Kind> =
    std::to_array<EnumName<shade::PageOverlay::Kind>>(
        {{"grid", shade::PageOverlay::Kind::grid},
         {"wireframe", shade::PageOverlay::Kind::wireframe},
         {"frames", shade::PageOverlay::Kind::frames},
         {"markers", shade::PageOverlay::Kind::markers}});

template <>
inline constexpr auto enum_names<shade::PagePass> =
    std::to_array<EnumName<shade::PagePass>>({{"covering", shade::PagePass::covering},
                                              {"transmissive", shade::PagePass::transmissive},
                                              {"blended", shade::PagePass::blended}});

}  // namespace relief
