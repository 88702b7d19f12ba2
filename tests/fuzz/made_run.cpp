#include "tests/fuzz/made_run.h"

#include "apps/run/sha256.h"
#include "apps/run/stored_scene.h"
#include "apps/run/stored_solution.h"
#include "meshing/read_scene.h"
#include "solver/adaptive.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace patchlight::testing {

namespace {

constexpr const char* room = R"(mtllib made.mtl
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v -.5 0 0
v .5 0 0
v .5 0 1
v -.5 0 1
v -.5 -.5 2
v -.5 .5 2
v .5 .5 2
v .5 -.5 2
usemtl white
f 1 2 3 4
f 5 6 7 8
usemtl lamp
f 9 10 11 12
)";

MadeRun solved()
{
    MadeRun run;
    fuzz_folder().write("made.mtl", "newmtl white\nKd .7 .6 .5\nnewmtl lamp\nKd 0 0 0\nKe 9 8 7\n");
    run.scene = read_scene(fuzz_folder().write("made.obj", room)).scene;
    run.options.max_elements = 40;
    run.options.iterations = 2;
    run.options.form_factors.rays = run.options.gather.rays = run.options.gather.shadow_rays = 16;
    AdaptiveObservers observers;
    observers.on_step = [&](const AdaptiveStep& step) {
        run.cycles.push_back(encode_solution(run.scene, step.mesh, step.B, step.vertex_B, step.error.eta,
                                             step.error.edge, step.middle_B));
        run.records.push_back(record_of(step));
        run.records.back().solution_sha256 = sha256_hex(run.cycles.back());
    };
    solve_adaptively(run.scene, run.options, observers);
    run.identity = {"made.obj",
                    sha256_hex(room),
                    scene_digest(run.scene),
                    run.scene.surfaces.size(),
                    6,
                    false,
                    {{"solve", json_of(run.options)}, {"scene", json_of(SceneOptions{})}},
                    1};
    return run;
}

std::string word(Choices& choices)
{
    static constexpr std::array<std::uint64_t, 6> hurting{
        std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN()),
        std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity()),
        std::bit_cast<std::uint64_t>(-1e308),
        std::bit_cast<std::uint64_t>(5e-324),
        0xffffffffffffffffU,
        0x7fffffff7fffffffU};
    const std::size_t kind = choices.below(hurting.size() + 2);
    const int length = 1 << choices.below(4);
    const std::uint64_t value = kind < hurting.size() ? hurting[kind] : choices.number(length);
    std::string text;
    for (int k = 0; k < length; ++k) text.push_back(static_cast<char>((value >> (8 * k)) & 0xffU));
    return text;
}

}  // namespace

const MadeRun& made_run()
{
    static const MadeRun run = solved();
    return run;
}

std::string damaged(std::string bytes, Choices& choices)
{
    for (int change = 0; change < 16 && choices.any_left(); ++change) {
        const std::size_t at = choices.number(3) % (bytes.size() + 1);
        switch (choices.below(4)) {
        case 0: {
            const std::size_t removed = choices.below(9), put_in = choices.below(9);
            bytes.replace(at, removed, choices.text(put_in));
            break;
        }
        case 1:
            bytes.erase(at, choices.below(64));
            break;
        case 2:
            bytes.insert(at, bytes.substr(at, choices.below(64)));
            break;
        default: {
            // Whole words, aligned as the arrays' entries are.
            const std::string value = word(choices);
            const std::size_t aligned = at - at % value.size();
            bytes.replace(aligned, value.size(), value);
        }
        }
    }
    return bytes;
}

}  // namespace patchlight::testing
