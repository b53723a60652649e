// Keeps nodes near obstacles within the region that detection has searched.
//
// Rule: near an obstacle a node ends close to the straight path of its prediction. A node with contacts may leave the
// path by the activation distance. A node without contacts may leave the path's end by most of the reach, and less
// towards the path's start. A node is near an obstacle if it or any of its faces is. Other nodes are not changed.
//
// The path is relative to a moving obstacle. Metres, world frame. Cost: linear in the nodes; again for nodes that left
// their paths and their faces, per near obstacle. Reasons: docs/design_notes/motion_limit.md.
#pragma once

#include <limits>
#include <vector>

#include "bullet_plugin/core/solver/solver_contact.h"
#include "bullet_plugin/core/solver/solver_nodes.h"
#include "bullet_plugin/core/solver/topology/cloth_faces.h"
#include "kernels/lib/solver/motion_limit.h"

namespace drape
{
// Share of the reach by which a node without contacts may leave its path; the rest is for rounding and the detection's
// own tolerances.
constexpr float kFreeShare = 0.9f;

// Minimum distance by which a node with contacts may leave its path, as a share of the thickness, if the activation is
// set to less.
constexpr float kLeastShare = 0.1f;

// Maximum distance by which a node may leave the path's start, as a share of the thickness, which is known to be free
// there.
constexpr float kMostStartShare = 0.8f;

class MotionLimit
{
public:
    // Forgets the obstacles; memory is kept.
    void clear();
    // Adds the box of an obstacle of one of the cloth's pairs, the pair's thickness, and the activation as a share of
    // it. Nodes are free if everything that their faces can pass between the ends of their paths and their positions
    // misses every box. The caller owns what carry points to. While all obstacles rest, a node with contacts ends at
    // most pathTolerance() of the thinnest pair from its path.
    void addObstacle(Vec3 low, Vec3 high, float thickness, float activation, const Carry& carry = Carry());
    // Begins a step; no node has contacts yet. The faces refer to the nodes of all other calls, and must stay unchanged
    // until the last of them.
    void startStep(const ClothFaces& faces);
    // Returns the distance by which a node with contacts may leave its path, m.
    static float pathTolerance(float thickness, float activation);
    // Names a node of a contact; after startStep().
    void addContactNode(int node) { m_hasContact[std::size_t(node)] = 1; }
    // Returns whether the cloth may have passed a surface without a contact. This is so if a node, limited or not,
    // ended more than kFreeShare of the reach from its path's end, and the node or one of its faces came near an
    // obstacle on the path.
    bool anyOffPath(const SolverNodes& nodes);
    // Brings nodes that left their path too far back to the nearest point of the allowed region.
    void apply(SolverNodes& nodes);
    // Does the same as apply() for nodes without contacts alone.
    void applyToOthers(SolverNodes& nodes);
    // Distances by which a node may leave the path's start and end.
    struct Allowance
    {
        float m_start, m_end;
    };
    // An obstacle and where it limits nodes.
    struct Region
    {
        Box m_box;
        Allowance m_allowance;
        Carry m_carry;
    };
    const std::vector<Region>& regions() const { return m_regions; }
    const ClothFaces* faces() const { return m_faces; }
    // Returns the distance from the ends of their paths within which nodes are free, m; infinity without obstacles.
    float sureDistance() const { return m_sure; }
    // Returns pathTolerance() of the thinnest pair, m.
    float leastTolerance() const { return m_leastTolerance; }
    // Returns whether all obstacles rest. keepNear() then replaces apply() for a node with contacts, wherever the
    // other nodes are.
    bool obstaclesRest() const { return !m_anyMoves; }
    // Returns how far the obstacles' motion in the step carries a node at most, m: one of a contact, or any.
    enum class Carried
    {
        ContactNodes,
        AllNodes
    };
    float mostCarried(const SolverNodes& nodes, Carried which = Carried::ContactNodes) const;
    // Returns a bound on the same for nodes that start in the box, m.
    float mostCarried(Vec3 low, Vec3 high) const;
    // Returns the distance from its path's end within which no node can have passed a surface without a contact, m.
    float freeDistance() const { return kFreeShare * m_leastReach; }
    // Limits a node while the obstacles rest, if it has contacts: it stays within the path tolerance of the thinnest
    // pair.
    void keepNear(SolverNodes& nodes, std::size_t node) const;

private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    // A node farther from its path's end than is always free.
    struct FarNode
    {
        int m_node;
        Allowance m_allowed;  // by the obstacles that rest
    };
    // The volume that a node or a triangle may pass between the end of its path and its current position.
    struct Passed
    {
        Box m_box;
        int m_nodes[3];
    };

    bool isFar(const SolverNodes& nodes, std::size_t node) const;
    bool findFarNodes(const SolverNodes& nodes);
    void boxPassed(const SolverNodes& nodes, bool withContacts);
    void addPassed(const SolverNodes& nodes, int a, int b, int c);
    // Marks nodes near the region. Returns false, with no mark changed, if there are none.
    bool markNear(const Region& region);
    Allowance allowance(const Region& region, std::size_t node) const;
    void applyResting(SolverNodes& nodes, bool withContacts);
    // Returns whether a node was brought back.
    bool applyMoving(SolverNodes& nodes, const Region& region);

    std::vector<Region> m_regions;
    bool m_anyMoves = false;
    float m_leastReach = kInfinity;
    float m_leastTolerance = kInfinity;
    float m_sure = kInfinity;  // m, from the end of its path; nodes within it need no test
    std::vector<unsigned char> m_hasContact;
    const ClothFaces* m_faces = nullptr;
    // Data of one apply(), kept for its memory.
    std::vector<FarNode> m_farNodes;
    std::vector<unsigned char> m_isBoxed, m_isNear;  // by node: is in m_passed; is near the region tested last
    std::vector<Passed> m_passed;
    Box m_all;  // around all of them
};
}  // namespace drape
