// Draws the cloth on the obstacle: soft key light, sky light with ambient occlusion, anti-aliased, on a studio floor.
// Several cloths are drawn side by side, from the same place. Uses all processor cores; the same input gives the same
// picture on one machine. Some seconds for a cloth.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes/mesh.h"
#include "tools/cloth_drop/image.h"
#include "tools/cloth_drop/ray_scene.h"

namespace drape
{
// One cloth on the obstacle. The two lines of text are drawn above it where there are several panels (see
// picture_label.h for the characters).
struct PicturePanel
{
    TriangleMesh m_cloth;
    std::string m_title, m_remark;
    std::vector<std::int32_t> m_lines{};  // ropes: two vertices of the cloth each, drawn as thin tubes
};

struct PictureHooks  // any may be empty
{
    std::function<void(int rows)> m_progress;  // called on the calling thread with the rows drawn of pictureRows()
    std::function<bool()> m_goesOn;            // called there after each row; false gives the picture up
};

// Returns the number of pixel rows of all panels together.
int pictureRows(std::size_t panels);

struct PictureSize
{
    int m_width, m_height;  // pixels of a panel
    int m_samples;          // a pixel and axis; each carries one shadow and one sky ray
};

// Returns the size of a panel in a picture of so many.
PictureSize pictureSize(std::size_t panels);

// Draws at least one panel; the floor of the view hides cloth that fell deeper. Returns false with one line in `error`
// on failure, and false without one when the picture was given up.
bool drawPicture(const std::vector<PicturePanel>& panels, const TriangleMesh& obstacle, const View& view,
                 const PictureSize& size, const PictureHooks& hooks, Image& image, std::string& error);

// Renders at least one panel and writes a PNG. The first cloth and the obstacle determine the view; the floor below
// them hides cloth that fell deeper. Returns false with one line in `error` on failure, and false without one when the
// picture was given up. Nothing is written then.
bool writePicture(const std::string& path, const std::vector<PicturePanel>& panels, const TriangleMesh& obstacle,
                  const PictureHooks& hooks, std::string& error);
}  // namespace drape
