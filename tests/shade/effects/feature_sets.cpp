// SPDX-License-Identifier: Apache-2.0
#include "shade/effects/feature_sets.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>
#include <set>

#include "relief/mesh/frames.h"
#include "relief/shade/scene.h"
#include "support/shapes.h"

namespace relief::test {
using namespace relief::shade;

namespace {

template <auto Member, unsigned Count = 2>
FeatureField field(const char* name) {
    using Value = std::decay_t<decltype(std::declval<Features>().*Member)>;
    return {name, Count, [](const Features& f) { return static_cast<unsigned>(f.*Member); },
            [](Features& f, unsigned value) { f.*Member = static_cast<Value>(value); }};
}

constexpr std::uint32_t second_bit(TextureSlot slot) {
    return 1U << static_cast<unsigned>(slot);
}

/// A bit of Features::second_texcoords.
template <TextureSlot Slot>
FeatureField second(const char* name) {
    return {
        name, 2,
        [](const Features& f) { return (f.second_texcoords & second_bit(Slot)) != 0 ? 1U : 0U; },
        [](Features& f, unsigned value) {
            f.second_texcoords =
                (f.second_texcoords & ~second_bit(Slot)) | value * second_bit(Slot);
        }};
}

constexpr unsigned max_values = 6;

/// Bits of the values of all fields: value v of field i has the number i * max_values + v.
using ValueBits = std::vector<std::uint64_t>;

/// A set and an upper bound of the pairs that it adds. The bound is its last count, since the
/// number of new pairs only decreases.
struct Candidate {
    const Features* features;
    std::vector<std::size_t> values;  ///< The number of the value of each field.
    ValueBits bits;                   ///< The same values.
    std::size_t bound = static_cast<std::size_t>(-1);
};

/// The pairs of values of two fields that occurred.
class CoveredPairs {
  public:
    explicit CoveredPairs(std::size_t fields)
        : words_((fields * max_values + 63) / 64), met_(fields * max_values, ValueBits(words_, 0)) {
        for (std::size_t value = 0; value < met_.size(); ++value)
            set(met_[value], value);  // A value is no pair with itself.
    }

    [[nodiscard]] Candidate candidate(const Features& features) const {
        Candidate made{&features, {}, ValueBits(words_, 0)};
        for (const FeatureField& field : feature_fields()) {
            made.values.push_back(made.values.size() * max_values + field.get(features));
            set(made.bits, made.values.back());
        }
        return made;
    }

    [[nodiscard]] std::size_t fresh_in(const Candidate& candidate) const {
        std::size_t fresh = 0;  // Each pair is counted from both sides.
        for (const std::size_t value : candidate.values) {
            const std::uint64_t* const met = met_[value].data();
            const std::uint64_t* const bits = candidate.bits.data();
            for (std::size_t word = 0; word < words_; ++word) {
                const std::uint64_t rest = bits[word] & ~met[word];
                if (rest != 0) fresh += static_cast<std::size_t>(std::popcount(rest));
            }
        }
        return fresh / 2;
    }
    void add(const Candidate& candidate) {
        for (const std::size_t value : candidate.values) {
            for (std::size_t word = 0; word < words_; ++word)
                met_[value][word] |= candidate.bits[word];
        }
    }

  private:
    static void set(ValueBits& bits, std::size_t value) {
        bits[value / 64] |= std::uint64_t{1} << (value % 64);
    }

    std::size_t words_;
    std::vector<ValueBits> met_;  ///< Of each value, the values that it met.
};

}  // namespace

const std::vector<FeatureField>& feature_fields() {
    using F = Features;
    static const std::vector<FeatureField> all = {
        field<&F::unlit>("unlit"),
        field<&F::metallic_roughness>("metallic-roughness"),
        field<&F::dielectric_reflectance>("dielectric reflectance"),
        field<&F::energy_compensation>("energy compensation"),
        field<&F::sheen>("sheen"),
        field<&F::clearcoat>("clearcoat"),
        field<&F::anisotropy>("anisotropy"),
        field<&F::iridescence>("iridescence"),
        field<&F::specular_weight_texture>("specular weight texture"),
        field<&F::specular_color_texture>("specular color texture"),
        field<&F::sheen_color_texture>("sheen color texture"),
        field<&F::sheen_roughness_texture>("sheen roughness texture"),
        field<&F::clearcoat_texture>("clearcoat texture"),
        field<&F::clearcoat_roughness_texture>("clearcoat roughness texture"),
        field<&F::clearcoat_normal_map>("clearcoat normal map"),
        field<&F::anisotropy_texture>("anisotropy texture"),
        field<&F::iridescence_texture>("iridescence texture"),
        field<&F::film_thickness_texture>("film thickness texture"),
        field<&F::transmission>("transmission"),
        field<&F::transmission_texture>("transmission texture"),
        field<&F::volume>("volume"),
        field<&F::dispersion>("dispersion"),
        field<&F::thickness_texture>("thickness texture"),
        second<TextureSlot::base_color>("diffuse texture at second coordinates"),
        second<TextureSlot::occlusion>("occlusion texture at second coordinates"),
        second<TextureSlot::thickness>("thickness texture at second coordinates"),
        field<&F::interpolation, 3>("interpolation"),
        field<&F::morphing>("morphing"),
        field<&F::skinning>("skinning"),
        field<&F::deformed_facets>("deformed facets"),
        field<&F::diffuse_texture>("diffuse texture"),
        field<&F::specular_texture>("specular texture"),
        field<&F::metallic_roughness_texture>("metallic-roughness texture"),
        field<&F::occlusion_texture>("occlusion texture"),
        field<&F::vertex_occlusion>("vertex occlusion"),
        field<&F::vertex_colors>("vertex colors"),
        field<&F::alpha, 3>("alpha"),
        field<&F::opacity_texture>("opacity texture"),
        field<&F::detail, 4>("detail"),
        field<&F::frame, 2>("frame"),
        field<&F::specular_antialiasing>("specular antialiasing"),
        field<&F::double_sided>("double-sided"),
        field<&F::depth_mapping, 6>("depth mapping"),
        field<&F::height_wrap_u, 3>("wrap of heights along u"),
        field<&F::height_wrap_v, 3>("wrap of heights along v"),
        field<&F::self_shadow>("self-shadow"),
        field<&F::clipped_relief>("clipped relief"),
        field<&F::curved_relief>("curved relief"),
        field<&F::written_depth>("written depth"),
        field<&F::displaced_shadow>("displaced shadow"),
        field<&F::ambient>("ambient"),
        field<&F::directional_lights, 3>("directional lights"),
        field<&F::point_lights, 3>("point lights"),
        field<&F::spot_lights, 3>("spot lights"),
        field<&F::falloff, 3>("falloff"),
        field<&F::light_ranges>("light ranges"),
        field<&F::highlight_colors>("highlight colors"),
        field<&F::lights_in_buffer>("light buffer"),
        field<&F::shadow, 4>("shadow"),
        field<&F::environment_diffuse>("environment light"),
        field<&F::diffuse>("diffuse"),
        field<&F::specular, 3>("specular"),
        field<&F::highlight_fresnel>("highlight Fresnel"),
        field<&F::emission>("emission"),
        field<&F::emission_texture>("emission texture"),
        field<&F::reflection, 3>("reflection"),
        field<&F::fresnel, 4>("fresnel"),
        field<&F::reflection_by_normal>("reflection by normal"),
        field<&F::refraction>("refraction"),
        field<&F::environment_rotation>("environment rotation"),
        field<&F::environment_tint>("environment tint"),
        field<&F::clamped_terms>("clamped terms"),
        field<&F::output, 4>("output"),
        field<&F::tone_mapping, 6>("tone mapping"),
        field<&F::exposure>("exposure"),
    };
    return all;
}

Features random_features(std::mt19937& random) {
    Features f;
    for (const FeatureField& field : feature_fields())
        field.set(f, static_cast<unsigned>(random() % field.count));
    if (random() % 8 != 0) f.unlit = false;
    return f;
}

void for_random_features(std::size_t count, const std::function<void(const Features&)>& visit) {
    std::mt19937 random(1);
    for (std::size_t i = 0; i < count; ++i)
        visit(random_features(random));
}

namespace {

std::vector<Features> make_covering_features() {
    std::set<Features> canonical_sets;
    for_random_features(40000, [&](const Features& f) { canonical_sets.insert(canonical(f)); });
    CoveredPairs covered(feature_fields().size());
    std::vector<Candidate> candidates;
    for (const Features& f : canonical_sets)
        candidates.push_back(covered.candidate(f));
    std::vector<Features> chosen;
    // Passes with a decreasing threshold. This is cheaper than the exact greedy choice and gives
    // almost as small a result.
    for (std::size_t bar = 400; bar > 0; bar = bar > 8 ? bar * 3 / 4 : bar - 1) {
        for (Candidate& candidate : candidates) {
            if (candidate.bound < bar) continue;
            candidate.bound = covered.fresh_in(candidate);
            if (candidate.bound < bar) continue;
            covered.add(candidate);
            chosen.push_back(*candidate.features);
            candidate.bound = 0;
        }
    }
    return chosen;
}

}  // namespace

const std::vector<Features>& covering_features() {
    static const std::vector<Features> all = make_covering_features();
    return all;
}

namespace {

/// Texels of noise between two codes, including alpha.
Image noise(std::uint32_t seed, int channels, int low, int high, ColorSpace space) {
    std::mt19937 random(seed);
    Image image = make_image(4, 4, channels, 8, space);
    for (std::uint8_t& sample : image.as<std::uint8_t>()) {
        sample = static_cast<std::uint8_t>(
            low + static_cast<int>(random() % static_cast<unsigned>(high - low)));
    }
    return image;
}

Texture add_image(Scene& scene, const char* name, Image image) {
    scene.images.push_back({name, std::move(image)});
    return {scene.images.size() - 1};
}

void add_textures(Scene& scene, Material& m, const Features& f) {
    const auto color = [&](const char* name, std::uint32_t seed) {
        return add_image(scene, name, noise(seed, 4, 40, 256, ColorSpace::srgb));
    };
    const auto data = [&](const char* name, std::uint32_t seed, int low) {
        return add_image(scene, name, noise(seed, 3, low, 256, ColorSpace::data));
    };
    if (f.diffuse_texture) m.diffuse_texture = color("diffuse", 1);
    if (f.specular_texture) m.specular_texture = color("specular", 2);
    if (f.emission_texture) m.emission_texture = color("emission", 3);
    if (f.occlusion_texture) m.occlusion_texture = data("occlusion", 4, 40);
    m.occlusion_strength = 0.7F;
    if (f.opacity_texture) m.opacity_texture = data("opacity", 5, 100);
    if (f.metallic_roughness_texture) {
        m.metallic_roughness->texture = data("metallic and roughness", 6, 40);
    }
    if (f.detail == NormalDetail::normal_map || f.detail == NormalDetail::object_normal_map) {
        m.normal_map = NormalMap{data("normal", 7, 90)};
        if (f.detail == NormalDetail::object_normal_map) m.normal_map->space = NormalSpace::object;
    }
    if (f.detail == NormalDetail::bump_map) m.bump_map = BumpMap{data("bump", 8, 0), 2.0F};
    if (f.depth_mapping != DepthMapping::none) {
        ReliefMap map;
        map.texture = data("relief", 21, 0);
        map.texture.wrap_u = f.height_wrap_u;
        map.texture.wrap_v = f.height_wrap_v;
        map.depth = 0.2F;
        map.method = static_cast<HeightMethod>(static_cast<int>(f.depth_mapping) - 1);
        map.self_shadow = f.self_shadow;
        if (f.clipped_relief) map.silhouette = ReliefSilhouette::clip;
        if (f.curved_relief) map.silhouette = ReliefSilhouette::curve;
        map.write_depth = f.written_depth;
        if (f.depth_mapping == DepthMapping::relaxed_cones) map.cones = data("cones", 22, 0);
        m.height_map = map;
    }
    if (m.diffuse_texture)
        m.diffuse_texture->second_texcoords =
            (f.second_texcoords & second_bit(TextureSlot::base_color)) != 0;
    if (m.occlusion_texture)
        m.occlusion_texture->second_texcoords =
            (f.second_texcoords & second_bit(TextureSlot::occlusion)) != 0;
    if (!f.metallic_roughness) return;
    MetallicRoughness& model = *m.metallic_roughness;
    if (f.specular_weight_texture) {
        model.specular_texture = add_image(scene, "weight", noise(9, 4, 40, 256, ColorSpace::data));
    }
    if (f.specular_color_texture) model.specular_color_texture = color("specular color", 10);
    if (f.sheen_color_texture) model.sheen_color_texture = color("sheen", 11);
    if (f.sheen_roughness_texture) {
        model.sheen_roughness_texture =
            add_image(scene, "fibers", noise(20, 4, 40, 256, ColorSpace::data));
    }
    if (f.clearcoat_texture) model.clearcoat_texture = data("coat", 12, 40);
    if (f.clearcoat_roughness_texture)
        model.clearcoat_roughness_texture = data("coat roughness", 13, 40);
    if (f.clearcoat_normal_map) model.clearcoat_normal_map = NormalMap{data("coat normal", 14, 90)};
    if (f.anisotropy_texture) model.anisotropy_texture = data("anisotropy", 15, 150);
    if (f.iridescence_texture) model.iridescence_texture = data("film", 16, 40);
    if (f.film_thickness_texture)
        model.iridescence_thickness_texture = data("film thickness", 17, 0);
    if (f.transmission_texture) model.transmission_texture = data("transmission", 18, 40);
    if (f.thickness_texture) {
        model.thickness_texture = data("thickness", 19, 40);
        model.thickness_texture->second_texcoords =
            (f.second_texcoords & second_bit(TextureSlot::thickness)) != 0;
    }
}

Material material_calling_for(const Features& f) {
    Material m;
    m.name = "m";
    m.unlit = f.unlit;
    m.interpolation = f.interpolation;
    m.tangent_frame = f.frame;
    m.specular_antialiasing = f.specular_antialiasing;
    m.double_sided = f.double_sided;
    m.alpha_mode = f.alpha;
    if (f.alpha != AlphaMode::opaque) m.opacity = 0.8F;
    m.alpha_cutoff = 0.3F;
    const bool scatters = f.diffuse || f.environment_diffuse || f.unlit;
    m.diffuse = scatters ? glm::vec3(0.6F, 0.5F, 0.4F) : glm::vec3(0.0F);
    m.ambient = glm::vec3(0.3F, 0.2F, 0.4F);
    if (f.metallic_roughness) {
        // Only plain, smooth dielectrics do without energy compensation.
        m.metallic_roughness = {{0.7F, 0.5F, 0.3F}, 0.4F, 0.5F, {}};
        if (!f.energy_compensation) m.metallic_roughness = {{0.7F, 0.5F, 0.3F}, 0.0F, 0.03F, {}};
    }
    if (f.dielectric_reflectance) {
        m.metallic_roughness->refractive_index = 1.9F;
        m.metallic_roughness->specular = 0.8F;
        m.metallic_roughness->specular_color = {1.0F, 0.6F, 0.3F};
    }
    if (f.sheen) {
        m.metallic_roughness->sheen_color = {0.9F, 0.5F, 0.2F};
        m.metallic_roughness->sheen_roughness = 0.6F;
    }
    if (f.clearcoat) {
        m.metallic_roughness->clearcoat = 0.7F;
        m.metallic_roughness->clearcoat_roughness = 0.2F;
    }
    if (f.iridescence) {
        m.metallic_roughness->iridescence = 0.8F;
        m.metallic_roughness->iridescence_thickness = 350.0F;
    }
    if (f.transmission) m.metallic_roughness->transmission = 0.6F;
    if (f.volume) {
        m.metallic_roughness->thickness = 0.4F;
        m.metallic_roughness->attenuation_distance = 0.8F;
        m.metallic_roughness->attenuation_color = {0.9F, 0.5F, 0.3F};
    }
    if (f.dispersion) m.metallic_roughness->dispersion = 4.0F;
    if (f.anisotropy) {
        m.metallic_roughness->anisotropy = 0.6F;
        m.metallic_roughness->anisotropy_rotation = 0.7F;
    }
    if (f.specular != SpecularTerm::none) m.specular = glm::vec3(0.5F, 0.4F, 0.3F);
    m.highlight_fresnel = f.highlight_fresnel;
    m.reflection_by_normal = f.reflection_by_normal;
    m.environment_tint = f.environment_tint;
    m.shininess = 12.0F;
    if (f.specular == SpecularTerm::phong) m.specular_model = SpecularModel::phong;
    if (f.emission) m.emission = glm::vec3(0.1F, 0.05F, 0.02F);
    if (f.reflection != ReflectionTerm::none) m.reflectivity = glm::vec3(0.4F, 0.5F, 0.6F);
    if (f.reflection == ReflectionTerm::glossy) m.reflection_roughness = 0.4F;
    if (f.fresnel == FresnelTerm::constant) m.grazing_reflectivity = m.reflectivity;
    if (f.fresnel == FresnelTerm::dielectric) m.fresnel = FresnelModel::dielectric;
    if (f.fresnel == FresnelTerm::conductor) m.fresnel = FresnelModel::conductor;
    if (f.refraction) m.transmission = 0.5F;
    return m;
}

void add_lights(Scene& scene, const Features& f) {
    const auto shift = [](std::uint32_t i) { return 0.5F * static_cast<float>(i); };
    for (std::uint32_t i = 0; i < f.directional_lights; ++i) {
        scene.directional_lights.push_back({{1.0F - shift(i), -1, -2}, {0.5F, 0.4F, 0.3F}});
    }
    const auto point = [&](std::uint32_t i) {
        PointLight light{{1.0F + shift(i), 1, 2}, glm::vec3(1.5F)};
        // Lights next to the sphere cast no shadow.
        if (f.shadow != ShadowTerm::none) light.position_world *= 2.0F;
        const bool falls = f.falloff == FalloffTerm::inverse_square ||
                           (f.falloff == FalloffTerm::mixed && i % 2 == 0);
        light.falloff = falls ? Falloff::inverse_square : Falloff::none;
        if (f.light_ranges) light.range = 5.0F;
        if (f.highlight_colors) light.highlight_intensity = glm::vec3(0.5F, 1.0F, 0.2F);
        return light;
    };
    for (std::uint32_t i = 0; i < f.point_lights; ++i)
        scene.point_lights.push_back(point(i));
    for (std::uint32_t i = 0; i < f.spot_lights; ++i) {
        scene.spot_lights.push_back({point(f.point_lights + i), {-0.5F, -0.4F, -1}, 0.2F, 0.7F});
    }
    if (!f.highlight_colors) return;
    for (DirectionalLight& light : scene.directional_lights)
        light.highlight_irradiance = glm::vec3(0.1F, 0.3F, 0.5F);
}

void add_surroundings(Scene& scene, const Features& f) {
    if (f.ambient) scene.ambient = glm::vec3(0.2F, 0.3F, 0.1F);
    if (!f.environment_diffuse && f.reflection == ReflectionTerm::none && !f.refraction &&
        !f.environment_tint)
        return;
    CubeFaces faces;
    for (std::uint32_t i = 0; i < 6; ++i)
        faces.faces[i] = {"face", noise(20 + i, 3, 0, 256, ColorSpace::srgb)};
    scene.environment = Environment{faces, 1.5F, !f.double_sided, f.environment_diffuse};
    if (f.environment_rotation) scene.environment->rotation = 0.4F;
}

/// Returns the closest features that a scene can need.
Features attainable(Features f) {
    f.lights_in_buffer = false;
    if (f.curved_relief) f.clipped_relief = true;  // Along axes that are clamped.
    const bool lights = f.directional_lights + f.point_lights + f.spot_lights > 0;
    const bool environment = f.environment_diffuse || f.reflection != ReflectionTerm::none;
    if (f.falloff == FalloffTerm::mixed && f.point_lights + f.spot_lights == 1) {
        f.falloff = FalloffTerm::inverse_square;
    }
    if (f.metallic_roughness && environment) f.reflection = ReflectionTerm::glossy;
    if (lights && f.environment_diffuse) f.diffuse = true;
    if (f.dielectric_reflectance || f.iridescence || f.clearcoat || f.anisotropy)
        f.energy_compensation = true;
    if (f.output == OutputCoding::half) f.output = OutputCoding::srgb;
    const bool casts = f.alpha != AlphaMode::blend && !f.transmission && !f.unlit;
    if (f.shadow != ShadowTerm::none) {
        f.shadow = !casts                     ? ShadowTerm::none
                   : f.directional_lights > 0 ? ShadowTerm::directional_light
                   : f.spot_lights > 0        ? ShadowTerm::spot_light
                                              : ShadowTerm::point_light;
    }
    f.displaced_shadow = f.written_depth && f.shadow != ShadowTerm::none;
    if ((f.alpha == AlphaMode::blend || f.transmission) && f.output != OutputCoding::linear) {
        f.output = OutputCoding::half;
    }
    return f;
}

}  // namespace

MeshPose pose_calling_for(const Mesh& mesh, const Features& f) {
    MeshPose pose;
    GltfDeformation deformation;
    deformation.targets.resize(2);
    deformation.joints.emplace_back();
    for (const glm::vec3& p : mesh.positions) {
        deformation.targets[0].positions.push_back(0.4F * p.x * glm::vec3(p.y, 1.0F, 0.3F));
        deformation.targets[0].normals.push_back(0.3F * glm::vec3(p.z, 0.0F, p.x));
        deformation.targets[0].tangents.push_back(0.3F * glm::vec3(0.0F, p.x, p.z));
        deformation.targets[1].positions.emplace_back(9.0F, 9.0F, 9.0F);
        deformation.joints[0].joints.emplace_back(0, 1, 0, 7);
        deformation.joints[0].weights.emplace_back(1.0F - p.y, 1.0F + p.y, 0.2F, 5.0F);
    }
    pose.deformation = std::move(deformation);
    if (f.morphing) pose.weights = {0.7F, 0.0F};
    if (f.skinning) {
        pose.joint_matrices.assign(2, glm::mat4(1.0F));
        pose.joint_matrices[1] = glm::mat4(0.9F, 0.3F, 0.0F, 0.0F, -0.3F, 0.9F, 0.2F, 0.0F, 0.0F,
                                           -0.2F, 1.1F, 0.0F, 0.1F, 0.2F, 0.0F, 1.0F);
    }
    pose.has_flat_normals = f.deformed_facets;
    return pose;
}

Mesh faceted(const Mesh& mesh) {
    FrameOptions options;
    options.normals = NormalMode::flat;
    Mesh apart = mesh;
    apart.positions.clear();
    apart.normals.clear();
    apart.texcoords.clear();
    apart.tangents.clear();
    apart.triangles.clear();
    for (const glm::uvec3& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(apart.positions.size());
        for (int k = 0; k < 3; ++k) {
            apart.positions.push_back(mesh.positions[triangle[k]]);
            apart.texcoords.push_back(mesh.texcoords[triangle[k]]);
        }
        apart.triangles.emplace_back(first, first + 1, first + 2);
    }
    return with_frames(apart, options).mesh;
}

std::vector<float> shares_of(const Mesh& mesh) {
    std::vector<float> shares;
    for (const glm::vec3& p : mesh.positions)
        shares.push_back(std::clamp(0.5F + 0.4F * p.x + 0.3F * p.y * p.z, 0.0F, 1.0F));
    return shares;
}

CallingScene scene_calling_for(const Features& features) {
    CallingScene result;
    Scene& scene = result.scene;
    Mesh mesh = features.deformed_facets ? faceted(sphere(24, 12)) : sphere(24, 12);
    mesh.name = "sphere";
    for (const glm::vec2& texcoord : mesh.texcoords)
        mesh.texcoords_2.emplace_back(texcoord.y, texcoord.x);
    if (features.vertex_colors) {
        for (const glm::vec3& p : mesh.positions) {
            mesh.colors.emplace_back(0.5F + 0.5F * p.x, 0.9F, 0.5F - 0.5F * p.y, 0.9F);
        }
    }
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}};
    std::optional<MeshPose> pose;
    if (features.morphing || features.skinning) pose = pose_calling_for(mesh, features);
    scene.meshes = {std::move(mesh)};
    scene.instances = {{0, glm::mat4(1.3F), "i", pose}};
    scene.instances[0].world_from_object[1] = glm::vec4(0.3F, 1.0F, 0.1F, 0.0F);
    scene.instances[0].world_from_object[3] = glm::vec4(0.1F, 0.2F, 0.0F, 1.0F);
    scene.materials = {material_calling_for(features)};
    add_textures(scene, scene.materials[0], features);
    add_lights(scene, features);
    add_surroundings(scene, features);
    if (features.shadow != ShadowTerm::none) scene.shadow = Shadow{};
    if (features.vertex_occlusion) scene.instances[0].open_shares = shares_of(scene.meshes[0]);
    if (features.exposure) scene.exposure = 1.5F;
    scene.clamp_terms = features.clamped_terms;
    scene.tone_mapping = features.tone_mapping;
    scene.background = {0.1F, 0.2F, 0.3F, 1.0F};
    scene.camera = framed(scene, 0.4F, 0.3F, 0.6F, 1.0F);
    result.expected = canonical(attainable(features));
    result.settings = {32, 32, 1, features.output};
    if (features.output == OutputCoding::half) result.settings.output = OutputCoding::srgb;
    return result;
}

Material gray(const char* name) {
    Material material;
    material.name = name;
    return material;
}

Scene lit_scene(const Material& material) {
    Scene scene;
    scene.meshes = {grid(1)};
    scene.meshes[0].edit().name = "plane";
    scene.meshes[0].edit().material_ranges = {{0, 2, 0}};
    scene.materials = {material};
    scene.instances = {{0, glm::mat4(1), "node"}};
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}};
    return scene;
}

const EffectReason& reason(const std::vector<EffectReason>& reasons, const char* effect) {
    const auto found = std::find_if(reasons.begin(), reasons.end(),
                                    [&](const EffectReason& r) { return r.effect == effect; });
    if (found == reasons.end()) throw std::runtime_error(std::string("no reason for ") + effect);
    return *found;
}

}  // namespace relief::test
