#include "meshing/build_scene.h"
#include "meshing/scene_error.h"
#include "solver/adaptive.h"
#include "solver/invariants.h"
#include "tests/fuzz/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <vector>

using namespace patchlight;

namespace {

using testing::Choices;

constexpr std::size_t lamp = 3, most_faces = 10;

/// A scene of polygons that touch, overlap, cross themselves or have no area, as bytes choose them.
class ChosenScene {
public:
    explicit ChosenScene(Choices& choices) : choices_(choices)
    {
        raw_.format = "obj";
        raw_.file_name = "fuzzed.obj";
        raw_.objects = {"all"};
        raw_.materials = {Material{.name = "white", .reflectance = Rgb(0.7)},
                          Material{.name = "both", .reflectance = Rgb(0.4), .two_sided = true},
                          Material{.name = "glowing", .reflectance = Rgb(0.3), .emission = Rgb(5, 4, 0)},
                          Material{.name = "lamp", .reflectance = Rgb(0.0), .emission = Rgb(10)}};
    }

    RawScene made()
    {
        const std::size_t turn = choices_.below(8);
        const bool lit = choices_.below(4) != 0;
        while (choices_.any_left() && raw_.faces.size() < most_faces) add();
        if (lit || raw_.faces.empty()) face({{0.75, 0.75, 2}, {0.75, 1.25, 2}, {1.25, 1.25, 2}, {1.25, 0.75, 2}}, lamp);
        turn_all(turn);
        return raw_;
    }

    /// Whether there may be gaps wider than what is snapped and narrower than rays can tell, in single precision.
    bool narrow() const { return narrow_; }

private:
    void face(std::vector<Vec3> corners, std::size_t material)
    {
        raw_.faces.push_back({raw_.corners.size(), corners.size(), MaterialId(material), ObjectId(std::size_t{0}), 0});
        for (const Vec3& p : corners) {
            raw_.corners.push_back(static_cast<std::int64_t>(raw_.vertices.size()));
            raw_.vertices.push_back(p);
        }
    }

    /// Mostly on a grid of 0, ½ … 2, where much coincides; sometimes beside it by a little, or anywhere.
    double length()
    {
        const std::uint8_t b = choices_.byte();
        const double on_grid = 0.5 * (b % 5);
        if (b < 180) return on_grid;
        if (b < 210 && b % 2 == 0) return on_grid + 1e-9;  // below what is snapped
        if (b >= 210 && b < 250) return 0.0437 * (b - 209);
        narrow_ = true;
        return on_grid + (b < 210 ? 3e-8 : 1e-7);
    }

    /// In a plane across an axis.
    std::vector<Vec3> flat(std::size_t corners, int axis, double level)
    {
        std::vector<Vec3> outline;
        for (std::size_t k = 0; k < corners; ++k) {
            Vec3 p(level);
            p[(axis + 1) % 3] = length();
            p[(axis + 2) % 3] = length();
            outline.push_back(p);
        }
        return outline;
    }

    std::vector<Vec3> rectangle(int axis)
    {
        const std::vector<Vec3> ends = flat(2, axis, length());
        Vec3 right = ends[0], left = ends[0];
        right[(axis + 1) % 3] = ends[1][(axis + 1) % 3];
        left[(axis + 2) % 3] = ends[1][(axis + 2) % 3];
        return {ends[0], right, ends[1], left};
    }

    /// Fronts outside, or, of a room, inside.
    void box(bool room, std::size_t material)
    {
        const Vec3 low{length(), length(), length()}, size{length(), length(), length()};  // braces: in this order
        const auto corner = [&](std::size_t k) {
            const auto bit = [&](std::size_t n) { return static_cast<double>((k >> n) & 1U); };
            return low + size * Vec3(bit(0), bit(1), bit(2));
        };
        static constexpr std::size_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                    {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
        for (const auto& side : sides) {
            std::vector<Vec3> corners{corner(side[0]), corner(side[1]), corner(side[2]), corner(side[3])};
            if (room) std::reverse(corners.begin(), corners.end());
            face(corners, material);
        }
    }

    /// The last face once more: turned round, moved by a little, or shifted in its plane.
    void again(std::size_t material)
    {
        if (raw_.faces.empty()) return;
        const auto indices = raw_.corners_of(raw_.faces.back());
        std::vector<Vec3> corners;
        for (const std::int64_t index : indices) corners.push_back(raw_.vertices[static_cast<std::size_t>(index)]);
        const std::size_t how = choices_.below(4);
        if (how % 2 == 1) std::reverse(corners.begin(), corners.end());
        if (how >= 2) {
            Vec3 by(0);
            by[static_cast<int>(choices_.below(3))] = length();
            for (Vec3& p : corners) p += by;
        }
        face(corners, material);
    }

    void add()
    {
        const std::size_t kind = choices_.below(8), material = choices_.below(4);
        const int axis = static_cast<int>(choices_.below(3));
        switch (kind) {
        case 0:
        case 1: {
            std::vector<Vec3> corners = rectangle(axis);
            if (kind == 1) std::reverse(corners.begin(), corners.end());
            face(corners, material);
            break;
        }
        case 2:
        case 3: {
            const std::size_t corners = 3 + choices_.below(6);
            face(flat(corners, axis, length()), material);
            break;
        }
        case 4: {
            std::vector<Vec3> corners(3 + choices_.below(3));
            for (Vec3& p : corners) p = {length(), length(), length()};
            face(corners, material);
            break;
        }
        case 5:
        case 6:
            box(kind == 6, material);
            break;
        default:
            again(material);
        }
    }

    void turn_all(std::size_t how)
    {
        if (how < 4) return;
        const double angle = how == 4 ? 1e-9 : how == 5 ? 0.3 : std::numbers::pi / 4;
        const double c = std::cos(angle), s = std::sin(angle);
        for (Vec3& p : raw_.vertices) {
            p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
            if (how == 7) p = Vec3(p.x, c * p.y - s * p.z, s * p.y + c * p.z) * 1e3 + Vec3(1e6, 0, 0);
        }
    }

    Choices& choices_;
    RawScene raw_;
    bool narrow_ = false;
};

AdaptiveOptions chosen_options(Choices& choices)
{
    AdaptiveOptions options;
    options.max_elements = 24;
    options.iterations = 1;
    options.form_factors.rays = options.gather.rays = options.gather.shadow_rays = 16;
    options.form_factors.resolution = 8;
    options.form_factors.tolerance = 0.05;
    options.estimate.rays = 16;
    static constexpr Refine refines[] = {Refine::both, Refine::intensity, Refine::discontinuity, Refine::none};
    static constexpr Solver solvers[] = {Solver::gauss_seidel, Solver::progressive,        Solver::jacobi,
                                         Solver::bicgstab,     Solver::conjugate_gradient, Solver::hierarchical};
    static constexpr FormFactorMethod methods[] = {FormFactorMethod::hemisphere, FormFactorMethod::exact,
                                                   FormFactorMethod::quadrature, FormFactorMethod::hemicube};
    options.refine = refines[choices.below(4)];
    options.final.solver = solvers[choices.below(6)];
    options.form_factors.method = methods[choices.below(4)];
    const std::size_t bits = choices.below(8);
    if (bits % 2 == 1) options.elements = Elements::quadratic;
    if (bits >= 6) options.direct = Direct::sampled;
    if (bits == 3) options.lines.secondary_share = 0.5;
    if (options.refine == Refine::none || options.refine == Refine::discontinuity)
        options.meshing.max_elements = options.max_elements;
    return options;
}

/// The patches of each surface cover it: to a millionth, far above rounding and far below any patch, or to what
/// snapping may move slivers' borders by, out of their plane, too, where patches have no area.
void check_areas(const Scene& scene, const PatchMesh& mesh)
{
    const double along_an_edge = SceneOptions{}.snap * scene.diameter * scene.diameter;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        double area = 0, snapped = 0;
        for (const auto& loop : surface.loops) snapped += along_an_edge * static_cast<double>(loop.size());
        for (const PatchId patch : mesh.patches_of(SurfaceId(s))) area += mesh.area(patch);
        if (std::abs(area - surface.area) > 1e-6 * surface.area + snapped)
            throw std::logic_error(fmt::format("the patches of surface {} have {} m2 of {}", s, area, surface.area));
    }
}

/// On patches as large and rays as few as these it can be right to refuse an answer: a hemicube sees all of a row from
/// one point, rows that don't fit together can't be scaled for conjugate gradients, and what is too near is neither
/// told apart by rays nor by its edges' angles.
bool may_refuse(const AdaptiveOptions& options, bool narrow, const InvariantError& refusal)
{
    const std::string_view what = refusal.what();
    if (narrow && (what.starts_with("the factors of a row") || what.starts_with("light escapes"))) return true;
    const bool hemicube = options.form_factors.method == FormFactorMethod::hemicube;
    if (hemicube && what.starts_with("light is made or lost")) return true;
    const bool scaled = options.final.solver == Solver::conjugate_gradient &&
                        (hemicube || options.form_factors.method == FormFactorMethod::hemisphere);
    return scaled && (what.starts_with("the factors of a row") || what.starts_with("a factor is outside"));
}

}  // namespace

/// Solves a small scene. What an answer must be, the solver itself looks after: an InvariantError is a mistake, too.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Choices choices(data, size);
    const AdaptiveOptions options = chosen_options(choices);
    Scene scene;
    ChosenScene chosen(choices);
    try {
        RawScene raw = chosen.made();
        validate(raw, {});
        scene = build_scene(raw, {}).scene;
    } catch (const SceneError&) {
        return 0;
    }
    AdaptiveObservers observers;
    observers.on_step = [&](const AdaptiveStep& step) { check_areas(scene, step.mesh); };
    try {
        const AdaptiveSolution solution = solve_adaptively(scene, options, observers);
        if (!std::isfinite(solution.error.total)) throw std::logic_error("an estimated error isn't finite");
    } catch (const InvariantError& refusal) {
        if (!may_refuse(options, chosen.narrow(), refusal)) throw;
    }
    return 0;
}
