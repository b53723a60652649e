// One scene of meshes that come, go and move at random, some obstacles by their places, in several pipelines at once.
//
// Every pipeline is told the same, so ids agree. nextStep() leaves the pipelines ready to run. Seeded.
#pragma once

#include <vector>

#include "tests/support/cases.h"
#include "tests/support/pipeline_driver.h"

namespace drape::test
{
class LiveScene
{
public:
    // teleports: now and then a cloth or an obstacle jumps far away, or a cloth back to where it was made.
    LiveScene(const std::vector<Pipeline*>& pipelines, std::uint32_t seed, bool teleports = false)
        : m_pipelines(pipelines), m_random(seed), m_teleports(teleports)
    {
    }

    void nextStep();

    // Gives the coming step to a pipeline that is none of the scene's, with every mesh added anew: of the steps before,
    // nothing that it kept can matter. added: what the call before added, empty at first.
    void giveAnew(Pipeline& pipeline, std::vector<MeshId>& added) const;
    // Returns the meshes in the order in which giveAnew() adds them.
    std::vector<MeshId> ids() const;

private:
    struct LiveMesh
    {
        MeshId m_id;
        TriangleMesh m_mesh;
        std::vector<float> m_home;
        std::vector<float> m_start;               // start positions of a cloth in the coming step
        std::vector<float> m_poseBefore, m_pose;  // poses of a placed obstacle in the coming step; else empty
    };
    struct LivePair
    {
        std::size_t m_cloth, m_obstacle;
        float m_thickness;
    };

    void changeMeshes();
    void moveObstacles();
    void place(LiveMesh& obstacle);
    void moveCloths();
    void namePairs();
    TriangleMesh randomCloth();
    TriangleMesh randomObstacle();
    void add(std::vector<LiveMesh>& meshes, TriangleMesh mesh, bool cloth);
    void removeOne(std::vector<LiveMesh>& meshes);
    void jump(LiveMesh& mesh);

    std::vector<Pipeline*> m_pipelines;
    Random m_random;
    bool m_teleports;
    std::vector<LiveMesh> m_cloths, m_obstacles;
    std::vector<LivePair> m_pairs;
};
}  // namespace drape::test
