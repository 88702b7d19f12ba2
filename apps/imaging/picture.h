#pragma once

#include "apps/imaging/image.h"
#include "formfactor/ray_caster.h"
#include "solver/element_light.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace patchlight {

enum class Shade {
    gouraud,  ///< the elements' reconstruction, linear or quadratic
    flat      ///< one value a patch
};

struct PictureOptions {
    int width = 640;  ///< pixels, 1 … largest_picture_side
    int height = 640;
    int samples = 2;  ///< rays along each side of a pixel, 1 … 8; 1 = through the pixel's centre
    Shade shade = Shade::gouraud;
    bool patch_borders = false;  ///< draws the mesh's edges over the shading, its lines in colours (line_overlay.h)
    double white = std::numeric_limits<double>::infinity();  ///< radiance at which a sample is cut before averaging,
                                                             ///< W/(m²·sr): keeps the edges of lamps smooth in a PNG
};

/// A solution and what it stands on. Everything must live as long as this.
struct ShownSolution {
    const Scene& scene;
    const PatchMesh& mesh;
    const PatchLocator& locator;
    const Radiosity& B;
    const VertexRadiosity& vertex_B;
    const MidpointRadiosity* middle_B = nullptr;  ///< null or empty: linear elements

    ElementLight light() const { return {mesh, locator, vertex_B, middle_B}; }
};

/// What each sample of a picture shows. It doesn't depend on the mesh: one tracing serves all cycles of a run.
struct ViewHits {
    View view;
    int width = 0, height = 0, samples = 1;
    std::vector<std::uint32_t> surface;  ///< rows of width × samples, from the top; values as in HitBatch
};

/// Traces samples² rays a pixel. Throws std::invalid_argument for a size outside the options' ranges.
ViewHits trace_view(const RayCaster& caster, const View& view, int width, int height, int samples);

/// Radiance B/π, W/(m²·sr), averaged over each pixel's samples. Black backs and the background are black.
/// The point a sample shows is computed in double from its ray and the plane of the surface hit.
Image shade_view(const ShownSolution& solution, const ViewHits& hits, const PictureOptions& options);

/// trace_view and shade_view at once.
Image render_picture(const ShownSolution& solution, const RayCaster& caster, const View& view,
                     const PictureOptions& options);

}  // namespace patchlight
