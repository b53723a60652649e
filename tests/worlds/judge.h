// The independent check of a random world. It finds the cloth triangles that intersect an obstacle after a step, and
// the nodes that are on another side of a surface than they started on.
//
// It shares no code with the product. Obstacles are read from the world's own arrays. Cloth is transformed into each
// obstacle's frame in double precision, and intersections are decided exactly there (oracle/exact_predicates.h).
// A node is through if its paths from step to step have passed an obstacle's triangles more often from the front than
// from the back, or vice versa. A path that passes in and out again changes nothing. Paths that end the step exactly on
// a surface have no side. A fixed offset of up to 0.1 µm, another one for each node, keeps nodes from such positions.
// Links that hang from cloth or belong to a rope count as triangles without area. Bending links count only for nodes
// without a face. Held nodes (without motion or anchored) and the triangles at them are counted separately: their
// supports may pull them into an obstacle, which no collision can prevent.
#pragma once

#include <memory>
#include <vector>

#include "oracle/triangle_tree.h"
#include "tests/worlds/world.h"

namespace drape::test
{
struct Findings
{
    int m_pairs = 0;        // a cloth triangle or string without held nodes and an obstacle triangle that share a point
    int m_heldPairs = 0;    // pairs with a held node
    int m_through = 0;      // nodes without those that are held
    int m_heldThrough = 0;  // held nodes
    int m_invalidNodes = 0;  // NaN or infinite; they and their triangles take no part in the rest
};

class Judge
{
public:
    explicit Judge(const World& world);

    // Looks at the world after a step. Nodes that pass in a step that reported something start anew where they are.
    Findings look(bool reported);
    // Notes where nodes are between two of Bullet's steps, for the next look: the way through several steps bends
    // around corners that a straight one would cut.
    void noteBetween(bool reported);

private:
    struct Obstacle
    {
        const WorldObstacle* m_obstacle;
        btVector3 m_scaling;
        std::unique_ptr<TriangleTree> m_surface;
        btTransform m_pose;  // the object's pose at the last look
    };
    struct Follow  // one cloth beside one obstacle
    {
        std::vector<Vector3> m_last;  // in the obstacle's frame; empty before the first look
        std::vector<int> m_passes;    // from the front minus from the back
        std::vector<bool> m_repeats;  // the last straight way met the surface several times
    };
    struct Cloth
    {
        const btSoftBody* m_body;
        std::vector<bool> m_held, m_valid, m_hasFace;
        std::vector<Vector3> m_offsets;
        std::vector<Follow> m_follows;                  // per obstacle
        std::vector<std::vector<btVector3>> m_between;  // positions after each of Bullet's steps but the last
    };

    void markHeld(Cloth& cloth);
    static void markValid(Cloth& cloth);
    void followBetween(Cloth& cloth, std::size_t obstacle);
    void readSurface(Obstacle& obstacle);
    void countPairs(const Cloth& cloth, const Obstacle& obstacle, const std::vector<Vector3>& places,
                    Findings& findings) const;
    void countPairsOf(const btSoftBody::Node* const nodes[3], const Cloth& cloth, const Obstacle& obstacle,
                      const std::vector<Vector3>& places, Findings& findings) const;
    void follow(Cloth& cloth, std::size_t obstacle, const std::vector<Vector3>& places, bool reported);
    static void forgetWaysAroundRims(const Cloth& cloth, Follow& follow);

    std::vector<Obstacle> m_obstacles;
    std::vector<Cloth> m_cloths;
    std::vector<bool> m_betweenReported;  // by noted step
};
}  // namespace drape::test
