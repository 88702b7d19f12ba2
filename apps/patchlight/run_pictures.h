#pragma once

#include "apps/imaging/image_file.h"
#include "apps/imaging/picture.h"
#include "apps/run/run_record.h"

#include <string>
#include <utility>

namespace patchlight {

/// Bytes to write, by file name.
using PictureFile = std::pair<std::string, std::vector<unsigned char>>;

/// The pictures of one run: one camera, one size, one exposure. Primary rays are traced once.
class RunPictures {
public:
    RunPictures(const Scene& scene, const RayCaster& caster, const View& view, int width, int height);

    /// The exposure that shows this solution well.
    double exposure_for(const ShownSolution& solution) const;

    /// Two samples along each side of a pixel.
    const ViewHits& samples() const { return fine_; }

    Image srgb(const ShownSolution& solution, double exposure, bool patch_borders = false) const;
    std::vector<unsigned char> png(const ShownSolution& solution, double exposure, bool patch_borders = false) const;
    /// Linear B/π through the pixels' centres, with the camera and the options as metadata.
    std::vector<unsigned char> exr(const ShownSolution& solution, const Json& options) const;

private:
    const Scene& scene_;
    ViewHits fine_;
    ViewHits centers_;
};

/// What an EXR says about itself: camera in the scene file's coordinates, units, options.
ImageMetadata exr_metadata(const Scene& scene, const View& view, const Json& options);

/// "before: 512 elements", and so on.
std::string caption_title(const std::string& which, const CycleRecord& record);
std::string caption_detail(const CycleRecord& record);

}  // namespace patchlight
