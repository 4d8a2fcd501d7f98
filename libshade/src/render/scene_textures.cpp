// SPDX-License-Identifier: Apache-2.0
// Tests: tests/shade/render/renderer_test.cpp.
#include "render/scene_textures.h"

#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_source.h"

namespace relief {

std::map<std::size_t, std::string> SceneTextures::decode(const std::vector<ImageSource>& sources) {
    std::map<std::size_t, std::string> unreadable;
    std::vector<ImageIdentity> identities;
    for (auto& [key, image] : images_) {
        const ImageSource& source = sources[key.first];
        note_image_file(source);
        image = cache_->find(source, key.second);
        if (image) continue;
        const std::string* const fault = cache_->find_fault(source, key.second);
        if (fault != nullptr && !source.is_required) {
            unreadable.try_emplace(key.first, *fault);
            continue;
        }
        identities.emplace_back(source);
        decoded_.emplace_back(key, Image{});
    }
    const std::vector<std::string> faults = decode_all(sources);
    for (std::size_t i = 0; i < faults.size(); ++i) {
        if (faults[i].empty()) continue;
        const Key& key = decoded_[i].first;
        cache_->add_fault(identities[i], key.second, faults[i]);
        unreadable.try_emplace(key.first, faults[i]);
    }
    const auto is_unreadable = [&](const auto& entry) {
        return unreadable.contains(entry.first.first);
    };
    std::erase_if(decoded_, is_unreadable);
    std::erase_if(images_, is_unreadable);
    return unreadable;
}

/// Fills decoded_. \return for each, what is wrong with it; empty: nothing
std::vector<std::string> SceneTextures::decode_all(const std::vector<ImageSource>& sources) {
    std::vector<std::string> faults(decoded_.size());
    ProgressStage stage("images", decoded_.size());
    parallel_for(decoded_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            auto& [key, image] = decoded_[i];
            const ImageSource& source = sources[key.first];
            try {
                image = relief::decode(source, key.second.use);
            } catch (const FileError& error) {
                if (source.is_required) throw;
                faults[i] = error.what();
            }
            stage.advance(1);
        }
    });
    return faults;
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
