#include "tests/support/live_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
std::vector<float> unposed()
{
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
}
}  // namespace

void LiveScene::nextStep()
{
    changeMeshes();
    moveObstacles();
    moveCloths();
    namePairs();
}

void LiveScene::changeMeshes()
{
    if (m_cloths.size() < 4 && m_random.below(3) == 0) add(m_cloths, randomCloth(), true);
    if (m_obstacles.size() < 4 && m_random.below(3) == 0) add(m_obstacles, randomObstacle(), false);
    if (m_random.below(5) == 0) removeOne(m_cloths);
    if (m_random.below(5) == 0) removeOne(m_obstacles);
}

void LiveScene::moveObstacles()
{
    for (LiveMesh& obstacle : m_obstacles)
    {
        if (m_random.below(3) == 0 && obstacle.m_id % 3 == 0 && obstacle.m_pose.empty()) obstacle.m_pose = unposed();
        if (!obstacle.m_pose.empty())
        {
            place(obstacle);
            continue;
        }
        if (m_random.below(4) != 0) continue;
        translate(obstacle.m_mesh.m_positions, m_random.uniform(-0.05f, 0.05f), m_random.uniform(-0.05f, 0.05f), 0.0f);
        if (m_teleports && m_random.below(4) == 0) jump(obstacle);
        for (Pipeline* pipeline : m_pipelines)
            pipeline->moveObstacle(obstacle.m_id, obstacle.m_mesh.m_positions.data());
    }
}

// Moves the obstacle in one of three cases.
void LiveScene::place(LiveMesh& obstacle)
{
    obstacle.m_poseBefore = obstacle.m_pose;
    if (m_random.below(3) == 0)
    {
        const float angle = m_random.uniform(-0.1f, 0.1f), cosine = std::cos(angle), sine = std::sin(angle);
        obstacle.m_pose = {cosine, 0, sine, 0, 0, 1, 0, 0, -sine, 0, cosine, 0};
        for (const std::size_t shift : {3u, 7u, 11u})
            obstacle.m_pose[shift] = obstacle.m_poseBefore[shift] + m_random.uniform(-0.05f, 0.05f);
    }
    for (Pipeline* pipeline : m_pipelines)
        pipeline->placeObstacle(obstacle.m_id, obstacle.m_poseBefore.data(), obstacle.m_pose.data());
}

void LiveScene::moveCloths()
{
    for (LiveMesh& cloth : m_cloths)
    {
        if (m_teleports && m_random.below(6) == 0) jump(cloth);
        std::vector<float> end = cloth.m_mesh.m_positions;
        translate(end, 0.0f, m_random.uniform(-0.05f, 0.03f), 0.0f);
        disturb(end, 0.02f, m_random);
        for (Pipeline* pipeline : m_pipelines)
            setMotion(*pipeline, cloth.m_id, cloth.m_mesh.m_positions, end);
        cloth.m_start = cloth.m_mesh.m_positions;
        cloth.m_mesh.m_positions = end;
    }
}

void LiveScene::namePairs()
{
    m_pairs.clear();
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        for (std::size_t j = 0; j < m_obstacles.size(); ++j)
        {
            if (m_random.below(4) == 0) continue;
            const float thickness = m_random.uniform(0.01f, 0.05f);
            m_pairs.push_back({i, j, thickness});
            for (Pipeline* pipeline : m_pipelines)
                pipeline->addPair(m_cloths[i].m_id, m_obstacles[j].m_id, thickness);
        }
    }
}

void LiveScene::giveAnew(Pipeline& pipeline, std::vector<MeshId>& added) const
{
    for (MeshId id : added)
        pipeline.remove(id);
    added.clear();
    for (const LiveMesh& cloth : m_cloths)
        added.push_back(addCloth(pipeline, cloth.m_mesh));
    for (const LiveMesh& obstacle : m_obstacles)
        added.push_back(addObstacle(pipeline, obstacle.m_mesh));
    for (std::size_t i = 0; i < m_obstacles.size(); ++i)
        if (!m_obstacles[i].m_pose.empty())
            pipeline.placeObstacle(added[m_cloths.size() + i], m_obstacles[i].m_poseBefore.data(),
                                   m_obstacles[i].m_pose.data());
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
        setMotion(pipeline, added[i], m_cloths[i].m_start, m_cloths[i].m_mesh.m_positions);
    for (const LivePair& pair : m_pairs)
        pipeline.addPair(added[pair.m_cloth], added[m_cloths.size() + pair.m_obstacle], pair.m_thickness);
}

std::vector<MeshId> LiveScene::ids() const
{
    std::vector<MeshId> ids;
    for (const std::vector<LiveMesh>* meshes : {&m_cloths, &m_obstacles})
        for (const LiveMesh& mesh : *meshes)
            ids.push_back(mesh.m_id);
    return ids;
}

TriangleMesh LiveScene::randomCloth()
{
    const int nodes = 3 + int(m_random.below(14));
    TriangleMesh mesh = makeClothGrid(nodes, nodes + 1, 1.0f, m_random.uniform(0.1f, 0.5f)).m_mesh;
    if (m_random.below(5) == 0) mesh.m_triangles.clear();
    return mesh;
}

TriangleMesh LiveScene::randomObstacle()
{
    const char* const shapes[] = {"sphere", "box", "torus", "terrain"};
    if (m_random.below(6) == 0) return TriangleMesh();
    if (m_random.below(4) == 0) return makeSoup(1.0f, 0.2f, int(1 + m_random.below(150)), m_random.below(1000));
    return shapeNamed(shapes[m_random.below(4)]);
}

void LiveScene::add(std::vector<LiveMesh>& meshes, TriangleMesh mesh, bool cloth)
{
    MeshId id = kNoMesh;
    for (Pipeline* pipeline : m_pipelines)
    {
        const MeshId added = cloth ? addCloth(*pipeline, mesh) : addObstacle(*pipeline, mesh);
        EXPECT_TRUE(id == kNoMesh || id == added);
        id = added;
    }
    const std::vector<float> home = mesh.m_positions;
    meshes.push_back({id, std::move(mesh), home, {}, {}, {}});
}

void LiveScene::removeOne(std::vector<LiveMesh>& meshes)
{
    if (meshes.empty()) return;
    const std::ptrdiff_t at = std::ptrdiff_t(m_random.below(std::uint32_t(meshes.size())));
    for (Pipeline* pipeline : m_pipelines)
        pipeline->remove(meshes[std::size_t(at)].m_id);
    meshes.erase(meshes.begin() + at);
}

void LiveScene::jump(LiveMesh& mesh)
{
    if (m_random.below(2) == 0)
    {
        mesh.m_mesh.m_positions = mesh.m_home;
        return;
    }
    translate(mesh.m_mesh.m_positions, m_random.uniform(-1.0f, 1.0f), m_random.uniform(-1.0f, 1.0f),
              m_random.uniform(-1.0f, 1.0f));
}
}  // namespace drape::test
