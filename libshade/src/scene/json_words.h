// SPDX-License-Identifier: Apache-2.0
/// \file
/// The words of scene files for what a scene chooses among, as they are read and written.
/// Tests: tests/shade/scene/scene_json_test.cpp.
#pragma once

#include <cstddef>

#include "relief/shade/scene.h"

namespace relief {

/// One of an enumeration's values by its name in files.
template <typename Value>
struct Named {
    const char* name;
    Value value;
};

/// The name of a value.
template <typename Value, std::size_t count>
const char* word_for(Value value, const Named<Value> (&names)[count]) {
    for (const Named<Value>& entry : names) {
        if (entry.value == value) return entry.name;
    }
    return "";
}

inline constexpr Named<ToneMapping> tone_mapping_words[] = {
    {"none", ToneMapping::none}, {"reinhard", ToneMapping::reinhard}, {"aces", ToneMapping::aces}};
inline constexpr Named<Interpolation> interpolation_words[] = {
    {"per_pixel", Interpolation::per_pixel},
    {"gouraud", Interpolation::gouraud},
    {"flat", Interpolation::flat}};
inline constexpr Named<SpecularModel> specular_model_words[] = {
    {"phong", SpecularModel::phong},
    {"blinn_phong", SpecularModel::blinn_phong},
    {"blinn_phong_normalized", SpecularModel::blinn_phong_normalized}};
inline constexpr Named<FresnelModel> fresnel_words[] = {{"schlick", FresnelModel::schlick},
                                                        {"dielectric", FresnelModel::dielectric},
                                                        {"conductor", FresnelModel::conductor}};
inline constexpr Named<AlphaMode> alpha_mode_words[] = {
    {"opaque", AlphaMode::opaque}, {"mask", AlphaMode::mask}, {"blend", AlphaMode::blend}};
inline constexpr Named<TangentFrame> tangent_frame_words[] = {
    {"stored", TangentFrame::stored}, {"derivatives", TangentFrame::derivatives}};
inline constexpr Named<NormalSpace> normal_space_words[] = {{"tangent", NormalSpace::tangent},
                                                            {"object", NormalSpace::object}};
inline constexpr Named<Green> green_words[] = {{"up", Green::up}, {"down", Green::down}};
inline constexpr Named<FlatCode> zero_code_words[] = {{"127.5", FlatCode::half},
                                                      {"128", FlatCode::middle}};
inline constexpr Named<TextureWrap> wrap_words[] = {{"repeat", TextureWrap::repeat},
                                                    {"clamp", TextureWrap::clamp},
                                                    {"mirror", TextureWrap::mirror}};
inline constexpr Named<TextureFilter> filter_words[] = {{"linear", TextureFilter::linear},
                                                        {"nearest", TextureFilter::nearest}};
inline constexpr Named<Falloff> falloff_words[] = {{"inverse_square", Falloff::inverse_square},
                                                   {"none", Falloff::none}};

}  // namespace relief
