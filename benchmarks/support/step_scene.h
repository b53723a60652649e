// The scenes of bench_step: one or many cloths draped over an obstacle, and their motion over some steps.
//
// A scene's steps repeat after its period, each beginning where the one before ended. Positions lie in joined arrays,
// all cloths end to end. Deterministic by the scene's name and the model's file. Lengths in metres.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape::bench
{
struct SceneSpec
{
    std::string m_name;
    std::string m_sweep;  // the series it belongs to, for plots and exponents; empty for single scenes
    std::string m_model;  // see scenes/models.h
    int m_cells = 0;      // a side of a cloth
    int m_cloths = 1;
    double m_size = 0;       // m, a side of a cloth
    double m_thickness = 0;  // m; 0: a cell's size, at most kThickness
    bool m_quick = false;    // belongs to --quick
    bool m_self = false;     // the cloths collide with themselves too
    bool m_folded = false;   // one half lies on the other

    std::size_t clothTriangles() const
    {
        return 2 * static_cast<std::size_t>(m_cells) * static_cast<std::size_t>(m_cells) *
               static_cast<std::size_t>(m_cloths);
    }
};

// The thickness of the acceptance scenes, on obstacles of 2 m, in m.
constexpr double kThickness = 0.02;

const std::vector<SceneSpec>& sceneSpecs();

// The thickness of a cloth with itself as a share of a cell's side. With the default activation contacts reach to 0.6
// of the side, which is less than the altitude of a cell's triangles, 0.7.
constexpr double kSelfShare = 0.4;

struct StepScene
{
    SceneSpec m_spec;
    float m_thickness = 0;      // m
    float m_selfThickness = 0;  // m; 0: the cloths do not collide with themselves
    TriangleMesh m_obstacle;
    std::vector<TriangleMesh> m_cloths;        // at rest
    std::vector<std::vector<float>> m_frames;  // a period: all cloths' nodes at the start of each step

    int period() const { return static_cast<int>(m_frames.size()); }
    std::size_t floats() const { return m_frames.front().size(); }  // number of floats of all nodes' positions
    const float* start(int step) const { return m_frames[static_cast<std::size_t>(step % period())].data(); }
    const float* end(int step) const { return start(step + 1); }
};

// Drapes the cloths over the obstacle (a mesh on the floor) and makes the frames.
StepScene makeStepScene(const SceneSpec& spec, const TriangleMesh& obstacle);
}  // namespace drape::bench
