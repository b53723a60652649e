#include "examples/cloth_drop/drop_scene.h"

#include "scenes/mesh_loader.h"
#include "scenes/shapes.h"

namespace drape
{
bool makeDropScene(const Options& options, DropScene& scene, std::string& error)
{
    LoadReport report;
    if (!makeShape(options.m_obstacle, scene.m_obstacle) &&
        !loadMesh(options.m_obstacle, Joining::ByPosition, scene.m_obstacle, report, error))
        return false;
    scene.m_notes = report.m_notes;
    if (!(boundsOf(scene.m_obstacle).largestExtent() > 0))
    {
        error = options.m_obstacle + ": all vertices: the mesh has no extent";
        return false;
    }
    placeOnFloor(scene.m_obstacle, static_cast<float>(options.m_obstacleSize));
    const double top = boundsOf(scene.m_obstacle).m_high[1];
    scene.m_cloth = makeClothGrid(options.m_clothColumns, options.m_clothRows, static_cast<float>(options.m_clothSize),
                                  static_cast<float>(top + options.m_thickness + options.m_dropHeight));
    scene.m_dropSpeed = options.m_dropSpeed;
    scene.m_dt = options.m_dt;
    scene.m_thickness = options.m_thickness;
    return true;
}
}  // namespace drape
