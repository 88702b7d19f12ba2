#pragma once

#include "apps/imaging/image_file.h"

namespace patchlight {

/// What the module of picture files does: image_file.h's functions. OpenImageIO stands in a library of its own, which
/// is only loaded for the first picture: it brings 250 shared libraries with it, a third of a second for every command.
struct ImageFileModule {
    std::vector<unsigned char> (*encode_png)(const Image& srgb);
    std::vector<unsigned char> (*encode_exr)(const Image& radiance, const ImageMetadata& metadata);
    ImageFile (*read_image)(const std::filesystem::path& file);
    bool (*draw_text)(Image& image, int x, int y, const std::string& text, int size, const Rgb& color, TextAlign align);
    ColorTable (*color_table)(const std::string& name);  ///< linear, as the library has it
};

/// The module's only entry.
extern "C" const ImageFileModule patchlight_image_file_module;

}  // namespace patchlight
