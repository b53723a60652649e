// Measures what becomes of a scene's bodies, without Drape's code, and judges Drape's outcome beside Bullet's.
//
// Depths are those of the soft bodies' nodes, middles of edges and middles of faces below the surfaces of rigid shapes,
// without margins. Metres, seconds.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/soft_demo/demo_scenes.h"
#include "oracle/self_intersections.h"

namespace drape::bench
{
enum class Measure
{
    Invalid,     // bodies and nodes whose positions are not finite, at the end
    Below,       // nodes more than 0.1 m under the ground's surface, at the end
    Depth,       // mm, largest depth of a soft body in a rigid one, in the second half of the run
    Stretch,     // largest length of an edge or of a rope's link over its rest length, the median of the second half
    Carried,     // dynamic bodies above the scene's level, at the end
    VolumeLost,  // share of the volume at the start that closed bodies lack at the end, the mean
    Pairs,       // triangles of soft bodies that intersect each other, at the end
    Rest,        // mm/s, RMS speed of nodes in the last tenth of the run
    Energy,      // largest rise of kinetic and height energy above the start's, over the start's
    Travel,      // m, mean way of the soft bodies' centres in the first kTravelSteps steps
    Disorder,    // pairs of neighbouring bodies of which the one with more friction slid farther
    Count
};

// Values of the measures that the scene has.
using Outcome = std::array<std::optional<double>, std::size_t(Measure::Count)>;

// Judges a measure. Values that differ by at most the larger of m_least and m_share of the lower one are equal;
// so are two values above m_most, such as speeds of scenes that rest in neither run.
struct MeasureRule
{
    const char* m_name;   // column
    const char* m_title;  // in documents
    int m_better;         // 1: more is better; -1: less is better; 0: a difference from Bullet is worse
    double m_least, m_share, m_most;
};

constexpr int kTravelSteps = 120;

const MeasureRule& ruleOf(Measure measure);

struct Verdict
{
    std::string m_word;    // "same", "better" or "worse"; worse if any measure is
    std::string m_reason;  // names the measures that decided; empty for "same"
};

Verdict judge(const Outcome& drape, const Outcome& stock);

class OutcomeMeter
{
public:
    // steps: of the whole run. Call it with the built scene, before the first step.
    OutcomeMeter(DemoWorld& world, const DemoScene& scene, int steps);
    // Call it after each step.
    void add();
    // Returns the outcome after the last step.
    Outcome finish();
    // Returns all nodes' positions, x y z each.
    std::vector<float> positions() const;

private:
    double depthNow() const;
    double stretchNow() const;
    double carriedNow() const;
    double volumeLost() const;
    double pairsNow();
    double invalidNow() const;
    double energyNow() const;
    double disorder() const;
    double travelNow() const;
    double belowNow() const;

    DemoWorld& m_world;
    const DemoScene& m_scene;
    const int m_steps;
    int m_step = 0;
    double m_depth = 0, m_speed2 = 0, m_mostEnergy = 0, m_travel = 0;
    int m_restSteps = 0;
    double m_energy = 0;              // J, at the start
    std::vector<double> m_stretches;  // by step of the second half
    std::vector<float> m_before;
    std::vector<double> m_volumes;     // at the start, by soft body
    std::vector<btVector3> m_centres;  // at the start
};
}  // namespace drape::bench
