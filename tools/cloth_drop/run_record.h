// Holds the measurements of a run, step by step, and their summary. Times are in ms, lengths in metres.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drape/recording.h"
#include "tools/cloth_drop/simulation.h"
#include "tools/cloth_drop/stretch_meter.h"
#include "oracle/measure.h"

namespace drape
{
struct StepRecord
{
    StepTimes m_times;
    StepMeasure m_measure;
    std::size_t m_nodesThrough = 0;  // whose way met the obstacle's surface, in this step or before (Crossings)
    std::size_t m_selfPairs = 0;     // intersecting pairs of cloth triangles, of one cloth or two
    double m_speed = 0;              // m/s, root mean square of the nodes' speeds over the step
    MeshStretch m_stretch;           // against the cloth at rest
    std::uint64_t m_hash = 0;        // hash of all positions up to and including this step
};

struct RunRecord
{
    std::string m_backend, m_device, m_deviceReason;
    std::string m_solver;  // the solver of the links: drape or bullet
    double m_prepareMs = 0;
    std::size_t m_clothTriangles = 0, m_clothNodes = 0, m_obstacleTriangles = 0;
    double m_thickness = 0;
    bool m_countsClothPairs = false;  // see countsClothPairs()
    std::vector<StepRecord> m_steps;
    std::vector<float> m_lastPositions;  // x y z per cloth node after the last step; a child's only where asked for
    Recording m_recording;               // empty unless asked for
    std::vector<std::vector<ObstacleFrame>> m_obstacles;  // at each frame of the recording; else after the last step
    bool m_capped = false;  // something ended the run before its last step: those done are there
    std::string m_trouble;  // one line, or empty
};

// Summarises the steps that had contacts; `m_first` is the first of them. All values are 0 if there was none.
struct TimeSummary
{
    double m_first = 0, m_median = 0, m_p95 = 0, m_max = 0;
};

struct RunSummary
{
    std::size_t m_stepsInContact = 0;
    TimeSummary m_step, m_collision;
    TimeSummary m_finding;   // the collision without solving; Bullet solves contacts in another part of the step
    WholeStepParts m_parts;  // medians of each, over the same steps
    std::size_t m_contactsMax = 0;
    double m_penetrationMax = 0;
    double m_penetrationP99 = 0;  // over every cloth node in every step in contact; nodes that are not below count as 0
    double m_gapMin = 0;
    std::size_t m_nodesBelow = 0;                // after the last step
    std::size_t m_nodesThrough = 0;              // nodes that ever went through the obstacle's surface
    std::size_t m_intersectingPairsEnd = 0;      // after the last step
    std::size_t m_intersectingPairsMax = 0;      // after any step
    std::size_t m_intersectingPairsMaxStep = 0;  // the first step that had so many, from 1; 0: no step had any
    bool m_countsClothPairs = false;             // see countsClothPairs()
    std::size_t m_selfPairsEnd = 0;              // after the last step
    std::size_t m_selfPairsMax = 0;              // after any step
    std::size_t m_invalidNodes = 0;              // most in any step
    MeshStretch m_stretch;                       // after the last step
    double m_restSpeed = 0;                      // m/s, root mean square over the last quarter of the steps
    std::uint64_t m_hash = 0;
};

RunSummary summarise(const RunRecord& record);

// Root mean square, m/s, of the nodes' motion (x y z per node, m) from one to the other within dt seconds.
double rmsSpeed(const std::vector<float>& before, const std::vector<float>& after, double dt);

// FNV-1a, 64 bits, over the bits of the floats, least significant byte first.
constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ull;
std::uint64_t hashFloats(std::uint64_t hash, const std::vector<float>& values);
std::string hashText(std::uint64_t hash);
}  // namespace drape
