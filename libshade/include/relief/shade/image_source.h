// SPDX-License-Identifier: Apache-2.0
/// \file
/// An image of a scene, decoded: from its file, its bytes, or as it is.
/// Tests: tests/shade/scene/image_source_test.cpp.
#pragma once

#include <string>

#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/scene.h"

namespace relief {

/// \return the image; one that is decoded already keeps its samples, and for ImageUse::data its
///         numbers are taken as numbers whatever its colour space says
/// \throws FileError as read_image does, and with the source's own fault where it has one
Image decode(const ImageSource& source, ImageUse use);

/// The message of an error in decoding an image, after the file that names the image, unless the
/// message begins with that file: "vase.gltf: bricks.png: no such file".
std::string with_origin(const ImageSource& source, const std::string& error);

/// Tells who waits (relief/mesh/progress.h) that a picture depends on a file, whether or not it is
/// decoded anew.
void note_image_file(const ImageSource& source);

/// Which stored code of a normal map stands for zero: what the file's text says, else 127.5, see
/// detect_flat_code(). \param image  decoded from the source
FlatCode detected_flat_code(const ImageSource& source, const Image& image);

}  // namespace relief
