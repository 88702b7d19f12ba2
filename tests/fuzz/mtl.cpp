#include "meshing/read_mtl.h"
#include "meshing/scene_error.h"
#include "tests/fuzz/target.h"

#include <cmath>
#include <stdexcept>

using namespace patchlight;

/// An MTL file. Reflectances are finite; exitances, π times what is read, may overflow, which validate() refuses.
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
            if (!std::isfinite(material.reflectance[band]) || std::isnan(material.emission[band]))
                throw std::logic_error("a material is of no numbers: " + name);
        }
    }
    return 0;
}
