// Keeps nodes near obstacles within the region that detection has searched.
//
// Rule: near an obstacle a node ends close to the straight path of its prediction. A node with contacts may leave the
// path by the activation distance. A node without contacts may leave the path's end by most of the reach, and less
// towards the path's start. A node is near an obstacle if it or any of its faces is. Other nodes are not changed.
//
// The path is relative to a moving obstacle. The velocity follows the position, as in Bullet's own update, so the
// limit adds no energy. Metres, world frame. Cost: linear in the nodes; again for nodes that left their paths and
// their faces, per near obstacle. Reasons: docs/design_notes/motion_limit.md.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/cloth_faces.h"
#include "bullet_plugin/adapter/node_paths.h"

namespace drape
{
// Share of the reach by which a node without contacts may leave its path; the rest is for rounding and the detection's
// own tolerances.
constexpr btScalar kFreeShare = btScalar(0.9);

// Minimum distance by which a node with contacts may leave its path, as a share of the thickness, if the activation is
// set to less.
constexpr btScalar kLeastShare = btScalar(0.1);

// Maximum distance by which a node may leave the path's start, as a share of the thickness, which is known to be free
// there.
constexpr btScalar kMostStartShare = btScalar(0.8);

class MotionLimit
{
public:
    // Forgets the obstacles; memory is kept.
    void clear();
    // Adds the box of an obstacle of one of the body's pairs, the pair's thickness, and the activation as a share of
    // it. Nodes are free if everything that their faces can pass between the predicted and the solved positions
    // misses every box. carry, carriedStarts: see StepContact; the caller owns the second. While all obstacles of a
    // body rest, a node with contacts ends at most pathTolerance() of the thinnest pair from its path.
    void addObstacle(const btVector3& low, const btVector3& high, btScalar thickness, btScalar activation,
                     const btTransform* carry = nullptr, const btVector3* carriedStarts = nullptr);
    // Starts recording the prediction, before Bullet solves; recordNodes() then records all nodes. No node has
    // contacts yet. The faces refer to the same nodes, and must stay unchanged until the last apply() or
    // applyToOthers().
    void startRecord(const ClothFaces& faces);
    // Records some of the nodes; another thread may record others meanwhile.
    void recordNodes(const btSoftBody& body, std::size_t first, std::size_t count);
    // Records the nodes' current ends alone, for the same step as recordNodes().
    void recordEnds(const btSoftBody& body, std::size_t first, std::size_t count);
    // Calls startRecord() and records all nodes.
    void record(const btSoftBody& body, const ClothFaces& faces);
    // Returns the distance by which a node with contacts may leave its path, m.
    static btScalar pathTolerance(btScalar thickness, btScalar activation);
    const NodePaths& paths() const { return m_paths; }
    // A node of a contact; after startRecord().
    void addContactNode(int node) { m_hasContact[static_cast<std::size_t>(node)] = 1; }
    // Returns whether the body may have passed a surface without a contact. This is so if a node, limited or not,
    // ended more than kFreeShare of the reach from its path's end, and the node or one of its faces came near an
    // obstacle on the way.
    bool strayed(const btSoftBody& body);
    // Brings nodes that left their path too far back to the nearest point of the allowed region.
    void apply(btSoftBody& body);
    // Does the same as apply() for nodes without contacts alone.
    void applyToOthers(btSoftBody& body);
    // Returns whether all obstacles rest. keepNear() then replaces apply() for a node with contacts, wherever the
    // other nodes are.
    bool obstaclesRest() const { return !m_anyMoves; }
    // Limits a node with contacts at `place` while the obstacles rest: it stays within the path tolerance of the
    // thinnest pair. Returns whether the node was brought back.
    bool keepNear(std::size_t node, btVector3& place) const;

private:
    // Distances by which a node may leave the path's start and end.
    struct Allowance
    {
        btScalar m_start, m_end;
    };
    struct Region
    {
        btVector3 m_low, m_high;
        Allowance m_allowance;
        bool m_moves;
        btTransform m_carry;
        const btVector3* m_carriedStarts;
    };

    // A node farther from its path's end than is always free.
    struct Restless
    {
        int m_node;
        Allowance m_allowed;  // by the obstacles that rest
    };
    // The volume that a node or a triangle may pass between its predicted and its current position.
    struct Passed
    {
        btVector3 m_low, m_high;
        int m_nodes[3];
    };

    bool isRestless(std::size_t node, const btVector3& place) const;
    bool findRestless(const btSoftBody& body);
    void boxPassed(const btSoftBody& body, bool withContacts);
    void addPassed(const btSoftBody& body, int a, int b, int c);
    // Marks nodes near the region. Returns false, with no mark changed, if there are none.
    bool markNear(const Region& region);
    Allowance allowance(const Region& region, std::size_t node) const;
    void applyResting(btSoftBody& body, btScalar velocityScale, bool withContacts);
    // Returns whether a node was brought back.
    bool applyMoving(btSoftBody& body, const Region& region, btScalar velocityScale);

    std::vector<Region> m_regions;
    bool m_anyMoves = false;
    btScalar m_leastReach = SIMD_INFINITY;
    btScalar m_leastTolerance = SIMD_INFINITY;
    btScalar m_free = SIMD_INFINITY;  // m, from the end of its path; nodes within it need no test
    NodePaths m_paths;
    std::vector<unsigned char> m_hasContact;
    const ClothFaces* m_faces = nullptr;
    // Data of one apply(), kept for its memory.
    std::vector<Restless> m_restless;
    std::vector<unsigned char> m_isBoxed, m_isNear;  // by node: is in m_passed; is near the region tested last
    std::vector<Passed> m_passed;
    btVector3 m_allLow, m_allHigh;  // around all of them
};
}  // namespace drape
