#include "apps/imaging/exposure.h"
#include "apps/imaging/image_file_module.h"

#include <cstddef>
#include <dlfcn.h>
#include <new>
#include <stdexcept>
#include <sys/mman.h>

namespace patchlight {

namespace {

constexpr const char* module_name = "patchlight_image_file.so";
constexpr const char* entry_name = "patchlight_image_file_module";

/// OpenImageIO's libraries take 430 MiB of addresses, and their threads stacks and arenas: where a limit (ulimit -v)
/// leaves less, one of them crashes while it is loaded.
void require_addresses()
{
    constexpr std::size_t needed = std::size_t{640} << 20;
    void* const place = ::mmap(nullptr, needed, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) throw std::bad_alloc();
    ::munmap(place, needed);
}

const ImageFileModule& load_module()
{
    require_addresses();
    // By its name alone: the program's run path says where it lies, in the build folder or installed. Never closed.
    void* const library = dlopen(module_name, RTLD_NOW | RTLD_LOCAL);
    const void* const entry = library ? dlsym(library, entry_name) : nullptr;
    if (!entry) {
        const std::string cause = dlerror();
        // The loader's words where a library doesn't fit into what memory is allowed.
        for (const char* words : {"failed to map segment", "annot allocate memory"})
            if (cause.find(words) != std::string::npos) throw std::bad_alloc();
        throw std::runtime_error(std::string("no pictures without ") + module_name + ": " + cause);
    }
    return *static_cast<const ImageFileModule*>(entry);
}

const ImageFileModule& loaded()
{
    static const ImageFileModule& module = load_module();
    return module;
}

}  // namespace

std::vector<unsigned char> encode_png(const Image& srgb)
{
    return loaded().encode_png(srgb);
}

std::vector<unsigned char> encode_exr(const Image& radiance, const ImageMetadata& metadata)
{
    return loaded().encode_exr(radiance, metadata);
}

ImageFile read_image(const std::filesystem::path& file)
{
    return loaded().read_image(file);
}

bool draw_text(Image& image, int x, int y, const std::string& text, int size, const Rgb& color, TextAlign align)
{
    return loaded().draw_text(image, x, y, text, size, color, align);
}

ColorTable color_table(const std::string& name)
{
    ColorTable table = loaded().color_table(name);
    for (Rgb& color : table) color = {srgb_encoded(color.r), srgb_encoded(color.g), srgb_encoded(color.b)};
    return table;
}

}  // namespace patchlight
