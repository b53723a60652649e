// The scenes on which error is weighed against run time: one cloth and one obstacle each, the same for every method.
//
// bunny, dragon: a cloth falls on a scanned mesh. stairs: sharp edges. plate: a thin plate and a cloth that meet at 30
// m/s; in the plate's frame, since Drape's obstacles rest: the cloth flies. pile: many thin boards with gaps hardly
// wider than the thickness, each turned against the last. Lengths in metres.
#pragma once

#include <string>
#include <vector>

#include "examples/cloth_drop/drop_scene.h"

namespace drape::bench
{
constexpr double kThickness = 0.02;      // m, what errors are measured in
constexpr double kFrameTime = 1.0 / 60;  // s

struct ErrorScene
{
    std::string m_name;
    DropScene m_drop;          // with the usual thickness and a step a frame
    double m_speed = 0;        // m/s, of the cloth downwards at the start
    bool m_symmetric = false;  // its resting shape can be compared between runs: others fold this way or that
};

// Of all, or of the few small ones of a quick run.
std::vector<std::string> errorSceneNames(bool quick);

// False with one line in `error` for a model that is not there.
bool makeErrorScene(const std::string& name, bool quick, const std::vector<std::string>& modelFolders,
                    ErrorScene& scene, std::string& error);
}  // namespace drape::bench
