#pragma once

#include "meshing/vectors.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace patchlight {

/// Named arrays of bytes, as the bufferViews of a stored solution hold them: little endian, doubles and 32-bit
/// integers, exactly as in memory.
using ByteViews = std::map<std::string, std::vector<unsigned char>>;

std::vector<unsigned char> bytes_of(std::span<const double> values);
std::vector<unsigned char> bytes_of(std::span<const std::uint32_t> values);
std::vector<unsigned char> bytes_of(std::span<const Vec3> values);

/// Read a named array back. Throw SceneError ("solution") when it is missing, not of whole entries, or, for
/// doubles, holds a number that isn't finite.
std::vector<double> doubles_in(const ByteViews& views, const std::string& name);
std::vector<std::uint32_t> integers_in(const ByteViews& views, const std::string& name);
std::vector<Vec3> vectors_in(const ByteViews& views, const std::string& name);
std::string text_in(const ByteViews& views, const std::string& name);

}  // namespace patchlight
