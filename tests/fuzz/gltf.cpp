#include "meshing/read_scene.h"
#include "meshing/scene_error.h"
#include "tests/fuzz/target.h"

using namespace patchlight;

/// A glTF or GLB file: which of them, its first bytes say. A buffer and a picture are beside it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const testing::TemporaryFolder& folder = testing::fuzz_folder();
    static const auto buffer = folder.write("b.bin", std::string(512, '\1'));
    static const auto picture = folder.write("p.ppm", "P6 1 1 255\nabc");
    SceneOptions options;
    options.require_emitter = false;
    try {
        read_scene(folder.write("fuzzed.gltf", testing::text_of(data, size)), options);
    } catch (const SceneError&) {}
    return 0;
}
