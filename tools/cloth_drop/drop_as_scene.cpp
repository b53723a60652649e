#include "tools/cloth_drop/drop_as_scene.h"

#include <algorithm>

#include "scenes/shapes.h"
#include "tools/cloth_drop/drop_scene.h"

namespace drape
{
namespace
{
SceneObstacle obstacleOf(const Options& options, const DropScene& drop)
{
    SceneObstacle obstacle;
    obstacle.m_mesh = drop.m_obstacle;
    obstacle.m_moves = false;
    obstacle.m_source.m_fit = options.m_obstacleSize;
    const std::vector<std::string>& shapes = shapeNames();
    const bool isShape = std::find(shapes.begin(), shapes.end(), options.m_obstacle) != shapes.end();
    (isShape ? obstacle.m_source.m_builtIn : obstacle.m_source.m_file) = options.m_obstacle;
    return obstacle;
}
}  // namespace

bool dropAsScene(const Options& options, SceneFile& file, std::string& error)
{
    DropScene drop;
    if (!makeDropScene(options, drop, error)) return false;
    file = SceneFile();
    file.m_description = "a cloth that drops on an obstacle";
    file.m_frames = options.m_steps;
    ClothScene& scene = file.m_scene;
    scene.m_name = "drop";
    scene.m_frameTime = options.m_dt;
    scene.m_stepsPerFrame = 1;
    scene.m_iterations = kDropIterations;
    scene.m_thickness = options.m_thickness;
    scene.m_seconds = options.m_steps * options.m_dt;
    scene.m_obstacles = {obstacleOf(options, drop)};
    const std::vector<float> positions = sheetsOf(drop).m_positions;
    const std::size_t count = drop.m_cloth.m_mesh.m_positions.size();
    for (std::size_t layer = 0; layer < drop.m_layers; ++layer)
    {
        const auto first = positions.begin() + std::ptrdiff_t(layer * count);
        SceneCloth cloth;
        cloth.m_shape = {ClothShape::Kind::Grid, options.m_clothColumns, options.m_clothRows, options.m_clothSize, 0};
        cloth.m_rest = makeClothGrid(options.m_clothColumns, options.m_clothRows, float(options.m_clothSize), 0);
        cloth.m_positions.assign(first, first + std::ptrdiff_t(count));
        cloth.m_restsAtStart = true;
        cloth.m_mass = drop.m_mass;
        cloth.m_material = dropMaterial();
        cloth.m_selfCollides = drop.m_self;
        cloth.m_velocity = {0, -drop.m_dropSpeed, 0};
        scene.m_cloths.push_back(cloth);
    }
    return true;
}
}  // namespace drape
