// Solves the light in a scene, tells how the mesh grows and the error falls, and makes a picture:
//
//     example SCENE ELEMENTS PICTURE.png

#include "apps/imaging/exposure.h"
#include "apps/imaging/image_file.h"
#include "apps/imaging/picture.h"
#include "apps/imaging/view_rays.h"
#include "formfactor/ray_caster.h"
#include "meshing/patch_locator.h"
#include "meshing/read_scene.h"
#include "solver/adaptive.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>

namespace {

void write_picture(const patchlight::Scene& scene, const patchlight::AdaptiveSolution& solution, const char* file)
{
    using namespace patchlight;
    const RayCaster caster(scene);
    const PatchLocator locator(solution.mesh);
    const ShownSolution shown{scene, solution.mesh, locator, solution.B, solution.vertex_B};
    const View view = scene.views.empty() ? default_view(scene, caster) : scene.views.front();
    const ViewHits hits = trace_view(caster, view, 320, 240, 1);
    const Image radiance = shade_view(shown, hits, {.width = 320, .height = 240, .samples = 1});
    const auto png = encode_png(to_srgb(radiance, auto_exposure(scene, hits, radiance)));
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(png.data()), std::ssize(png));
}

}  // namespace

int main(int argc, char** argv)
try {
    if (argc != 4) {
        std::fprintf(stderr, "usage: example SCENE ELEMENTS PICTURE.png\n");
        return 2;
    }
    const patchlight::Scene scene = patchlight::read_scene(argv[1]).scene;
    patchlight::AdaptiveOptions options;
    options.max_elements = std::strtoul(argv[2], nullptr, 10);

    patchlight::AdaptiveObservers observers;
    observers.on_step = [](const patchlight::AdaptiveStep& step) {
        std::printf("cycle %d: %zu elements, estimated error %.3g %%\n", step.cycle, step.mesh.patch_count(),
                    100 * step.error.relative);
    };
    const patchlight::AdaptiveSolution solution = patchlight::solve_adaptively(scene, options, observers);

    std::printf("elements %zu\nestimated_error %.17g\n", solution.mesh.patch_count(), solution.error.relative);
    write_picture(scene, solution, argv[3]);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "example: %s\n", error.what());
    return 1;
}
