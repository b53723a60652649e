// Draws the cloth on the obstacle: soft key light, sky light with ambient occlusion, anti-aliased, on a studio floor.
// Several cloths are drawn side by side, from the same place. Uses all processor cores; the same input gives the same
// picture on one machine. Some seconds for a cloth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
// A cloth on the obstacle and, where there are several, what is written above it: A to Z in either case, digits and
// ( ) . , : - / are drawn.
struct PicturePanel
{
    TriangleMesh m_cloth;
    std::string m_title, m_remark;
};

struct PictureHooks  // any may be empty
{
    std::function<void(int rows)> m_progress;  // so many rows of pictureRows() are drawn; on the calling thread
    std::function<bool()> m_goesOn;            // asked on the calling thread after each row: false gives the picture up
};

// The rows of pixels of all panels together.
int pictureRows(std::size_t panels);

// Renders at least one panel and writes a PNG. The first one's cloth and the obstacle decide what is in view; what is
// below the floor that both stand on is hidden. False, with one line in `error` unless the picture was given up, when
// there is none then; nothing is written in that case.
bool writePicture(const std::string& path, const std::vector<PicturePanel>& panels, const TriangleMesh& obstacle,
                  const PictureHooks& hooks, std::string& error);
}  // namespace drape
