#include "meshing/gltf_textures.h"

#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace patchlight {

namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t largest_side = 8192;

struct Size {
    std::size_t width = 0, height = 0;
};

std::size_t big_endian(const Bytes& bytes, std::size_t offset, int count)
{
    std::size_t value = 0;
    for (int k = 0; k < count; ++k) value = value << 8U | bytes[offset + static_cast<std::size_t>(k)];
    return value;
}

/// What the header says, before a decoder allocates for it.
Size image_size(const Bytes& bytes)
{
    static constexpr unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    if (bytes.size() >= 24 && std::memcmp(bytes.data(), png, sizeof(png)) == 0) {
        return {big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
    }
    if (bytes.size() < 4 || bytes[0] != 0xFF || bytes[1] != 0xD8) return {};
    for (std::size_t at = 2; at + 9 <= bytes.size() && bytes[at] == 0xFF;) {
        const unsigned char marker = bytes[at + 1];
        const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        if (frame) return {big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
        at += 2 + big_endian(bytes, at + 2, 2);
    }
    return {};
}

std::optional<Bytes> image_bytes(const GltfFile& gltf, const nlohmann::json& image, std::string& why)
{
    if (const auto uri = image.find("uri"); uri != image.end() && uri->is_string()) {
        const auto text = uri->get<std::string>();
        Bytes bytes;
        std::string mime;
        if (text.starts_with("data:")) {
            if (tinygltf::DecodeDataURI(&bytes, mime, text, 0, false)) return bytes;
            why = "its data can't be decoded";
            return {};
        }
        const auto file = gltf.folder.resolve(percent_decoded(text));
        if (!file) {
            why = fmt::format("{} is outside the scene's folder and was not opened", text);
            return {};
        }
        try {
            const std::string read = read_whole_file(*file, std::uintmax_t{1} << 28U);
            return Bytes(read.begin(), read.end());
        } catch (const SceneError& failure) {
            why = failure.what();
            return {};
        }
    }
    const auto view = image.find("bufferView");
    why = "it has no data";
    if (view == image.end() || !view->is_number_unsigned()) return {};
    const auto index = view->get<std::size_t>();
    if (index >= gltf.model.bufferViews.size()) return {};
    const tinygltf::BufferView& range = gltf.model.bufferViews[index];
    const Bytes& data = gltf.model.buffers.at(static_cast<std::size_t>(range.buffer)).data;
    if (range.byteOffset > data.size() || range.byteLength > data.size() - range.byteOffset) return {};
    const auto first = data.begin() + static_cast<std::ptrdiff_t>(range.byteOffset);
    return Bytes(first, first + static_cast<std::ptrdiff_t>(range.byteLength));
}

double linear(double srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

Rgb mean_of(const tinygltf::Image& image)
{
    const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const auto channels = static_cast<std::size_t>(image.component);
    const std::size_t bytes = image.bits == 16 ? 2 : 1;
    Rgb sum{0.0};
    for (std::size_t p = 0; p < pixels; ++p) {
        for (std::size_t k = 0; k < 3; ++k) {
            const unsigned char* at = &image.image[(p * channels + (channels >= 3 ? k : 0)) * bytes];
            std::uint16_t wide = 0;
            if (bytes == 2) std::memcpy(&wide, at, 2);
            sum[static_cast<int>(k)] += linear(bytes == 2 ? wide / 65535.0 : *at / 255.0);
        }
    }
    return sum / static_cast<double>(pixels);
}

}  // namespace

std::optional<Rgb> mean_texture_colour(const GltfFile& gltf, int texture, std::string& why)
{
    why = "it has no image";
    if (texture < 0 || static_cast<std::size_t>(texture) >= gltf.model.textures.size()) return {};
    const int source = gltf.model.textures[static_cast<std::size_t>(texture)].source;
    if (source < 0 || static_cast<std::size_t>(source) >= gltf.images.size()) return {};
    const auto bytes = image_bytes(gltf, gltf.images[static_cast<std::size_t>(source)], why);
    if (!bytes) return {};
    const Size size = image_size(*bytes);
    if (size.width == 0 || size.height == 0) {
        why = "it is neither PNG nor JPEG";
        return {};
    }
    if (size.width > largest_side || size.height > largest_side) {
        why = fmt::format("it has {} × {} pixels, more than {} × {}", size.width, size.height, largest_side,
                          largest_side);
        return {};
    }
    tinygltf::Image image;
    std::string error, warning;
    const bool decoded = tinygltf::LoadImageData(&image, source, &error, &warning, 0, 0, bytes->data(),
                                                 static_cast<int>(bytes->size()), nullptr);
    if (!decoded || image.image.empty() || image.width <= 0 || image.height <= 0) {
        why = "it can't be decoded";
        return {};
    }
    return mean_of(image);
}

}  // namespace patchlight
