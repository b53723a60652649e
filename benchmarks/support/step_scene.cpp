#include "benchmarks/support/step_scene.h"

#include <algorithm>
#include <cmath>

#include "scenes/draped_cloth.h"

namespace drape::bench
{
namespace
{
constexpr double kClothSize = 2.4;  // m, over a 2 m obstacle, as in cloth_drop
constexpr double kPatchSize = 0.3;  // m, of one of many cloths
// The vertical gap as a share of the thickness. On the steepest drape 0.48 of the thickness remains, and the motion
// takes a little over 0.2 of it. The cloth is near the surface and does not pass it.
constexpr double kGap = 0.75;
constexpr double kWay = 0.15;     // motion per step as a share of the thickness: 3 mm at 20 mm
constexpr double kFoldGap = 0.8;  // vertical gap between a folded cloth's halves, as a share of their thickness
constexpr std::uint32_t kSeed = 7;

std::string sizeName(int cells)
{
    const std::size_t triangles = 2 * static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
    if (triangles >= 1000000) return std::to_string(triangles / 1000000) + "m";
    return triangles >= 1000 ? std::to_string(triangles / 1000) + "k" : std::to_string(triangles);
}

std::vector<SceneSpec> makeSpecs()
{
    std::vector<SceneSpec> specs = {
        {"thesis", "", "bunny", 32, 1, kClothSize, kThickness, false},
        {"fine", "", "bunny", 256, 1, kClothSize, kThickness, false},
        {"fine_on_coarse", "", "sphere_1k", 256, 1, kClothSize, kThickness, false},
        {"many_200", "", "bunny", 16, 200, kPatchSize, kThickness, false},
        {"static_1m", "", "bunny_1m", 32, 1, kClothSize, kThickness, false},
        {"static_1m_fine", "", "bunny_1m", 256, 1, kClothSize, kThickness, false},
        {"self_131k", "", "bunny", 256, 1, kClothSize, kThickness, false, true},
        {"self_2k", "", "bunny", 32, 1, kClothSize, kThickness, false, true},
        {"folded_131k", "", "bunny", 256, 1, kClothSize, kThickness, false, true, true},
        {"quick_self", "", "sphere_1k", 16, 1, kClothSize, kThickness, true, true},
        {"quick_one", "", "sphere_1k", 16, 1, kClothSize, kThickness, true},
        {"quick_many", "", "sphere_1k", 8, 5, kPatchSize, kThickness, true},
    };
    for (const int cells : {16, 32, 64, 128, 256, 512, 1024})
        specs.push_back({"cloth_" + sizeName(cells), "cloth", "bunny", cells, 1, kClothSize, 0, false});
    for (const char* size : {"1k", "5k", "20k", "82k", "328k", "1m"})
        specs.push_back({std::string("obstacle_") + size, "obstacle", std::string("sphere_") + size, 32, 1, kClothSize,
                         kThickness, false});
    const char* const spheres[] = {"1k", "5k", "20k", "82k", "328k", "1m"};
    for (int level = 0; level < 6; ++level)
    {
        const int cells = 32 << level;
        specs.push_back({"both_" + sizeName(cells), "both", std::string("sphere_") + spheres[level], cells, 1,
                         kClothSize, 0, false});
    }
    // The sweep goes from the smallest to the largest cloth, on the smallest obstacle, a middle one and the largest.
    for (const char* size : {"1k", "82k", "1m"})
        for (const int cells : {16, 64, 256, 1024})
            specs.push_back({"cloth_" + sizeName(cells) + "_on_" + size, std::string("on_") + size,
                             std::string("sphere_") + size, cells, 1, kClothSize, 0, false});
    for (const int cloths : {1, 10, 100, 1000})
        specs.push_back(
            {"cloths_" + std::to_string(cloths), "cloths", "bunny", 16, cloths, kPatchSize, kThickness, false});
    return specs;
}

// Returns the number of steps until the motion repeats. Large scenes repeat sooner: their host reference takes seconds
// a step.
int periodOf(const SceneSpec& spec, std::size_t obstacleTriangles)
{
    if (spec.m_quick) return 3;
    if (spec.clothTriangles() > 40000 && obstacleTriangles > 500000) return 4;
    return spec.clothTriangles() <= 40000 ? 12 : spec.clothTriangles() <= 300000 ? 8 : 4;
}

// Lays the second half of a draped cloth, in the direction of its columns, over the first, a gap (m) above.
void foldCloth(std::vector<float>& positions, int cells, float gap)
{
    const std::size_t side = static_cast<std::size_t>(cells) + 1;
    for (std::size_t node = 0; 3 * node < positions.size(); ++node)
    {
        const std::size_t column = node % side;
        if (2 * column <= side - 1) continue;
        const std::size_t under = node - column + (side - 1 - column);
        std::copy_n(&positions[3 * under], 3, &positions[3 * node]);
        positions[3 * node + 1] += gap;
    }
}

double meanEdge(const TriangleMesh& mesh)
{
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        const float* a = &mesh.m_positions[3 * static_cast<std::size_t>(mesh.m_triangles[3 * t])];
        const float* b = &mesh.m_positions[3 * static_cast<std::size_t>(mesh.m_triangles[3 * t + 1])];
        sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }
    return sum / static_cast<double>(std::max<std::size_t>(mesh.triangleCount(), 1));
}
}  // namespace

const std::vector<SceneSpec>& sceneSpecs()
{
    static const std::vector<SceneSpec> specs = makeSpecs();
    return specs;
}

StepScene makeStepScene(const SceneSpec& spec, const TriangleMesh& obstacle)
{
    StepScene scene;
    scene.m_spec = spec;
    scene.m_obstacle = obstacle;
    scene.m_thickness =
        static_cast<float>(spec.m_thickness > 0 ? spec.m_thickness : std::min(kThickness, spec.m_size / spec.m_cells));
    if (spec.m_self) scene.m_selfThickness = static_cast<float>(kSelfShare * spec.m_size / spec.m_cells);
    const HeightField field(obstacle);
    ClothPlace place;
    place.m_cells = spec.m_cells;
    place.m_size = spec.m_size;
    place.m_gap = kGap * scene.m_thickness;
    place.m_detail = meanEdge(obstacle);
    const std::vector<ClothPlace> places = spec.m_cloths == 1 && spec.m_size == kClothSize
                                               ? std::vector<ClothPlace>{place}
                                               : scatterCloths(field, place, spec.m_cloths, kSeed);
    std::vector<float> rest;
    for (const ClothPlace& next : places)
    {
        scene.m_cloths.push_back(drapeCloth(field, next));
        rest.insert(rest.end(), scene.m_cloths.back().m_positions.begin(), scene.m_cloths.back().m_positions.end());
    }
    if (spec.m_folded) foldCloth(rest, spec.m_cells, static_cast<float>(kFoldGap) * scene.m_selfThickness);
    const ClothMotion motion = {periodOf(spec, obstacle.triangleCount()), kWay * scene.m_thickness};
    for (int step = 0; step < motion.m_period; ++step)
    {
        scene.m_frames.emplace_back(rest.size());
        motion.positions(rest, step, scene.m_frames.back().data());
    }
    return scene;
}
}  // namespace drape::bench
