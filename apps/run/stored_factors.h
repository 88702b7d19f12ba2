#pragma once

#include "apps/run/run_options.h"
#include "meshing/patch_mesh.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace patchlight {

inline constexpr const char* factors_file = "factors.bin";

/// All that a mesh's rows depend on, part by part: the sources of the program, instruction set (rays may hit otherwise
/// by another), geometry with which surfaces reflect and emit, mesh, and options. Not how much they reflect or emit.
Json factors_key(const Scene& scene, const PatchMeshArrays& mesh, const AdaptiveOptions& options,
                 const std::string& instruction_set);

/// Key, rows (columns of 4 bytes; factors of 4 where all are single precision, as rays' are, else of 8), and the
/// SHA-256 of all that.
std::string encode_factors(const KeptRows& rows, const Json& key);

/// The rows, or why there are none.
struct StoredFactors {
    std::optional<KeptRows> rows;
    std::string differs;  ///< the part of the key that is another; empty: none is
};

/// Rows of a mesh of so many patches. Throws SceneError ("factors") for what is cut short, changed, or no such file;
/// nothing of that is ever used.
StoredFactors decode_factors(std::string_view bytes, const Json& key, std::size_t patches);

/// Bytes of a file for a mesh of so many elements, from above.
double factors_bytes(double elements, const AdaptiveOptions& options);

}  // namespace patchlight
