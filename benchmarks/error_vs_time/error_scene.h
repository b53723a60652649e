// The scenes on which error is weighed against run time: one cloth and one obstacle each, the same for every method.
//
// bunny, dragon: a cloth falls on a scanned mesh. stairs: sharp edges. plate: a thin plate that rises at 30 m/s, half a
// metre a frame, into the cloth and takes it along. pile: many thin boards with gaps hardly wider than the thickness,
// each turned against the last. Lengths in metres.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/cloth_drop/drop_scene.h"

namespace drape::bench
{
constexpr double kThickness = 0.02;      // m, what errors are measured in
constexpr double kFrameTime = 1.0 / 60;  // s

struct ErrorScene
{
    std::string m_name;
    DropScene m_drop;          // with the usual thickness and a step a frame
    double m_rise = 0;         // m/s, of the obstacle upwards all the time, as a kinematic body; 0: it is static
    bool m_symmetric = false;  // its resting shape can be compared between runs: others fold this way or that
};

// Returns the names of all scenes, or of the few small ones of a quick run.
std::vector<std::string> errorSceneNames(bool quick);

// Returns false with one line in `error` if the model does not exist.
bool makeErrorScene(const std::string& name, bool quick, const std::vector<std::string>& modelFolders,
                    ErrorScene& scene, std::string& error);

// Makes one of many different falls of it: turned about the vertical, shifted and thrown, as the seed says.
void varyFall(ErrorScene& scene, std::uint32_t seed);
}  // namespace drape::bench
