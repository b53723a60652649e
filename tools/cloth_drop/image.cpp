#include "tools/cloth_drop/image.h"

#include <png.h>

#include "scenes/atomic_file.h"

namespace drape
{
bool writePng(const std::string& path, const Image& image, std::string& error)
{
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.m_width);
    header.height = static_cast<png_uint_32>(image.m_height);
    header.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&header, &bytes[0], &size, 0, image.m_pixels.data(), 0, nullptr) == 0)
    {
        error = path + ": cannot make a PNG: " + header.message;
        return false;
    }
    bytes.resize(size);
    return writeFileAtomically(path, bytes, error);
}
}  // namespace drape
