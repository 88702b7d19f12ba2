#pragma once

#include "apps/imaging/image.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace patchlight {

/// What is written beside the pixels, by name.
using ImageMetadata = std::map<std::string, std::string>;

/// An 8-bit PNG of sRGB values between 0 and 1. Same picture, same bytes: no date, no command line.
/// Throws std::runtime_error when the encoder fails.
std::vector<unsigned char> encode_png(const Image& srgb);

/// A linear 32-bit float EXR of radiance, ZIP-compressed, with its metadata as string attributes. The date that
/// the library would put in is left empty. Throws std::runtime_error when the encoder fails.
std::vector<unsigned char> encode_exr(const Image& radiance, const ImageMetadata& metadata);

/// A picture read back, its numbers as they are stored (PNG: sRGB 0 … 1), and its string attributes.
struct ImageFile {
    Image image;
    ImageMetadata metadata;
};

/// Reads a PNG or EXR of at least three channels. Throws std::runtime_error with the path and the reason.
ImageFile read_image(const std::filesystem::path& file);

enum class TextAlign { left, center, right };

/// Writes one line of text, its baseline at (x, y), in the DejaVu Sans face; `size` is in pixels.
/// Returns false, and leaves the picture as it is, when there is no font to write with.
bool draw_text(Image& image, int x, int y, const std::string& text, int size, const Rgb& color,
               TextAlign align = TextAlign::left);

/// Colours for numbers from 0 (the first) to 1 (the last), as sRGB values between 0 and 1.
using ColorTable = std::vector<Rgb>;

/// 256 colours of one of OpenImageIO's maps: "viridis", "inferno", "magma", "plasma", "turbo". Throws
/// std::runtime_error for a name that it doesn't know.
ColorTable color_table(const std::string& name);

}  // namespace patchlight
