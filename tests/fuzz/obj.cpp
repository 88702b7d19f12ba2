#include "meshing/read_scene.h"
#include "meshing/scene_error.h"
#include "tests/fuzz/target.h"

using namespace patchlight;

/// An OBJ file, with a material file beside it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const testing::TemporaryFolder& folder = testing::fuzz_folder();
    static const auto materials =
        folder.write("m.mtl", "newmtl white\nKd .7 .7 .7\nnewmtl lamp\nKd 0 0 0\nKe 9 9 9\nnewmtl mirror\nKd 1 1 1\n");
    try {
        read_scene(folder.write("fuzzed.obj", testing::text_of(data, size)));
    } catch (const SceneError&) {}
    return 0;
}
