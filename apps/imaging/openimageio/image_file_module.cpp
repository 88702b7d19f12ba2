#include "apps/imaging/image_file_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>

namespace patchlight {

namespace {

// Debian's fonts-dejavu-core. By path: what a bare name finds depends on the machine.
constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

OIIO::ImageSpec spec_of(const Image& image, OIIO::TypeDesc type)
{
    OIIO::ImageSpec spec(image.width, image.height, 3, type);
    spec.attribute("Software", "patchlight");
    // Without this the EXR writer puts today's date in, and no two runs have the same bytes.
    spec.attribute("DateTime", "");
    return spec;
}

std::vector<unsigned char> encode(const Image& image, const OIIO::ImageSpec& spec, const char* format)
{
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output) {
        throw std::runtime_error(std::string("no writer for ") + format + ": " + OIIO::geterror());
    }
    output->threads(1);
    if (!output->set_ioproxy(&memory) || !output->open(format, spec) ||
        !output->write_image(OIIO::TypeFloat, image.rgb.data()) || !output->close()) {
        throw std::runtime_error(std::string("can't encode ") + format + ": " + output->geterror());
    }
    return bytes;
}

std::vector<unsigned char> png_of(const Image& srgb)
{
    OIIO::ImageSpec spec = spec_of(srgb, OIIO::TypeUInt8);
    spec.erase_attribute("DateTime");
    spec.attribute("oiio:ColorSpace", "sRGB");
    // A run writes a picture a cycle: a third of the usual level's time, a tenth more bytes.
    spec.attribute("png:compressionLevel", 3);
    return encode(srgb, spec, "png");
}

std::vector<unsigned char> exr_of(const Image& radiance, const ImageMetadata& metadata)
{
    OIIO::ImageSpec spec = spec_of(radiance, OIIO::TypeFloat);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    for (const auto& [name, value] : metadata) {
        spec.attribute(name, value);
    }
    return encode(radiance, spec, "exr");
}

ImageFile image_in(const std::filesystem::path& file)
{
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
    if (!input) {
        throw std::runtime_error(file.string() + ": " + OIIO::geterror());
    }
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > largest_picture_side * 2 ||
        spec.height > largest_picture_side * 2 || spec.nchannels < 3) {
        throw std::runtime_error(file.string() + ": not a picture of three channels and a sensible size");
    }
    ImageFile result{Image(spec.width, spec.height), {}};
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeFloat, result.image.rgb.data())) {
        throw std::runtime_error(file.string() + ": " + input->geterror());
    }
    for (const auto& attribute : spec.extra_attribs) {
        if (attribute.type() == OIIO::TypeString) {
            result.metadata[attribute.name().string()] = attribute.get_string();
        }
    }
    return result;
}

/// On `rgb`, of `rows` rows of `width` pixels; where no font is found nothing.
bool render(std::vector<float>& rgb, int width, int rows, int x, int y, const std::string& text, int size,
            const Rgb& color, TextAlign align)
{
    using OIIO::ImageBufAlgo::TextAlignX;
    OIIO::ImageBuf canvas(OIIO::ImageSpec(width, rows, 3, OIIO::TypeFloat), rgb.data());
    const std::vector<float> ink{static_cast<float>(color.r), static_cast<float>(color.g), static_cast<float>(color.b)};
    const auto side = align == TextAlign::left     ? TextAlignX::Left
                      : align == TextAlign::center ? TextAlignX::Center
                                                   : TextAlignX::Right;
    for (const char* font : {font_file, "DejaVuSans", ""}) {
        if (OIIO::ImageBufAlgo::render_text(canvas, x, y, text, size, font, ink, side)) {
            return true;
        }
        (void)canvas.geterror();
    }
    return false;
}

bool write_text(Image& image, int x, int y, const std::string& text, int size, const Rgb& color, TextAlign align)
{
    // The rows that letters on this line can reach.
    const int first = std::clamp(y - 2 * size, 0, image.height), last = std::clamp(y + size, first, image.height);
    if (first == last) return true;
    const auto begin = image.rgb.begin() + (image.pixel(0, first) - image.rgb.data());
    const std::vector<float> ground(begin, begin + std::ptrdiff_t{3} * image.width * (last - first));
    std::vector<float> once = ground, again = ground;
    const auto write = [&](std::vector<float>& rgb) {
        return render(rgb, image.width, last - first, x, y - first, text, size, color, align);
    };
    const bool written = write(once);
    // Letters that FreeType has no memory for are left out, and nobody says so: "3.16 %" would be "3.1 %".
    if (write(again) != written || once != again) throw std::bad_alloc();
    std::ranges::copy(once, begin);
    return written;
}

ColorTable table_of(const std::string& name)
{
    constexpr int count = 256;
    OIIO::ImageBuf ramp(OIIO::ImageSpec(count, 1, 1, OIIO::TypeFloat));
    for (int i = 0; i < count; ++i) {
        const float value = static_cast<float>(i) / (count - 1);
        ramp.setpixel(i, 0, &value, 1);
    }
    const OIIO::ImageBuf colors = OIIO::ImageBufAlgo::color_map(ramp, 0, name);
    if (colors.has_error()) {
        throw std::runtime_error("no colour map " + name + ": " + colors.geterror());
    }
    ColorTable table;
    for (int i = 0; i < count; ++i) {
        float c[3] = {};
        colors.getpixel(i, 0, c, 3);
        table.emplace_back(c[0], c[1], c[2]);
    }
    return table;
}

}  // namespace

const ImageFileModule patchlight_image_file_module{.encode_png = &png_of,
                                                   .encode_exr = &exr_of,
                                                   .read_image = &image_in,
                                                   .draw_text = &write_text,
                                                   .color_table = &table_of};

}  // namespace patchlight
