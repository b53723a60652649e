// An RGB picture in memory and its PNG file (written whole or not at all).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drape
{
struct Image
{
    int m_width = 0, m_height = 0;
    std::vector<std::uint8_t> m_pixels;  // r g b per pixel, top row first, sRGB
};

// False with one line in `error`.
bool writePng(const std::string& path, const Image& image, std::string& error);
}  // namespace drape
