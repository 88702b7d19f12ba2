#include "meshing/read_mtl.h"
#include "meshing/scene_error.h"
#include "tests/fuzz/target.h"

#include <cmath>
#include <stdexcept>

using namespace patchlight;

/// An MTL file. What is read is finite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    MtlLibrary library;
    try {
        read_mtl(testing::text_of(data, size), "fuzzed.mtl", library);
    } catch (const SceneError&) {
        return 0;
    }
    for (const auto& [name, material] : library.materials) {
        for (int band = 0; band < 3; ++band) {
            if (!std::isfinite(material.reflectance[band]) || !std::isfinite(material.emission[band]))
                throw std::logic_error("a material isn't finite: " + name);
        }
    }
    return 0;
}
