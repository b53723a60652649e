// The panel of drape_window: what the user may choose, and what the last step took.
#pragma once

#include <string>

#include "examples/window/simulation.h"

namespace drape::window
{
// The user's choices.
struct Choices
{
    std::string m_scene;
    bool m_byBullet = false;
    unsigned m_draws = 0;  // DebugDrawFlags
    bool m_wires = true;
    bool m_isPaused = false;
    bool m_stepsOnce = false;  // until the next step
    bool m_restarts = false;   // until the scene is made anew
    std::string m_error;       // why the last choice failed; empty if it was good
};

// Sets the panel's colours and sizes; after ImGui's context is made.
void styleAsPanel();
// Draws the panel within ImGui's frame, and takes the user's choices.
void drawPanel(const Simulation& simulation, Choices& choices);
}  // namespace drape::window
