#include "apps/imaging/animation.h"

#include <boost/crc.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace patchlight {

namespace {

using Bytes = std::vector<unsigned char>;
constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";

struct Chunk {
    std::string type;
    std::span<const unsigned char> data;
};

std::uint32_t number_at(const Bytes& bytes, std::size_t at)
{
    return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 | std::uint32_t(bytes[at + 2]) << 8 |
           bytes[at + 3];
}

void append(Bytes& out, std::uint32_t number, std::ptrdiff_t size = 4)
{
    std::array<unsigned char, 4> bytes{};
    for (std::size_t k = 0; k < 4; ++k) bytes[k] = static_cast<unsigned char>(number >> (24 - 8 * k));
    out.insert(out.end(), bytes.end() - size, bytes.end());
}

void append_chunk(Bytes& out, std::string_view type, std::span<const unsigned char> data)
{
    append(out, static_cast<std::uint32_t>(data.size()));
    const std::size_t checked = out.size();
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), data.begin(), data.end());
    boost::crc_32_type crc;
    crc.process_bytes(out.data() + checked, out.size() - checked);
    append(out, crc.checksum());
}

std::vector<Chunk> chunks_of(const Bytes& png)
{
    std::vector<Chunk> chunks;
    if (png.size() < signature.size() ||
        !std::equal(signature.begin(), signature.end(), png.begin(),
                    [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; })) {
        throw std::invalid_argument("a frame is no PNG");
    }
    for (std::size_t at = signature.size(); at < png.size();) {
        const std::size_t left = png.size() - at;
        if (left < 12 || number_at(png, at) > left - 12) throw std::invalid_argument("a frame's PNG is cut short");
        const std::size_t size = number_at(png, at);
        const char* const type = reinterpret_cast<const char*>(png.data()) + at + 4;
        chunks.push_back({std::string(type, 4), {png.data() + at + 8, size}});
        at += size + 12;
    }
    if (chunks.empty() || chunks.front().type != "IHDR" || chunks.front().data.size() != 13) {
        throw std::invalid_argument("a frame's PNG has no header");
    }
    return chunks;
}

/// fcTL: the whole picture, shown for some time, replacing what was there.
Bytes frame_control(std::uint32_t sequence, std::span<const unsigned char> header, int milliseconds)
{
    Bytes data;
    append(data, sequence);
    data.insert(data.end(), header.begin(), header.begin() + 8);  // width and height
    append(data, 0);
    append(data, 0);
    append(data, static_cast<std::uint32_t>(milliseconds), 2);
    append(data, 1000, 2);
    append(data, 0, 2);
    return data;
}

}  // namespace

std::vector<unsigned char> encode_animation(const std::vector<std::vector<unsigned char>>& frames, int milliseconds)
{
    if (frames.empty() || milliseconds < 1 || milliseconds > 65535) {
        throw std::invalid_argument("an animation has frames, and each a time of 1 … 65535 ms");
    }
    const std::vector<Chunk> first = chunks_of(frames.front());
    const auto header = first.front().data;
    Bytes out(signature.begin(), signature.end());
    append_chunk(out, "IHDR", header);
    Bytes control;
    append(control, static_cast<std::uint32_t>(frames.size()));
    append(control, 0);
    append_chunk(out, "acTL", control);
    for (const Chunk& chunk : first) {
        if (chunk.type != "IHDR" && chunk.type != "IDAT" && chunk.type != "IEND") {
            append_chunk(out, chunk.type, chunk.data);
        }
    }
    std::uint32_t sequence = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::vector<Chunk> chunks = chunks_of(frames[i]);
        if (!std::ranges::equal(chunks.front().data, header)) {
            throw std::invalid_argument("frames of different size or kind");
        }
        const bool last = i + 1 == frames.size();
        append_chunk(out, "fcTL",
                     frame_control(sequence++, header, last ? std::min(3 * milliseconds, 65535) : milliseconds));
        for (const Chunk& chunk : chunks) {
            if (chunk.type != "IDAT") continue;
            if (i == 0) {
                append_chunk(out, "IDAT", chunk.data);
                continue;
            }
            Bytes data;
            append(data, sequence++);
            data.insert(data.end(), chunk.data.begin(), chunk.data.end());
            append_chunk(out, "fdAT", data);
        }
    }
    append_chunk(out, "IEND", {});
    return out;
}

}  // namespace patchlight
