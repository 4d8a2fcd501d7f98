// SPDX-License-Identifier: Apache-2.0
// Unreadable files throw FileError. Tests: tests/shade/render/renderer_test.cpp.
#include "render/scene_textures.h"

#include "parallel.h"
#include "progress_stage.h"
#include "relief/shade/image_source.h"

namespace relief {

void SceneTextures::decode(const std::vector<ImageSource>& sources) {
    for (auto& [key, image] : images_) {
        note_image_file(sources[key.first]);
        image = cache_->find(sources[key.first], key.second);
        if (!image) decoded_.emplace_back(key, Image{});
    }
    ProgressStage stage("images", decoded_.size());
    parallel_for(decoded_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            auto& [key, image] = decoded_[i];
            image = relief::decode(sources[key.first], key.second.use);
            stage.advance(1);
        }
    });
}

void SceneTextures::upload(const std::vector<ImageSource>& sources) {
    ProgressStage stage("uploading images", decoded_.size());
    for (const auto& [key, image] : decoded_) {
        images_.at(key) = cache_->add(sources[key.first], key.second, image);
        stage.advance(1);
    }
    decoded_.clear();
}

}  // namespace relief
