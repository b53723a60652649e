// Chooses the back end of a scene's steps if the settings leave the choice to cost.
//
// Input: the crossover, in expected triangle pairs (expected_pairs.h), and which cloth has a pair with which obstacle.
// A cloth counts with the obstacle that makes most work for it among its pairs so far: it cannot lie on two with all
// its area.
//
// The scene begins on the host, and moves to the device when its work passes the crossover. It returns only below
// half of it, once meshes are removed, to avoid alternation. Both back ends give the same contacts bit for bit, so a
// move changes only time.
#pragma once

#include <cstdint>
#include <map>

#include "bullet_plugin/core/scene/mesh_id.h"

namespace drape
{
class BackendChoice
{
public:
    // Lets the work decide from now on. 0: the device from the first pair on; infinite: the host.
    void begin(double crossover);
    void end() { m_active = false; }
    bool active() const { return m_active; }

    // Sets the work of a cloth with an obstacle, in expected triangle pairs.
    void setWork(MeshId cloth, MeshId obstacle, double pairs);
    void forget(MeshId mesh);

    double crossover() const { return m_crossover; }
    // Returns the scene's work.
    double work() const;
    // Decides by the work as it is now; returns whether the host runs the next step.
    bool chooseHost();

private:
    std::map<MeshId, std::map<MeshId, double>> m_work;  // by cloth, by obstacle
    double m_crossover = 0;
    bool m_active = false;
    bool m_onHost = true;
};
}  // namespace drape
