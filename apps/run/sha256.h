#pragma once

#include <string>
#include <string_view>

namespace patchlight {

/// The SHA-256 of some bytes, 64 hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace patchlight
