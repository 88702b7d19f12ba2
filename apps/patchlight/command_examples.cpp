#include "apps/patchlight/command_examples.h"

namespace patchlight {

const std::vector<CommandExamples>& command_examples()
{
    static const std::vector<CommandExamples> all{
        {"", "", {"demo", "solve data/scenes/furniture-room.obj -o room"}},
        {"demo", "Solve", {"demo -o patchlight-demo"}},
        {"inspect",
         "Solve",
         {"inspect data/scenes/gallery.obj", "inspect data/scenes/cornell-box.obj --unit mm --lines"}},
        {"solve",
         "Solve",
         {"solve data/scenes/cornell-box.obj --unit mm -o box --max-elements 3000",
          "solve data/scenes/furniture-room.obj -o room --target-error 0.05"}},
        {"render",
         "Look",
         {"render box -o mesh.png --wireframe",
          "render box -o above.png --from 278,500,-200 --to 278,100,300 --fov 60"}},
        {"compare", "Look", {"compare box@first box -o compared --points 1000"}},
        {"animate", "Look", {"animate box -o cycles.png"}},
        {"report", "Look", {"report box -o box.html"}},
        {"probe", "Look", {"probe box --points data/points/cornell-box-floor.csv"}},
        {"export", "Look", {"export box --format ply -o box.ply", "export box --format pvd -o box.pvd"}},
        {"verify", "Check", {"verify box --points 200 --paths 256"}},
        {"rerun", "Check", {"rerun box -o box-again"}},
        {"formfactors",
         "Check",
         {"formfactors data/scenes/cornell-box.obj --unit mm --between light floor",
          "formfactors data/scenes/furnace.obj --max-elements 300 -o factors.csv"}},
        {"validate", "Check", {"validate --method closed-form"}},
        {"study",
         "Study",
         {"study check data/studies/cornell-meshes.toml", "study run data/studies/cornell-meshes.toml -o meshes"}},
        {"study check",
         "Study",
         {"study check data/studies/cornell-meshes.toml",
          "study check data/studies/cornell-meshes.toml --jobs 2 --json"}},
        {"study run", "Study", {"study run data/studies/cornell-meshes.toml -o meshes --jobs 2"}},
        {"study table", "Study", {"study table data/studies/cornell-meshes.toml -o meshes --format tex"}},
        {"study report", "Study", {"study report data/studies/cornell-meshes.toml --dir meshes -o meshes.html"}},
        {"study cell",
         "Study",
         {"study cell data/studies/cornell-meshes.toml --index 3 -o meshes",
          "study cell data/studies/cornell-meshes.toml --reference -o meshes"}},
        {"completion", "Shell", {"completion bash > patchlight.bash"}},
        {"man", "Shell", {"man > patchlight.1"}},
    };
    return all;
}

}  // namespace patchlight
