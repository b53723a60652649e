// An RGB picture in memory and its PNG file (written whole or not at all).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drape
{
struct Image
{
    // Makes a white picture.
    Image(int width, int height)
        : m_width(width),
          m_height(height),
          m_pixels(std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255)
    {
    }

    // Returns r g b of the pixel in column x of row y.
    std::uint8_t* at(int x, int y)
    {
        return &m_pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) +
                              static_cast<std::size_t>(x))];
    }

    int m_width, m_height;
    std::vector<std::uint8_t> m_pixels;  // r g b per pixel, top row first, sRGB
};

// Returns false with one line in `error` on failure.
bool writePng(const std::string& path, const Image& image, std::string& error);
}  // namespace drape
