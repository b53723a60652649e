#include "benchmarks/error_vs_time/error_scene.h"

#include <cmath>

#include "scenes/models.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace drape::bench
{
namespace
{
constexpr float kPlateHeight = 1.0f;       // m
constexpr float kPlateThickness = 0.004f;  // m, a fifth of the contact's
constexpr double kPlateSpeed = 30;         // m/s: half a metre a frame
constexpr float kPlateRun = 1.2f;  // m from the plate to the cloth: Bullet knows a body's speed from its second step on
constexpr int kBoards = 24;
constexpr float kBoardThickness = 0.008f;  // m
constexpr float kBoardPitch = 0.03f;       // m: the gaps are 22 mm wide
constexpr float kBoardTurn = 0.26f;        // rad, 15 degrees
// Bounds the random differences between falls: any rotation, shifts that leave the obstacle under the cloth, and
// throws.
constexpr double kShift = 0.25;  // m
constexpr double kThrow = 8;     // m/s downwards

// Appends the mesh, turned about y and raised.
void append(TriangleMesh& all, const TriangleMesh& mesh, float turn, float height)
{
    const std::int32_t first = std::int32_t(all.vertexCount());
    const float c = std::cos(turn), s = std::sin(turn);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    {
        const float* p = &mesh.m_positions[3 * v];
        all.m_positions.insert(all.m_positions.end(), {c * p[0] + s * p[2], p[1] + height, c * p[2] - s * p[0]});
    }
    for (const std::int32_t index : mesh.m_triangles)
        all.m_triangles.push_back(first + index);
}

TriangleMesh makePile()
{
    TriangleMesh pile;
    const TriangleMesh board = makeBox(0.9f, kBoardThickness, 0.9f);
    for (int i = 0; i < kBoards; ++i)
        append(pile, board, kBoardTurn * float(i), kBoardPitch * (float(i) + 0.5f));
    return pile;
}

// Makes the named obstacle, and sets its cloth's side in m and the height above the top at which the cloth starts.
bool makeObstacle(ErrorScene& scene, const std::vector<std::string>& folders, float& clothSize, float& drop,
                  std::string& error)
{
    TriangleMesh& obstacle = scene.m_drop.m_obstacle;
    clothSize = 2.4f;
    drop = 0.3f;
    if (scene.m_name == "bunny" || scene.m_name == "dragon") return makeModel(scene.m_name, folders, obstacle, error);
    if (scene.m_name == "stairs")
    {
        obstacle = makeStairs(2.0f, 1.2f, 2.0f, 6);
        scene.m_symmetric = true;
    }
    else if (scene.m_name == "plate")
    {
        append(obstacle, makeBox(1.2f, kPlateThickness, 1.2f), 0, kPlateHeight);
        clothSize = 1.8f;
        drop = kPlateRun;
        scene.m_rise = kPlateSpeed;
        scene.m_symmetric = true;
    }
    else if (scene.m_name == "pile")
    {
        obstacle = makePile();
        clothSize = 1.8f;
    }
    else
    {
        error = "no scene is called " + scene.m_name;
        return false;
    }
    return true;
}
}  // namespace

std::vector<std::string> errorSceneNames(bool quick)
{
    if (quick) return {"stairs", "plate"};
    return {"bunny", "stairs", "plate", "pile", "dragon"};
}

bool makeErrorScene(const std::string& name, bool quick, const std::vector<std::string>& modelFolders,
                    ErrorScene& scene, std::string& error)
{
    scene = ErrorScene();
    scene.m_name = name;
    float clothSize = 0, drop = 0;
    if (!makeObstacle(scene, modelFolders, clothSize, drop, error)) return false;
    const int nodes = quick ? 13 : 33;
    const float top = boundsOf(scene.m_drop.m_obstacle).m_high[1];
    scene.m_drop.m_cloth = makeClothGrid(nodes, nodes, clothSize, top + float(kThickness) + drop);
    scene.m_drop.m_dt = kFrameTime;
    scene.m_drop.m_thickness = kThickness;
    return true;
}

void varyFall(ErrorScene& scene, std::uint32_t seed)
{
    Random random(seed);
    const double turn = random.within(0, 2 * 3.14159265358979), shiftX = random.within(-kShift, kShift),
                 shiftZ = random.within(-kShift, kShift);
    std::vector<float>& positions = scene.m_drop.m_cloth.m_mesh.m_positions;
    for (std::size_t i = 0; i < positions.size(); i += 3)
    {
        const double x = positions[i], z = positions[i + 2];
        positions[i] = float(std::cos(turn) * x + std::sin(turn) * z + shiftX);
        positions[i + 2] = float(std::cos(turn) * z - std::sin(turn) * x + shiftZ);
    }
    scene.m_drop.m_dropSpeed = random.within(0, kThrow);
}
}  // namespace drape::bench
