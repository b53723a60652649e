// Writes recorded runs as an animated WebP file, drawn like a picture (picture.h) but smaller.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drape/recording.h"
#include "tools/cloth_drop/picture.h"

namespace drape
{
// Returns the number of pixel rows of all of an animation's pictures.
int animationRows(const std::vector<const Recording*>& runs);

using ObstacleAt = std::function<TriangleMesh(std::size_t frame)>;

// Draws the runs side by side, with their titles where there are several; a run that ended earlier keeps its last
// frame. Every other frame of 60 a second is drawn, or of other rates so many that about 30 are. The cloth is what is
// soft in the recording, unless it is the obstacle; `obstacleAt` returns the obstacles of a frame.
// Returns false like drawPicture().
bool writeAnimation(const std::string& path, const std::vector<const Recording*>& runs, const ObstacleAt& obstacleAt,
                    const PictureHooks& hooks, std::string& error);
}  // namespace drape
