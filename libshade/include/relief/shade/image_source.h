// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decodes the images of a scene.
#pragma once

#include <string>

#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/scene.h"

namespace relief {

/// Decodes an image.
/// \return the image; a decoded image keeps its samples, and for ImageUse::data its color space is
///         ignored
/// \throws FileError as read_image() does, and with the fault of the source if it has one
Image decode(const ImageSource& source, ImageUse use);

/// Returns the message of an error in decoding an image, after the file that names the image,
/// unless the message begins with that file: "vase.gltf: bricks.png: no such file".
std::string with_origin(const ImageSource& source, const std::string& error);

/// Records that a picture depends on a file (relief/mesh/progress.h), even if the file is not
/// decoded again.
void note_image_file(const ImageSource& source);

/// Returns the code of zero in a normal map: that of the file's metadata, otherwise 127.5, see
/// detect_flat_code(). \param image  decoded from the source
FlatCode detected_flat_code(const ImageSource& source, const Image& image);

}  // namespace relief
