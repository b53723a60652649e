// The command line of drape_window.
#pragma once

#include <string>

#include "drape/debug_draw.h"

namespace drape::window
{
struct Options
{
    std::string m_scene = "bunny";             // a built-in scene's name, or a scene file
    std::string m_backend = "auto", m_device;  // see tools/common/device_option.h
    std::string m_models;                      // folder with model files; empty: the usual ones
    std::string m_screenshot;                  // PNG written at the end; empty: none
    int m_frames = 0;                          // frames after which the program ends; 0: until the window is closed
    int m_width = 1280, m_height = 800;        // pixels
    int m_detail = 2;                          // fineness of the cloth, see ClothSceneSize
    unsigned m_draws = 0;                      // DebugDrawFlags at the start
    bool m_bullet = false;                     // starts with Bullet's own collision
    bool m_listScenes = false;
};

// Returns true if the program goes on; see parseArguments().
bool parse(int argc, const char* const* argv, Options& options, int& exitCode);
}  // namespace drape::window
