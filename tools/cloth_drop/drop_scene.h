// The scene that every back end is given: an obstacle standing on y = 0 and flat cloths above it. Knows no Bullet.
#pragma once

#include <string>
#include <vector>

#include "tools/cloth_drop/options.h"
#include "tools/cloth_drop/run_subject.h"
#include "scenes/cloth_grid.h"
#include "scenes/cloth_scene.h"
#include "scenes/mesh.h"

namespace drape
{
constexpr double kGravity = 9.81;  // m/s² downwards

constexpr int kDropIterations = 5;  // piterations

// Returns a woven cloth: stiff along its threads, soft in bending, with some air drag, and enough friction to stay on a
// round obstacle.
inline SceneMaterial dropMaterial()
{
    return {0.9, 0.1, 0.02, 0.6};
}

struct DropScene
{
    TriangleMesh m_obstacle;
    ClothGrid m_cloth;                 // the lowest sheet
    std::size_t m_layers = 1;          // sheets above one another
    bool m_self = false;               // sheets collide with themselves and with each other
    double m_dropSpeed = 0;            // m/s downwards, of the whole cloth at the start
    double m_dt = 0;                   // s
    double m_thickness = 0;            // m; each side's margin is half of it
    double m_mass = 1.0;               // kg, of each sheet
    std::vector<std::string> m_notes;  // parts of the obstacle's file that were left out or lost, one line each
};

// Returns whether the pairs of cloth triangles that intersect are counted: where sheets may meet each other. The exact
// check of a large flat cloth with itself takes seconds a step.
inline bool countsClothPairs(const DropScene& scene)
{
    return scene.m_self || scene.m_layers > 1;
}

// Returns all sheets as one mesh, one after the other, the lowest first.
TriangleMesh sheetsOf(const DropScene& scene);

// Returns what is measured of a run of the scene.
RunSubject subjectOf(const DropScene& scene);

// Returns false, with one line in `error`, if the obstacle cannot be made.
bool makeDropScene(const Options& options, DropScene& scene, std::string& error);

// Returns one line if the thickness is out of proportion to the scene, which is probably a mistake, else "". The
// thickness is too large above a quarter of the obstacle's or the cloth's size. It is too small below the resolution of
// float32 there.
std::string thicknessRemark(const Options& options);
}  // namespace drape
