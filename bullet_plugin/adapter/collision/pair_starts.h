// Finds pairs of a cloth and an obstacle that begin a step with intersecting triangles, and separates them. Contacts
// alone would keep such cloth on the wrong side.
//
// Job: a pair is guarded once a check found none of its triangles intersecting at a step's start. New, restarted and
// intersecting pairs are checked, pairs that were absent from a step, and faces of displaced nodes. Nodes on the wrong
// side of a closed obstacle are pushed to its nearest surface point at a bounded speed. Pairs with an open obstacle are
// only reported.
//
// Cost: a comparison per node of a guarded pair. A new pair takes a pass over the obstacle's triangles if the boxes
// meet, and O(log n) per cloth face if a triangle enters the cloth's box. Deterministic with any number of threads.
// Details: docs/design_notes/tangled_starts.md.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "bullet_plugin/adapter/collision/body_contacts.h"
#include "bullet_plugin/adapter/motion/kinematic_motion.h"
#include "bullet_plugin/core/probe/mesh_probe.h"

namespace drape
{
class ClothMirror;
class ObstacleMirror;
class PluginState;

// A pair of the coming step.
struct StartingPair
{
    const ClothMirror* m_cloth;
    const ObstacleMirror* m_obstacle;
    BodyMotion m_motion;
    bool m_isMovable;  // else the obstacle's positions are the world's
};

class PairStarts
{
public:
    explicit PairStarts(PluginState& state) : m_state(state) {}

    // Begins a step, before its first check(). Forgets pairs that have been absent for long.
    void beginStep();
    // Checks the pair where necessary. jumped: nodes that are not where the last step left them. If the pair
    // intersects and can be separated, adds the necessary pushes to the body. Reads Bullet's nodes only.
    void check(const StartingPair& pair, const std::vector<int>& jumped, BodyContacts& body);
    // Returns whether a pair that began the step apart ends it with a face, none of whose nodes are fixed, through the
    // obstacle. Ends the use of the mesh before the step of an obstacle whose vertices move in it.
    bool endsMeeting(const StartingPair& pair);
    // Returns whether check() will look at the pair's nodes though none has jumped.
    bool startsAnew(const StartingPair& pair) const;

    // Return the number of intersecting pairs of a cloth and an obstacle in the step so far, and of their triangles.
    std::size_t intersectingPairs() const { return m_intersectingPairs; }
    std::uint64_t intersections() const { return m_intersections; }

private:
    struct Guard
    {
        std::uint64_t m_clothRevision = 0, m_obstacleRevision = 0;  // at the last check
        std::uint64_t m_intersections = 0;                          // pairs of triangles; 0: guarded
        std::uint64_t m_lastStep = 0;
        std::uint64_t m_calmUntil = 0;  // step up to which the cloth counts as tangled shortly before
        int m_passes = 0;               // over all of the obstacle's triangles
        int m_pushedSteps = 0;          // steps in which nodes were on the wrong side
        int m_passingSteps = 0;         // steps in which faces met the obstacle, with all nodes on the right side
        int m_keptNode = -1;            // a node of the part that the rest is drawn back to; -1: no such part
        int m_backSteps = 0;            // steps in which the rest was drawn back
        int m_outSteps = 0;             // steps in which the whole cloth was moved out
        Vec3 m_out = {};                // direction out, unit, in the frame of the obstacle's positions
        bool m_checked = false, m_told = false;
    };
    struct Probe
    {
        std::unique_ptr<MeshProbe> m_probe;
        std::uint64_t m_revision = 0;  // revision of the obstacle's positions
        std::uint64_t m_lastStep = 0;
    };
    // A face of the cloth and the obstacle's triangles that it meets.
    struct MeetingFace
    {
        std::uint32_t m_face;
        std::vector<std::uint32_t> m_triangles;
    };

    bool startsAnew(const StartingPair& pair, const Guard& guard) const;
    using Row = std::map<int, btVector3>;  // by node, direction of the push, of any length

    void listFaces(const StartingPair& pair, const std::vector<int>* nodes);
    enum class PathEnd
    {
        Start,
        End
    };
    void findPlaces(const StartingPair& pair, bool all, PathEnd end = PathEnd::Start);
    bool mayMeet(const StartingPair& pair, Guard& guard);
    MeshProbe* probeOf(const StartingPair& pair);
    std::uint64_t findMeeting(const StartingPair& pair, const MeshProbe& probe);
    void flag(const StartingPair& pair, const MeshProbe& probe);
    void tellMargins(const StartingPair& pair) const;
    void tell(const StartingPair& pair, Guard& guard, bool pushed);
    void pushApart(const StartingPair& pair, const MeshProbe& probe, Guard& guard, BodyContacts& body);
    bool push(const StartingPair& pair, const MeshProbe& probe, const TangledPair& tangled, Guard& guard,
              BodyContacts& body);
    Row firstRow(const ClothFaces& faces, const MeshProbe& probe, int kept) const;
    Row nextRow(const ClothFaces& faces, const Row& row, const Row& drawn, int kept) const;
    void findRegions(const ClothFaces& faces, const MeshProbe& probe);
    int largestPart(const TangledPair& tangled, std::size_t& count) const;
    void pushToSurface(const StartingPair& pair, const MeshProbe& probe, BodyContacts& body);
    void drawBack(const StartingPair& pair, const MeshProbe& probe, int keptNode, BodyContacts& body);
    bool isInsideOnItsPath(const StartingPair& pair, const MeshProbe& probe, const Guard& guard);
    void moveOut(const StartingPair& pair, const MeshProbe& probe, Guard& guard, BodyContacts& body);
    void pushNode(const StartingPair& pair, int node, Vec3 displacement, BodyContacts& body) const;
    void pushFaces(const StartingPair& pair, const MeshProbe& probe, BodyContacts& body);

    PluginState& m_state;
    std::unordered_map<std::uint64_t, Guard> m_guards;  // by the cloth's id above the obstacle's
    std::unordered_map<MeshId, Probe> m_probes;
    std::uint64_t m_step = 0;
    std::size_t m_intersectingPairs = 0;
    std::uint64_t m_intersections = 0;
    // Working memory of one check, kept between checks.
    std::vector<std::uint32_t> m_faces;
    std::vector<Vec3> m_places;  // by node, in the frame of the obstacle's positions, at one end of the step
    std::vector<MeetingFace> m_meeting;
    std::vector<int> m_regions;          // by node: the first node that is reached over faces that meet nothing
    std::vector<unsigned char> m_wrong;  // by node: on the wrong side
    bool m_insideIsRight = false;
};
}  // namespace drape
